#include "simplex_crossing.h"

#include <pent/dimensions.h>

#include <Eigen/LU>

#include <cmath>
#include <limits>

namespace pent::contact {

namespace {

using Real = long double;

// Sign of a determinant, 0 where rounding may have decided it. The columns are differences of
// doubles, so their own rounding is within the bound too.
template <int Dim>
int sign_of(const Eigen::Matrix<Real, Dim, Dim>& columns) {
    constexpr Real kErrors = 64;
    Real size = 1;
    for (int i = 0; i < Dim; ++i) {
        size *= columns.col(i).norm();
    }
    const Real det = columns.determinant();
    if (std::abs(det) <= kErrors * std::numeric_limits<Real>::epsilon() * size) {
        return 0;
    }
    return det > 0 ? 1 : -1;
}

// Sign of the coefficient of point i in the affine dependency of Dim + 2 points.
template <int Dim>
int dependency_sign(const Eigen::Matrix<Real, Dim, Dim + 2>& points, int i) {
    const int origin = i == 0 ? 1 : 0;
    Eigen::Matrix<Real, Dim, Dim> columns;
    int count = 0;
    for (int k = 0; k < Dim + 2; ++k) {
        if (k != i && k != origin) {
            columns.col(count++) = points.col(k) - points.col(origin);
        }
    }
    return (i % 2 == 0 ? 1 : -1) * sign_of<Dim>(columns);
}

}  // namespace

template <int Dim, int K, int L>
bool is_crossing(const Corners<Dim, K>& first, const Corners<Dim, L>& second) {
    static_assert(K + L == Dim + 2);
    Eigen::Matrix<Real, Dim, Dim + 2> points;
    points << first.template cast<Real>(), second.template cast<Real>();
    const int side = dependency_sign<Dim>(points, 0);
    for (int i = 1; i < K; ++i) {
        if (side == 0 || dependency_sign<Dim>(points, i) != side) {
            return false;
        }
    }
    for (int j = K; j < K + L; ++j) {
        if (dependency_sign<Dim>(points, j) != -side) {
            return false;
        }
    }
    return true;
}

#define PENT_INSTANTIATE(Dim) \
    template bool is_crossing<Dim, 2, Dim>(const Corners<Dim, 2>&, const Corners<Dim, Dim>&);
PENT_FOR_EACH_DIMENSION(PENT_INSTANTIATE)
#undef PENT_INSTANTIATE
template bool is_crossing<4, 3, 3>(const Corners<4, 3>&, const Corners<4, 3>&);

}  // namespace pent::contact
