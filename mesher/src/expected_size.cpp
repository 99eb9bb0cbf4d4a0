#include "body_steps.h"

#include <cmath>

namespace pent::mesher {

int parts_of_edge(const BodyRequest& request) {
    return request.subdivide * (request.is_quadratic ? 2 : 1);
}

template <int Dim>
ExpectedSize expected_size(double base_cells,
                           double cells_over,
                           int slabs,
                           const BodyRequest& request) {
    constexpr double kSeconds = 0.4e-6;  // to extrude, prove and measure a cell on one core
    ExpectedSize size;
    size.base_cells = base_cells;
    size.layers = slabs;
    size.cells = base_cells * cells_over * std::pow(parts_of_edge(request), Dim);
    size.seconds = kSeconds * size.cells;
    return size;
}

template ExpectedSize expected_size<3>(double, double, int, const BodyRequest&);
template ExpectedSize expected_size<4>(double, double, int, const BodyRequest&);

void announce(const BodyRequest& request, const ExpectedSize& size) {
    if (request.on_size) {
        request.on_size(size);
    }
}

}  // namespace pent::mesher
