#pragma once

#include "linear/dof_map.h"
#include "linear/sharing.h"
#include "model/cell_range.h"
#include "model/quadratic_cells.h"

#include <pent/simplex_mesh.h>
#include <pent/simulator/scene.h>

#include <cstdint>
#include <optional>
#include <vector>

namespace pent::simulator {

/// All bodies of a scene as one mesh: vertices and cells of the bodies one after the other. While a
/// simulation runs nothing in here changes; what of it is held does, see HeldVertices.
template <int Dim>
struct Bodies {
    std::vector<SimplexMesh<Dim>> meshes;    ///< As placed.
    std::vector<Eigen::Index> first_vertex;  ///< Bodies + 1 entries.
    std::vector<Eigen::Index> first_cell;    ///< Bodies + 1 entries.
    /// What rest() and cells() give; empty where the one mesh has that already.
    std::optional<Positions<Dim>> joined_rest;
    std::optional<Simplices<Dim + 1>> joined_cells;
    Eigen::Index cell_count = 0;  ///< Of all ranks.
    std::vector<std::uint32_t>
        mesh_cells;  ///< Which cell of its mesh each is; empty if all are and no body has regions.
    std::vector<CellRange> ranges;    ///< One a body and one a region, in this order.
    QuadraticCells<Dim> quadratic;    ///< Of which the cells are children; empty if not asked for.
    Eigen::VectorXd masses;           ///< One a vertex, kg.
    double large_energy = 0;          ///< Elastic energy of all bodies at strains of about one, J.
    Sharing sharing;                  ///< By ranks.
    bool may_couple_anything = true;  ///< Whether a matrix may couple vertices that share no cell.

    [[nodiscard]] Eigen::Index vertex_count() const { return first_vertex.back(); }
    [[nodiscard]] std::size_t count() const { return meshes.size(); }

    /// Where all vertices are at rest, Dim x vertices, m.
    [[nodiscard]] const Positions<Dim>& rest() const {
        return joined_rest ? *joined_rest : meshes.front().positions;
    }

    /// Corners by vertices of all bodies counted through. Cells are in the order of bodies, in one
    /// with regions in that of these. Ranks may have those of their vertices alone: see
    /// keep_near_cells().
    [[nodiscard]] const Simplices<Dim + 1>& cells() const {
        return joined_cells ? *joined_cells : meshes.front().cells;
    }

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
        return quadratic.nodes.cols() > 0 ? quadratic.nodes.cols() : cells().cols();
    }

    /// Which cell of its mesh a cell is.
    [[nodiscard]] std::uint32_t mesh_cell(std::size_t body, Eigen::Index cell) const {
        return mesh_cells.empty() ? static_cast<std::uint32_t>(cell - first_cell[body])
                                  : mesh_cells[static_cast<std::size_t>(cell)];
    }

    /// The body that a vertex belongs to.
    [[nodiscard]] std::size_t body_of(std::uint32_t vertex) const;
};

/// The columns of all bodies; a mesh without columns has one a vertex.
template <int Dim>
[[nodiscard]] Columns number_columns(const std::vector<SimplexMesh<Dim>>& meshes);

/// Places the meshes and lumps masses.
///
/// Lumped mass: every cell gives each of its Dim + 1 corners the same share. Throws an Error as the
/// constructor of Simulation says.
template <int Dim>
[[nodiscard]] Bodies<Dim> make_bodies(const Scene& scene, std::vector<SimplexMesh<Dim>> meshes);

/// The velocities that the scene gives its bodies at the start, Dim x vertices, m/s.
template <int Dim>
[[nodiscard]] Positions<Dim> start_velocities(const Scene& scene, const Bodies<Dim>& bodies);

}  // namespace pent::simulator
