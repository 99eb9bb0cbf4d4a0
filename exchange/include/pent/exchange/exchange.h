#pragma once

#include <pent/exchange/tet_surface.h>
#include <pent/pent_file.h>
#include <pent/simplex_mesh.h>

#include <filesystem>
#include <span>
#include <string>
#include <string_view>
#include <variant>
#include <vector>

namespace pent::exchange {

/// A body with what a .pent file says of it beside the mesh. Of these extras other formats hold
/// nothing, but for MFEM: labels of the boundary from 1 to 65535, if not all are 1.
struct Body {
    SimplexMesh<4> mesh;
    MeshExtras<4> extras = {};
};

/// What a file of four dimensions holds: the boundary of a body, or a body.
using Content = std::variant<TetSurface, Body>;

/// Where all points are at another time.
struct FramePoints {
    std::string name;  ///< Of no other frame.
    Positions<4> points;
};

struct WriteOptions {
    std::string created_by = "pentimento";
    bool in_double = false;  ///< Coordinates of G4MF: many programs read float alone.
    /// Labels of the boundary of MFEM meshes: those of the body, or, where it has none and was
    /// extruded, 1 bottom, 2 lateral, 3 top; or as MFEM numbers those of its own, behind the labels
    /// of the cells.
    bool has_mfem_attributes = false;
    /// Each becomes a blend shape of G4MF, the one format that has any: the displacements from the
    /// points that are written to where those of the content are in the frame.
    std::vector<FramePoints> frames = {};
};

/// A file format. Orientation is ours whichever the file's is.
struct Format {
    std::string_view name;
    std::span<const std::string_view> endings;  ///< ".g4tf" and so on, in small letters.
    bool has_cells = false;                     ///< Holds bodies, else boundaries.
    bool has_frames = false;                    ///< Holds places of the points at other times.
    Content (*read)(const std::filesystem::path& path);  ///< Null for one that is only written.
    void (*write)(const std::filesystem::path& path,
                  const Content& content,
                  const WriteOptions& options);
    bool has_extras = false;  ///< Holds all that a .pent file says of a body.
};

/// All formats: .pent, 4OFF, G4MF, 4DO, tesserxel's OBJ, MFEM, and views as legacy VTK and Gmsh.
[[nodiscard]] std::span<const Format> formats();

/// The format that the ending of a name stands for. Throws an Error that lists all for others.
[[nodiscard]] const Format& format_of(const std::filesystem::path& path);

/// What a body has that a file of a format does not hold, as in "regions, fibers, heat": of its
/// cells, of its boundary, and quantities by their names. Empty if nothing.
[[nodiscard]] std::string left_out(const Body& body, const Format& format);

struct ReadOptions {
    /// Merges points at the same place, see weld(), if the boundary is not closed without that. If
    /// false all points and tetrahedra stay those of the file.
    bool is_welded = true;
};

/// Reads a boundary, oriented outward if it is closed, or a body.
///
/// Throws an Error that names the file and the place for what cannot be read, is not finite, has
/// indices out of range or ends too soon; nothing is allocated from a count that the file does not
/// bear out.
[[nodiscard]] Content read(const std::filesystem::path& path, const ReadOptions& options = {});

/// Writes a boundary or a body, whole or not at all: what the format holds of it, the boundary of a
/// body or the cone_of() a boundary. Throws an Error for frames of another number of points or of
/// one name, and in formats that have none.
void write(const std::filesystem::path& path,
           const Content& content,
           const WriteOptions& options = {});

}  // namespace pent::exchange
