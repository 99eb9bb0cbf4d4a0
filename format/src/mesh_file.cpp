#include "body.h"
#include "input_file.h"

#include <pent/error.h>
#include <pent/pent_file.h>

#include <utility>

namespace pent {

namespace {

template <typename Value>
Column array_column(std::string name, PlyType type, const std::vector<Value>& values) {
    auto* data = const_cast<Value*>(values.data());  // as in row_column
    return {std::move(name), type, reinterpret_cast<char*>(data), sizeof(Value)};
}

template <int Dim>
std::vector<Column> vertex_columns(const SimplexMesh<Dim>& mesh) {
    std::vector<Column> columns = vector_columns<Dim>(mesh.positions, "");
    if (!mesh.columns.empty()) {
        columns.push_back(array_column("column", PlyType::Uint, mesh.columns));
    }
    if (!mesh.layers.empty()) {
        columns.push_back(array_column("layer", PlyType::Uint, mesh.layers));
    }
    return columns;
}

template <int Dim>
std::vector<Column> cell_columns(const SimplexMesh<Dim>& mesh) {
    std::vector<Column> columns;
    for (int k = 0; k <= Dim; ++k) {
        columns.push_back(row_column("v" + std::to_string(k), PlyType::Uint, mesh.cells, k));
    }
    if (!mesh.regions.empty()) {
        columns.push_back(array_column("region", PlyType::Ushort, mesh.regions));
    }
    if (!mesh.parents.empty()) {
        columns.push_back(array_column("parent", PlyType::Uint, mesh.parents));
    }
    if (mesh.fibers.cols() > 0) {
        const std::vector<Column> fibers = vector_columns<Dim>(mesh.fibers, "fiber_");
        columns.insert(columns.end(), fibers.begin(), fibers.end());
    }
    return columns;
}

}  // namespace

FileInfo read_info(const std::filesystem::path& path) {
    constexpr std::size_t kLongestHeader = std::size_t{1} << 20;
    const InputFile file = read_input(path, kLongestHeader);
    return parse_header(file.view(), path).info;
}

template <int Dim>
std::uint32_t write_mesh(const std::filesystem::path& path,
                         const SimplexMesh<Dim>& mesh,
                         const WriteOptions& options) {
    validate(mesh, path.string());
    const std::vector<Column> vertices = vertex_columns(mesh);
    const std::vector<Column> cells = cell_columns(mesh);
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
    return write_file(path, std::move(header), body);
}

template <int Dim>
MeshFile<Dim> read_mesh(const std::filesystem::path& path) {
    const InputFile file = read_input(path);
    const Header header = parse_header(file.view(), path);
    if (header.info.dimension != Dim) {
        throw Error(path.string() + ": header: dimension " + std::to_string(header.info.dimension)
                    + ", expected " + std::to_string(Dim));
    }
    if (header.info.is_frame) {
        throw Error(path.string() + ": header: this is a frame of the mesh " + header.mesh_name
                    + ", expected a mesh");
    }
    BodyReader reader(header, file.view(), path);
    const PlyElement& vertex = header.elements[0];
    const PlyElement& cell = header.elements[1];
    SimplexMesh<Dim> mesh;
    mesh.positions.resize(Dim, static_cast<Eigen::Index>(vertex.count));
    mesh.cells.resize(Dim + 1, static_cast<Eigen::Index>(cell.count));
    if (has_property(vertex, "column", PlyType::Uint, path)) {
        mesh.columns.resize(vertex.count);
    }
    if (has_property(vertex, "layer", PlyType::Uint, path)) {
        mesh.layers.resize(vertex.count);
    }
    if (has_property(cell, "region", PlyType::Ushort, path)) {
        mesh.regions.resize(cell.count);
    }
    if (has_property(cell, "parent", PlyType::Uint, path)) {
        mesh.parents.resize(cell.count);
    }
    if (has_vector(cell, Dim, "fiber_", "fiber", path)) {
        mesh.fibers.resize(Dim, static_cast<Eigen::Index>(cell.count));
    }
    reader.read(vertex_columns(mesh));
    reader.read(cell_columns(mesh));
    reader.finish();
    validate(mesh, path.string());
    return {std::move(mesh), header.info};
}

#define PENT_INSTANTIATE(Dim)                                                                     \
    template std::uint32_t write_mesh<Dim>(const std::filesystem::path&, const SimplexMesh<Dim>&, \
                                           const WriteOptions&);                                  \
    template MeshFile<Dim> read_mesh<Dim>(const std::filesystem::path&);
PENT_INSTANTIATE(2)
PENT_INSTANTIATE(3)
PENT_INSTANTIATE(4)
#undef PENT_INSTANTIATE

}  // namespace pent
