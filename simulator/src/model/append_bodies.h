#pragma once

#include "model/bodies.h"

#include <cstdint>
#include <vector>

namespace pent::simulator {

/// The quadratic cells that the cells of a mesh, or of a part of one, are the children of.
template <int Dim>
struct MadeQuadratic {
    QuadraticSimplices<Dim> nodes;  ///< Of the mesh.
    std::vector<std::uint32_t>
        parents;                ///< One a cell of the mesh: which of them it is a child of.
    SimplexMesh<Dim> straight;  ///< As if edges were straight, with labels.
    std::vector<std::uint32_t> numbers;  ///< Of each the first child, which stands for it, in the
                                         ///< whole mesh.
};

/// @param mesh   As placed.
/// @param whole  All ranks ask together.
/// Throws an Error unless its cells make up such: on all ranks that of the whole mesh.
template <int Dim>
[[nodiscard]] MadeQuadratic<Dim> make_quadratic(const SimplexMesh<Dim>& mesh,
                                                const Body& body,
                                                const CellsOfRank& whole = {});

/// Appends the cells of a body, and its quadratic cells, those of one material after those of
/// another. There is room for them.
///
/// @param place      Of the body in the scene.
/// @param mesh       As placed, or a part of it.
/// @param quadratic  Null for other elements.
/// @param materials  One an element, see materials_of_cells().
/// @return           The order in which the cells of the mesh are now.
template <int Dim>
std::vector<Eigen::Index> append_cells(const Body& body,
                                       std::size_t place,
                                       const SimplexMesh<Dim>& mesh,
                                       const MadeQuadratic<Dim>* quadratic,
                                       const std::vector<std::uint16_t>& materials,
                                       Bodies<Dim>& bodies);

/// Puts the vertices of the placed meshes one after the other, if there is not one mesh alone.
template <int Dim>
void join_rest(Bodies<Dim>& bodies);

/// Places the meshes of `bodies` and puts their vertices, cells and quadratic cells one after the
/// other, those of a body by their materials.
template <int Dim>
void append_bodies(const Scene& scene, Bodies<Dim>& bodies);

}  // namespace pent::simulator
