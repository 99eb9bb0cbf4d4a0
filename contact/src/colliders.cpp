#include "colliders.h"

#include <pent/dimensions.h>

#include <algorithm>

namespace pent::contact {

template <int Dim>
Colliders<Dim>::Colliders(const ContactScene<Dim>& scene)
    : scene_(scene), core_points_(Dim, 0), rest_(scene.rest) {
    for (std::uint32_t i = 0; is_barrier() && i < scene.obstacles.size(); ++i) {
        if (repels(scene.obstacles[i].shape) == Repels::Facets) {
            add_core(i);
        }
    }
    if (!cores_.empty()) {
        rest_.resize(Dim, scene.rest.cols() + core_points_.cols());
        rest_ << scene.rest, core_points_;
    }
}

template <int Dim>
void Colliders<Dim>::add_core(std::uint32_t obstacle) {
    ObstacleCore<Dim> core = core_of<Dim>(scene_.obstacles[obstacle].shape);
    const Eigen::Index begin = core_points_.cols();
    const auto first = static_cast<std::uint32_t>(scene_.is_fixed.size() + begin);
    core.surface.first_vertex = first;
    core.surface.vertices.array() += first;
    core.surface.edges.array() += first;
    core.surface.ridges.array() += first;
    core.surface.facets.array() += first;
    core_points_.conservativeResize(Dim, begin + core.points.cols());
    core_points_.rightCols(core.points.cols()) = core.points;
    cores_.push_back({std::move(core.surface), obstacle, core.radius});
}

template <int Dim>
void Colliders<Dim>::update_cores() {
    Eigen::Index next = 0;
    for (const Core& core : cores_) {
        const Positions<Dim> points = core_of<Dim>(scene_.obstacles[core.obstacle].shape).points;
        core_points_.middleCols(next, points.cols()) = points;
        next += points.cols();
    }
}

template <int Dim>
bool Colliders<Dim>::can_meet(int a, int b) const {
    if (is_core(a) || is_core(b)) {
        return is_core(a) != is_core(b) && !(is_kinematic(a) && is_kinematic(b));
    }
    const std::pair<std::uint32_t, std::uint32_t> both = std::minmax(a, b);
    if (std::binary_search(scene_.ignored.begin(), scene_.ignored.end(), both)) {
        return false;
    }
    // A barrier does not lead what is moved from outside through itself either.
    const bool is_of_interest = is_barrier() || !(is_kinematic(a) && is_kinematic(b));
    return is_of_interest && (a != b || scene_.options.self);
}

#define PENT_INSTANTIATE(Dim) template class Colliders<Dim>;
PENT_FOR_EACH_DIMENSION(PENT_INSTANTIATE)
#undef PENT_INSTANTIATE

}  // namespace pent::contact
