#include "model/falling_values.h"

namespace pent::simulator {

FallingValues::FallingValues(const Ranks* ranks,
                             std::span<const std::uint32_t> owners,
                             std::span<const std::uint32_t> corners)
    : ranks_(ranks) {
    if (ranks == nullptr) {
        return;
    }
    std::vector<bool> is_here(owners.size(), false);
    for (const std::uint32_t vertex : corners) {
        is_here[vertex] = true;
    }
    // Columns of a rank are its vertices in their order, wherever it is asked for them.
    std::vector<std::uint32_t> next(static_cast<std::size_t>(ranks->count()), 0);
    Ghosts ghosts;
    for (std::uint32_t vertex = 0; vertex < owners.size(); ++vertex) {
        const std::uint32_t owner = owners[vertex];
        const std::uint32_t place = next[owner]++;
        if (owner == static_cast<std::uint32_t>(ranks->rank())) {
            own_.push_back(vertex);
        } else if (is_here[vertex]) {
            ghosts_.push_back(vertex);
            ghosts.owners.push_back(owner);
            ghosts.places.push_back(place);
        }
    }
    ghosts.own_columns = static_cast<std::uint32_t>(own_.size());
    for (std::uint32_t i = 0; i < ghosts_.size(); ++i) {
        ghosts.columns.push_back(ghosts.own_columns + i);
    }
    exchange_ = ranks->make_exchange(ghosts);
    columns_.resize(static_cast<Eigen::Index>(own_.size() + ghosts_.size()));
}

std::vector<std::uint32_t> FallingValues::take_over(Eigen::VectorXd& values) {
    std::vector<std::uint32_t> fallen;
    if (exchange_ == nullptr) {
        return fallen;
    }
    Eigen::Index column = 0;
    for (const std::uint32_t vertex : own_) {
        columns_[column++] = values[vertex];
    }
    exchange_->update(columns_.data(), 1);
    for (const std::uint32_t vertex : ghosts_) {
        const double value = columns_[column++];
        if (value < values[vertex]) {
            values[vertex] = value;
            fallen.push_back(vertex);
        }
    }
    return fallen;
}

bool FallingValues::any(bool is_so) const {
    return ranks_ == nullptr ? is_so : simulator::any(*ranks_, is_so);
}

}  // namespace pent::simulator
