#pragma once

#include <pent/pent_file.h>
#include <pent/simplex_mesh.h>

#include <cstdint>
#include <filesystem>
#include <string>

namespace pent::mesher {

/// Whether the name ends like that of a file with tetrahedra, or the format, as in "msh", is one of
/// theirs.
[[nodiscard]] bool is_tetrahedra_file(const std::filesystem::path& path,
                                      const std::string& format = {});

/// Whether it is one of VTK, whose cells have arrays by name, of which one has their labels.
[[nodiscard]] bool has_region_arrays(const std::filesystem::path& path,
                                     const std::string& format = {});

/// A tet mesh as a file has it, and what was done to read it.
struct TetrahedraFile {
    SimplexMesh<3> mesh;   ///< Positively oriented; regions where the file has labels, fibers
                           ///< where it has them.
    MeshExtras<3> extras;  ///< Of VTK, Gmsh and TetGen: quantities of vertices and cells, of one
                           ///< or three numbers.
    std::string region_array;        ///< Of VTK: which array the regions are from; empty: none.
    std::int64_t turned_cells = 0;   ///< Cells that were negative in the file.
    std::int64_t unused_points = 0;  ///< Points without a tetrahedron, left out.
    std::string cut;  ///< Other cells and what they became, as in "2 hexahedra into 12 tetrahedra".
    std::string left_out;  ///< Cells of fewer dimensions, as in "12 triangles, 3 lines", and arrays
                           ///< that are no quantities of a body.
    std::int64_t curved_cells = 0;  ///< Cells of higher order, of which the corners are taken.
};

/// Reads a tet mesh: TetGen .node or .ele (either name; both files), Medit .mesh, HOBAK .tobj as
/// text, Gmsh .msh 2.0 to 2.2 and 4.1 and legacy VTK .vtk as text or binary.
///
/// All but TetGen's are read from standard input, too, by the path "-".
/// Quantities of TetGen, which have no names there, are called `attribute1` and so on and
/// `boundary_marker`, of cells `region_attribute2` and so on, as the first is the region.
/// Pyramids, prisms and hexahedra are cut into tetrahedra such that neighbors agree; other cells of
/// three dimensions are refused. Throws an Error that names file and line for what is damaged, and
/// one for a mesh that does not pass validate(). Allocates no more than the size of the file bears
/// out.
///
/// @param region_array  Of a file of VTK, the array of the cells that has their labels, and an
///                      Error if there is none of whole numbers from 0 to 65535; empty: the first
///                      with a usual name, as "region" or "material", in whatever case. Without
///                      meaning for others.
[[nodiscard]] TetrahedraFile read_tetrahedra(const std::filesystem::path& path,
                                             const std::string& format = {},
                                             const std::string& region_array = {});

}  // namespace pent::mesher
