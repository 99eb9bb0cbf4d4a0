#include "mesh_columns.h"

namespace pent {

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
        columns.push_back(array_column(kParent, PlyType::Uint, mesh.parents));
    }
    if (mesh.fibers.cols() > 0) {
        const std::vector<Column> fibers = vector_columns<Dim>(mesh.fibers, "fiber_");
        columns.insert(columns.end(), fibers.begin(), fibers.end());
    }
    return columns;
}

template <int Dim>
void size_vertices(const PlyElement& vertex,
                   const std::filesystem::path& path,
                   SimplexMesh<Dim>& mesh) {
    mesh.positions.resize(Dim, static_cast<Eigen::Index>(vertex.count));
    if (has_property(vertex, "column", PlyType::Uint, path)) {
        mesh.columns.resize(vertex.count);
    }
    if (has_property(vertex, "layer", PlyType::Uint, path)) {
        mesh.layers.resize(vertex.count);
    }
}

template <int Dim>
void size_cells(const PlyElement& cell, const std::filesystem::path& path, SimplexMesh<Dim>& mesh) {
    mesh.cells.resize(Dim + 1, static_cast<Eigen::Index>(cell.count));
    if (has_property(cell, "region", PlyType::Ushort, path)) {
        mesh.regions.resize(cell.count);
    }
    if (has_property(cell, kParent, PlyType::Uint, path)) {
        mesh.parents.resize(cell.count);
    }
    if (has_vector(cell, Dim, "fiber_", "fiber", path)) {
        mesh.fibers.resize(Dim, static_cast<Eigen::Index>(cell.count));
    }
}

#define PENT_INSTANTIATE(Dim)                                                         \
    template std::vector<Column> vertex_columns<Dim>(const SimplexMesh<Dim>&);        \
    template std::vector<Column> cell_columns<Dim>(const SimplexMesh<Dim>&);          \
    template void size_vertices<Dim>(const PlyElement&, const std::filesystem::path&, \
                                     SimplexMesh<Dim>&);                              \
    template void size_cells<Dim>(const PlyElement&, const std::filesystem::path&,    \
                                  SimplexMesh<Dim>&);
PENT_INSTANTIATE(2)
PENT_INSTANTIATE(3)
PENT_INSTANTIATE(4)
#undef PENT_INSTANTIATE

}  // namespace pent
