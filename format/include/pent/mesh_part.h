#pragma once

#include <pent/pent_file.h>
#include <pent/simplex_mesh.h>
#include <pent/slab_writers.h>

#include <cstdint>
#include <filesystem>
#include <memory>
#include <span>
#include <string_view>
#include <vector>

namespace pent {

/// Some cells of a mesh, with all of its vertices.
template <int Dim>
struct MeshPart {
    SimplexMesh<Dim> mesh;               ///< The cells in the order of the whole mesh.
    std::vector<std::uint32_t> numbers;  ///< Which of its cells they are, increasing.
    Eigen::Index cell_count = 0;         ///< Of the whole mesh.
};

/// Of several meshes.
template <int Dim>
using MeshParts = std::vector<MeshPart<Dim>>;

/// validate() of a mesh of which only some cells are here, or none.
///
/// @param numbers  Which cells of the whole they are, for messages; empty if the first ones.
template <int Dim>
void validate_part(const SimplexMesh<Dim>& mesh,
                   std::string_view name,
                   std::span<const std::uint32_t> numbers);

/// The rows of a mesh that one of several processes reads or writes: vertices, and behind them
/// cells, as a file has them.
struct MeshSlab {
    Eigen::Index first_vertex = 0;
    Eigen::Index last_vertex = 0;  ///< Behind the last one.
    Eigen::Index first_cell = 0;
    Eigen::Index last_cell = 0;
};

/// @param place  Below `count`.
[[nodiscard]] MeshSlab slab_of(Eigen::Index vertices, Eigen::Index cells, int place, int count);

/// The rows of a slab of a mesh that is here as a whole.
template <int Dim>
[[nodiscard]] SimplexMesh<Dim> rows_of(const SimplexMesh<Dim>& mesh, const MeshSlab& slab);

/// Writes a mesh together with other processes: each gives the rows of its slab, in the order of
/// the writers. The file is the one that write_mesh() writes of the whole. What is written has been
/// validated: it is not again.
///
/// @param slab    As rows_of() has it.
/// @param extras  What is beside these rows, as read_extras() has it, with the names of all
///                quantities.
/// @return        The checksum in the header, of the whole.
template <int Dim>
std::uint32_t write_mesh_slab(const std::filesystem::path& path,
                              const SimplexMesh<Dim>& slab,
                              const MeshExtras<Dim>& extras,
                              const WriteOptions& options);

/// The checksum that write_mesh_slab() would put into the header of a mesh without extras.
///
/// @param writers  Null for one alone, whose slab is the mesh.
template <int Dim>
[[nodiscard]] std::uint32_t checksum_of_mesh(const SimplexMesh<Dim>& slab,
                                             const SlabWriters* writers);

/// Checks that the data of a .pent file has the checksum in its header; each process reads a slab
/// of the bytes. Throws an Error on all of them where it is not.
///
/// @param readers  Null for one alone.
void check_checksum(const std::filesystem::path& path, const SlabWriters* readers);

/// A mesh in a file, of which no more is in memory than is asked for, and base and layers where the
/// file has these.
template <int Dim>
class MeshSource {
public:
    /// Reads the header, and goes through text for where its lines begin. Throws an Error as
    /// read_mesh() does.
    ///
    /// @param parts  In how many parts the cells will be asked for, one at a time: cells of an
    /// extrusion
    ///               have to fit the machine's memory.
    MeshSource(const std::filesystem::path& path, int parts);
    ~MeshSource();
    MeshSource(const MeshSource&) = delete;
    MeshSource& operator=(const MeshSource&) = delete;
    MeshSource(MeshSource&&) noexcept;
    MeshSource& operator=(MeshSource&&) noexcept;

    [[nodiscard]] const FileInfo& info() const;

    /// The mesh without its cells. Coordinates are not checked yet.
    [[nodiscard]] SimplexMesh<Dim> vertices() const;

    /// Cells [first, last) without vertices, not checked.
    [[nodiscard]] SimplexMesh<Dim> cells(Eigen::Index first, Eigen::Index last) const;

    /// Whether it has base and layers, so that whoever needs cells makes them.
    [[nodiscard]] bool is_extrusion() const;

    /// Those of an extrusion that are over a base cell with a vertex that is wanted.
    ///
    /// @param is_wanted  One entry a vertex of the base.
    /// @return           Without vertices, not checked.
    [[nodiscard]] MeshPart<Dim> cells_over(const std::vector<bool>& is_wanted) const;

private:
    struct Content;
    std::unique_ptr<Content> content_;
};

}  // namespace pent
