#include "linear/aggregate_places.h"

#include <pent/dimensions.h>

#include <cmath>
#include <cstddef>

namespace pent::simulator {

namespace {

// Gives children of other ranks the arms that they have there.
template <int Dim>
void update(std::vector<Arm<Dim>>& arms, GhostExchange& exchange) {
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
AggregatePlaces<Dim> places_of(const Aggregates& aggregates, const AggregatePlaces<Dim>& children) {
    const std::size_t count = aggregates.members.size();
    AggregatePlaces<Dim> places{Positions<Dim>::Zero(Dim, aggregates.count()),
                                std::vector<double>(count), std::vector<double>(count)};
    for (std::size_t a = 0; a < count; ++a) {
        auto middle = places.middles.col(static_cast<Eigen::Index>(a));
        for (const std::uint32_t child : aggregates.members[a]) {
            middle += children.counts[child] * children.middles.col(child);
            places.counts[a] += children.counts[child];
        }
        middle /= places.counts[a];
        double spread = 0;
        for (const std::uint32_t child : aggregates.members[a]) {
            spread += children.counts[child]
                      * ((children.middles.col(child) - middle).squaredNorm()
                         + children.sizes[child] * children.sizes[child]);
        }
        places.sizes[a] = std::sqrt(spread / places.counts[a]);
    }
    return places;
}

template <int Dim>
std::vector<Arm<Dim>> arms_of(const Aggregates& aggregates,
                              const AggregatePlaces<Dim>& children,
                              const AggregatePlaces<Dim>& places,
                              GhostExchange* exchange) {
    std::vector<Arm<Dim>> arms(aggregates.of_child.size(),
                               {Eigen::Matrix<double, Dim, 1>::Zero(), 0});
    for (std::size_t a = 0; a < aggregates.members.size(); ++a) {
        const double size = places.sizes[a] > 0 ? places.sizes[a] : 1;
        for (const std::uint32_t child : aggregates.members[a]) {
            arms[child].x =
                (children.middles.col(child) - places.middles.col(static_cast<Eigen::Index>(a)))
                / size;
            arms[child].ratio = children.sizes[child] / size;
        }
    }
    if (exchange != nullptr) {
        update(arms, *exchange);
    }
    return arms;
}

#define PENT_INSTANTIATE(Dim)                                                                \
    template AggregatePlaces<Dim> places_of(const Aggregates&, const AggregatePlaces<Dim>&); \
    template std::vector<Arm<Dim>> arms_of(const Aggregates&, const AggregatePlaces<Dim>&,   \
                                           const AggregatePlaces<Dim>&, GhostExchange*);
PENT_FOR_EACH_DIMENSION(PENT_INSTANTIATE)
#undef PENT_INSTANTIATE

}  // namespace pent::simulator
