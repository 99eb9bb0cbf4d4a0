#include "extras_columns.h"

#include <pent/error.h>

#include <algorithm>
#include <utility>

namespace pent {

namespace {

constexpr const char* kBaseLabel = "base_label";

void append(std::vector<Column>& columns, const std::vector<Column>& more) {
    columns.insert(columns.end(), more.begin(), more.end());
}

void append_fields(const std::vector<VertexField>& fields, std::vector<Column>& columns) {
    for (const VertexField& field : fields) {
        append(columns, field_columns(field));
    }
}

}  // namespace

template <int Dim>
std::vector<Column> vertex_columns(const MeshExtras<Dim>& extras) {
    std::vector<Column> columns;
    append_fields(extras.vertex_fields, columns);
    return columns;
}

template <int Dim>
std::vector<Column> vertex_columns(const SimplexMesh<Dim>& mesh, const MeshExtras<Dim>& extras) {
    std::vector<Column> columns = vertex_columns(mesh);
    append(columns, vertex_columns(extras));
    return columns;
}

template <int Dim>
std::vector<Column> cell_columns(const MeshExtras<Dim>& extras) {
    std::vector<Column> columns;
    if (!extras.bisection_tags.empty()) {
        columns.push_back(array_column(kBisectionTag, PlyType::Uchar, extras.bisection_tags));
    }
    append_fields(extras.cell_fields, columns);
    return columns;
}

template <int Dim>
std::vector<Column> cell_columns(const SimplexMesh<Dim>& mesh, const MeshExtras<Dim>& extras) {
    std::vector<Column> columns = cell_columns(mesh);
    append(columns, cell_columns(extras));
    return columns;
}

template <int Dim>
std::vector<Column> boundary_columns(const MeshExtras<Dim>& extras) {
    std::vector<Column> columns;
    columns.reserve(Dim + 2);
    for (int k = 0; k < Dim; ++k) {
        columns.push_back(row_column("v" + std::to_string(k), PlyType::Uint, extras.boundary, k));
    }
    columns.push_back(array_column("label", PlyType::Ushort, extras.labels));
    if (!extras.base_labels.empty()) {
        columns.push_back(array_column(kBaseLabel, PlyType::Ushort, extras.base_labels));
    }
    return columns;
}

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
    if (has_property(header.elements[1], kBisectionTag, PlyType::Uchar, path)) {
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

template <int Dim>
void check_extras(const MeshExtras<Dim>& extras,
                  const MeshSlab& slab,
                  Eigen::Index vertices,
                  const std::filesystem::path& path) {
    const Eigen::Index cells = slab.last_cell - slab.first_cell;
    check_fields(extras.vertex_fields, Dim, slab.last_vertex - slab.first_vertex, "vertex", path,
                 static_cast<std::uint64_t>(slab.first_vertex));
    check_fields(extras.cell_fields, Dim, cells, cell_name(Dim), path,
                 static_cast<std::uint64_t>(slab.first_cell));
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
        require(extras.bisection_tags.size(), cells, "bisection tags");
    }
    for (Eigen::Index facet = 0; facet < extras.boundary.cols(); ++facet) {
        for (int k = 0; k < Dim; ++k) {
            if (std::cmp_greater_equal(extras.boundary(k, facet), vertices)) {
                throw Error(path.string() + ": boundary " + std::to_string(facet) + ": vertex "
                            + std::to_string(extras.boundary(k, facet)) + " of "
                            + std::to_string(vertices));
            }
        }
    }
}

#define PENT_INSTANTIATE(Dim)                                                                \
    template std::vector<Column> vertex_columns<Dim>(const MeshExtras<Dim>&);                \
    template std::vector<Column> vertex_columns<Dim>(const SimplexMesh<Dim>&,                \
                                                     const MeshExtras<Dim>&);                \
    template std::vector<Column> cell_columns<Dim>(const MeshExtras<Dim>&);                  \
    template std::vector<Column> cell_columns<Dim>(const SimplexMesh<Dim>&,                  \
                                                   const MeshExtras<Dim>&);                  \
    template std::vector<Column> boundary_columns<Dim>(const MeshExtras<Dim>&);              \
    template MeshExtras<Dim> sized_extras<Dim>(const Header&, const std::filesystem::path&); \
    template void check_extras<Dim>(const MeshExtras<Dim>&, const MeshSlab&, Eigen::Index,   \
                                    const std::filesystem::path&);
PENT_INSTANTIATE(2)
PENT_INSTANTIATE(3)
PENT_INSTANTIATE(4)
#undef PENT_INSTANTIATE

}  // namespace pent
