#pragma once

#include "linear/aggregates.h"
#include "linear/rigid_modes.h"

#include <pent/simulator/ranks.h>

#include <vector>

namespace pent::simulator {

/// Where aggregates are. A vertex is its own, of no size.
template <int Dim>
struct AggregatePlaces {
    Positions<Dim> middles;      ///< Dim x aggregates, m: means of their vertices.
    std::vector<double> sizes;   ///< Root mean square distance of the vertices from the middle, m.
    std::vector<double> counts;  ///< Of vertices.
};

/// @param children  One a child of this rank at least.
template <int Dim>
[[nodiscard]] AggregatePlaces<Dim> places_of(const Aggregates& aggregates,
                                             const AggregatePlaces<Dim>& children);

/// One a child, those of other ranks among them.
///
/// @param places    Of the aggregates.
/// @param exchange  Of the children; null where nothing is shared.
template <int Dim>
[[nodiscard]] std::vector<Arm<Dim>> arms_of(const Aggregates& aggregates,
                                            const AggregatePlaces<Dim>& children,
                                            const AggregatePlaces<Dim>& places,
                                            GhostExchange* exchange);

}  // namespace pent::simulator
