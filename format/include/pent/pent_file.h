#pragma once

#include <pent/simplex_mesh.h>
#include <pent/slab_writers.h>

#include <cstdint>
#include <filesystem>
#include <set>
#include <string>
#include <string_view>
#include <vector>

namespace pent {

/// `.pent` files: a fixed profile of PLY, specified in docs/pent-format.md.

enum class Encoding { Binary, Ascii };

struct WriteOptions {
    Encoding encoding = Encoding::Binary;
    std::string created_by = "pent";       ///< Program and version; one line.
    const SlabWriters* writers = nullptr;  ///< Of frames alone: see write_frame().
};

/// What the header of a .pent file says.
struct FileInfo {
    int dimension = 0;  ///< 2, 3 or 4.
    Encoding encoding = Encoding::Binary;
    std::string created_by;
    std::uint32_t crc32c = 0;  ///< Over every byte behind the header, as stated there.
    std::uint64_t vertices = 0;
    std::uint64_t cells = 0;    ///< 0 in a frame.
    bool is_frame = false;      ///< Positions (and velocities) without cells.
    bool is_extrusion = false;  ///< Base and layers (see extrusion.h); dimension, vertices and
                                ///< cells are those of the mesh that read_mesh() makes of them.
};

/// A further quantity of the vertices of a frame or a mesh, or of the cells of a mesh. Its name has
/// letters, digits and '_'; a file has a property of that name for a number, or, with _x, _y, _z
/// and _w behind it, one for each component of a vector. Within an element these differ from one
/// another and from those reserved, and numbers that follow one another are not named like the
/// components of a vector, as which they would be read.
struct VertexField {
    std::string name;
    Eigen::MatrixXd values;  ///< A column each, of one number or of one an axis.

    bool operator==(const VertexField& other) const {
        return name == other.name && values.rows() == other.values.rows()
               && values.cols() == other.values.cols() && values == other.values;
    }
};

/// Positions, velocities and whatever else frames have of a body at one moment; the cells are those
/// of its mesh.
template <int Dim>
struct Frame {
    Positions<Dim> positions;         ///< Dim x vertices, m.
    Positions<Dim> velocities;        ///< Dim x vertices, m/s; or Dim x 0 where the file has none.
    Positions<Dim> contact_forces;    ///< Dim x vertices, N; or Dim x 0 where the file has none.
    std::vector<VertexField> fields;  ///< Others, in the order of the file.
    std::string mesh_name;            ///< File name of the mesh, without folders or spaces.
    std::uint32_t mesh_crc = 0;       ///< crc32c of that mesh file.
    std::uint64_t frame = 0;          ///< Number of the frame, from 0.
    std::uint64_t step = 0;           ///< Time steps taken so far.
    double time = 0;                  ///< s.
};

/// The field of a frame with a name; null if there is none.
template <int Dim>
[[nodiscard]] const VertexField* find_field(const Frame<Dim>& frame, std::string_view name) {
    for (const VertexField& field : frame.fields) {
        if (field.name == name) {
            return &field;
        }
    }
    return nullptr;
}

/// Names of properties with a meaning of their own, which no quantity of the vertices or cells of a
/// mesh has; frames have those of vertices but for "column" and "layer".
[[nodiscard]] std::set<std::string> reserved_vertex_names(int dimension);
[[nodiscard]] std::set<std::string> reserved_cell_names(int dimension);

/// What the boundary of a body that was extruded or swept along its last axis is made of.
enum class BoundaryLabel : std::uint16_t {
    Bottom = 1,
    Lateral = 2,
    Top = 3,
    InterfaceBelow = 4,  ///< The top of the slab below is the same, in a file of its own.
    InterfaceAbove = 5,  ///< The bottom of the slab above is.
};

/// What a file may say of a mesh beside the mesh itself.
template <int Dim>
struct MeshExtras {
    std::vector<VertexField> vertex_fields;    ///< A column a vertex.
    std::vector<VertexField> cell_fields;      ///< A column a cell.
    Simplices<Dim> boundary;                   ///< Facets that have labels, outward.
    std::vector<std::uint16_t> labels;         ///< Theirs: a BoundaryLabel, or free to use.
    std::vector<std::uint16_t> base_labels;    ///< What the base mesh has there, 0 if nothing.
    std::vector<std::uint8_t> bisection_tags;  ///< One a cell, or empty; see docs/pent-format.md.
};

template <int Dim>
struct MeshFile {
    SimplexMesh<Dim> mesh;
    FileInfo info;
    MeshExtras<Dim> extras;
};

/// Reads the header alone; of an extrusion the layers, too. Throws an Error for a file that is
/// missing or has a damaged header.
[[nodiscard]] FileInfo read_info(const std::filesystem::path& path);

/// Writes a mesh under a temporary name beside `path`, then renames it.
///
/// The mesh must pass validate(), which is called first. Throws an Error that names the path when
/// the file cannot be written (no folder, no right, disk full), and for quantities that would not
/// be read as what they are (see VertexField); nothing is left behind then.
/// @return  The checksum in the header.
template <int Dim>
std::uint32_t write_mesh(const std::filesystem::path& path,
                         const SimplexMesh<Dim>& mesh,
                         const WriteOptions& options = {},
                         const MeshExtras<Dim>& extras = {});

/// Reads and fully validates a mesh; extrudes it where the file has base and layers. Nothing is
/// allocated from a count that the file's size does not bear out. Throws an Error with file,
/// element, what was found and what was expected.
template <int Dim>
[[nodiscard]] MeshFile<Dim> read_mesh(const std::filesystem::path& path);

/// Writes a frame, as write_mesh does. Throws an Error if a coordinate is not finite, too.
///
/// Where several processes write it each gives the vertices of its slab, in the order of the
/// writers, and all else alike. The file is that which one of them alone would write of all.
template <int Dim>
void write_frame(const std::filesystem::path& path,
                 const Frame<Dim>& frame,
                 const WriteOptions& options = {});

/// Reads and validates a frame, as read_mesh does.
template <int Dim>
[[nodiscard]] Frame<Dim> read_frame(const std::filesystem::path& path);

/// The name of a body's frame in the folder of a run: "octopus_000042.pent".
[[nodiscard]] std::string frame_file_name(const std::string& body, int frame);

}  // namespace pent
