#pragma once

#include <pent/parallel.h>
#include <pent/simplex_mesh.h>
#include <pent/simulator/energies.h>
#include <pent/simulator/scene.h>

#include <cstdint>
#include <functional>
#include <limits>
#include <memory>
#include <optional>
#include <span>
#include <string>
#include <vector>

namespace pent::contact {
template <int Dim>
struct Contact;
}  // namespace pent::contact

namespace pent::simulator {

struct SimulationOptions {
    int threads = 1;  ///< At least 1. Results do not depend on it.
    std::optional<TaskSystem> tasks =
        {};  ///< The host's, in place of `threads` of ours. Results do not depend on it.
    std::string isa =
        {};  ///< "scalar", "baseline", "avx2" or "avx512"; empty for the best there is.
    /// Told of the path that Newton's method takes in a step: all positions (Dim x vertices, m)
    /// where it starts, with true, and every iterate, with false. For plots of convergence, and
    /// proofs that nothing crosses on the way.
    std::function<void(const Eigen::MatrixXd& positions, bool is_start)> on_iterate = {};
};

/// How big a simulation is.
struct SimulationSize {
    std::int64_t vertices = 0;
    std::int64_t cells = 0;
    std::int64_t free_vertices = 0;  ///< Those with unknowns now: Dim each.
    std::int64_t elements = 0;       ///< Cells, edges or quadratic cells, with a free
                                     ///< vertex near; others cost nothing.
    std::int64_t matrix_blocks = 0;  ///< Dim x Dim blocks stored, upper triangle.
    std::int64_t element_bytes = 0;  ///< Of elements; part of `bytes`.
    std::int64_t matrix_bytes = 0;   ///< Of the matrix; part of `bytes`.
    std::int64_t contact_bytes = 0;  ///< Of surfaces and trees for contact; part of `bytes`.
    std::int64_t bytes = 0;          ///< Of what grows with the mesh, in memory.
};

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

/// An attachment at the end of a step.
struct AttachmentSummary {
    std::int64_t springs = 0;  ///< That pull: none of an attachment that is not there now.
    std::int64_t broken = 0;   ///< Of all times.
    double force = 0;          ///< Of all its springs together, on what is selected, N.
    double largest_force = 0;  ///< Of one spring, N.
};

/// Whether a body sleeps, and what it takes to decide that; see Sleep.
struct SleepState {
    bool is_asleep = false;
    std::uint64_t quiet_steps = 0;  ///< Steps in a row, up to now, that ended with it at rest.
    double contact_stiffness =
        0;  ///< Of a barrier when it fell asleep, N/m: it keeps those forces.

    bool operator==(const SleepState&) const = default;
};

/// All that a simulation carries from one step to the next, to be put back later: the same steps
/// follow, to the bit.
template <int Dim>
struct Snapshot {
    Positions<Dim> positions;   ///< Dim x vertices of all bodies, m.
    Positions<Dim> velocities;  ///< Dim x vertices, m/s.
    /// What BDF2 looks back to, the state one step ago; no columns after a step that was cut in
    /// two, and for the other integrators.
    Positions<Dim> previous_positions;
    Positions<Dim> previous_velocities;
    std::vector<SleepState> sleep;  ///< One a body.
    std::uint64_t steps = 0;        ///< Taken so far.
    double contact_stiffness = 0;   ///< To which a barrier has adapted, N/m; 0 without one.
    /// Where constraints that begin after the start have taken up their vertices, m: Dim x their
    /// vertices, one constraint after the other; zero for those that have not begun.
    Positions<Dim> hold_places;
    /// One for each spring of all attachments: 1 if it is broken, else 0.
    std::vector<std::uint8_t> broken_springs;
};

/// What one step did.
struct StepReport {
    std::uint64_t step = 0;     ///< Steps taken so far, this one included.
    double time = 0;            ///< At its end, s.
    bool is_accepted = false;   ///< If not, the state is that before the step.
    std::string failure;        ///< Why the last attempt was thrown away; empty if none was.
    int substeps = 0;           ///< 1, or more where the step had to be cut.
    int refused = 0;            ///< Attempts that were thrown away.
    int newton_iterations = 0;  ///< After the first, linear step; 0 for LinearEuler.
    int iterations = 0;         ///< Of the linear solver, in all.
    int asleep = 0;             ///< Bodies that sleep at the end.
    std::int64_t unknowns = 0;  ///< Scalars solved for, in all linear solves.
    std::int64_t hessians = 0;  ///< Of elements that were assembled, in all.
    std::int64_t filtered = 0;  ///< Of those, the ones that Filter changed: none with Filter::None.
    std::int64_t damping_hessians =
        0;                  ///< The same for Rayleigh damping with a tangent of its own.
    double residual = 0;    ///< Largest |b - A x| / |b|, computed from x.
    double unbalanced = 0;  ///< Largest unbalanced force at the end of a Newton step over that at
                            ///< its start; above newton_tolerance at kinks and barriers alone.
    std::int64_t inverted = 0;  ///< Cells with J <= 0 at the end.
    std::int64_t collapsed =
        0;              ///< Elements in the false minimum at the end; see collapse_scale().
    Energies energies;  ///< At the end.
    ContactSummary contact;
    std::vector<AttachmentSummary> attachments;  ///< One for each of the scene.
    double assembly_seconds = 0;
    double solve_seconds = 0;
    double seconds = 0;  ///< All of the step.
};

/// A scene in motion, which a host program steps.
///
/// State is kept in double. Bodies are in the order of the scene; vertices in the order of their
/// mesh. Views hold until the next step(), set_state() or restore(); then take them anew.
template <int Dim>
class Simulation {
public:
    using View = Eigen::Map<const Positions<Dim>>;

