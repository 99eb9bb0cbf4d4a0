#include "model/held_vertices.h"

#include "model/part_selection.h"
#include "model/same_time.h"

#include <pent/dimensions.h>
#include <pent/error.h>
#include <pent/formatted.h>
#include <pent/simulator/placed_mesh.h>

#include <algorithm>
#include <cmath>
#include <iterator>
#include <limits>
#include <string>
#include <utility>

namespace pent::simulator {

namespace {

// The first step that begins at a time or later.
std::uint64_t first_step_from(double time, double dt) {
    constexpr auto kNever = std::numeric_limits<std::uint64_t>::max();
    const double step = steps_to(time, dt);
    return step < 1e18 ? static_cast<std::uint64_t>(std::max(step, 0.0)) : kNever;
}

// A constraint that takes hold of its vertices after its first keyframe would make them jump, or
// ignore it.
void refuse_early_keyframes(const Constraint& constraint, double start, double dt) {
    for (const Motion& motion : constraint.motion) {
        if (!motion.keyframes.empty() && is_by(motion.keyframes.front().time, start, dt)) {
            throw Error(
                place_and_name(constraint)
                + formatted(": the first of \"keyframes\" is at %g s, and the first step that"
                            " holds anything begins at %g s; expected it behind that",
                            motion.keyframes.front().time, start));
        }
    }
}

// What is left of a constraint's motions when it takes hold of its vertices.
std::vector<Motion> path_from(double start, bool begins_later, std::vector<Motion> motions) {
    std::erase_if(motions, [&](const Motion& motion) { return motion.to <= start; });
    for (Motion& motion : motions) {
        motion.from = begins_later ? std::max(motion.from, start) : motion.from;
    }
    return motions;
}

// Finds what each motion of a set turns about, by where the set was taken hold of.
template <int Dim>
void center_motions(DirichletSet<Dim>& set) {
    Vector<Dim> sum = Vector<Dim>::Zero();
    for (const auto place : set.places.colwise()) {
        sum += place;
    }
    set.motions = center<Dim>(set.path, sum / static_cast<double>(set.places.cols()));
}

// Takes hold of a set where it is.
template <int Dim>
void take_up(const Positions<Dim>& positions, DirichletSet<Dim>& set) {
    for (std::size_t i = 0; i < set.vertices.size(); ++i) {
        set.places.col(static_cast<Eigen::Index>(i)) = positions.col(set.vertices[i]);
    }
    center_motions<Dim>(set);
}

// What a constraint holds, and when.
template <int Dim>
DirichletSet<Dim> make_set(const Constraint& constraint,
                           const Scene& scene,
                           const Bodies<Dim>& bodies) {
    DirichletSet<Dim> set;
    set.body = index_of(scene, constraint.body);
    set.first_step = first_step_from(constraint.from, scene.dt());
    set.end_step = first_step_from(constraint.to, scene.dt());
    for (const std::uint32_t vertex :
         select_vertices(bodies, set.body, constraint.select, place_and_name(constraint))) {
        set.vertices.push_back(static_cast<std::uint32_t>(vertex + bodies.first_vertex[set.body]));
    }
    const double start = static_cast<double>(set.first_step) * scene.dt();
    if (set.begins_later()) {
        refuse_early_keyframes(constraint, start, scene.dt());
    }
    set.path = path_from(start, set.begins_later(), constraint.motion);
    set.places = Positions<Dim>::Zero(Dim, static_cast<Eigen::Index>(set.vertices.size()));
    if (!set.begins_later()) {
        take_up<Dim>(bodies.rest(), set);
    }
    return set;
}

// Whether one constraint lets go before another takes hold: by their times, too, so that a scene
// that is right stays so with another length of steps.
bool does_end_before(const Constraint& first, const Constraint& then, double dt) {
    return is_by(first.to, then.from, dt)
           && first_step_from(first.to, dt) <= first_step_from(then.from, dt);
}

// Throws where two constraints, which hold these vertices, hold one of them at one time.
void refuse_overlap(const Constraint& constraint,
                    const std::vector<std::uint32_t>& vertices,
                    const Constraint& other,
                    const std::vector<std::uint32_t>& vertices_of_other,
                    double dt,
                    std::uint32_t first_of_body) {
    if (does_end_before(other, constraint, dt) || does_end_before(constraint, other, dt)) {
        return;
    }
    std::vector<std::uint32_t> both;
    std::set_intersection(vertices.begin(), vertices.end(), vertices_of_other.begin(),
                          vertices_of_other.end(), std::back_inserter(both));
    if (!both.empty()) {
        throw Error((constraint.source.empty() ? "" : constraint.source + ": ") + "vertex "
                    + std::to_string(both.front() - first_of_body) + " of body \"" + constraint.body
                    + "\" is held by two constraints at one time"
                    + (other.source.empty() ? "" : ", this one and that at " + other.source)
                    + "; make their selections disjoint, or let one end before the other begins");
    }
}

// Puts what a host holds on the straight way to its target.
template <int Dim>
void place_host_holds(const HostHolds<Dim>& holds,
                      double time,
                      Positions<Dim>& positions,
                      Positions<Dim>* velocities) {
    const double h = holds.end - holds.begin;
    const double part = (time - holds.begin) / h;
    for (std::size_t i = 0; i < holds.vertices.size(); ++i) {
        const std::uint32_t vertex = holds.vertices[i];
        const auto column = static_cast<Eigen::Index>(i);
        const Vector<Dim> displacement = holds.targets.col(column) - holds.starts.col(column);
        positions.col(vertex) = holds.targets.col(column);
        if (!is_whole_step(part)) {
            positions.col(vertex) = holds.starts.col(column) + part * displacement;
        }
        if (velocities != nullptr) {
            velocities->col(vertex) = displacement / h;
        }
    }
}

}  // namespace

template <int Dim>
HeldVertices<Dim>::HeldVertices(const Scene& scene, const Bodies<Dim>& bodies)
    : is_held_(static_cast<std::size_t>(bodies.vertex_count()), false), is_always_held_(is_held_) {
    for (const Constraint& constraint : scene.constraints) {
        DirichletSet<Dim> set = make_set<Dim>(constraint, scene, bodies);
        for (std::size_t other = 0; other < sets_.size(); ++other) {
            refuse_overlap(constraint, set.vertices, scene.constraints[other],
                           sets_[other].vertices, scene.dt(),
                           static_cast<std::uint32_t>(bodies.first_vertex[set.body]));
        }
        for (const std::uint32_t vertex : set.vertices) {
            is_always_held_[vertex] =
                is_always_held_[vertex] || (!set.begins_later() && std::isinf(constraint.to));
        }
        sets_.push_back(std::move(set));
    }
    for (std::size_t body = 0; body < bodies.count(); ++body) {
        is_kinematic_.push_back(std::all_of(is_always_held_.begin() + bodies.first_vertex[body],
                                            is_always_held_.begin() + bodies.first_vertex[body + 1],
                                            [](bool is_held) { return is_held; }));
    }
    mark();
}

template <int Dim>
Grips HeldVertices<Dim>::grips() const {
    Grips grips(is_held_.size(), kNoGrip);
    for (std::size_t set = 0; set < sets_.size(); ++set) {
        if (is_held(sets_[set])) {
            const bool is_rigid = !sets_[set].begins_later();
            for (const std::uint32_t vertex : sets_[set].vertices) {
                grips[vertex] = is_rigid ? static_cast<std::int32_t>(set) : kOtherGrip;
            }
        }
    }
    for (const std::uint32_t vertex : of_host_.vertices) {
        grips[vertex] = kOtherGrip;
    }
    return grips;
}

// Marks what is held in the step.
template <int Dim>
void HeldVertices<Dim>::mark() {
    is_held_.assign(is_held_.size(), false);
    for (const DirichletSet<Dim>& set : sets_) {
        for (const std::uint32_t vertex : set.vertices) {
            is_held_[vertex] = is_held_[vertex] || is_held(set);
        }
    }
    for (const std::uint32_t vertex : of_host_.vertices) {
        is_held_[vertex] = true;
    }
}

template <int Dim>
std::vector<std::size_t> HeldVertices<Dim>::hold(std::uint64_t step,
                                                 const Positions<Dim>& positions) {
    std::vector<std::size_t> changed;
    for (DirichletSet<Dim>& set : sets_) {
        if (set.is_held(step) != is_held(set)) {
            changed.push_back(set.body);
        }
        // Once more where the step was refused: a host may have put the body elsewhere since.
        if (step == set.first_step && set.begins_later()) {
            take_up<Dim>(positions, set);
        }
    }
    step_ = step;
    if (!changed.empty()) {
        mark();
    }
    return changed;
}

template <int Dim>
Positions<Dim> HeldVertices<Dim>::places() const {
    Positions<Dim> all(Dim, 0);
    for (const DirichletSet<Dim>& set : sets_) {
        if (set.begins_later()) {
            const Eigen::Index count = all.cols();
            all.conservativeResize(Dim, count + set.places.cols());
            all.rightCols(set.places.cols()) = set.places;
        }
    }
    return all;
}

template <int Dim>
void HeldVertices<Dim>::set_places(const Positions<Dim>& places) {
    Eigen::Index next = 0;
    for (DirichletSet<Dim>& set : sets_) {
        if (set.begins_later()) {
            set.places = places.middleCols(next, set.places.cols());
            next += set.places.cols();
            center_motions<Dim>(set);
        }
    }
}

template <int Dim>
bool HeldVertices<Dim>::hold_for_host(
    std::vector<std::uint32_t> vertices,  // NOLINT(performance-unnecessary-value-param): moved
    const Positions<Dim>& targets) {
    const bool has_changed = vertices != of_host_.vertices;
    of_host_.vertices = std::move(vertices);
    of_host_.targets = targets;
    if (has_changed) {
        mark();
    }
    return has_changed;
}

template <int Dim>
void HeldVertices<Dim>::begin_step_of_host(const Positions<Dim>& positions,
                                           double begin,
                                           double end) {
    of_host_.begin = begin;
    of_host_.end = end;
    of_host_.starts.resize(Dim, of_host_.targets.cols());
    for (std::size_t i = 0; i < of_host_.vertices.size(); ++i) {
        of_host_.starts.col(static_cast<Eigen::Index>(i)) = positions.col(of_host_.vertices[i]);
    }
}

template <int Dim>
void HeldVertices<Dim>::place(double time,
                              Positions<Dim>& positions,
                              Positions<Dim>* velocities) const {
    for (const DirichletSet<Dim>& set : sets_) {
        if (!is_held(set)) {
            continue;
        }
        const MotionChain<Dim> chain(set.motions, time);
        for (std::size_t i = 0; i < set.vertices.size(); ++i) {
            const std::uint32_t vertex = set.vertices[i];
            Vector<Dim> point = set.places.col(static_cast<Eigen::Index>(i));
            Vector<Dim> velocity = Vector<Dim>::Zero();
            chain.move(point, velocities != nullptr ? &velocity : nullptr);
            positions.col(vertex) = point;
            if (velocities != nullptr) {
                velocities->col(vertex) = velocity;
            }
        }
    }
    place_host_holds<Dim>(of_host_, time, positions, velocities);
}

#define PENT_INSTANTIATE(Dim) template class HeldVertices<Dim>;
PENT_FOR_EACH_DIMENSION(PENT_INSTANTIATE)
#undef PENT_INSTANTIATE

}  // namespace pent::simulator
