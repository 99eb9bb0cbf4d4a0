#pragma once

#include "linear/block_pattern.h"
#include "linear/sharing.h"

#include <pent/parallel.h>
#include <pent/simplex_mesh.h>

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <span>
#include <utility>
#include <vector>

namespace pent::simulator {

/// A partition of children (dofs, or the aggregates of the level below) into connected, compact
/// pieces of about equal size.
///
/// Aggregates are numbered by color, which is all over a body, children from one side of it to the
/// other. So aggregates are gone over, and their members kept, in the order of their first members:
/// what neighbors need of the same memory is read once.
///
/// Where dofs are shared those of other ranks may be numbered behind those of this one, children
/// and aggregates alike.
class Aggregates {
public:
    Aggregates() = default;
    /// @param of_child  Which aggregate each child of this rank belongs to.
    /// @param count     Of aggregates; none is empty.
    Aggregates(std::vector<std::uint32_t> of_child, std::size_t count);

    /// Of this rank.
    [[nodiscard]] int count() const { return static_cast<int>(members_of_.size()); }
    /// Children of one, increasing.
    [[nodiscard]] std::span<const std::uint32_t> members(std::size_t aggregate) const {
        return {members_.data() + members_of_[aggregate].first, members_of_[aggregate].count};
    }
    /// Where its members begin if those of all follow one another.
    [[nodiscard]] std::size_t first_of(std::size_t aggregate) const {
        return members_of_[aggregate].first;
    }
    /// Children of this rank.
    [[nodiscard]] std::size_t children() const { return members_.size(); }
    /// Which aggregate a child belongs to.
    [[nodiscard]] const std::vector<std::uint32_t>& of_child() const { return of_child_; }

    /// Aggregates of other ranks: without members here.
    [[nodiscard]] std::uint32_t ghosts() const { return ghosts_; }
    /// @param of_child  Which aggregate each child belongs to, with children of other ranks.
    void set_ghosts(std::vector<std::uint32_t> of_child, std::uint32_t ghosts) {
        of_child_ = std::move(of_child);
        ghosts_ = ghosts;
    }

    /// Calls work(aggregates) for those of this rank, `most` of them in a task.
    template <typename Work>
    void for_each_part(const Workers& workers, std::size_t most, const Work& work) const {
        workers.for_each((order_.size() + most - 1) / most, [&](std::size_t part) {
            const std::size_t first = part * most;
            work(std::span<const std::uint32_t>(order_.data() + first,
                                                std::min(most, order_.size() - first)));
        });
    }
    /// Calls work(aggregate) for each of this rank, at the same time.
    template <typename Work>
    void for_each(const Workers& workers, const Work& work) const {
        constexpr std::size_t kTask = 64;
        for_each_part(workers, kTask, [&](std::span<const std::uint32_t> aggregates) {
            for (const std::uint32_t aggregate : aggregates) {
                work(aggregate);
            }
        });
    }

private:
    struct Range {
        std::uint32_t first = 0;
        std::uint32_t count = 0;
    };

    std::vector<std::uint32_t> of_child_;
    std::vector<std::uint32_t> order_;
    std::vector<std::uint32_t> members_;  // of all, in that order
    std::vector<Range> members_of_;
    std::uint32_t ghosts_ = 0;
};

/// Most aggregates at which a hierarchy ends, unless they share no link.
inline constexpr int kCoarsestAggregates = 24;

/// Aggregates of about 29 dofs each, aggregates of about 6 of these, and so on until few are left.
///
/// Clusters of whole columns, single dofs where a mesh knows none, grow from a seed beside those
/// that are there, along links of the matrix, always by what is nearest to their middle; then
/// borders move until they are halfway between middles, for ragged ones lock where a body bends.
/// Each is then cut across in parts about twice as long as wide, thin layers not at all: these are
/// the finest aggregates. Arms of a body that lie side by side never share one, as pieces of space
/// would make them. What has no link to others stays alone. Those that share no link follow one
/// another, by color.
///
/// Where dofs are shared each rank has aggregates of its own dofs, and all have as many levels.
///
/// @param pattern       Links of the dofs that have rows; columns of others are left out.
/// @param column_start  As DofMap::column_start().
/// @param rest          Dim x dofs, rest positions, m.
/// @param sharing       Null where nothing is shared.
/// @return              The finest first; at least one level, which is empty without dofs.
template <int Dim>
[[nodiscard]] std::vector<Aggregates> make_hierarchy(const BlockPattern& pattern,
                                                     const std::vector<std::uint32_t>& column_start,
                                                     const Positions<Dim>& rest,
                                                     const Sharing* sharing = nullptr);

}  // namespace pent::simulator