    /// @param meshes  One for each body, as loaded: placement is done here.
    ///
    /// Throws an Error if the scene does not pass check(), its dimension is not Dim, a mesh does
    /// not pass validate(), a constraint selects nothing, or two hold the same vertex at one time.
    Simulation(const Scene& scene,
               std::vector<SimplexMesh<Dim>> meshes,
               const SimulationOptions& options = {});
    ~Simulation();
    Simulation(Simulation&&) noexcept;
    Simulation& operator=(Simulation&&) noexcept;
    Simulation(const Simulation&) = delete;
    Simulation& operator=(const Simulation&) = delete;

    /// One time step of Scene::dt().
    ///
    /// An attempt fails when the linear solver does not reach its tolerance or the state stops
    /// being finite; it is then thrown away and the step cut in two, up to
    /// SolverOptions::max_halvings times. If that does not help, the report says so and the state
    /// stays as it was.
    [[nodiscard]] StepReport step();

    [[nodiscard]] int body_count() const;
    [[nodiscard]] const SimplexMesh<Dim>& mesh(int body) const;  ///< As placed.
    [[nodiscard]] View positions(int body) const;                ///< m.
    [[nodiscard]] View velocities(int body) const;               ///< m/s.
    [[nodiscard]] View forces(int body) const;                   ///< Of all that has an energy, N.
    [[nodiscard]] Eigen::Map<const Eigen::VectorXd> masses(int body) const;  ///< Lumped, kg.

    /// Forces of contact alone, of bodies and obstacles, on the vertices of a body, Dim x vertices,
    /// N.
    [[nodiscard]] Positions<Dim> contact_forces(int body) const;

    /// A quantity of the vertices of a body, a column each: 1 row of a number, Dim of a vector.
    [[nodiscard]] Eigen::MatrixXd vertex_values(VertexQuantity quantity, int body) const;

    /// What touches: pairs by bodies, kind and place, then vertices at surfaces of obstacles.
    /// Vertices are counted through all bodies. <pent/contact/contact.h> has the type.
    [[nodiscard]] std::span<const contact::Contact<Dim>> contacts() const;

    /// The obstacles of the scene, where they are now.
    [[nodiscard]] const std::vector<pent::Obstacle<Dim>>& obstacles() const;

    /// First vertex of a body where those of all bodies are counted through.
    [[nodiscard]] std::int64_t first_vertex(int body) const;

    /// Settings that do not suit the meshes, a line each; empty if there is none.
    [[nodiscard]] std::vector<std::string> warnings() const;

    [[nodiscard]] double time() const;  ///< s.
    [[nodiscard]] std::uint64_t step_count() const;
    [[nodiscard]] Energies energies() const;
    [[nodiscard]] SimulationSize size() const;
    [[nodiscard]] std::string isa() const;  ///< Name of the instruction set in use.

    /// Puts a body somewhere, awake: a host's own start. Dirichlet vertices follow their motion
    /// from the next step on, whatever is said here. Throws an Error unless both arrays are finite
    /// and Dim x vertices, and a CrossingError where a barrier does not allow it; nothing has
    /// changed then. To move several bodies at once, change a snapshot.
    void set_state(int body, const Positions<Dim>& positions, const Positions<Dim>& velocities);

    /// Whether each body sleeps; none does without Scene::sleep.
    [[nodiscard]] const std::vector<SleepState>& sleep() const;

    [[nodiscard]] Snapshot<Dim> save() const;

    /// Puts everything back. Throws an Error, and changes nothing, unless the snapshot fits the
    /// scene: as many vertices, bodies and springs, all finite, none asleep without Scene::sleep; and a
    /// CrossingError where a barrier does not allow the positions.
    void restore(const Snapshot<Dim>& snapshot);

private:
    class Stepper;
    std::unique_ptr<Stepper> stepper_;
};

}  // namespace pent::simulator
