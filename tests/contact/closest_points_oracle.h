#pragma once

#include "closest_point_search.h"

#include <Eigen/QR>

#include <bit>
#include <limits>

namespace pent::contact::test {

/// Closest points of two simplices, however far they are apart.
template <int Dim, int K, int L>
[[nodiscard]] ClosestPoints<Dim, K, L> closest_points(const Corners<Dim, K>& first,
                                                      const Corners<Dim, L>& second) {
    ClosestPointSearch<Dim, K, L> search(first, second, std::numeric_limits<double>::infinity());
    search.run();
    return search.best();
}

/// Distance of two simplices by enumeration: the least of the free minima over the affine hulls of
/// all pairs of faces that have no negative weight, in long double by a rank-revealing QR. Pairs of
/// faces with dependent edges are left out, since the same minimum is on one of their facets.
template <int Dim, int K, int L>
[[nodiscard]] double brute_force_distance(const Corners<Dim, K>& first,
                                          const Corners<Dim, L>& second) {
    using Real = long double;
    using Matrix = Eigen::Matrix<Real, Dim, Eigen::Dynamic>;
    Real best = std::numeric_limits<Real>::infinity();
    for (unsigned a = 1; a < (1U << K); ++a) {
        for (unsigned b = 1; b < (1U << L); ++b) {
            const int a0 = std::countr_zero(a);
            const int b0 = std::countr_zero(b);
            Matrix edges(Dim, std::popcount(a) + std::popcount(b) - 2);
            int count = 0;
            for (int i = a0 + 1; i < K; ++i) {
                if ((a >> i & 1U) != 0) {
                    edges.col(count++) =
                        first.col(i).template cast<Real>() - first.col(a0).template cast<Real>();
                }
            }
            const int in_first = count;
            for (int j = b0 + 1; j < L; ++j) {
                if ((b >> j & 1U) != 0) {
                    edges.col(count++) =
                        second.col(b0).template cast<Real>() - second.col(j).template cast<Real>();
                }
            }
            Eigen::Matrix<Real, Dim, 1> difference =
                first.col(a0).template cast<Real>() - second.col(b0).template cast<Real>();
            if (count > 0) {
                Eigen::ColPivHouseholderQR<Matrix> factors(edges);
                factors.setThreshold(1e-17L);
                if (factors.rank() < count) {
                    continue;
                }
                const Eigen::Matrix<Real, Eigen::Dynamic, 1> t = factors.solve(-difference);
                if (t.minCoeff() < 0 || t.head(in_first).sum() > 1
                    || t.tail(count - in_first).sum() > 1) {
                    continue;
                }
                difference += edges * t;
            }
            best = std::min(best, difference.norm());
        }
    }
    return static_cast<double>(best);
}

}  // namespace pent::contact::test
