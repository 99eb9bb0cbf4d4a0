#include "extrude_fields.h"

namespace pent::mesher {

namespace {

template <int Dim>
using Linear = Eigen::Matrix<double, Dim, Dim - 1>;

// Numbers stay as they are, vectors go the way of a layer.
template <int Dim>
Eigen::VectorXd carried(const Eigen::VectorXd& value, const Linear<Dim>& linear) {
    return value.size() == 1 ? value : Eigen::VectorXd(linear * value);
}

template <int Dim>
Eigen::Index rows_over(const Eigen::MatrixXd& values) {
    return values.rows() == 1 ? 1 : Dim;
}

template <int Dim>
Eigen::MatrixXd over_vertices(const Eigen::MatrixXd& values,
                              const std::vector<Layer<Dim>>& layers,
                              const SimplexMesh<Dim>& mesh) {
    Eigen::MatrixXd result(rows_over<Dim>(values), mesh.vertex_count());
    const Eigen::VectorXd mean = values.rowwise().mean();
    for (Eigen::Index v = 0; v < mesh.vertex_count(); ++v) {
        const Eigen::Index column = mesh.columns[v];
        const bool is_end = column >= values.cols();  // a point, which has a column of its own
        result.col(v) = carried<Dim>(is_end ? mean : Eigen::VectorXd(values.col(column)),
                                     layers[mesh.layers[v]].linear);
    }
    return result;
}

// Over each cell of the base those of all layers follow one another, each between two of them.
template <int Dim>
Eigen::MatrixXd over_cells(const Eigen::MatrixXd& values,
                           const std::vector<Layer<Dim>>& layers,
                           const SimplexMesh<Dim>& mesh) {
    const Eigen::Index per_base = cells_of_column<Dim>(layers);
    Eigen::MatrixXd result(rows_over<Dim>(values), mesh.cell_count());
    for (Eigen::Index cell = 0; cell < mesh.cell_count(); ++cell) {
        const std::uint32_t below = mesh.layers[mesh.cells(0, cell)];  // extrude() has it first
        const Linear<Dim> linear = (layers[below].linear + layers[below + 1].linear) / 2;
        result.col(cell) = carried<Dim>(values.col(cell / per_base), linear);
    }
    return result;
}

}  // namespace

template <int Dim>
MeshExtras<Dim> extrude_fields(const SimplexMesh<Dim - 1>& base,
                               const MeshExtras<Dim - 1>& fields,
                               const std::vector<Layer<Dim>>& layers,
                               SimplexMesh<Dim>& mesh) {
    MeshExtras<Dim> extruded;
    for (const VertexField& field : fields.vertex_fields) {
        extruded.vertex_fields.push_back(
            {field.name, over_vertices<Dim>(field.values, layers, mesh)});
    }
    for (const VertexField& field : fields.cell_fields) {
        extruded.cell_fields.push_back({field.name, over_cells<Dim>(field.values, layers, mesh)});
    }
    if (base.fibers.size() > 0) {
        mesh.fibers = over_cells<Dim>(base.fibers, layers, mesh);
    }
    return extruded;
}

template MeshExtras<3> extrude_fields<3>(const SimplexMesh<2>&,
                                         const MeshExtras<2>&,
                                         const std::vector<Layer<3>>&,
                                         SimplexMesh<3>&);
template MeshExtras<4> extrude_fields<4>(const SimplexMesh<3>&,
                                         const MeshExtras<3>&,
                                         const std::vector<Layer<4>>&,
                                         SimplexMesh<4>&);

}  // namespace pent::mesher
