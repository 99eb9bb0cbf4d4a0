#pragma once

#include "linear/aggregates.h"
#include "linear/links.h"

#include <pent/simplex_mesh.h>

#include <cstddef>
#include <cstdint>
#include <vector>

namespace pent::simulator {

/// What differs relatively by less counts as equal, so that rounding, in which compilers and
/// instruction sets differ, decides nothing.
inline constexpr double kTie = 1e-9;

/// The graph that aggregates grow on.
template <int Dim>
struct AggregateNodes {
    Links links;
    Positions<Dim> places;        ///< Of the nodes, m.
    std::vector<double> weights;  ///< What each node counts toward the size of an aggregate.
    std::vector<double> dofs;     ///< How many each node stands for.
};

/// Connected, compact aggregates by greedy growth: each starts from a seed beside those made before
/// it and goes on taking the adjacent node that is nearest to its centroid. Then, as in Lloyd's
/// method, borders move until they are halfway between centroids.
///
/// @param size  About the weight of an aggregate.
/// @return      Numbered by color: aggregates that share no link follow one another.
template <int Dim>
[[nodiscard]] Aggregates grow_aggregates(const AggregateNodes<Dim>& nodes, double size);

/// Aggregates from a given partition: the connected components of each piece, where one that is
/// small joins the neighbor with which it has the most links.
///
/// @param piece_of  The piece of each node.
/// @return          Numbered as above.
template <int Dim>
[[nodiscard]] Aggregates mend_aggregates(const AggregateNodes<Dim>& nodes,
                                         double size,
                                         std::vector<std::uint32_t> piece_of);

}  // namespace pent::simulator
