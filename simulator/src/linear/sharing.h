#pragma once

#include <pent/simplex_mesh.h>
#include <pent/simulator/ranks.h>

#include <cstdint>
#include <memory>
#include <vector>

namespace pent::simulator {

/// Which rank owns which vertex, and reductions over ranks. By default there are no ranks: this
/// process owns everything, and a reduction returns what it is given.
class Sharing {
public:
    Sharing() = default;

    /// @param owners  The rank of every vertex, below ranks->count(); the same on all ranks.
    Sharing(std::shared_ptr<const Ranks> ranks, std::vector<std::uint32_t> owners);

    [[nodiscard]] bool is_shared() const { return ranks_ != nullptr; }

    /// Only where it is shared.
    [[nodiscard]] const Ranks& ranks() const { return *ranks_; }

    [[nodiscard]] bool owns(std::uint32_t vertex) const {
        return ranks_ == nullptr || owners_[vertex] == rank_;
    }

    /// Only where it is shared.
    [[nodiscard]] std::uint32_t owner(std::uint32_t vertex) const { return owners_[vertex]; }

    /// How many of so many vertices are of this rank.
    [[nodiscard]] std::int64_t own_count(std::int64_t vertices) const {
        return ranks_ == nullptr ? vertices : counts_[rank_];
    }

    /// Sums over ranks, added in the order of ranks: the same bits on all of them.
    [[nodiscard]] double sum(double value) const;
    [[nodiscard]] std::int64_t sum(std::int64_t value) const;  ///< Below 2^53.
    void sum(std::vector<double>& values) const;

    /// Whether it is so on any rank.
    [[nodiscard]] bool any(bool is_so) const;

    /// One number of each rank, in their order; without ranks the number itself.
    [[nodiscard]] std::vector<double> list(double value) const;

    /// Sets every column, one a vertex, to what the rank that owns the vertex has there.
    template <int Rows>
    void gather(Eigen::Matrix<double, Rows, Eigen::Dynamic>& values) const;

private:
    std::shared_ptr<const Ranks> ranks_;
    std::uint32_t rank_ = 0;
    std::vector<std::uint32_t> owners_;
    std::vector<std::int64_t> counts_;  // of the vertices of each rank
};

}  // namespace pent::simulator
