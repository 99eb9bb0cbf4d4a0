#pragma once

#include "kernels/quadratic_rule.h"
#include "model/cell_range.h"

#include <pent/simplex_mesh.h>
#include <pent/simulator/ranks.h>

#include <array>
#include <cstdint>
#include <functional>
#include <span>
#include <string>
#include <vector>

namespace pent::simulator {

/// Quadratic simplices: nodes in the order of kQuadraticNodes, one simplex a column.
template <int Dim>
using QuadraticSimplices = Eigen::Matrix<std::uint32_t, kQuadraticNodes<Dim>, Eigen::Dynamic>;

/// The quadratic simplices of all bodies.
template <int Dim>
struct QuadraticCells {
    QuadraticSimplices<Dim> nodes;
    std::vector<CellRange> ranges;       ///< As of Bodies.
    std::vector<std::uint32_t> parents;  ///< One a cell of Bodies: which of them it is a child of.
};

/// Corners of the linear simplex that a quadratic one deforms as, see QuadraticRule.
///
/// @param places       Of its nodes.
/// @param coordinates  Barycentric, of the point.
template <int Dim>
[[nodiscard]] Eigen::Matrix<double, Dim, Dim + 1> tangent_corners(
    const Eigen::Matrix<double, Dim, kQuadraticNodes<Dim>>& places,
    const Eigen::Matrix<double, Dim + 1, 1>& coordinates);

/// The places of its nodes.
template <int Dim>
[[nodiscard]] Eigen::Matrix<double, Dim, kQuadraticNodes<Dim>> places_of_nodes(
    const Positions<Dim>& positions,
    const QuadraticSimplices<Dim>& simplices,
    Eigen::Index simplex);

/// A quadratic simplex at rest as kernels take it: ElementRun::rest but for the volume.
template <int Dim>
struct QuadraticRest {
    std::array<double, kQuadraticRestRows<Dim> - 1> rows{};
    double volume = 0;  ///< m^Dim.
};

/// @param places  Of its nodes at rest, m.
template <int Dim>
[[nodiscard]] QuadraticRest<Dim> quadratic_rest(
    const Eigen::Matrix<double, Dim, kQuadraticNodes<Dim>>& places);

/// How the cells of a mesh are those of one rank (the NeededCells) of a whole mesh. As it stands,
/// of a mesh that is here as a whole.
struct CellsOfRank {
    const Ranks* ranks = nullptr;
    Eigen::Index count = 0;                       ///< Cells of the whole.
    std::span<const std::uint32_t> numbers = {};  ///< Of these cells in the whole.
    std::function<bool(std::uint32_t)> owns;      ///< Whether a vertex is at home on this rank.

    [[nodiscard]] std::uint32_t number(Eigen::Index cell) const {
        return ranks != nullptr ? numbers[static_cast<std::size_t>(cell)]
                                : static_cast<std::uint32_t>(cell);
    }
};

/// The cells of a mesh by the quadratic simplices that they are the children of, 2^Dim each: by
/// their parents, or, where it has none, every 2^Dim cells that follow one another, as subdivision
/// leaves them.
///
/// @param name   Of the mesh, for messages.
/// @param whole  All ranks ask together.
/// Throws an Error unless each has as many: on all ranks that of the whole.
template <int Dim>
[[nodiscard]] std::vector<Eigen::Index> child_cells(const SimplexMesh<Dim>& mesh,
                                                    const std::string& name,
                                                    const CellsOfRank& whole = {});

/// The quadratic simplices that the cells of a mesh are the children of.
///
/// Children are known by what they share: a corner belongs to one of them, and the middle of an
/// edge is the vertex that the children at its two ends have in common. A middle need not be
/// halfway, but the Jacobian must be positive at all nodes and points.
///
/// @param cells  By their parents, as child_cells() has them.
/// @param name   Of the mesh, for messages.
/// @param whole  All ranks ask together.
/// Throws an Error if the cells are no such children: on all ranks that of the whole.
template <int Dim>
[[nodiscard]] QuadraticSimplices<Dim> quadratic_simplices(const SimplexMesh<Dim>& mesh,
                                                          const std::vector<Eigen::Index>& cells,
                                                          const std::string& name,
                                                          const CellsOfRank& whole = {});

template <int Dim>
[[nodiscard]] QuadraticSimplices<Dim> quadratic_simplices(const SimplexMesh<Dim>& mesh,
                                                          const std::string& name) {
    return quadratic_simplices<Dim>(mesh, child_cells<Dim>(mesh, name), name);
}

}  // namespace pent::simulator
