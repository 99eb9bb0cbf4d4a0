#include "linear/sharing.h"

#include <pent/dimensions.h>

#include <utility>

namespace pent::simulator {

Sharing::Sharing(std::shared_ptr<const Ranks> ranks, std::vector<std::uint32_t> owners)
    : ranks_(std::move(ranks)),
      rank_(static_cast<std::uint32_t>(ranks_->rank())),
      owners_(std::move(owners)),
      counts_(static_cast<std::size_t>(ranks_->count()), 0) {
    for (const std::uint32_t owner : owners_) {
        ++counts_[owner];
    }
}

void Sharing::sum(std::vector<double>& values) const {
    if (!is_shared() || values.empty()) {
        return;
    }
    const std::vector<std::int64_t> sizes(counts_.size(), static_cast<std::int64_t>(values.size()));
    const std::vector<double> all = ranks_->gather(values, sizes);
    for (std::size_t i = 0; i < values.size(); ++i) {
        double total = 0;
        for (std::size_t at = i; at < all.size(); at += values.size()) {
            total += all[at];
        }
        values[i] = total;
    }
}

std::vector<double> Sharing::list(double value) const {
    if (!is_shared()) {
        return {value};
    }
    return ranks_->gather({&value, 1}, std::vector<std::int64_t>(counts_.size(), 1));
}

double Sharing::sum(double value) const {
    if (!is_shared()) {
        return value;
    }
    double total = 0;
    for (const double part : list(value)) {
        total += part;
    }
    return total;
}

std::int64_t Sharing::sum(std::int64_t value) const {
    return is_shared() ? static_cast<std::int64_t>(sum(static_cast<double>(value))) : value;
}

bool Sharing::any(bool is_so) const {
    return is_shared() ? sum(is_so ? 1.0 : 0.0) > 0 : is_so;
}

template <int Rows>
void Sharing::gather(Eigen::Matrix<double, Rows, Eigen::Dynamic>& values) const {
    if (!is_shared()) {
        return;
    }
    std::vector<std::int64_t> sizes;
    for (const std::int64_t count : counts_) {
        sizes.push_back(count * Rows);
    }
    std::vector<double> own;
    own.reserve(static_cast<std::size_t>(sizes[rank_]));
    for (std::uint32_t vertex = 0; vertex < owners_.size(); ++vertex) {
        if (owners_[vertex] == rank_) {
            own.insert(own.end(), values.col(vertex).begin(), values.col(vertex).end());
        }
    }
    const std::vector<double> all = ranks_->gather(own, sizes);
    std::vector<std::int64_t> next(sizes.size(), 0);
    for (std::size_t rank = 1; rank < sizes.size(); ++rank) {
        next[rank] = next[rank - 1] + sizes[rank - 1];
    }
    for (std::uint32_t vertex = 0; vertex < owners_.size(); ++vertex) {
        std::int64_t& at = next[owners_[vertex]];
        values.col(vertex) = Eigen::Map<const Eigen::Matrix<double, Rows, 1>>(all.data() + at);
        at += Rows;
    }
}

#define PENT_INSTANTIATE(Rows) \
    template void Sharing::gather(Eigen::Matrix<double, Rows, Eigen::Dynamic>&) const;
PENT_INSTANTIATE(1)
PENT_FOR_EACH_DIMENSION(PENT_INSTANTIATE)
#undef PENT_INSTANTIATE

}  // namespace pent::simulator
