#include "potentials/contact_potential.h"

#include "potentials/contact_scene.h"
#include "potentials/contact_team.h"

#include <pent/dimensions.h>
#include <pent/stopwatch.h>

#include <algorithm>
#include <utility>

namespace pent::simulator {

namespace {

template <int Dim>
contact::Collider body_of(std::uint32_t vertex, const contact::ContactScene<Dim>& scene) {
    const auto behind = std::upper_bound(
        scene.bodies.begin(), scene.bodies.end(), vertex,
        [](std::uint32_t v, const auto& body) { return v < body.surface.first_vertex; });
    return {contact::Collider::Kind::Body,
            static_cast<std::uint32_t>(behind - scene.bodies.begin() - 1)};
}

}  // namespace

template <int Dim>
void add_stencils(double weight,
                  const contact::StencilHessians<Dim>& hessians,
                  std::size_t first,
                  NewtonSystem<Dim>& system) {
    const std::size_t weighted = hessians.weighted.size();
    system.reserve_stencils(weighted + hessians.spectral.size());
    for (std::size_t k = 0; k < weighted; ++k) {
        const contact::WeightedHessian<Dim>& hessian = hessians.weighted[(first + k) % weighted];
        system.add_stencil({.vertices = hessian.vertices.data(),
                            .weights = hessian.weights.data(),
                            .numbers = hessian.block.data(),
                            .count = hessian.count,
                            .stride = Dim,
                            .scale = weight});
    }
    for (const contact::SpectralHessian<Dim>& hessian : hessians.spectral) {
        if (hessian.rank > 0) {
            system.add_stencil({.vertices = hessian.vertices.data(),
                                .numbers = hessians.numbers.data() + hessian.begin,
                                .count = hessian.count,
                                .rank = hessian.rank,
                                .scale = weight});
        }
    }
}

template <int Dim>
ContactPotential<Dim>::ContactPotential(const Workers& workers,
                                        const Scene& scene,
                                        const Bodies<Dim>& bodies,
                                        const HeldVertices<Dim>& held)
    : workers_(&workers),
      sharing_(&bodies.sharing),
      settings_(scene.contact.value_or(ContactSettings{})),
      stiffness_of_sleepers_(bodies.count()),
      motions_(scene),
      obstacles_(motions_.at(0)) {
    is_barrier_ = scene.contact && settings_.model == ContactModel::Barrier;
    do_bodies_meet_ = is_barrier_ || (scene.contact && may_any_touch(scene, bodies.count()));
    has_obstacles_ = !scene.obstacles.empty();
    stiffness_ = settings_.stiffness;
    set_held(scene, bodies, held);
}

template <int Dim>
void ContactPotential<Dim>::set_held(const Scene& scene,
                                     const Bodies<Dim>& bodies,
                                     const HeldVertices<Dim>& held) {
    if (do_bodies_meet_ || has_obstacles_) {
        finder_ = std::make_unique<contact::ContactFinder<Dim>>(
            contact_scene<Dim>(scene, bodies, held, do_bodies_meet_),
            sharing_->is_shared() ? std::make_shared<ContactTeam>(sharing_->ranks()) : nullptr);
        finder_->move_obstacles(obstacles_);
    }
}

template <int Dim>
bool ContactPotential<Dim>::set_time(const TimeSpan& step) {
    const bool has_changed = motions_.is_any() && (are_at_begin_ || step != step_);
    step_ = step;
    if (has_changed) {
        are_at_begin_ = false;
        put_obstacles(step.end);
    }
    return has_changed;
}

template <int Dim>
void ContactPotential<Dim>::put_obstacles(double time) {
    obstacles_ = motions_.at(time);
    finder_->move_obstacles(obstacles_);
}

template <int Dim>
bool ContactPotential<Dim>::has_moving_obstacles() const {
    for (std::size_t o = 0; motions_.is_any() && o < obstacles_.size(); ++o) {
        if (motions_.is_moving(o, step_.begin, step_.end)) {
            return true;
        }
    }
    return false;
}

template <int Dim>
contact::Contacts<Dim> ContactPotential<Dim>::contacts_at_begin(const Positions<Dim>& x) const {
    return workers_->run([&] {
        finder_->move_obstacles(motions_.at(step_.begin));
        contact::Contacts<Dim> contacts = find(x);
        finder_->move_obstacles(obstacles_);
        return contacts;
    });
}

// How far the point of the surface moves that is nearest to the body.
template <int Dim>
Vector<Dim> ContactPotential<Dim>::obstacle_displacement(const contact::Contact<Dim>& contact,
                                                         const Positions<Dim>& x) const {
    Vector<Dim> point = -contact.distance * contact.direction;
    for (int i = 0; i < contact.count; ++i) {
        point += contact.weights[i] * x.col(contact.vertices[static_cast<std::size_t>(i)]);
    }
    return motions_.displacement(contact.second.index, point, step_.begin, step_.end);
}

template <int Dim>
std::string ContactPotential<Dim>::obstacle_in_the_way(const Positions<Dim>& x) {
    if (!is_barrier_ || !motions_.is_any()) {
        return "";
    }
    limit_ = workers_->run([&] { return finder_->limit_obstacles(motions_.at(step_.begin), x); });
    work_.seconds += limit_.seconds;
    work_.ccd_seconds += limit_.seconds;
    return limit_.fraction < 1
               ? "an obstacle moves so far in a step that " + describe(limit_.limiting)
                     + "; take smaller steps, or move it more slowly"
               : "";
}

template <int Dim>
std::string ContactPotential<Dim>::obstacle_passed(const Positions<Dim>& from,
                                                   const Positions<Dim>& to) const {
    if (!has_obstacles_ || is_barrier_) {
        return "";
    }
    const contact::ContactScene<Dim>& scene = finder_->scene();
    for (std::uint32_t o = 0; o < obstacles_.size(); ++o) {
        const auto carried = motions_.carried(o, step_.begin, step_.end);
        for (std::uint32_t vertex = 0; vertex < scene.is_fixed.size(); ++vertex) {
            // As the obstacle sees it, which stands where it is in the end.
            const Vector<Dim> start = carried.rotation * from.col(vertex) + carried.shift;
            if (!scene.is_fixed[vertex]
                && contact::passes_through<Dim>(obstacles_[o], start, to.col(vertex),
                                                scene.obstacles[o].distance)) {
                return describe({.kind = contact::CrossingKind::Through,
                                 .first = body_of(vertex, scene),
                                 .second = {contact::Collider::Kind::Obstacle, o},
                                 .first_corners = {vertex},
                                 .second_corners = {}});
            }
        }
    }
    return "";
}

template <int Dim>
bool ContactPotential<Dim>::set_sleepers(std::vector<double> stiffness) {
    if (!is_barrier_) {
        return false;  // penalties have one stiffness for good
    }
    const bool has_changed = stiffness != stiffness_of_sleepers_;
    stiffness_of_sleepers_ = std::move(stiffness);
    return has_changed;
}

// The stiffness of a contact over the current one. Where all bodies of it sleep, or are moved from
// outside, it keeps that with which they fell asleep (two that sleep fell asleep together); where
// one is awake it has the current one.
template <int Dim>
double ContactPotential<Dim>::stiffness_over_current(const contact::Contact<Dim>& contact) const {
    double factor = 1;
    for (const contact::Collider& side : {contact.first, contact.second}) {
        if (!side.is_obstacle() && !finder_->scene().bodies[side.index].is_kinematic) {
            const double stiffness = stiffness_of_sleepers_[side.index];
            if (stiffness == 0) {
                return 1;
            }
            factor = stiffness / stiffness_;
        }
    }
    return factor;
}

template <int Dim>
contact::Contacts<Dim> ContactPotential<Dim>::find(const Positions<Dim>& x) const {
    contact::Contacts<Dim> contacts = finder_->find(x, stiffness_);
    for (contact::MollifierGradient<Dim>& part : contacts.mollified) {
        part.vector *= stiffness_over_current(contacts.list[part.contact]);
    }
    for (contact::Contact<Dim>& contact : contacts.list) {
        const double factor = stiffness_over_current(contact);
        if (factor != 1) {  // else 0 times an energy that may be infinite
            (contact.second.is_obstacle() ? contacts.obstacle_energy : contacts.body_energy) +=
                (factor - 1) * contact.energy;
            contact.energy *= factor;
            contact.slope *= factor;
        }
    }
    return contacts;
}

template <int Dim>
double ContactPotential<Dim>::evaluate(const Positions<Dim>& x, Positions<Dim>& gradient) {
    if (is_empty()) {
        return 0;
    }
    const Stopwatch watch;
    gradient_.setZero(Dim, x.cols());
    workers_->run([&] {
        contacts_ = find(x);
        contact::add_gradient<Dim>(contacts_, gradient_);
        if (are_at_begin_) {
            add_obstacle_displacements(x);
        }
    });
    gradient += gradient_;
    const contact::ContactReport& report = contacts_.report;
    work_.searches += do_bodies_meet_ ? 1 : 0;
    work_.obstacle_tests += report.obstacle_tests;
    work_.candidates += report.candidates;
    work_.trees_built += report.trees_built;
    work_.trees_refit += report.trees_refit;
    work_.seconds += watch.seconds();
    return contacts_.body_energy + contacts_.obstacle_energy;
}

// Adds what the motion of obstacles in the step changes of the contact forces, to first order. What
// the motion of held vertices changes is in the matrix of the linear solve, by their columns;
// obstacles have none.
template <int Dim>
void ContactPotential<Dim>::add_obstacle_displacements(const Positions<Dim>& x) {
    contact::Contacts<Dim> at_obstacles;
    at_obstacles.list.assign(
        contacts_.list.begin() + static_cast<std::ptrdiff_t>(contacts_.pair_count),
        contacts_.list.end());
    const contact::StencilHessians<Dim> hessians =
        finder_->hessians(at_obstacles, x, stiffness_, settings_.filter);
    for (std::size_t k = 0; k < at_obstacles.list.size(); ++k) {
        const contact::Contact<Dim>& contact = at_obstacles.list[k];
        gradient_.col(contact.vertices[0]) -=
            hessians.weighted[k].block * obstacle_displacement(contact, x);
    }
}

template <int Dim>
ContactSummary ContactPotential<Dim>::summary() const {
    const contact::ContactReport& report = contacts_.report;
    ContactSummary summary;
    summary.point_facet = report.point_facet;
    summary.mixed = report.mixed;
    summary.self = report.self;
    summary.obstacle = report.obstacle;
    summary.deepest = report.deepest;
    summary.smallest_distance = report.smallest_distance;
    return summary;
}

// The contacts that have entries in rows of this rank, in their order.
template <int Dim>
contact::Contacts<Dim> ContactPotential<Dim>::own_contacts() const {
    contact::Contacts<Dim> own;
    for (std::size_t k = 0; k < contacts_.list.size(); ++k) {
        const contact::Contact<Dim>& contact = contacts_.list[k];
        const auto begin = contact.vertices.begin();
        if (std::any_of(begin, begin + contact.count,
                        [&](std::uint32_t vertex) { return sharing_->owns(vertex); })) {
            own.list.push_back(contact);
            own.pair_count += k < contacts_.pair_count ? 1 : 0;
        }
    }
    return own;
}

template <int Dim>
void ContactPotential<Dim>::add_hessian(const Positions<Dim>& x,
                                        double weight,
                                        Filter /*filter*/,
                                        NewtonSystem<Dim>& system) {
    if (is_empty()) {
        return;
    }
    const Stopwatch watch;
    contact::Contacts<Dim> own;
    if (sharing_->is_shared()) {
        own = own_contacts();
    }
    const contact::Contacts<Dim>& contacts = sharing_->is_shared() ? own : contacts_;
    hessians_ = workers_->run([&] {
        return finder_->hessians(contacts, x, stiffness_, settings_.filter, std::move(hessians_));
    });
    add_stencils<Dim>(weight, hessians_, is_barrier_ ? 0 : contacts.pair_count, system);
    work_.seconds += watch.seconds();
}

template <int Dim>
std::vector<TermEnergy> ContactPotential<Dim>::energies() const {
    std::vector<TermEnergy> parts;
    if (has_obstacles_) {
        parts.push_back({"obstacle", contacts_.obstacle_energy});
    }
    if (do_bodies_meet_) {
        parts.push_back({"contact", contacts_.body_energy});
    }
    return parts;
}

template <int Dim>
std::vector<std::size_t> ContactPotential<Dim>::on_moving_obstacles(const TimeSpan& step) const {
    std::vector<std::size_t> bodies;
    for (const contact::Contact<Dim>& contact : contacts_.list) {
        if (motions_.is_any() && contact.second.is_obstacle()
            && motions_.is_moving(contact.second.index, step.begin, step.end)) {
            bodies.push_back(contact.first.index);
        }
    }
    return bodies;
}

// Pairs of different bodies in contact, each once.
template <int Dim>
void ContactPotential<Dim>::add_couplings(Couplings& couplings) const {
    std::vector<std::pair<std::size_t, std::size_t>> pairs;
    for (const contact::Contact<Dim>& contact : contacts_.list) {
        if (!contact.second.is_obstacle() && !contact.is_self()) {
            pairs.emplace_back(std::minmax(contact.first.index, contact.second.index));
        }
    }
    const std::vector<std::size_t> driven = on_moving_obstacles(step_);
    couplings.driven.insert(couplings.driven.end(), driven.begin(), driven.end());
    std::sort(pairs.begin(), pairs.end());
    const auto end = std::unique(pairs.begin(), pairs.end());
    couplings.pairs.insert(couplings.pairs.end(), pairs.begin(), end);
}

template <int Dim>
bool ContactPotential<Dim>::begin_step(const StepStart<Dim>& start) {
    last_gap_ = gap();
    // A single linear solve finds contacts once, with vertices at the start of the step. With
    // obstacles at its end, vertices would have lost one that sinks, and be deep in one that rises.
    are_at_begin_ = start.is_linear && has_moving_obstacles();
    if (are_at_begin_) {
        put_obstacles(step_.begin);
    }
    return are_at_begin_;
}

template <int Dim>
ContactWork ContactPotential<Dim>::take_work() {
    return std::exchange(work_, {});
}

template <int Dim>
std::vector<std::string> ContactPotential<Dim>::warnings() const {
    return finder_ ? finder_->warnings() : std::vector<std::string>();
}

template <int Dim>
std::int64_t ContactPotential<Dim>::bytes() const {
    return finder_ ? finder_->bytes() : 0;
}

#define PENT_INSTANTIATE(Dim)                                                             \
    template void add_stencils(double, const contact::StencilHessians<Dim>&, std::size_t, \
                               NewtonSystem<Dim>&);                                       \
    template class ContactPotential<Dim>;
PENT_FOR_EACH_DIMENSION(PENT_INSTANTIATE)
#undef PENT_INSTANTIATE

}  // namespace pent::simulator
