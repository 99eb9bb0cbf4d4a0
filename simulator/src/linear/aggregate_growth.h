#pragma once

#include "linear/aggregates.h"
#include "linear/links.h"

#include <pent/simplex_mesh.h>

#include <cstddef>
#include <cstdint>
#include <vector>

namespace pent::simulator {

/// A relative difference that is none: rounding, which instruction sets and compilers do each in
/// their own way, does not decide.
inline constexpr double kTie = 1e-9;

/// What aggregates grow from.
template <int Dim>
struct AggregateNodes {
    Links links;
    Positions<Dim> places;        ///< m
    std::vector<double> weights;  ///< What each counts for the size of an aggregate.
    std::vector<double> dofs;     ///< In each.
};

/// Connected, compact aggregates, each from a seed beside those that are there, always by what is
/// nearest to its middle. Then borders move until they are halfway between middles.
///
/// @param size  What nodes of an aggregate weigh together, about.
/// @return      By color: those that share no link follow one another.
template <int Dim>
[[nodiscard]] Aggregates grow_aggregates(const AggregateNodes<Dim>& nodes, double size);

/// Aggregates from pieces that are there: the parts of each that hang together; what is small joins
/// what it has most links with.
///
/// @param piece_of  A number of each node's piece.
/// @return          As above.
template <int Dim>
[[nodiscard]] Aggregates mend_aggregates(const AggregateNodes<Dim>& nodes,
                                         double size,
                                         std::vector<std::uint32_t> piece_of);

}  // namespace pent::simulator
