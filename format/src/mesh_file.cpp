#include "body.h"
#include "extrusion_file.h"
#include "input_file.h"
#include "mesh_columns.h"

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
constexpr const char* kTag = "bisection_tag";
constexpr const char* kBaseLabel = "base_label";
constexpr const char* kBoundary = "boundary";
const std::vector<std::string_view> kCellVectors = {"fiber_"};

void append_fields(const std::vector<VertexField>& fields, std::vector<Column>& columns) {
    for (const VertexField& field : fields) {
        const std::vector<Column> more = field_columns(field);
        columns.insert(columns.end(), more.begin(), more.end());
    }
}

template <int Dim>
std::vector<Column> vertex_columns(const SimplexMesh<Dim>& mesh, const MeshExtras<Dim>& extras) {
    std::vector<Column> columns = vertex_columns(mesh);
    append_fields(extras.vertex_fields, columns);
    return columns;
}

template <int Dim>
std::vector<Column> cell_columns(const SimplexMesh<Dim>& mesh, const MeshExtras<Dim>& extras) {
    std::vector<Column> columns = cell_columns(mesh);
    if (!extras.bisection_tags.empty()) {
        columns.push_back(array_column(kTag, PlyType::Uchar, extras.bisection_tags));
    }
    append_fields(extras.cell_fields, columns);
    return columns;
}

template <int Dim>
std::vector<Column> boundary_columns(const MeshExtras<Dim>& extras) {
    std::vector<Column> columns;
    for (int k = 0; k < Dim; ++k) {
        columns.push_back(row_column("v" + std::to_string(k), PlyType::Uint, extras.boundary, k));
    }
    columns.push_back(array_column("label", PlyType::Ushort, extras.labels));
    if (!extras.base_labels.empty()) {
        columns.push_back(array_column(kBaseLabel, PlyType::Ushort, extras.base_labels));
    }
    return columns;
}

// Counts, indices and numbers of what is beside the mesh.
template <int Dim>
void check_extras(const SimplexMesh<Dim>& mesh,
                  const MeshExtras<Dim>& extras,
                  const std::filesystem::path& path) {
    check_fields(extras.vertex_fields, Dim, mesh.vertex_count(), "vertex", path);
    check_fields(extras.cell_fields, Dim, mesh.cell_count(), cell_name(Dim), path);
    const auto require = [&](std::size_t found, Eigen::Index expected, const std::string& what) {
        if (std::cmp_not_equal(found, expected)) {
            throw Error(path.string() + ": " + std::to_string(found) + " " + what + ", expected "
                        + std::to_string(expected));
        }
    };
    require(extras.labels.size(), extras.boundary.cols(), "labels of the boundary");
    if (!extras.base_labels.empty()) {
        require(extras.base_labels.size(), extras.boundary.cols(), "base labels of the boundary");
    }
    if (!extras.bisection_tags.empty()) {
        require(extras.bisection_tags.size(), mesh.cell_count(), "bisection tags");
    }
    for (Eigen::Index facet = 0; facet < extras.boundary.cols(); ++facet) {
        for (int k = 0; k < Dim; ++k) {
            if (std::cmp_greater_equal(extras.boundary(k, facet), mesh.vertex_count())) {
                throw Error(path.string() + ": boundary " + std::to_string(facet) + ": vertex "
                            + std::to_string(extras.boundary(k, facet)) + " of "
                            + std::to_string(mesh.vertex_count()));
            }
        }
    }
}

// Names of quantities, which the header of a file has.
template <int Dim>
void check_names(const MeshExtras<Dim>& extras, const std::filesystem::path& path) {
    check_names(extras.vertex_fields, Dim, reserved_vertex_names(Dim), "vertex", path);
    check_names(extras.cell_fields, Dim, reserved_cell_names(Dim), cell_name(Dim), path);
}

// The labeled facets of a file, if it has an element with what they need.
const PlyElement* boundary_of(const Header& header) {
    if (header.elements.size() < 3 || header.elements[2].name != kBoundary) {
        return nullptr;
    }
    const std::vector<PlyProperty>& properties = header.elements[2].properties;
    const bool has_lists =
        std::any_of(properties.begin(), properties.end(),
                    [](const PlyProperty& p) { return p.count_type.has_value(); });
    return has_lists ? nullptr : &header.elements[2];
}

template <int Dim>
MeshExtras<Dim> sized_extras(const Header& header, const std::filesystem::path& path) {
    MeshExtras<Dim> extras;
    extras.vertex_fields = fields_of(header.elements[0], Dim, kVertexVectors);
    extras.cell_fields = fields_of(header.elements[1], Dim, kCellVectors);
    if (has_property(header.elements[1], kTag, PlyType::Uchar, path)) {
        extras.bisection_tags.resize(header.elements[1].count);
    }
    const PlyElement* boundary = boundary_of(header);
    if (boundary == nullptr) {
        return extras;
    }
    for (const Column& column : boundary_columns(extras)) {
        if (!has_property(*boundary, column.name, column.type, path)) {
            throw Error(path.string() + ": header: element boundary has no " + column.name
                        + ", expected v0 to v" + std::to_string(Dim - 1) + " and label");
        }
    }
    extras.boundary.resize(Dim, static_cast<Eigen::Index>(boundary->count));
    extras.labels.resize(boundary->count);
    if (has_property(*boundary, kBaseLabel, PlyType::Ushort, path)) {
        extras.base_labels.resize(boundary->count);
    }
    return extras;
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
    names.insert({"region", kParent, kTag});
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
    check_extras(mesh, extras, name);
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
    check_extras(mesh, extras, path);
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
