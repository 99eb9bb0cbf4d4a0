#include "pent/mesh_extras.h"

#include "element_rows.h"
#include "extras_columns.h"
#include "extrusion_file.h"
#include "input_file.h"

#include <pent/error.h>

#include <utility>

namespace pent {

namespace {

// Whether the slab, which may end with the last cell, is one of a mesh with so many rows.
template <int Dim>
bool is_slab_of(const Header& header, const MeshSlab& slab) {
    return !header.info.is_frame && header.info.dimension == Dim
           && std::cmp_less_equal(slab.last_vertex, header.info.vertices)
           && std::cmp_less_equal(slab.last_cell, header.info.cells);
}

Eigen::MatrixXd cut(const Eigen::MatrixXd& values, Eigen::Index first, Eigen::Index last) {
    return values.middleCols(first, last - first);
}

// Where a row begins is not known in text, so all are read.
template <int Dim>
MeshExtras<Dim> read_text_extras(const std::filesystem::path& path,
                                 const Header& header,
                                 const MeshSlab& slab) {
    MeshExtras<Dim> extras = sized_extras<Dim>(header, path);
    const bool has_boundary = boundary_of(header) != nullptr;
    if (!has_boundary && vertex_columns(extras).empty() && cell_columns(extras).empty()) {
        return extras;
    }
    const InputFile file = read_input(path);
    BodyReader reader(header, file.view(), path);
    reader.read(vertex_columns(extras));
    reader.read(cell_columns(extras));
    if (has_boundary) {
        reader.read(boundary_columns(extras));
    }
    for (VertexField& field : extras.vertex_fields) {
        field.values = cut(field.values, slab.first_vertex, slab.last_vertex);
    }
    for (VertexField& field : extras.cell_fields) {
        field.values = cut(field.values, slab.first_cell, slab.last_cell);
    }
    if (!extras.bisection_tags.empty()) {
        const auto tags = extras.bisection_tags.begin();
        extras.bisection_tags =
            std::vector<std::uint8_t>(tags + slab.first_cell, tags + slab.last_cell);
    }
    if (std::cmp_less(slab.last_cell, header.info.cells)) {
        extras.boundary.resize(Dim, 0);
        extras.labels.clear();
        extras.base_labels.clear();
    }
    return extras;
}

template <int Dim>
MeshExtras<Dim> read_binary_extras(const std::filesystem::path& path,
                                   const Header& header,
                                   const MeshSlab& slab) {
    // The file with these rows alone.
    Header own = header;
    own.elements[0].count = static_cast<std::uint64_t>(slab.last_vertex - slab.first_vertex);
    own.elements[1].count = static_cast<std::uint64_t>(slab.last_cell - slab.first_cell);
    if (boundary_of(own) != nullptr && std::cmp_less(slab.last_cell, header.info.cells)) {
        own.elements[2].count = 0;
    }
    MeshExtras<Dim> extras = sized_extras<Dim>(own, path);
    std::uint64_t begin = header.body;
    const auto read = [&](std::size_t element, Eigen::Index first,
                          const std::vector<Column>& columns) {
        const PlyElement& rows = own.elements[element];
        const std::uint64_t each = row_bytes(rows);
        const auto in_front = static_cast<std::uint64_t>(first);
        if (rows.count > 0 && !columns.empty()) {
            read_rows(path, Encoding::Binary,
                      {.first = begin + in_front * each,
                       .last = begin + (in_front + rows.count) * each,
                       .in_front = in_front},
                      rows, columns);
        }
        begin += header.elements[element].count * each;
    };
    read(0, slab.first_vertex, vertex_columns(extras));
    read(1, slab.first_cell, cell_columns(extras));
    if (boundary_of(own) != nullptr) {
        read(2, 0, boundary_columns(extras));
    }
    return extras;
}

}  // namespace

template <int Dim>
MeshExtras<Dim> read_extras(const std::filesystem::path& path, const MeshSlab& slab) {
    const Header header = read_header(path);
    if (is_extrusion(header)) {
        return {};
    }
    if (!is_slab_of<Dim>(header, slab)) {
        throw Error(path.string() + ": became another mesh while it was read");
    }
    check_counts(header, std::filesystem::file_size(path) - header.body, path);
    return header.info.encoding == Encoding::Ascii ? read_text_extras<Dim>(path, header, slab)
                                                   : read_binary_extras<Dim>(path, header, slab);
}

template <int Dim>
void validate_extras(const MeshExtras<Dim>& extras,
                     const MeshSlab& slab,
                     Eigen::Index vertices,
                     std::string_view name) {
    check_extras(extras, slab, vertices, name);
}

#define PENT_INSTANTIATE(Dim)                                                                 \
    template MeshExtras<Dim> read_extras<Dim>(const std::filesystem::path&, const MeshSlab&); \
    template void validate_extras<Dim>(const MeshExtras<Dim>&, const MeshSlab&, Eigen::Index, \
                                       std::string_view);
PENT_INSTANTIATE(3)
PENT_INSTANTIATE(4)
#undef PENT_INSTANTIATE

}  // namespace pent
