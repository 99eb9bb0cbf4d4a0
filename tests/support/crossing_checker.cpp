#include "support/crossing_checker.h"

#include <pent/dimensions.h>

#include <Eigen/LU>
#include <Eigen/QR>

#include <algorithm>
#include <bit>
#include <cmath>
#include <limits>

namespace pent::test {

namespace {

template <int Dim, int Count>
RealCorners<Dim, Count> real_corners(const Simplices<Count>& simplices,
                                     Eigen::Index i,
                                     const Positions<Dim>& positions) {
    RealCorners<Dim, Count> corners;
    for (int k = 0; k < Count; ++k) {
        corners.col(k) = positions.col(simplices(k, i)).template cast<Real>();
    }
    return corners;
}

// Least distance of two simplices over all pairs of their faces.
template <int Dim, int K, int L>
Real least_distance(const RealCorners<Dim, K>& a, const RealCorners<Dim, L>& b) {
    using Edges = Eigen::Matrix<Real, Dim, Eigen::Dynamic>;
    Real best = std::numeric_limits<Real>::infinity();
    for (unsigned m = 1; m < (1U << K); ++m) {
        for (unsigned n = 1; n < (1U << L); ++n) {
            const int i0 = std::countr_zero(m);
            const int j0 = std::countr_zero(n);
            Edges edges(Dim, std::popcount(m) + std::popcount(n) - 2);
            int count = 0;
            for (int i = i0 + 1; i < K; ++i) {
                if ((m >> i & 1U) != 0) {
                    edges.col(count++) = a.col(i) - a.col(i0);
                }
            }
            const int of_first = count;
            for (int j = j0 + 1; j < L; ++j) {
                if ((n >> j & 1U) != 0) {
                    edges.col(count++) = b.col(j0) - b.col(j);
                }
            }
            Eigen::Matrix<Real, Dim, 1> difference = a.col(i0) - b.col(j0);
            if (count > 0) {
                const Eigen::ColPivHouseholderQR<Edges> factors(edges);
                if (factors.rank() < count) {
                    continue;
                }
                const Eigen::Matrix<Real, Eigen::Dynamic, 1> t = factors.solve(-difference);
                if (t.minCoeff() < 0 || t.head(of_first).sum() > 1
                    || t.tail(count - of_first).sum() > 1) {
                    continue;
                }
                difference += edges * t;
            }
            best = std::min(best, difference.norm());
        }
    }
    return best;
}

// See do_meet().
template <int Dim, int K, int L>
class SweptPair {
public:
    SweptPair(const RealCorners<Dim, K>& a0,
              const RealCorners<Dim, K>& a1,
              const RealCorners<Dim, L>& b0,
              const RealCorners<Dim, L>& b1)
        : a0_(a0), a1_(a1), b0_(b0), b1_(b1) {}

    [[nodiscard]] bool do_meet() const {
        static const Square kToBernstein = bernstein().fullPivLu().inverse();  // of all pairs
        Coefficients values;
        for (int k = 0; k <= Dim; ++k) {
            values[k] = volume(static_cast<Real>(k) / Dim);
        }
        return has_meeting_root(kToBernstein * values, 0, 1);
    }

private:
    using Coefficients = Eigen::Matrix<Real, Dim + 1, 1>;
    using Square = Eigen::Matrix<Real, Dim + 1, Dim + 1>;

    // Of each time a row: what the Bernstein polynomials are there.
    [[nodiscard]] static Square bernstein() {
        Square at;
        for (int k = 0; k <= Dim; ++k) {
            const Real t = static_cast<Real>(k) / Dim;
            Real binomial = 1;
            for (int i = 0; i <= Dim; ++i) {
                at(k, i) = binomial * std::pow(t, i) * std::pow(1 - t, Dim - i);
                binomial = binomial * (Dim - i) / (i + 1);
            }
        }
        return at;
    }

    [[nodiscard]] RealCorners<Dim, K> a(Real t) const { return (1 - t) * a0_ + t * a1_; }
    [[nodiscard]] RealCorners<Dim, L> b(Real t) const { return (1 - t) * b0_ + t * b1_; }

    [[nodiscard]] Real volume(Real t) const {
        Eigen::Matrix<Real, Dim, Dim> edges;
        const RealCorners<Dim, K> first = a(t);
        const RealCorners<Dim, L> second = b(t);
        for (int i = 1; i < K; ++i) {
            edges.col(i - 1) = first.col(i) - first.col(0);
        }
        for (int j = 0; j < L; ++j) {
            edges.col(K - 1 + j) = second.col(j) - first.col(0);
        }
        return edges.determinant();
    }

