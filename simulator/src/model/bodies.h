#pragma once

#include "linear/dof_map.h"
#include "linear/sharing.h"
#include "model/cell_range.h"
#include "model/motion_chain.h"
#include "model/quadratic_cells.h"

#include <pent/simplex_mesh.h>
#include <pent/simulator/scene.h>

#include <cstdint>
#include <vector>

namespace pent::simulator {

/// Vertices whose places are given in some steps: those of one constraint (Dirichlet boundary
/// conditions).
template <int Dim>
struct DirichletSet {
    std::vector<std::uint32_t> vertices;       ///< Of all bodies counted through, increasing.
    std::vector<CenteredMotion<Dim>> motions;  ///< Applied one after the other.
    Positions<Dim> places;                     ///< Dim x vertices: what they start from, m.
    std::size_t body = 0;
    std::size_t constraint = 0;    ///< Its place in the scene.
    std::uint64_t first_step = 0;  ///< Held in the steps [first_step, end_step), counted from 0.
    std::uint64_t end_step = 0;

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

/// All bodies of a scene as one mesh: vertices and cells of the bodies one after the other. While a
/// simulation runs nothing in here changes but what is held; see hold().
template <int Dim>
struct Bodies {
    std::vector<SimplexMesh<Dim>> meshes;    ///< As placed.
    std::vector<Eigen::Index> first_vertex;  ///< Bodies + 1 entries.
    Positions<Dim> rest;                     ///< Dim x vertices, m.
    std::vector<Eigen::Index> first_cell;    ///< Bodies + 1 entries.
    Simplices<Dim + 1> cells;  ///< Of a body with regions those of each one after the other. Ranks
                               ///< may have those of their vertices alone: see keep_near_cells().
    Eigen::Index cell_count = 0;  ///< Of all ranks.
    std::vector<std::uint32_t>
        mesh_cells;  ///< Which cell of its mesh each is; empty if all are and no body has regions.
    std::vector<CellRange> ranges;  ///< One a body and one a region, in this order.
    QuadraticCells<Dim> quadratic;  ///< Of which the cells are children; empty if not asked for.
    Eigen::VectorXd masses;         ///< One a vertex, kg.
    double large_energy = 0;        ///< Elastic energy of all bodies at strains of about one, J.
    std::vector<DirichletSet<Dim>> dirichlet_sets;  ///< One a constraint.
    HostHolds<Dim> host_holds;
    std::vector<bool> is_dirichlet;    ///< One a vertex: whether it is held now.
    std::vector<bool> is_always_held;  ///< One a vertex: in every step.
    std::uint64_t step = 0;            ///< What is held is that of this step.
    Columns columns;
    Sharing sharing;                  ///< By ranks.
    bool may_couple_anything = true;  ///< Whether a matrix may couple vertices that share no cell.

    [[nodiscard]] Eigen::Index vertex_count() const { return rest.cols(); }
    [[nodiscard]] std::size_t count() const { return meshes.size(); }

    struct Range {
        Eigen::Index begin = 0;
        Eigen::Index size = 0;
    };
    /// Vertices of a body.
    [[nodiscard]] Range vertices(std::size_t body) const {
        return {first_vertex[body], first_vertex[body + 1] - first_vertex[body]};
    }

    /// Cells of a body.
    [[nodiscard]] Range cells_of(std::size_t body) const {
        return {first_cell[body], first_cell[body + 1] - first_cell[body]};
    }

    /// Elements of a body: its quadratic cells, or its cells where there are none.
    [[nodiscard]] Range elements_of(std::size_t body) const;
    [[nodiscard]] Eigen::Index element_count() const {
        return quadratic.nodes.cols() > 0 ? quadratic.nodes.cols() : cells.cols();
    }

    /// Which cell of its mesh a cell is.
    [[nodiscard]] std::uint32_t mesh_cell(std::size_t body, Eigen::Index cell) const {
        return mesh_cells.empty() ? static_cast<std::uint32_t>(cell - first_cell[body])
                                  : mesh_cells[static_cast<std::size_t>(cell)];
    }

    /// The body that a vertex belongs to.
    [[nodiscard]] std::size_t body_of(std::uint32_t vertex) const;

    /// Whether every vertex of a body is held all the time: it then moves from outside alone.
    [[nodiscard]] bool is_kinematic(std::size_t body) const;
};

/// Places the meshes, selects vertices with given places and lumps masses.
///
/// Lumped mass: every cell gives each of its Dim + 1 corners the same share. Throws an Error as the
/// constructor of Simulation says.
template <int Dim>
[[nodiscard]] Bodies<Dim> make_bodies(const Scene& scene, std::vector<SimplexMesh<Dim>> meshes);

/// Holds what is held in a step, which may be any; what begins to be held in it is taken up where
/// it is. Returns the bodies of which something is held or free now that was not before.
///
/// @param positions  Dim x vertices: where the step begins, m.
template <int Dim>
[[nodiscard]] std::vector<std::size_t> hold(const Scene& scene,
                                            std::uint64_t step,
                                            const Positions<Dim>& positions,
                                            Bodies<Dim>& bodies);

/// Where sets that begin later have been taken up, see Snapshot::hold_places.
template <int Dim>
[[nodiscard]] Positions<Dim> hold_places(const Bodies<Dim>& bodies);

/// Puts them back, as many as hold_places() gives.
template <int Dim>
void set_hold_places(const Scene& scene, const Positions<Dim>& places, Bodies<Dim>& bodies);

/// Holds these vertices for a host, and no others. Returns whether it held others before.
template <int Dim>
[[nodiscard]] bool hold_for_host(std::vector<std::uint32_t> vertices,
                                 const Positions<Dim>& targets,
                                 Bodies<Dim>& bodies);

/// From where to where, and when, what a host holds is taken in the next step.
///
/// @param positions  Dim x vertices: where the step begins, m.
template <int Dim>
void begin_host_holds(const Positions<Dim>& positions,
                      double begin,
                      double end,
                      Bodies<Dim>& bodies);

/// Numbers the vertices of some bodies that are free to move, as this rank has them in its matrix.
///
/// @param is_in  One entry a body.
template <int Dim>
[[nodiscard]] DofMap number_dofs(const Bodies<Dim>& bodies, const std::vector<bool>& is_in);

/// The same vertices in an order that is one on all ranks.
template <int Dim>
[[nodiscard]] DofMap number_dofs_alike(const Bodies<Dim>& bodies, const std::vector<bool>& is_in);

/// The velocities that the scene gives its bodies at the start, Dim x vertices, m/s.
template <int Dim>
[[nodiscard]] Positions<Dim> start_velocities(const Scene& scene, const Bodies<Dim>& bodies);

/// Puts what is held now where it is at a time; their velocities too unless that is null.
template <int Dim>
void place_dirichlet(const Bodies<Dim>& bodies,
                     double time,
                     Positions<Dim>& positions,
                     Positions<Dim>* velocities);

}  // namespace pent::simulator
