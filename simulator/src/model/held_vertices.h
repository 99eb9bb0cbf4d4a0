#pragma once

#include "model/bodies.h"
#include "model/grips.h"
#include "model/motion_chain.h"

#include <pent/simulator/scene.h>

#include <cstdint>
#include <vector>

namespace pent::simulator {

/// Vertices whose places are given in some steps: those of one constraint (Dirichlet boundary
/// conditions).
template <int Dim>
struct DirichletSet {
    std::size_t body = 0;
    std::vector<std::uint32_t> vertices;  ///< Of all bodies counted through, increasing.
    std::uint64_t first_step = 0;  ///< Held in the steps [first_step, end_step), counted from 0.
    std::uint64_t end_step = 0;
    std::vector<Motion> path;                  ///< Of the scene, from when they are held on.
    std::vector<CenteredMotion<Dim>> motions;  ///< The same, about where they were taken up.
    Positions<Dim> places;                     ///< Dim x vertices: what they start from, m.

    [[nodiscard]] bool is_held(std::uint64_t step) const {
        return first_step <= step && step < end_step;
    }
    [[nodiscard]] bool begins_later() const { return first_step > 0; }
};

/// Vertices that a host holds, whatever constraints say of them.
template <int Dim>
struct HostHolds {
    std::vector<std::uint32_t> vertices;  ///< Of all bodies counted through, increasing.
    Positions<Dim> targets =
        Positions<Dim>(Dim, 0);                      ///< Dim x vertices: at the end of the step, m.
    Positions<Dim> starts = Positions<Dim>(Dim, 0);  ///< At its start, m.
    double begin = 0;                                ///< The step, s.
    double end = 0;
};

/// Which vertices are held, by constraints or by a host, and where: all that changes of the bodies
/// of a scene while a simulation runs. It has one owner; nobody else keeps a pointer to it.
template <int Dim>
class HeldVertices {
public:
    /// Selects what constraints hold, and holds what they hold in the first step. Throws an Error
    /// as the constructor of Simulation says.
    ///
    /// @param bodies  Of the scene, not needed afterwards.
    HeldVertices(const Scene& scene, const Bodies<Dim>& bodies);

    /// Whether a vertex is held now.
    [[nodiscard]] bool is_held(std::uint32_t vertex) const { return is_held_[vertex]; }

    /// One a vertex: whether it is held now, and whether it is in every step.
    [[nodiscard]] const std::vector<bool>& now() const { return is_held_; }
    [[nodiscard]] const std::vector<bool>& always() const { return is_always_held_; }

    /// One a vertex, as it is now.
    [[nodiscard]] Grips grips() const;

    /// Whether every vertex of a body is held all the time: it then moves from outside alone.
    [[nodiscard]] bool is_kinematic(std::size_t body) const { return is_kinematic_[body]; }

    /// One a constraint, and whether one of them holds its vertices now.
    [[nodiscard]] const std::vector<DirichletSet<Dim>>& sets() const { return sets_; }
    [[nodiscard]] bool is_held(const DirichletSet<Dim>& set) const { return set.is_held(step_); }

    [[nodiscard]] const HostHolds<Dim>& of_host() const { return of_host_; }

    /// Holds what is held in a step, which may be any; takes hold, where they are, of vertices that
    /// constraints begin to hold in it. Returns the bodies of which something is held or free now
    /// that was not before.
    ///
    /// @param positions  Dim x vertices: where the step begins, m.
    [[nodiscard]] std::vector<std::size_t> hold(std::uint64_t step,
                                                const Positions<Dim>& positions);

    /// Where constraints that begin later have taken hold of their vertices, see
    /// Snapshot::hold_places.
    [[nodiscard]] Positions<Dim> places() const;

    /// Puts them back, as many as places() gives.
    void set_places(const Positions<Dim>& places);

    /// Holds these vertices for a host, and no others. Returns whether it held others before.
    [[nodiscard]] bool hold_for_host(std::vector<std::uint32_t> vertices,
                                     const Positions<Dim>& targets);

    /// Sets from where, and when, what a host holds is taken to its targets in the next step.
    ///
    /// @param positions   Dim x vertices: where the step begins, m.
    /// @param begin, end  s.
    void begin_step_of_host(const Positions<Dim>& positions, double begin, double end);

    /// Puts what is held now where it is at a time; their velocities too unless that is null.
    void place(double time, Positions<Dim>& positions, Positions<Dim>* velocities) const;

private:
    void mark();

    std::vector<DirichletSet<Dim>> sets_;
    HostHolds<Dim> of_host_;
    std::uint64_t step_ = 0;  // what is held is that of this step
    std::vector<bool> is_held_;
    std::vector<bool> is_always_held_;
    std::vector<bool> is_kinematic_;
};

}  // namespace pent::simulator
