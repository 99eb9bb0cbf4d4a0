#pragma once

#include <pent/parallel.h>
#include <pent/simplex_mesh.h>
#include <pent/simulator/energies.h>
#include <pent/simulator/scene.h>
#include <pent/simulator/snapshot.h>
#include <pent/simulator/step_report.h>

#include <Eigen/Core>

#include <cstdint>
#include <functional>
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
