#pragma once

#include <pent/simulator/energies.h>

#include <cstdint>
#include <limits>
#include <string>
#include <vector>

namespace pent::simulator {

/// What contact cost in a step. All zero without [contact] and [[obstacle]].
struct ContactWork {
    std::int64_t searches = 0;        ///< How often contacts were asked for.
    std::int64_t candidates = 0;      ///< Pairs of boxes that overlapped.
    std::int64_t obstacle_tests = 0;  ///< Distances of vertices to obstacles.
    std::int64_t friction = 0;        ///< Contacts whose friction was computed.
    std::int64_t trees_built = 0;
    std::int64_t trees_refit = 0;
    double ccd_seconds = 0;  ///< Of `seconds`: how far steps may go without a crossing.
    double seconds = 0;      ///< Finding contacts, their forces and their part of the matrix.

    ContactWork& operator+=(const ContactWork& other) {
        searches += other.searches;
        candidates += other.candidates;
        obstacle_tests += other.obstacle_tests;
        friction += other.friction;
        trees_built += other.trees_built;
        trees_refit += other.trees_refit;
        ccd_seconds += other.ccd_seconds;
        seconds += other.seconds;
        return *this;
    }
};

/// What touches at the end of a step, and what contact cost in it.
struct ContactSummary : ContactWork {
    std::int64_t point_facet = 0;  ///< Vertices in contact with a facet.
    std::int64_t mixed = 0;        ///< Edges with triangles; in three dimensions with edges.
    std::int64_t self = 0;         ///< Of both kinds, those within one body.
    std::int64_t obstacle = 0;     ///< Vertices in contact with an obstacle.
    double deepest = 0;            ///< Deepest penetration of a vertex, m, >= 0.
    double smallest_distance =
        std::numeric_limits<double>::infinity();  ///< Least signed distance in contact, m;
                                                  ///< infinite where nothing touches.
    double stiffness = 0;  ///< Of the barrier at the end, N/m; 0 without one.
};

/// A constraint at the end of a step: what holds its vertices against all forces on them, without
/// inertia and damping, as VertexQuantity::Reaction.
struct ConstraintSummary {
    std::int64_t held = 0;       ///< Vertices: none of a constraint that is not there now.
    std::vector<double> center;  ///< Mean of its vertices, held or not, m.
    std::vector<double> force;   ///< Of all together, N.
    std::vector<double> moment;  ///< About `center`, N m: planes xy, xz, xw, yz, yw, zw.
};

/// An attachment at the end of a step.
struct AttachmentSummary {
    std::int64_t springs = 0;  ///< That pull: none of an attachment that is not there now.
    std::int64_t broken = 0;   ///< Of all times.
    double force = 0;          ///< Of all its springs together, on what is selected, N.
    double largest_force = 0;  ///< Of one spring, N.
};

/// A region of a body at the end of a step.
struct RegionSummary {
    double energy = 0;  ///< Elastic, J.
};

/// What one step did.
struct StepReport {
    std::uint64_t step = 0;    ///< Steps taken so far, this one included.
    double time = 0;           ///< At its end, s.
    bool is_accepted = false;  ///< If not, all is where it was before the step.
    std::string failure;       ///< Why the last attempt was thrown away; empty if none was.
    int substeps = 0;          ///< 1, or more where the step had to be cut.
    int refused = 0;           ///< Attempts that were thrown away.
    int damped = 0;  ///< Substeps of LinearEuler whose linear step had gone astray, and a few
                     ///< iterations of Newton's method took its place.
    int newton_iterations = 0;  ///< After the first, linear step; of LinearEuler in damped ones.
    int iterations = 0;         ///< Of the linear solver, in all.
    int asleep = 0;             ///< Bodies that sleep at the end.
    std::int64_t unknowns = 0;  ///< Scalars solved for, in all linear solves.
    std::int64_t hessians = 0;  ///< Of elements, in all matrices solved with.
    std::int64_t filtered = 0;  ///< Of those, the ones that Filter changed: none with Filter::None.
    std::int64_t damping_hessians =
        0;                  ///< The same for Rayleigh damping with a tangent of its own.
    double residual = 0;    ///< Largest |b - A x| / |b| from x, in the norm where most is left.
    double unbalanced = 0;  ///< Largest unbalanced force at the end of a Newton step over that at
                            ///< its start; above newton_tolerance at kinks and barriers alone.
    std::int64_t inverted = 0;  ///< Cells with J <= 0 at the end.
    std::int64_t collapsed =
        0;              ///< Elements in the false minimum at the end; see collapse_scale().
    Energies energies;  ///< At the end.
    ContactSummary contact;
    std::vector<double> momentum;          ///< Of all bodies, kg m/s; empty unless Output::balance.
    std::vector<double> angular_momentum;  ///< About the origin, kg m^2/s: planes as of a moment.
    std::vector<ConstraintSummary> constraints;  ///< One for each of the scene.
    std::vector<AttachmentSummary> attachments;  ///< One for each of the scene.
    std::vector<RegionSummary> regions;          ///< Of all bodies, one body after the other.
    double activation_work = 0;                  ///< Done on the bodies in the step, J.
    double assembly_seconds = 0;
    double solve_seconds = 0;
    double seconds = 0;  ///< All of the step.
};

}  // namespace pent::simulator
