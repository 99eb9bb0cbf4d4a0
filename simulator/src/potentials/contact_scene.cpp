#include "potentials/contact_scene.h"

#include "model/part_bodies.h"

#include <pent/contact/boundary_surface.h>
#include <pent/dimensions.h>
#include <pent/simulator/seen_pairs.h>

#include <cstdint>
#include <span>
#include <utility>
#include <vector>

namespace pent::simulator {

namespace {

// How far vertices may move before pairs are searched again, as a part of the activation distance:
// the evaluations of one Newton step mostly stay within it.
constexpr double kMargin = 0.25;

// The cells of a body; none where other ranks have some of them.
template <int Dim>
std::span<const std::uint32_t> whole_cells(const Bodies<Dim>& bodies, std::size_t body) {
    const Simplices<Dim + 1>& cells = bodies.cells();
    const auto [begin, size] = bodies.cells_of(body);
    if (cells.cols() < bodies.cell_count) {
        return {};
    }
    return {cells.col(begin).data(), static_cast<std::size_t>(size) * (Dim + 1)};
}

std::vector<std::pair<std::uint32_t, std::uint32_t>> ignored_pairs(const SeenPairs& seen,
                                                                   std::size_t bodies) {
    std::vector<std::pair<std::uint32_t, std::uint32_t>> ignored;
    for (std::uint32_t a = 0; a < bodies; ++a) {
        for (std::uint32_t b = a; b < bodies; ++b) {
            if (!seen.may_touch(a, b)) {
                ignored.emplace_back(a, b);
            }
        }
    }
    return ignored;
}

}  // namespace

bool may_any_touch(const Scene& scene, std::size_t bodies) {
    const SeenPairs seen(scene);
    for (std::uint32_t a = 0; a < bodies; ++a) {
        for (std::uint32_t b = a; b < bodies; ++b) {
            if (seen.may_touch(a, b)) {
                return true;
            }
        }
    }
    return false;
}

template <int Dim>
contact::ContactScene<Dim> contact_scene(const Scene& scene,
                                         const Bodies<Dim>& bodies,
                                         const HeldVertices<Dim>& held,
                                         bool do_bodies_meet) {
    const ContactSettings contact = scene.contact.value_or(ContactSettings{});
    const bool is_searched_often = scene.solver.integrator != Integrator::LinearEuler;
    contact::ContactScene<Dim> result;
    result.options = {.model = contact.model,
                      .distance = contact.distance,
                      .separation = contact.separation,
                      .self = contact.self,
                      .margin = is_searched_often ? kMargin * contact.distance : 0};
    for (std::size_t body = 0; body < bodies.count(); ++body) {
        const auto first = static_cast<std::uint32_t>(bodies.first_vertex[body]);
        contact::Surface<Dim> surface;
        surface.first_vertex = first;
        if (do_bodies_meet) {
            surface = contact::surface_of<Dim>(boundary_of(bodies, body), first);
        }
        result.bodies.push_back({scene.bodies[body].name, std::move(surface),
                                 held.is_kinematic(body), whole_cells(bodies, body)});
    }
    for (const Obstacle& obstacle : scene.obstacles) {
        result.obstacles.push_back(
            {fixed_size<Dim>(obstacle.shape), obstacle.distance, obstacle.stiffness});
    }
    if (do_bodies_meet) {
        result.ignored = ignored_pairs(SeenPairs(scene), bodies.count());
    }
    result.is_fixed = held.now();
    result.is_always_fixed = held.always();
    result.rest = bodies.rest();
    return result;
}

#define PENT_INSTANTIATE(Dim)                                                           \
    template contact::ContactScene<Dim> contact_scene(const Scene&, const Bodies<Dim>&, \
                                                      const HeldVertices<Dim>&, bool);
PENT_FOR_EACH_DIMENSION(PENT_INSTANTIATE)
#undef PENT_INSTANTIATE

}  // namespace pent::simulator
