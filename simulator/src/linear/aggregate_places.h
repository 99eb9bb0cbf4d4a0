#pragma once

#include "linear/aggregates.h"
#include "linear/rigid_modes.h"

#include <pent/parallel.h>
#include <pent/simulator/ranks.h>

#include <cstdint>
#include <vector>

namespace pent::simulator {

/// Where aggregates are, and how large.
template <int Dim>
struct AggregatePlaces {
    Positions<Dim> middles;      ///< Dim x aggregates, m: centroids of their vertices.
    std::vector<double> sizes;   ///< Root mean square distance of the vertices from these, m.
    std::vector<double> counts;  ///< Of vertices.
};

/// The same for the children of a level: aggregates or, on the finest level, vertices, each of
/// which counts as an aggregate of size zero. What it is made from must outlive it.
template <int Dim>
class ChildPlaces {
public:
    explicit ChildPlaces(const Positions<Dim>& vertices) : middles_(&vertices) {}
    explicit ChildPlaces(const AggregatePlaces<Dim>& aggregates)
        : middles_(&aggregates.middles), aggregates_(&aggregates) {}

    [[nodiscard]] auto middle(std::uint32_t child) const { return middles_->col(child); }
    [[nodiscard]] double size(std::uint32_t child) const {
        return aggregates_ != nullptr ? aggregates_->sizes[child] : 0;
    }
    [[nodiscard]] double count(std::uint32_t child) const {
        return aggregates_ != nullptr ? aggregates_->counts[child] : 1;
    }

private:
    const Positions<Dim>* middles_;
    const AggregatePlaces<Dim>* aggregates_ = nullptr;
};

/// @param children  Those of this rank at least.
template <int Dim>
[[nodiscard]] AggregatePlaces<Dim> places_of(const Workers& workers,
                                             const Aggregates& aggregates,
                                             const ChildPlaces<Dim>& children);

/// The arm of each child in its aggregate, ghosts among the children.
///
/// @param places    Of the aggregates.
/// @param exchange  Of the children; null where nothing is shared.
template <int Dim>
[[nodiscard]] Arms<Dim> arms_of(const Workers& workers,
                                const Aggregates& aggregates,
                                const ChildPlaces<Dim>& children,
                                const AggregatePlaces<Dim>& places,
                                GhostExchange* exchange);

}  // namespace pent::simulator
