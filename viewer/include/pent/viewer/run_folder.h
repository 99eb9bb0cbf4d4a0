#pragma once

#include <pent/obstacle.h>
#include <pent/pent_file.h>
#include <pent/simplex_mesh.h>
#include <pent/viewer/boundary.h>

#include <cstdint>
#include <filesystem>
#include <string>
#include <vector>

namespace pent::viewer {

/// What there is to look at: a run folder of the simulator, or one mesh as a run of one frame.
struct RunFolder {
    std::filesystem::path path;       ///< The folder, or the mesh file.
    bool is_mesh = false;             ///< Whether it is one mesh: frame 0 is the mesh itself.
    int dimension = 4;                ///< 3 or 4, the same for all bodies.
    std::vector<std::string> bodies;  ///< Names, in ascending order: meshes/NAME.pent.
    std::vector<int> frames;          ///< Numbers of the frames every body has, ascending:
                                      ///< frames/NAME_000123.pent. At least one.
};

/// A body at rest with all that is made of it once.
template <int Dim>
struct Body {
    std::string name;
    SimplexMesh<Dim> mesh;
    std::uint32_t mesh_crc = 0;  ///< Stated in the mesh file's header.
    Boundary<Dim> boundary;
    /// Quantities of the mesh at its vertices: its own, and those of cells under other names as the
    /// mean over the cells at a vertex by their volume.
    std::vector<VertexField> fields = {};
};

/// Looks what is in a run folder, or at a mesh file.
///
/// Throws an Error if there is nothing of the kind, a body has no frames, or dimensions differ.
[[nodiscard]] RunFolder open_run(const std::filesystem::path& path);

/// Reads all bodies, in the order of run.bodies. Throws an Error as read_mesh and make_boundary do.
template <int Dim>
[[nodiscard]] std::vector<Body<Dim>> load_bodies(const RunFolder& run);

/// Reads one frame of a body. Throws an Error as read_frame does, and if it was made from another
/// mesh than the body's.
template <int Dim>
[[nodiscard]] Frame<Dim> load_frame(const RunFolder& run, const Body<Dim>& body, int frame);

/// The obstacles of a run at a frame, in the order of its scene; none where the run says nothing of
/// any.
/// Throws an Error as read_obstacles does.
template <int Dim>
[[nodiscard]] std::vector<ObstacleShape<Dim>> load_obstacles(const RunFolder& run, int frame);

/// The numbers a user asked for, out of those there are.
///
/// @param text  "A:B" or "A:B:STEP" from A to B with B included, each part optional; single
///              numbers; "last"; or several of these with commas between. Empty for all.
/// @return      Ascending, none twice. Throws an Error if nothing is left or the text is not
///              understood.
[[nodiscard]] std::vector<int> select_frames(const std::vector<int>& frames,
                                             const std::string& text);

}  // namespace pent::viewer
