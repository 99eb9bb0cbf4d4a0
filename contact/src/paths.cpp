#include "paths.h"

#include <pent/dimensions.h>

#include <algorithm>
#include <cassert>
#include <cmath>

namespace pent::contact {

template <int Dim>
Vector<Dim> mean_shift(const Simplices<1>& vertices,
                       const PositionsView<Dim>& a,
                       const PositionsView<Dim>& b) {
    Vector<Dim> sum = Vector<Dim>::Zero();
    for (const std::uint32_t v : vertices.reshaped()) {
        sum += b.col(v) - a.col(v);
    }
    return sum / std::max<double>(1, static_cast<double>(vertices.cols()));
}

template <int Dim>
double longest_path(const Simplices<1>& vertices,
                    const PositionsView<Dim>& from,
                    const PositionsView<Dim>& to) {
    const Vector<Dim> drift = mean_shift<Dim>(vertices, from, to);
    double squared = 0;
    for (const std::uint32_t v : vertices.reshaped()) {
        squared = std::max(squared, (to.col(v) - from.col(v) - drift).squaredNorm());
    }
    return std::sqrt(squared);
}

template <int Dim>
void set_inflation(const Simplices<1>& vertices,
                   const Paths<Dim>& paths,
                   double least,
                   double of_path,
                   Eigen::VectorXd& inflation) {
    assert(inflation.size() == paths.to.cols());
    for (const std::uint32_t v : vertices.reshaped()) {
        const double length = (paths.to.col(v) - paths.from.col(v) - paths.drift).norm();
        inflation[v] = std::max(least, of_path * length);
    }
}

#define PENT_INSTANTIATE(Dim)                                                           \
    template Vector<Dim> mean_shift(const Simplices<1>&, const PositionsView<Dim>&,     \
                                    const PositionsView<Dim>&);                         \
    template double longest_path(const Simplices<1>&, const PositionsView<Dim>&,        \
                                 const PositionsView<Dim>&);                            \
    template void set_inflation(const Simplices<1>&, const Paths<Dim>&, double, double, \
                                Eigen::VectorXd&);
PENT_FOR_EACH_DIMENSION(PENT_INSTANTIATE)
#undef PENT_INSTANTIATE

}  // namespace pent::contact
