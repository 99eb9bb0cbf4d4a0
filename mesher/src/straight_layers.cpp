#include "layer_places.h"

#include <pent/mesher/edge_order.h>
#include <pent/mesher/straight_layers.h>

#include <algorithm>
#include <cassert>
#include <cmath>

namespace pent::mesher {

template <int Dim>
std::vector<Layer<Dim>> straight_layers(const Eigen::Matrix<double, Dim, 1>& direction,
                                        int slabs,
                                        Anchor anchor) {
    assert(slabs >= 1);
    return straight_layers<Dim>(direction, even_places(slabs, anchor == Anchor::Middle ? 0.5 : 0));
}

template <int Dim>
std::vector<Layer<Dim>> straight_layers(const Eigen::Matrix<double, Dim, 1>& direction,
                                        const std::vector<double>& places) {
    std::vector<Layer<Dim>> layers(places.size());
    for (std::size_t l = 0; l < places.size(); ++l) {
        layers[l].linear.setIdentity();
        layers[l].offset = places[l] * direction;
    }
    return layers;
}

int automatic_slabs(double height, double mean_edge) {
    constexpr double kMaxLayers = 1e6;
    return static_cast<int>(std::clamp(std::round(height / (0.7 * mean_edge)), 1.0, kMaxLayers));
}

template <int Dim>
double mean_edge(const SimplexMesh<Dim>& mesh) {
    const DirectedEdges edges = edges_of<Dim>(mesh.cells);
    double sum = 0;
    for (const auto& edge : edges.colwise()) {
        sum += (mesh.positions.col(edge[1]) - mesh.positions.col(edge[0])).norm();
    }
    return sum / static_cast<double>(edges.cols());
}

#define PENT_INSTANTIATE(Dim)                                                                   \
    template std::vector<Layer<Dim>> straight_layers<Dim>(const Eigen::Matrix<double, Dim, 1>&, \
                                                          int, Anchor);                         \
    template std::vector<Layer<Dim>> straight_layers<Dim>(const Eigen::Matrix<double, Dim, 1>&, \
                                                          const std::vector<double>&);          \
    template double mean_edge<Dim - 1>(const SimplexMesh<Dim - 1>&);

PENT_INSTANTIATE(2)
PENT_INSTANTIATE(3)
PENT_INSTANTIATE(4)

#undef PENT_INSTANTIATE

}  // namespace pent::mesher