    // A polynomial without a change of sign in its Bernstein coefficients has no root between.
    [[nodiscard]] bool has_meeting_root(const Coefficients& c, Real begin, Real end) const {
        constexpr Real kShort = 1e-7L;
        constexpr Real kMeeting =
            1e-11L;  // m; how near two simplices are that meet at a time within
                     // kShort of this is checked at both ends
        if (c.minCoeff() > 0 || c.maxCoeff() < 0) {
            return false;
        }
        const Real middle = (begin + end) / 2;
        const Real distance = least_distance<Dim, K, L>(a(middle), b(middle));
        const Real travel = (end - begin) / 2 * speed();
        if (distance > travel) {
            return false;  // they cannot meet in this time
        }
        if (end - begin < kShort) {
            return distance < std::max(kMeeting, 2 * travel);
        }
        Coefficients left;
        Coefficients right = c;
        for (int k = 0; k <= Dim; ++k) {  // de Casteljau
            left[k] = right[0];
            for (int i = 0; i < Dim - k; ++i) {
                right[i] = (right[i] + right[i + 1]) / 2;
            }
        }
        // What is left in `right` runs from the middle on.
        return has_meeting_root(left, begin, middle) || has_meeting_root(right, middle, end);
    }

    // No two points of the two come nearer to each other faster than this.
    [[nodiscard]] Real speed() const {
        Real most = 0;
        for (int i = 0; i < K; ++i) {
            for (int j = 0; j < L; ++j) {
                most = std::max(most, (a1_.col(i) - a0_.col(i) - b1_.col(j) + b0_.col(j)).norm());
            }
        }
        return most;
    }

    RealCorners<Dim, K> a0_;
    RealCorners<Dim, K> a1_;
    RealCorners<Dim, L> b0_;
    RealCorners<Dim, L> b1_;
};

template <int Dim, int K, int L>
bool share_corner(const Simplices<K>& a, Eigen::Index i, const Simplices<L>& b, Eigen::Index j) {
    for (int p = 0; p < K; ++p) {
        for (int q = 0; q < L; ++q) {
            if (a(p, i) == b(q, j)) {
                return true;
            }
        }
    }
    return false;
}

// The extents of simplices along every axis over a motion: lowest and highest, Dim x simplices
// each.
template <int Dim>
struct Extents {
    Eigen::Matrix<double, Dim, Eigen::Dynamic> low;
    Eigen::Matrix<double, Dim, Eigen::Dynamic> high;

