#pragma once

#include "model/rotation.h"

#include <pent/simplex_mesh.h>
#include <pent/simulator/scene.h>

#include <cstdint>
#include <functional>
#include <limits>
#include <string>
#include <vector>

namespace pent::simulator {

// The parts of select_vertices() and select_cells(): for parts of meshes, of which one may have
// nothing selected where another has something.

/// Whether any of these selects by a region's label.
[[nodiscard]] bool selects_by_region(const std::vector<Selection>& select);

/// One entry a vertex: whether it is selected. A label selects the vertices of the cells that are
/// here.
///
/// @param where  Who selects, for messages. Throws an Error if it asks for layers that the mesh
///               does not know.
template <int Dim>
[[nodiscard]] std::vector<bool> mark_vertices(const SimplexMesh<Dim>& mesh,
                                              const std::vector<Selection>& select,
                                              const std::string& where);

/// The same of cells, as select_cells() selects them.
template <int Dim>
[[nodiscard]] std::vector<bool> mark_cells(const SimplexMesh<Dim>& mesh,
                                           const std::vector<Selection>& select,
                                           const std::string& where);

/// The number of the material of every cell, see materials_of_cells().
///
/// @param mark  Which cells a region has, one entry a cell.
[[nodiscard]] std::vector<std::uint16_t> materials_by_regions(
    std::size_t cells,
    const Body& body,
    const std::function<std::vector<bool>(const Region&)>& mark);

/// The middles of cells: the mean of their corners.
template <int Dim>
[[nodiscard]] Positions<Dim> centers(const SimplexMesh<Dim>& mesh);

/// What a selection of nothing came nearest to.
template <int Dim>
struct NearMiss {
    double distance = std::numeric_limits<double>::infinity();  ///< From the place, m.
    double number = 0;                                          ///< What that point is called.
    Vector<Dim> point = Vector<Dim>::Zero();
    double least_label = std::numeric_limits<double>::infinity();  ///< Of regions.
    double most_label = -std::numeric_limits<double>::infinity();
};

/// @param points   Vertices, or middles of cells; the first of equally near ones counts.
/// @param numbers  What each is called; empty if as they come.
template <int Dim>
[[nodiscard]] NearMiss<Dim> near_miss(const SimplexMesh<Dim>& mesh,
                                      const Positions<Dim>& points,
                                      const std::vector<std::uint32_t>& numbers,
                                      const Selection& selection);

/// Throws an Error: "WHERE selects no WHAT: the nearest one is ...".
template <int Dim>
[[noreturn]] void refuse_none(const SimplexMesh<Dim>& mesh,
                              const std::string& what,
                              const NearMiss<Dim>& miss,
                              const std::vector<Selection>& select,
                              const std::string& where);

}  // namespace pent::simulator
