#pragma once

#include "document.h"

#include <pent/simplex_mesh.h>

#include <array>
#include <filesystem>
#include <string>

namespace pent::scene_fuzz {

/// A small mesh, which its name says all of: "box-2x1x1-0.6x0.3x0.3.pent". Its box has its center
/// at the origin, and may be cut and marked:
///
///     box        cubes, each cut into Dim! simplices
///     layered    the same with columns and layers, as an extruded mesh has along its last axis
///     regions    the same with a region for each slab of cubes along x
///     fork       a box without the middle of its upper half along x: two prongs, for self-contact
///     simplex    one cell
///     pieces     two boxes side by side that share nothing, in one body
///
/// Of any kind there is one for quadratic elements, with every edge cut in two:
/// "quadratic-box-2x1x1-0.6x0.3x0.3.pent".
struct MeshName {
    std::string kind = "box";
    std::array<int, 4> count = {1, 1, 1, 1};  ///< Cubes along each axis.
    std::array<double, 4> size = {};          ///< Of the box around it, m.
    int dimension = 3;
    bool is_quadratic = false;
};

[[nodiscard]] std::string text_of(const MeshName& name);

/// Throws pent::Error unless the text is a name of such a mesh.
[[nodiscard]] MeshName parse_mesh_name(const std::string& text);

template <int Dim>
[[nodiscard]] SimplexMesh<Dim> make_mesh(const MeshName& name);

/// Writes into `folder` every mesh that the bodies of a scene name and that is not there yet.
void write_meshes(const Json& scene, const std::filesystem::path& folder);

}  // namespace pent::scene_fuzz
