#include "linear/aggregate_places.h"

#include <pent/dimensions.h>

#include <algorithm>
#include <cmath>
#include <cstddef>

namespace pent::simulator {

namespace {

// Gives ghosts among the children the arms that they have on their own ranks.
template <int Dim>
void update(Arms<Dim>& arms, GhostExchange& exchange) {
    Eigen::Matrix<double, Dim + 1, Eigen::Dynamic> told(Dim + 1,
                                                        static_cast<Eigen::Index>(arms.size()));
    for (std::size_t child = 0; child < arms.size(); ++child) {
        told.col(static_cast<Eigen::Index>(child)) << arms[child].x, arms[child].ratio;
    }
    exchange.update(told.data(), Dim + 1);
    for (std::size_t child = 0; child < arms.size(); ++child) {
        const auto column = told.col(static_cast<Eigen::Index>(child));
        arms[child] = {column.template head<Dim>(), column[Dim]};
    }
}

}  // namespace

template <int Dim>
AggregatePlaces<Dim> places_of(const Workers& workers,
                               const Aggregates& aggregates,
                               const ChildPlaces<Dim>& children) {
    const auto count = static_cast<std::size_t>(aggregates.count());
    AggregatePlaces<Dim> places{Positions<Dim>::Zero(Dim, aggregates.count()),
                                std::vector<double>(count), std::vector<double>(count)};
    aggregates.for_each(workers, [&](std::size_t a) {
        auto middle = places.middles.col(static_cast<Eigen::Index>(a));
        for (const std::uint32_t child : aggregates.members(a)) {
            middle += children.count(child) * children.middle(child);
            places.counts[a] += children.count(child);
        }
        middle /= places.counts[a];
        double spread = 0;
        for (const std::uint32_t child : aggregates.members(a)) {
            spread += children.count(child)
                      * ((children.middle(child) - middle).squaredNorm()
                         + children.size(child) * children.size(child));
        }
        places.sizes[a] = std::sqrt(spread / places.counts[a]);
    });
    return places;
}

template <int Dim>
Arms<Dim> arms_of(const Workers& workers,
                  const Aggregates& aggregates,
                  const ChildPlaces<Dim>& children,
                  const AggregatePlaces<Dim>& places,
                  GhostExchange* exchange) {
    Arms<Dim> arms(aggregates.of_child().size());
    std::fill(arms.begin() + static_cast<std::ptrdiff_t>(aggregates.children()), arms.end(),
              Arm<Dim>{Eigen::Matrix<double, Dim, 1>::Zero(), 0});
    aggregates.for_each(workers, [&](std::size_t a) {
        const double size = places.sizes[a] > 0 ? places.sizes[a] : 1;
        for (const std::uint32_t child : aggregates.members(a)) {
            arms[child].x =
                (children.middle(child) - places.middles.col(static_cast<Eigen::Index>(a))) / size;
            arms[child].ratio = children.size(child) / size;
        }
    });
    if (exchange != nullptr) {
        update(arms, *exchange);
    }
    return arms;
}

#define PENT_INSTANTIATE(Dim)                                                              \
    template AggregatePlaces<Dim> places_of(const Workers&, const Aggregates&,             \
                                            const ChildPlaces<Dim>&);                      \
    template Arms<Dim> arms_of(const Workers&, const Aggregates&, const ChildPlaces<Dim>&, \
                               const AggregatePlaces<Dim>&, GhostExchange*);
PENT_FOR_EACH_DIMENSION(PENT_INSTANTIATE)
#undef PENT_INSTANTIATE

}  // namespace pent::simulator
