// What a host does to a Stepper between steps.

#include "step/crossing_error.h"
#include "step/stepper.h"

#include <pent/dimensions.h>

#include <algorithm>
#include <iterator>
#include <memory>
#include <utility>

namespace pent::simulator {

template <int Dim>
void Simulation<Dim>::Stepper::wake(const std::vector<std::size_t>& bodies) {
    for (const std::size_t body : bodies) {
        islands_.wake(static_cast<int>(body));
    }
    number_dofs_of_the_awake();
}

template <int Dim>
void Simulation<Dim>::Stepper::set_held(const std::map<std::uint32_t, Vector>& held) {
    std::vector<std::uint32_t> vertices;
    Positions<Dim> targets(Dim, static_cast<Eigen::Index>(held.size()));
    for (const auto& [vertex, target] : held) {
        targets.col(static_cast<Eigen::Index>(vertices.size())) = target;
        vertices.push_back(vertex);
    }
    std::vector<std::uint32_t> changed;
    const std::vector<std::uint32_t>& before = held_.of_host().vertices;
    std::set_symmetric_difference(before.begin(), before.end(), vertices.begin(), vertices.end(),
                                  std::back_inserter(changed));
    if (!std::includes(vertices.begin(), vertices.end(), before.begin(), before.end())) {
        HeldVertices<Dim> after = held_;  // held vertices may touch one another, free ones may not
        static_cast<void>(after.hold_for_host(vertices, targets));
        refuse_crossings(current_.positions, after, time());
    }
    if (!held_.hold_for_host(std::move(vertices), targets)) {
        return;
    }
    for (const std::uint32_t vertex : changed) {
        islands_.wake(static_cast<int>(bodies_.body_of(vertex)));
    }
    number_dofs_of_the_free();
    forget_history();
    evaluate_current();  // the energy leaves out elements that are held all around
}

template <int Dim>
void Simulation<Dim>::Stepper::set_grabs(const Holdings& grabs, std::uint64_t next, int body) {
    energy_.grabs->set(grabs, time());
    next_grab_ = next;
    wake({static_cast<std::size_t>(body)});
    energy_.sum.invalidate();
}

template <int Dim>
void Simulation<Dim>::Stepper::set_forces(int body, const Positions<Dim>& forces) {
    const auto range = bodies_.vertices(static_cast<std::size_t>(body));
    Positions<Dim> all = energy_.forces->of_host();
    if (all.cols() == 0) {
        all.setZero(Dim, bodies_.vertex_count());
    }
    auto own = all.middleCols(range.begin, range.size);
    if (own == forces) {
        return;
    }
    own = forces;
    energy_.forces->set_of_host(all.isZero(0) ? Positions<Dim>(Dim, 0) : std::move(all));
    wake({static_cast<std::size_t>(body)});
    energy_.sum.invalidate();
}

template <int Dim>
void Simulation<Dim>::Stepper::set_gravity(const Vector& gravity) {
    if (gravity == gravity_.value_or(scene_.gravity)) {
        return;
    }
    gravity_ = gravity;
    energy_.gravity->set_acceleration(gravity);
    for (std::size_t body = 0; body < bodies_.count(); ++body) {
        islands_.wake(static_cast<int>(body));
    }
    number_dofs_of_the_awake();
    energy_.sum.invalidate();
}

template <int Dim>
HostState<Dim> Simulation<Dim>::Stepper::host() const {
    return {.gravity = gravity_,
            .forces = energy_.forces->of_host(),
            .grabs = energy_.grabs->holdings(),
            .next_grab = next_grab_,
            .held = held_.of_host().vertices,
            .targets = held_.of_host().targets};
}

// Returns whether other vertices are held than before. Who sleeps is not its business.
template <int Dim>
bool Simulation<Dim>::Stepper::restore_host(const HostState<Dim>& host) {
    gravity_ = host.gravity;
    energy_.gravity->set_acceleration(gravity_.value_or(scene_.gravity));
    energy_.forces->set_of_host(host.forces);
    energy_.grabs->set(host.grabs, time());
    next_grab_ = host.next_grab;
    energy_.sum.invalidate();
    return held_.hold_for_host(host.held, host.targets);
}

template <int Dim>
void Simulation<Dim>::Stepper::set_body(int body,
                                        const Positions<Dim>& positions,
                                        const Positions<Dim>& velocities) {
    const auto range = bodies_.vertices(static_cast<std::size_t>(body));
    Positions<Dim> all = current_.positions;
    all.middleCols(range.begin, range.size) = positions;
    refuse_crossings(all, held_, time());
    // What lies on the body is moved from its rest, too: it is about to fall.
    std::vector<std::size_t> moved = neighbors_of_body(static_cast<std::size_t>(body));
    moved.push_back(static_cast<std::size_t>(body));
    current_.positions = all;  // copied: hosts see the arrays where they lie
    current_.velocities.middleCols(range.begin, range.size) = velocities;
    wake(moved);
    forget_history();  // of where it was taken from
    evaluate_anew();
}

template <int Dim>
void Simulation<Dim>::Stepper::set_obstacles(Scene scene, const std::vector<std::size_t>& woken) {
    check(scene);
    auto contact = std::make_unique<ContactPotential<Dim>>(workers_, scene, bodies_, held_);
    static_cast<void>(contact->set_time(last_step()));
    contact->set_stiffness(energy_.contact->stiffness());
    const std::vector<contact::Crossing> crossings = contact->find_crossings(current_.positions);
    if (!crossings.empty()) {
        throw crossing_error(bodies_, *contact, crossings, current_.positions);
    }
    scene_ = std::move(scene);
    energy_.replace_contact(std::move(contact), scene_);
    wake(woken);
    evaluate_anew();
}

template <int Dim>
std::vector<std::size_t> Simulation<Dim>::Stepper::neighbors_of_body(std::size_t body) const {
    std::vector<std::size_t> neighbors;
    for (const auto& [a, b] : energy_.sum.couplings().pairs) {
        if (a == body || b == body) {
            neighbors.push_back(a == body ? b : a);
        }
    }
    return neighbors;
}

template <int Dim>
std::vector<std::size_t> Simulation<Dim>::Stepper::neighbors_of_obstacle(
    std::size_t obstacle) const {
    std::vector<std::size_t> neighbors;
    for (const contact::Contact<Dim>& contact : energy_.contact->contacts().list) {
        if (contact.second.is_obstacle() && contact.second.index == obstacle) {
            neighbors.push_back(contact.first.index);
        }
    }
    return neighbors;
}

#define PENT_INSTANTIATE(Dim)                                                                      \
    template void Simulation<Dim>::Stepper::wake(const std::vector<std::size_t>&);                 \
    template void Simulation<Dim>::Stepper::set_held(const std::map<std::uint32_t, Vector>&);      \
    template void Simulation<Dim>::Stepper::set_grabs(const Holdings&, std::uint64_t, int);        \
    template void Simulation<Dim>::Stepper::set_forces(int, const Positions<Dim>&);                \
    template void Simulation<Dim>::Stepper::set_gravity(const Vector&);                            \
    template HostState<Dim> Simulation<Dim>::Stepper::host() const;                                \
    template bool Simulation<Dim>::Stepper::restore_host(const HostState<Dim>&);                   \
    template void Simulation<Dim>::Stepper::set_body(int, const Positions<Dim>&,                   \
                                                     const Positions<Dim>&);                       \
    template void Simulation<Dim>::Stepper::set_obstacles(Scene, const std::vector<std::size_t>&); \
    template std::vector<std::size_t> Simulation<Dim>::Stepper::neighbors_of_body(std::size_t)     \
        const;                                                                                     \
    template std::vector<std::size_t> Simulation<Dim>::Stepper::neighbors_of_obstacle(std::size_t) \
        const;
PENT_FOR_EACH_DIMENSION(PENT_INSTANTIATE)
#undef PENT_INSTANTIATE

}  // namespace pent::simulator
