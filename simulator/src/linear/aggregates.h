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

/// A partition of children (dofs, or the aggregates of the next finer level) into connected,
/// compact pieces of about equal size.
///
/// Aggregates are numbered by color, so that consecutive ones are scattered over a body, children
/// from one end of it to the other. For locality aggregates are therefore visited, and their
/// members stored, in the order of first members: neighbors find what they share in the caches.
///
/// With ranks, ghosts are numbered behind what is of this rank, children and aggregates alike.
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
    /// Where its members begin in an array of those of all aggregates, in the order of visits.
    [[nodiscard]] std::size_t first_of(std::size_t aggregate) const {
        return members_of_[aggregate].first;
    }
    /// Children of this rank.
    [[nodiscard]] std::size_t children() const { return members_.size(); }
    /// Which aggregate a child belongs to.
    [[nodiscard]] const std::vector<std::uint32_t>& of_child() const { return of_child_; }

    /// How many ghosts there are: aggregates of other ranks, without members here.
    [[nodiscard]] std::uint32_t ghosts() const { return ghosts_; }
    /// @param of_child  Which aggregate each child belongs to, ghosts among the children.
    void set_ghosts(std::vector<std::uint32_t> of_child, std::uint32_t ghosts) {
        of_child_ = std::move(of_child);
        ghosts_ = ghosts;
    }

    /// Calls work(aggregates), in parallel, for those of this rank, up to `most` of them at a time.
    template <typename Work>
    void for_each_part(const Workers& workers, std::size_t most, const Work& work) const {
        workers.for_each((order_.size() + most - 1) / most, [&](std::size_t part) {
            const std::size_t first = part * most;
            work(std::span<const std::uint32_t>(order_.data() + first,
                                                std::min(most, order_.size() - first)));
        });
    }
    /// Calls work(aggregate), in parallel, for each of this rank.
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
    std::vector<std::uint32_t> members_;  // of all aggregates, in that order
    std::vector<Range> members_of_;       // of each aggregate, in members_
    std::uint32_t ghosts_ = 0;
};

/// A hierarchy ends with at most so many aggregates, unless they share no links.
inline constexpr int kCoarsestAggregates = 24;

/// Aggregates of about 29 dofs each, aggregates of about 6 of these, and so on until few are left.
///
/// Whole extrusion columns (single dofs, where a mesh knows no columns) are clustered along the
/// links of the matrix by grow_aggregates(), with borders halfway between centroids, since rigid
/// pieces with ragged borders lock where a body bends. Each cluster is then cut across into parts
/// about twice as long as wide, thin layers not at all: these are the finest aggregates. Growing
/// along links keeps parts of a body apart that lie side by side without being connected, which
/// cutting space into boxes would not. What has no link to others stays alone. Aggregates that
/// share no link follow one another, by color.
///
/// With ranks each has aggregates of its own dofs alone, and all have as many levels.
///
/// @param pattern       Whose blocks are the links of the dofs; ghosts are left out.
/// @param column_start  As DofMap::column_start().
/// @param rest          Dim x dofs, rest positions, m.
/// @param sharing       Null without ranks.
/// @return              The finest first; at least one level, which is empty without dofs.
template <int Dim>
[[nodiscard]] std::vector<Aggregates> make_hierarchy(const BlockPattern& pattern,
                                                     const std::vector<std::uint32_t>& column_start,
                                                     const Positions<Dim>& rest,
                                                     const Sharing* sharing = nullptr);

}  // namespace pent::simulator
