#pragma once

#include "linear/dof_map.h"
#include "model/cell_range.h"
#include "model/motion_chain.h"

#include <pent/simplex_mesh.h>
#include <pent/simulator/scene.h>

#include <cstdint>
#include <vector>

namespace pent::simulator {

/// Vertices whose places are given: those of one constraint (Dirichlet boundary conditions).
template <int Dim>
struct DirichletSet {
    std::vector<std::uint32_t> vertices;       ///< Of all bodies counted through, increasing.
    std::vector<CenteredMotion<Dim>> motions;  ///< Applied one after the other.
};

/// All bodies of a scene as one mesh: vertices and cells of the bodies one after the other. Nothing
/// in here changes while a simulation runs.
template <int Dim>
struct Bodies {
    std::vector<SimplexMesh<Dim>> meshes;    ///< As placed.
    std::vector<Eigen::Index> first_vertex;  ///< Bodies + 1 entries.
    Positions<Dim> rest;                     ///< Dim x vertices, m.
    Simplices<Dim + 1> cells;
    std::vector<CellRange> ranges;  ///< One a body.
    Eigen::VectorXd masses;         ///< One a vertex, kg.
    double large_energy = 0;        ///< Elastic energy of all bodies at strains of about one, J.
    std::vector<DirichletSet<Dim>> dirichlet_sets;  ///< One a constraint.
    std::vector<bool> is_dirichlet;                 ///< One a vertex.
    Columns columns;

    [[nodiscard]] Eigen::Index vertex_count() const { return rest.cols(); }
    [[nodiscard]] std::size_t count() const { return meshes.size(); }

    /// Vertices of a body: [begin, begin + size).
    struct Range {
        Eigen::Index begin = 0;
        Eigen::Index size = 0;
    };
    [[nodiscard]] Range vertices(std::size_t body) const {
        return {first_vertex[body], first_vertex[body + 1] - first_vertex[body]};
    }

    /// The body that a vertex belongs to.
    [[nodiscard]] std::size_t body_of(std::uint32_t vertex) const;

    /// Whether every vertex of a body has a given place: it then moves from outside alone.
    [[nodiscard]] bool is_kinematic(std::size_t body) const;
};

/// Places the meshes, selects vertices with given places and lumps masses.
///
/// Lumped mass: every cell gives each of its Dim + 1 corners the same share. Throws an Error as the
/// constructor of Simulation says.
template <int Dim>
[[nodiscard]] Bodies<Dim> make_bodies(const Scene& scene, std::vector<SimplexMesh<Dim>> meshes);

/// Numbers the vertices of some bodies that are free to move.
///
/// @param is_in  One entry a body.
template <int Dim>
[[nodiscard]] DofMap number_dofs(const Bodies<Dim>& bodies, const std::vector<bool>& is_in);

/// The velocities that the scene gives its bodies at the start, Dim x vertices, m/s.
template <int Dim>
[[nodiscard]] Positions<Dim> start_velocities(const Scene& scene, const Bodies<Dim>& bodies);

/// Puts Dirichlet vertices where they are at a time; their velocities too unless that is null.
template <int Dim>
void place_dirichlet(const Bodies<Dim>& bodies,
                     double time,
                     Positions<Dim>& positions,
                     Positions<Dim>* velocities);

}  // namespace pent::simulator
