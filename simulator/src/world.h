#pragma once

#include "elements.h"
#include "numbering.h"

#include <pent/simplex_mesh.h>
#include <pent/simulator/scene.h>

#include <cstdint>
#include <vector>

namespace pent::simulator {

/// A motion and what it turns about, m.
template <int Dim>
struct CenteredMotion {
    Motion motion;
    Eigen::Matrix<double, Dim, 1> about;
};

/// Vertices that a constraint moves.
template <int Dim>
struct HeldSet {
    std::vector<std::uint32_t> vertices;       ///< Of all bodies counted through, increasing.
    std::vector<CenteredMotion<Dim>> motions;  ///< Applied one after the other.
};

/// Extrusion columns of all bodies, numbered through, and places within them. One entry a vertex.
struct Columns {
    std::vector<std::uint32_t> columns;
    std::vector<std::uint32_t> layers;
};

/// All bodies of a scene as one mesh: vertices and cells of the bodies one after the other.
template <int Dim>
struct World {
    std::vector<SimplexMesh<Dim>> meshes;    ///< As placed.
    std::vector<Eigen::Index> first_vertex;  ///< Bodies + 1 entries.
    Positions<Dim> rest;                     ///< Dim x vertices, m.
    Simplices<Dim + 1> cells;
    std::vector<CellRange> ranges;   ///< One a body.
    Eigen::VectorXd masses;          ///< One a vertex, kg.
    double large_energy = 0;         ///< Elastic energy of all bodies at strains of about one, J.
    std::vector<HeldSet<Dim>> held;  ///< One a constraint.
    std::vector<bool> is_held;       ///< One a vertex.
    Columns columns;
    Numbering numbering;  ///< Of what is solved for: vertices that are not held, of bodies awake.

    [[nodiscard]] Eigen::Index vertex_count() const { return rest.cols(); }
};

/// Places the meshes, selects held vertices, lumps masses and numbers unknowns.
///
/// Lumped mass: every cell gives each of its Dim + 1 corners the same share. Throws an Error as the
/// constructor of Simulation says.
template <int Dim>
[[nodiscard]] World<Dim> make_world(const Scene& scene, std::vector<SimplexMesh<Dim>> meshes);

/// Numbers the unknowns of some bodies alone.
///
/// @param is_in  One entry a body.
template <int Dim>
[[nodiscard]] Numbering number_bodies(const World<Dim>& world, const std::vector<bool>& is_in);

/// The velocities that the scene gives its bodies at the start, Dim x vertices, m/s.
template <int Dim>
[[nodiscard]] Positions<Dim> start_velocities(const Scene& scene, const World<Dim>& world);

/// Puts held vertices where they are at a time; their velocities too unless that is null.
template <int Dim>
void place_held(const World<Dim>& world,
                double time,
                Positions<Dim>& positions,
                Positions<Dim>* velocities);

}  // namespace pent::simulator
