#include "linear/sharing.h"

#include <pent/dimensions.h>

#include <algorithm>
#include <numeric>
#include <span>
#include <utility>

namespace pent::simulator {

namespace {

// How many vertices are gathered at a time. All at once would take buffers as large as the array
// itself.
constexpr std::size_t kPiece = std::size_t{1} << 16;

// Sets every column, one a vertex, to what the rank that owns the vertex has there.
//
// @param owners  Of these vertices.
// @param values  Column-major, `Rows` numbers a column.
template <int Rows>
void gather_piece(const Ranks& ranks, std::span<const std::uint32_t> owners, double* values) {
    std::vector<std::int64_t> sizes(static_cast<std::size_t>(ranks.count()), 0);
    std::vector<double> own;
    for (std::size_t vertex = 0; vertex < owners.size(); ++vertex) {
        sizes[owners[vertex]] += Rows;
        if (owners[vertex] == static_cast<std::uint32_t>(ranks.rank())) {
            own.insert(own.end(), values + vertex * Rows, values + (vertex + 1) * Rows);
        }
    }
    const std::vector<double> all = ranks.gather(own, sizes);
    std::vector<std::int64_t> next(sizes.size(), 0);
    std::exclusive_scan(sizes.begin(), sizes.end(), next.begin(), std::int64_t{0});
    for (std::size_t vertex = 0; vertex < owners.size(); ++vertex) {
        std::int64_t& at = next[owners[vertex]];
        std::copy_n(all.data() + at, Rows, values + vertex * Rows);
        at += Rows;
    }
}

}  // namespace

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
    for (std::size_t first = 0; first < owners_.size(); first += kPiece) {
        const std::span<const std::uint32_t> owners =
            std::span(owners_).subspan(first, std::min(kPiece, owners_.size() - first));
        gather_piece<Rows>(*ranks_, owners, values.col(static_cast<Eigen::Index>(first)).data());
    }
}

#define PENT_INSTANTIATE(Rows) \
    template void Sharing::gather(Eigen::Matrix<double, Rows, Eigen::Dynamic>&) const;
PENT_INSTANTIATE(1)
PENT_FOR_EACH_DIMENSION(PENT_INSTANTIATE)
#undef PENT_INSTANTIATE

}  // namespace pent::simulator
