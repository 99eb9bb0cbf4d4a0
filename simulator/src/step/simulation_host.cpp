// What a host does to a Simulation: checked here, done by the Stepper.

#include "step/host_checks.h"
#include "step/stepper.h"

#include <pent/dimensions.h>
#include <pent/error.h>

#include <algorithm>
#include <map>

namespace pent::simulator {

namespace {

template <int Dim>
using Holdings = std::vector<typename HostState<Dim>::Holding>;

template <int Dim>
std::size_t find_grab(const Holdings<Dim>& grabs, std::uint64_t id) {
    const auto found = std::find_if(grabs.begin(), grabs.end(),
                                    [&](const auto& holding) { return holding.id == id; });
    if (found == grabs.end()) {
        throw Error("there is no grab " + std::to_string(id) + "; it was removed, or never added");
    }
    return static_cast<std::size_t>(found - grabs.begin());
}

// What a host holds, with the targets, by vertices of all bodies counted through.
template <int Dim>
using Held = std::map<std::uint32_t, Vector<Dim>>;

template <int Dim>
Held<Dim> held_in(const HostHolds<Dim>& holds) {
    Held<Dim> held;
    for (std::size_t i = 0; i < holds.vertices.size(); ++i) {
        held[holds.vertices[i]] = holds.targets.col(static_cast<Eigen::Index>(i));
    }
    return held;
}

}  // namespace

template <int Dim>
void Simulation<Dim>::set_targets(int body,
                                  const std::vector<std::uint32_t>& vertices,
                                  const Positions<Dim>& targets) {
    const Bodies<Dim>& bodies = stepper_->bodies();
    check_vertices(body, vertices, bodies);
    check_array<Dim>("targets", targets, static_cast<Eigen::Index>(vertices.size()), vertices);
    Held<Dim> held = held_in(stepper_->held().of_host());
    for (std::size_t i = 0; i < vertices.size(); ++i) {
        held[static_cast<std::uint32_t>(first_vertex(body)) + vertices[i]] =
            targets.col(static_cast<Eigen::Index>(i));
    }
    stepper_->set_held(held);
}

template <int Dim>
void Simulation<Dim>::release(int body, const std::vector<std::uint32_t>& vertices) {
    check_vertices(body, vertices, stepper_->bodies());
    Held<Dim> held = held_in(stepper_->held().of_host());
    for (const std::uint32_t vertex : vertices) {
        held.erase(static_cast<std::uint32_t>(first_vertex(body)) + vertex);
    }
    stepper_->set_held(held);
}

template <int Dim>
std::uint64_t Simulation<Dim>::add_grab(const Grab<Dim>& grab) {
    check_grab(grab, stepper_->bodies());
    Holdings<Dim> grabs = stepper_->grabs();
    auto& added = grabs.emplace_back();
    added.id = stepper_->next_grab();
    added.grab = grab;
    added.grab.max_force = grab.max_force.value_or(bearable_force(stepper_->bodies(), grab.point));
    added.from = grab.anchor;
    const std::uint64_t id = added.id;
    stepper_->set_grabs(grabs, id + 1, grab.point.body);
    return id;
}

template <int Dim>
void Simulation<Dim>::move_grab(std::uint64_t grab, const Vector& anchor) {
    if (!anchor.allFinite()) {
        throw Error("the anchor of a grab must be finite");
    }
    Holdings<Dim> grabs = stepper_->grabs();
    Grab<Dim>& moved = grabs[find_grab<Dim>(grabs, grab)].grab;
    if (moved.anchor != anchor) {
        moved.anchor = anchor;
        stepper_->set_grabs(grabs, stepper_->next_grab(), moved.point.body);
    }
}

template <int Dim>
void Simulation<Dim>::remove_grab(std::uint64_t grab) {
    Holdings<Dim> grabs = stepper_->grabs();
    const auto removed = grabs.begin() + static_cast<std::ptrdiff_t>(find_grab<Dim>(grabs, grab));
    const int body = removed->grab.point.body;
    grabs.erase(removed);
    stepper_->set_grabs(grabs, stepper_->next_grab(), body);
}

template <int Dim>
void Simulation<Dim>::set_forces(int body, const Positions<Dim>& forces) {
    check_body(body, stepper_->bodies());
    check_array<Dim>("forces", forces, mesh(body).vertex_count());
    stepper_->set_forces(body, forces);
}

template <int Dim>
void Simulation<Dim>::set_gravity(const Vector& gravity) {
    if (!gravity.allFinite()) {
        throw Error("gravity must be finite");
    }
    stepper_->set_gravity(gravity);
}

template <int Dim>
HostState<Dim> Simulation<Dim>::host() const {
    return stepper_->host();
}

#define PENT_INSTANTIATE(Dim)                                                          \
    template void Simulation<Dim>::set_targets(int, const std::vector<std::uint32_t>&, \
                                               const Positions<Dim>&);                 \
    template void Simulation<Dim>::release(int, const std::vector<std::uint32_t>&);    \
    template std::uint64_t Simulation<Dim>::add_grab(const Grab<Dim>&);                \
    template void Simulation<Dim>::move_grab(std::uint64_t, const Vector&);            \
    template void Simulation<Dim>::remove_grab(std::uint64_t);                         \
    template void Simulation<Dim>::set_forces(int, const Positions<Dim>&);             \
    template void Simulation<Dim>::set_gravity(const Vector&);                         \
    template HostState<Dim> Simulation<Dim>::host() const;
PENT_FOR_EACH_DIMENSION(PENT_INSTANTIATE)
#undef PENT_INSTANTIATE

}  // namespace pent::simulator
