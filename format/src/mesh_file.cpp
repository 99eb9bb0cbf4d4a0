#include "extras_columns.h"
#include "extrusion_file.h"
#include "input_file.h"

#include <pent/cell_parents.h>
#include <pent/error.h>
#include <pent/pent_file.h>
#include <pent/validate_extras.h>

#include <algorithm>
#include <set>
#include <utility>

namespace pent {

namespace {

constexpr std::size_t kLongestHeader = std::size_t{1} << 20;
template <int Dim>
MeshSlab whole_slab(const SimplexMesh<Dim>& mesh) {
    return {.last_vertex = mesh.vertex_count(), .last_cell = mesh.cell_count()};
}

// Names of quantities, which the header of a file has.
template <int Dim>
void check_names(const MeshExtras<Dim>& extras, const std::filesystem::path& path) {
    check_names(extras.vertex_fields, Dim, reserved_vertex_names(Dim), "vertex", path);
    check_names(extras.cell_fields, Dim, reserved_cell_names(Dim), cell_name(Dim), path);
}

}  // namespace

std::set<std::string> reserved_vertex_names(int dimension) {
    std::set<std::string> names = axis_names(dimension, kVertexVectors);
    names.insert({"column", "layer"});
    return names;
}

std::set<std::string> reserved_cell_names(int dimension) {
    std::set<std::string> names = axis_names(dimension, kCellVectors);
    for (int corner = 0; corner <= dimension; ++corner) {
        names.insert("v" + std::to_string(corner));
    }
    names.insert({"region", kParent, kBisectionTag});
    return names;
}

FileInfo read_info(const std::filesystem::path& path) {
    const InputFile file = read_input(path, kLongestHeader);
    const Header header = parse_header(file.view(), path);
    return is_extrusion(header) ? info_of_extrusion(header, read_input(path).view(), path)
                                : header.info;
}

bool has_parents(const std::filesystem::path& path) {
    const InputFile file = read_input(path, kLongestHeader);
    const Header header = parse_header(file.view(), path);
    return !header.info.is_frame && !is_extrusion(header)
           && has_property(header.elements[1], kParent, PlyType::Uint, path);
}

template <int Dim>
void validate_extras(const SimplexMesh<Dim>& mesh,
                     const MeshExtras<Dim>& extras,
                     std::string_view name) {
    check_extras(extras, whole_slab(mesh), mesh.vertex_count(), name);
    check_names(extras, name);
}

template <int Dim>
std::uint32_t write_mesh(const std::filesystem::path& path,
                         const SimplexMesh<Dim>& mesh,
                         const WriteOptions& options,
                         const MeshExtras<Dim>& extras) {
    validate(mesh, path.string());
    validate_extras(mesh, extras, path.string());
    const std::vector<Column> vertices = vertex_columns(mesh, extras);
    const std::vector<Column> cells = cell_columns(mesh, extras);
    const auto vertex_count = static_cast<std::uint64_t>(mesh.vertex_count());
    const auto cell_count = static_cast<std::uint64_t>(mesh.cell_count());
    Header header;
    header.info.dimension = Dim;
    header.info.encoding = options.encoding;
    header.info.created_by = options.created_by;
    header.elements = {make_element("vertex", vertex_count, vertices),
                       make_element(cell_name(Dim), cell_count, cells)};
    std::string body;
    encode_rows(body, options.encoding, vertices, vertex_count);
    encode_rows(body, options.encoding, cells, cell_count);
    if (extras.boundary.cols() > 0) {
        const std::vector<Column> facets = boundary_columns(extras);
        const auto facet_count = static_cast<std::uint64_t>(extras.boundary.cols());
        header.elements.push_back(make_element(kBoundary, facet_count, facets));
        encode_rows(body, options.encoding, facets, facet_count);
    }
    return write_file(path, std::move(header), body);
}

template <int Dim>
MeshFile<Dim> read_mesh(const std::filesystem::path& path) {
    const InputFile file = read_input(path);
    const Header header = parse_header(file.view(), path);
    const int dimension = header.info.dimension + (is_extrusion(header) ? 1 : 0);
    if (dimension != Dim) {
        throw Error(path.string() + ": header: dimension " + std::to_string(dimension)
                    + ", expected " + std::to_string(Dim));
    }
    if constexpr (Dim > 2) {
        if (is_extrusion(header)) {
            return extrude_file<Dim>(header, file.view(), path);
        }
    }
    refuse_frame(header, path);
    BodyReader reader(header, file.view(), path);
    const PlyElement& vertex = header.elements[0];
    const PlyElement& cell = header.elements[1];
    SimplexMesh<Dim> mesh;
    size_vertices(vertex, path, mesh);
    size_cells(cell, path, mesh);
    MeshExtras<Dim> extras = sized_extras<Dim>(header, path);
    reader.read(vertex_columns(mesh, extras));
    reader.read(cell_columns(mesh, extras));
    if (boundary_of(header) != nullptr) {
        reader.read(boundary_columns(extras));
    }
    reader.finish();
    validate(mesh, path.string());
    check_extras(extras, whole_slab(mesh), mesh.vertex_count(), path);
    return {std::move(mesh), header.info, std::move(extras)};
}

#define PENT_INSTANTIATE(Dim)                                                                     \
    template void validate_extras<Dim>(const SimplexMesh<Dim>&, const MeshExtras<Dim>&,           \
                                       std::string_view);                                         \
    template std::uint32_t write_mesh<Dim>(const std::filesystem::path&, const SimplexMesh<Dim>&, \
                                           const WriteOptions&, const MeshExtras<Dim>&);          \
    template MeshFile<Dim> read_mesh<Dim>(const std::filesystem::path&);
PENT_INSTANTIATE(2)
PENT_INSTANTIATE(3)
PENT_INSTANTIATE(4)
#undef PENT_INSTANTIATE

}  // namespace pent