    [[nodiscard]] bool do_meet(Eigen::Index i, const Extents& other, Eigen::Index j) const {
        return (low.col(i).array() <= other.high.col(j).array()).all()
               && (other.low.col(j).array() <= high.col(i).array()).all();
    }
};

template <int Dim, int Count>
Extents<Dim> extents_of(const Simplices<Count>& simplices,
                        const Positions<Dim>& from,
                        const Positions<Dim>& to) {
    Extents<Dim> extents;
    extents.low.resize(Dim, simplices.cols());
    extents.high.resize(Dim, simplices.cols());
    for (Eigen::Index i = 0; i < simplices.cols(); ++i) {
        extents.low.col(i) = from.col(simplices(0, i));
        extents.high.col(i) = from.col(simplices(0, i));
        for (int k = 0; k < Count; ++k) {
            for (const Positions<Dim>* positions : {&from, &to}) {
                const auto corner = positions->col(simplices(k, i));
                extents.low.col(i) = extents.low.col(i).cwiseMin(corner);
                extents.high.col(i) = extents.high.col(i).cwiseMax(corner);
            }
        }
    }
    return extents;
}

// Calls visit(i, j) for all pairs of simplices, but those that share a corner or whose extents do
// not meet.
template <int Dim, int K, int L, typename Visit>
void for_each_near_pair(const Simplices<K>& a,
                        const Simplices<L>& b,
                        const Positions<Dim>& from,
                        const Positions<Dim>& to,
                        const Visit& visit) {
    const Extents<Dim> of_a = extents_of<Dim, K>(a, from, to);
    const Extents<Dim> of_b = extents_of<Dim, L>(b, from, to);
    for (Eigen::Index i = 0; i < a.cols(); ++i) {
        for (Eigen::Index j = 0; j < b.cols(); ++j) {
            if (of_a.do_meet(i, of_b, j) && !share_corner<Dim, K, L>(a, i, b, j)) {
                visit(i, j);
            }
        }
    }
}

}  // namespace

template <int Dim, int K, int L>
bool do_cross(const RealCorners<Dim, K>& a, const RealCorners<Dim, L>& b) {
    Eigen::Matrix<Real, Dim, Dim> edges;
    for (int i = 1; i < K; ++i) {
        edges.col(i - 1) = a.col(i) - a.col(0);
    }
    for (int j = 1; j < L; ++j) {
        edges.col(K - 2 + j) = b.col(0) - b.col(j);
    }
    const Eigen::FullPivLU<Eigen::Matrix<Real, Dim, Dim>> factors(edges);
    if (factors.rank() < Dim) {
        return false;  // parallel: they meet in faces if at all, which other pairs find
    }
    const Eigen::Matrix<Real, Dim, 1> t = factors.solve(b.col(0) - a.col(0));
    return t.minCoeff() > 0 && t.head(K - 1).sum() < 1 && t.tail(L - 1).sum() < 1;
}

template <int Dim, int K, int L>
bool do_meet(const RealCorners<Dim, K>& a0,
             const RealCorners<Dim, K>& a1,
             const RealCorners<Dim, L>& b0,
             const RealCorners<Dim, L>& b1) {
    return SweptPair<Dim, K, L>(a0, a1, b0, b1).do_meet();
}

template <int Dim>
int count_crossings(const contact::Surface<Dim>& first,
                    const contact::Surface<Dim>& second,
                    const Positions<Dim>& positions) {
    int count = 0;
    const auto visit = [&]<int K, int L>(const Simplices<K>& a, const Simplices<L>& b) {
        for_each_near_pair<Dim, K, L>(
            a, b, positions, positions, [&](Eigen::Index i, Eigen::Index j) {
                count += do_cross<Dim, K, L>(real_corners<Dim, K>(a, i, positions),
                                             real_corners<Dim, L>(b, j, positions))
                             ? 1
                             : 0;
            });
    };
    visit.template operator()<2, Dim>(first.edges, second.facets);
    if (&first != &second) {
        visit.template operator()<2, Dim>(second.edges, first.facets);
    }
    if constexpr (Dim > 3) {
        visit.template operator()<3, 3>(first.ridges, second.ridges);
    }
    return count;
}

template <int Dim>
int count_swept_crossings(const contact::Surface<Dim>& first,
                          const contact::Surface<Dim>& second,
                          const Positions<Dim>& from,
                          const Positions<Dim>& to) {
    int count = 0;
    const auto visit = [&]<int K, int L>(const Simplices<K>& a, const Simplices<L>& b) {
        for_each_near_pair<Dim, K, L>(a, b, from, to, [&](Eigen::Index i, Eigen::Index j) {
            count +=
                do_meet<Dim, K, L>(real_corners<Dim, K>(a, i, from), real_corners<Dim, K>(a, i, to),
                                   real_corners<Dim, L>(b, j, from), real_corners<Dim, L>(b, j, to))
                    ? 1
                    : 0;
        });
    };
    visit.template operator()<1, Dim>(first.vertices, second.facets);
    visit.template operator()<2, Dim - 1>(first.edges, second.ridges);
    if (&first != &second) {
        visit.template operator()<1, Dim>(second.vertices, first.facets);
        if constexpr (Dim > 3) {
            visit.template operator()<2, Dim - 1>(second.edges, first.ridges);
        }
    }
    return count;
}

#define PENT_INSTANTIATE(Dim)                                                                      \
    template bool do_cross<Dim, 2, Dim>(const RealCorners<Dim, 2>&, const RealCorners<Dim, Dim>&); \
    template bool do_meet<Dim, 1, Dim>(const RealCorners<Dim, 1>&, const RealCorners<Dim, 1>&,     \
                                       const RealCorners<Dim, Dim>&,                               \
                                       const RealCorners<Dim, Dim>&);                              \
    template bool do_meet<Dim, 2, Dim - 1>(const RealCorners<Dim, 2>&, const RealCorners<Dim, 2>&, \
                                           const RealCorners<Dim, Dim - 1>&,                       \
                                           const RealCorners<Dim, Dim - 1>&);                      \
    template int count_crossings(const contact::Surface<Dim>&, const contact::Surface<Dim>&,       \
                                 const Positions<Dim>&);                                           \
    template int count_swept_crossings(const contact::Surface<Dim>&, const contact::Surface<Dim>&, \
                                       const Positions<Dim>&, const Positions<Dim>&);
PENT_FOR_EACH_DIMENSION(PENT_INSTANTIATE)
#undef PENT_INSTANTIATE
template bool do_cross<4, 3, 3>(const RealCorners<4, 3>&, const RealCorners<4, 3>&);

}  // namespace pent::test
