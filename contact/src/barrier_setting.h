#pragma once

#include "path_candidates.h"

#include <pent/contact/barrier_finder.h>

#include <algorithm>
#include <array>
#include <vector>

namespace pent::contact {

/// A scene as the barrier model sees it, and what in it may come near what.
template <int Dim>
struct BarrierSetting {
    const std::vector<ContactBody<Dim>>& bodies;
    const std::vector<Obstacle<Dim>>& obstacles;
    const BarrierOptions& options;
    const Positions<Dim>& rest;
    const PathCandidates<Dim>& candidates;

    /// Calls visit(list, first, second, bodies) for each list of candidates: the list, the lists of
    /// simplices that its pairs are places in, and the bodies that these belong to.
    template <typename Visit>
    void for_each_list(const Visit& visit) const {
        for (const CandidatePairs& pairs : candidates.pairs()) {
            const Surface<Dim>& first = bodies[pairs.first_body].surface;
            const Surface<Dim>& second = bodies[pairs.second_body].surface;
            const std::array<int, 2> in_order{pairs.first_body, pairs.second_body};
            const std::array<int, 2> swapped{pairs.second_body, pairs.first_body};
            visit(pairs.points_first, first.vertices, second.facets, in_order);
            visit(pairs.points_second, second.vertices, first.facets, swapped);
            visit(pairs.mixed_first, first.edges, second.ridges, in_order);
            visit(pairs.mixed_second, second.edges, first.ridges, swapped);
        }
    }

    /// Calls visit(body, vertex) for surface vertices that are not held.
    template <typename Visit>
    void for_each_free_vertex(const Visit& visit) const {
        for (std::size_t body = 0; body < bodies.size(); ++body) {
            const Simplices<1>& vertices = bodies[body].surface.vertices;
            for (Eigen::Index i = 0; !bodies[body].is_kinematic && i < vertices.cols(); ++i) {
                if (!candidates.is_held()[vertices(0, i)]) {
                    visit(static_cast<std::int32_t>(body), vertices(0, i));
                }
            }
        }
    }

    /// Calls visit(body, facet) for facets with a free vertex that may come near a ball, ascending.
    template <typename Visit>
    void for_each_facet_near(const Ball<Dim>& ball, const Visit& visit) const {
        for (std::size_t body = 0; body < bodies.size(); ++body) {
            if (bodies[body].is_kinematic) {
                continue;
            }
            std::vector<std::uint32_t> facets;
            candidates.for_each_facet_near(static_cast<int>(body), ball.center, ball.radius,
                                           [&](std::uint32_t facet) { facets.push_back(facet); });
            std::sort(facets.begin(), facets.end());
            const Simplices<Dim>& corners = bodies[body].surface.facets;
            for (const std::uint32_t facet : facets) {
                if (!candidates.template is_held<Dim>(corners, facet)) {
                    visit(static_cast<std::int32_t>(body), facet);
                }
            }
        }
    }
};

/// What is near what at positions that the candidates cover, without the report's seconds.
template <int Dim>
[[nodiscard]] BarrierContacts<Dim> find_barrier_contacts(const BarrierSetting<Dim>& setting,
                                                         const PositionsView<Dim>& positions);

/// How far a step that the candidates cover may go, without the seconds.
template <int Dim>
[[nodiscard]] StepLimit limit_barrier_step(const BarrierSetting<Dim>& setting,
                                           const PositionsView<Dim>& from,
                                           const PositionsView<Dim>& to);

}  // namespace pent::contact
