#include "step/balance.h"
#include "step/stepper.h"

#include <pent/dimensions.h>
#include <pent/geometry.h>
#include <pent/simulator/energy.h>

#include <Eigen/LU>

namespace pent::simulator {

namespace {

// The mean over the cells at each vertex, weighted by their volumes at rest. A rank has all cells
// at its own vertices, and tells the others of these.
template <int Dim>
Eigen::RowVectorXd energy_densities(const Bodies<Dim>& bodies,
                                    const ActiveStrain<Dim>& strain,
                                    std::size_t body,
                                    const Positions<Dim>& x) {
    const auto vertices = bodies.vertices(body);
    Eigen::RowVectorXd energy = Eigen::RowVectorXd::Zero(vertices.size);
    Eigen::RowVectorXd volume = Eigen::RowVectorXd::Zero(vertices.size);
    for (const CellRange& range : bodies.ranges) {
        for (Eigen::Index cell = range.begin; range.body == body && cell < range.end; ++cell) {
            const Eigen::Matrix<double, Dim, Dim> rest =
                edge_matrix<Dim>(bodies.rest(), bodies.cells(), cell);
            const Eigen::Matrix<double, Dim, Dim> F =
                edge_matrix<Dim>(x, bodies.cells(), cell) * rest.inverse();
            const double weight = rest.determinant();
            const auto* shape = strain.of_cell(cell);
            const double density =
                shape == nullptr
                    ? energy_density(range.material, F)
                    : shape->growth * energy_density(range.material, F * shape->inverse);
            for (int a = 0; a <= Dim; ++a) {
                const Eigen::Index vertex = bodies.cells()(a, cell) - vertices.begin;
                energy[vertex] += weight * density;
                volume[vertex] += weight;
            }
        }
    }
    Eigen::Matrix<double, 1, Eigen::Dynamic> all = Eigen::RowVectorXd::Zero(bodies.vertex_count());
    all.middleCols(vertices.begin, vertices.size) =
        energy.cwiseQuotient(volume);  // every vertex belongs to a cell
    bodies.sharing.gather(all);
    return all.middleCols(vertices.begin, vertices.size);
}

}  // namespace

template <int Dim>
Eigen::MatrixXd Simulation<Dim>::vertex_values(VertexQuantity quantity, int body) const {
    const auto place = static_cast<std::size_t>(body);
    const auto range = stepper_->bodies().vertices(place);
    switch (quantity) {
        case VertexQuantity::ContactForce:
            return contact_forces(body);
        case VertexQuantity::Reaction:
            return reactions(stepper_->held(), stepper_->forces())
                .middleCols(range.begin, range.size);
        case VertexQuantity::EnergyDensity:
            break;
    }
    return energy_densities(stepper_->bodies(), stepper_->strain(), place,
                            stepper_->current().positions);
}

#define PENT_INSTANTIATE(Dim) \
    template Eigen::MatrixXd Simulation<Dim>::vertex_values(VertexQuantity, int) const;
PENT_FOR_EACH_DIMENSION(PENT_INSTANTIATE)
#undef PENT_INSTANTIATE

}  // namespace pent::simulator
