#pragma once

#include <pent/mesh_part.h>
#include <pent/simulator/energies.h>
#include <pent/simulator/host.h>
#include <pent/simulator/scene.h>
#include <pent/simulator/simulation_options.h>
#include <pent/simulator/snapshot.h>
#include <pent/simulator/step_report.h>

#include <Eigen/Core>

#include <cstdint>
#include <memory>
#include <span>
#include <string>
#include <vector>

namespace pent::contact {
template <int Dim>
struct Contact;
}  // namespace pent::contact

namespace pent::simulator {

/// A scene in motion, which a host program steps.
///
/// State is kept in double. Bodies are in the order of the scene; vertices in the order of their
/// mesh. Views show the state as it is at the time, until bodies come or go.
template <int Dim>
class Simulation {
public:
    using View = Eigen::Map<const Positions<Dim>>;
    using Vector = Eigen::Matrix<double, Dim, 1>;

    /// @param meshes  One for each body, as loaded: placement is done here.
    ///
    /// Throws an Error if the scene does not pass check(), its dimension is not Dim, a mesh does
    /// not pass validate(), a constraint selects nothing, or two hold the same vertex at one time.
    Simulation(const Scene& scene,
               std::vector<SimplexMesh<Dim>> meshes,
               const SimulationOptions& options = {});
    /// On ranks that have parts of the meshes, see mesh_parts.h.
    Simulation(const Scene& scene, MeshParts<Dim> parts, const SimulationOptions& options);
    ~Simulation();
    Simulation(Simulation&&) noexcept;
    Simulation& operator=(Simulation&&) noexcept;
    Simulation(const Simulation&) = delete;
    Simulation& operator=(const Simulation&) = delete;

    /// One time step of Scene::dt().
    ///
    /// An attempt fails when a solver does not reach its tolerance, the state is not finite or far
    /// beyond that before, something may have passed through something else, or an obstacle comes
    /// over a body that it may not touch; the step is then cut in two, up to
    /// SolverOptions::max_halvings times. If that does not help, the report says so, and positions,
    /// velocities and time stay as they were; bodies that it woke are awake.
    [[nodiscard]] StepReport step();

    /// As it is now. Once a body or an obstacle has been added or removed the placements of bodies
    /// are identities, as their meshes have been placed.
    [[nodiscard]] const Scene& scene() const;

    [[nodiscard]] int body_count() const;
    [[nodiscard]] const SimplexMesh<Dim>& mesh(int body) const;  ///< As placed; of parts no cells.
    [[nodiscard]] View positions(int body) const;                ///< m.
    [[nodiscard]] View velocities(int body) const;               ///< m/s.
    [[nodiscard]] View forces(int body) const;                   ///< Of all that has an energy, N.
    [[nodiscard]] Eigen::Map<const Eigen::VectorXd> masses(int body) const;  ///< Lumped, kg.

    [[nodiscard]] std::shared_ptr<const void> arrays() const;  ///< Keeps current views valid.

    /// Forces of contact alone, of bodies and obstacles, on the vertices of a body, Dim x vertices,
    /// N.
    [[nodiscard]] Positions<Dim> contact_forces(int body) const;

    /// A quantity of the vertices of a body, a column each: 1 row of a number, Dim of a vector.
    [[nodiscard]] Eigen::MatrixXd vertex_values(VertexQuantity quantity, int body) const;

    /// What touches: pairs by bodies, kind and place, then vertices at surfaces of obstacles.
    /// Vertices are counted through all bodies. <pent/contact/contact.h> has the type.
    [[nodiscard]] std::span<const contact::Contact<Dim>> contacts() const;

    /// The obstacles of the scene, where they are now.
    [[nodiscard]] const std::vector<pent::ObstacleShape<Dim>>& obstacles() const;

    /// First vertex of a body where those of all bodies are counted through.
    [[nodiscard]] std::int64_t first_vertex(int body) const;

    /// Settings that do not suit the meshes, a line each; empty if there is none.
    [[nodiscard]] std::vector<std::string> warnings() const;

    [[nodiscard]] double time() const;  ///< s.
    [[nodiscard]] std::uint64_t step_count() const;
    [[nodiscard]] Energies energies() const;
    [[nodiscard]] SimulationSize size() const;
    [[nodiscard]] std::string isa() const;  ///< Name of the instruction set in use.

    /// Puts a body somewhere, awake, and wakes what it touched: a host's own start. Dirichlet
    /// vertices follow their motion from the next step on, whatever is said here. Throws an Error
    /// unless there is such a body and both arrays are finite and Dim x its vertices, and a
    /// CrossingError where a barrier does not allow it; nothing has changed then. To move several
    /// bodies at once, change a snapshot.
    ///
    /// @param body  Below body_count().
    void set_state(int body, const Positions<Dim>& positions, const Positions<Dim>& velocities);

    // What a host does, see HostState. It takes effect with the next step; until then forces() and
    // energies() stay as they are. Bodies that it concerns wake. All throw an Error, and change
    // nothing, where bodies, vertices or numbers are not in their range.

    /// Holds vertices of a body and takes them, on a straight way, to targets (Dim x vertices, m)
    /// by the end of the next step; there they stay until they have other targets. From then on a
    /// constraint has no say in them.
    void set_targets(int body,
                     const std::vector<std::uint32_t>& vertices,
                     const Positions<Dim>& targets);

    /// Lets vertices go: they are free, or again where a constraint has them at the end of the next
    /// step. Those that no host holds are left alone. A CrossingError where a barrier would not
    /// have them free as they are.
    void release(int body, const std::vector<std::uint32_t>& vertices);

    /// Takes hold of a point. The number returned stands for the grab below.
    std::uint64_t add_grab(const Grab<Dim>& grab);
    void move_grab(std::uint64_t grab, const Vector& anchor);  ///< By the end of the next step; m.
    void remove_grab(std::uint64_t grab);

    /// Forces on the vertices of a body, Dim x vertices, N, in all steps until they are set anew.
    void set_forces(int body, const Positions<Dim>& forces);
    void set_gravity(const Vector& gravity);  ///< m/s^2.

    [[nodiscard]] HostState<Dim> host() const;

    // Bodies and obstacles that come and go. A body costs what a start costs, and views are gone;
    // an obstacle costs as much as holding other vertices. What is not right, or crosses at a
    // barrier, is refused as by the constructor, and nothing has changed.

    /// Adds a body behind all others, as a scene has it at its start.
    void add_body(const Body& body, SimplexMesh<Dim> mesh);

    /// Removes a body, and with it constraints, loads, attachments, grabs and pairs of contact that
    /// have to do with it; later ones move up. What touched it, or was tied to it, wakes.
    void remove_body(int body);

    void add_obstacle(const Obstacle& obstacle);  ///< Behind all others.
    void remove_obstacle(int obstacle);           ///< Later ones move up; what touched it wakes.

    /// Whether each body sleeps; none does without Scene::sleep.
    [[nodiscard]] const std::vector<SleepState>& sleep() const;

    [[nodiscard]] Snapshot<Dim> save() const;

    /// Puts everything back. Throws an Error, and changes nothing, unless the snapshot fits the
    /// scene as it is now: the same time step, as many vertices, bodies and springs, all finite,
    /// none asleep without Scene::sleep; and a CrossingError where a barrier does not allow the
    /// positions.
    void restore(const Snapshot<Dim>& snapshot);

private:
    class Stepper;
    std::shared_ptr<Stepper> stepper_;
};

}  // namespace pent::simulator
