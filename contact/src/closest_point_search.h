#pragma once

#include <pent/contact/stencil.h>

#include <bit>
#include <cmath>
#include <cstdint>
#include <utility>

namespace pent::contact {

/// The closest points of two simplices in R^Dim:
///
///     x = sum beta_i r_i,   y = sum alpha_j p_j,   all beta, alpha >= 0, each summing to 1.
template <int Dim, int K, int L>
struct ClosestPoints {
    Eigen::Matrix<double, K, 1> beta;   ///< Weights in the first simplex.
    Eigen::Matrix<double, L, 1> alpha;  ///< Weights in the second simplex.
    Vector<Dim> difference;             ///< x - y, m. Zero, and of no direction, where they touch.
    double distance_squared = 0;        ///< |x - y|^2, m^2.
    std::uint8_t first_face = 0;        ///< Bit i: corner i of the first simplex carries x.
    std::uint8_t second_face = 0;       ///< Bit j: corner j of the second simplex carries y.
};

/// Closest points of two simplices of K and L corners, K + L = Dim + 1, among those nearer than a
/// limit: of a point and a facet, or of the mixed pair (edge and edge in R^3, edge and triangle in
/// R^4).
///
/// Minimizes |x - y|^2 over the product of the simplices, a convex polytope: the free minimum over
/// the affine hulls if its weights are all positive, else the best of the facets it lies beyond.
/// Where the edges are dependent within 0.01 rad every facet is tried, so that the distance is
/// right to rounding (1e-14 of the size of the simplices) for parallel, touching and collapsed
/// simplices too. Which of several closest pairs comes out depends on the order of the corners.
///
/// In a header so that searches can inline what most pairs need, run_interior(); the recursion over
/// all faces is in the source. Faces are bit masks of corners known at compile time: every pair of
/// faces has straight-line code of its own.
template <int Dim, int K, int L>
class ClosestPointSearch {
public:
    /// @param limit_squared  Nothing at this squared distance or beyond is found.
    ClosestPointSearch(const Corners<Dim, K>& first,
                       const Corners<Dim, L>& second,
                       double limit_squared)
        : first_(first), second_(second) {
        best_.distance_squared = limit_squared;
    }

    /// Whether there is a pair below the limit; best() is it.
    bool run();

    /// Whether the closest points are below the limit and inside both simplices (their weights are
    /// all positive); best() is the pair then. Tries no face, so costs a fraction of run().
    bool run_interior() {
        constexpr unsigned kA = (1U << K) - 1;
        constexpr unsigned kB = (1U << L) - 1;
        constexpr int kN = kUnknowns<kA, kB>;
        Vector<Dim> offset = first_.col(0) - second_.col(0);
        const Edges<kN> edges = edges_of<kA, kB>(std::make_integer_sequence<int, kN>());
        Parameters<kN> t = Parameters<kN>::Zero();
        if (!solve_normal_equations<kN>(edges, offset, t)
            && (is_apart<kN>(edges, offset) || !solve_stably<kN>(edges, offset, t))) {
            return false;
        }
        if (!is_inside<kA, kB>(t)) {
            return false;
        }
        offset += edges * t;
        if (!(offset.squaredNorm() < best_.distance_squared)) {
            return false;
        }
        record<kA, kB>(t, offset);
        return true;
    }

    [[nodiscard]] const ClosestPoints<Dim, K, L>& best() const { return best_; }

private:
    template <unsigned A, unsigned B>
    static constexpr int kUnknowns = std::popcount(A) + std::popcount(B) - 2;

    template <int N>
    using Edges = Eigen::Matrix<double, Dim, N>;
    template <int N>
    using Parameters = Eigen::Matrix<double, N, 1>;

    // Sine squared of the angle between edges below which the normal equations are not trusted.
    static constexpr double kDependent = 1e-4;

    static constexpr int corner(unsigned mask, int i) {
        for (; i > 0; --i) {
            mask &= mask - 1;
        }
        return std::countr_zero(mask);
    }

    // The best pair of points on face A of the first and face B of the second simplex.
    template <unsigned A, unsigned B>
    void visit();
    template <unsigned A, unsigned B>
    void visit_facets(const Parameters<kUnknowns<A, B>>& t, bool all);
    template <unsigned A, unsigned B>
    void visit_dependent(const Edges<kUnknowns<A, B>>& edges, const Vector<Dim>& offset);

    // x - y = offset + edges t: edges of A from its first corner, then those of B, reversed.
    template <unsigned A, unsigned B, int... I>
    [[nodiscard]] Edges<kUnknowns<A, B>> edges_of(
        std::integer_sequence<int, I...> /*which*/) const {
        Edges<kUnknowns<A, B>> edges;
        ((edges.col(I) = edge<A, B, I>()), ...);
        return edges;
    }

    template <unsigned A, unsigned B, int I>
    [[nodiscard]] Vector<Dim> edge() const {
        constexpr int kInFirst = std::popcount(A) - 1;
        if constexpr (I < kInFirst) {
            return first_.col(corner(A, I + 1)) - first_.col(corner(A, 0));
        } else {
            return second_.col(corner(B, 0)) - second_.col(corner(B, I - kInFirst + 1));
        }
    }

    // Minimizes |offset + edges t| by LDL^T; false where the edges are nearly dependent.
    template <int N>
    [[nodiscard, gnu::always_inline]] static bool solve_normal_equations(const Edges<N>& edges,
                                                                         const Vector<Dim>& offset,
                                                                         Parameters<N>& t) {
        Eigen::Matrix<double, N, N> lower = Eigen::Matrix<double, N, N>::Zero();
        Parameters<N> inverse_pivot = Parameters<N>::Zero();
        for (int i = 0; i < N; ++i) {
            const double gram = edges.col(i).dot(edges.col(i));
            double pivot = gram;
            double right = -edges.col(i).dot(offset);
            for (int j = 0; j < i; ++j) {
                double entry = edges.col(i).dot(edges.col(j));  // times the pivot of j, below
                for (int k = 0; k < j; ++k) {
                    entry -= lower(i, k) * lower(j, k) * inverse_pivot[k];
                }
                lower(i, j) = entry;
                pivot -= entry * entry * inverse_pivot[j];
                right -= entry * t[j] * inverse_pivot[j];
            }
            if (!(pivot > kDependent * gram)) {
                return false;
            }
            inverse_pivot[i] = 1 / pivot;
            t[i] = right;
        }
        for (int i = N - 1; i >= 0; --i) {
            for (int j = i + 1; j < N; ++j) {
                t[i] -= lower(j, i) * t[j];
            }
            t[i] *= inverse_pivot[i];
        }
        return true;
    }

    // Weight of corner i of a face from the parameters of its edges, i = 0 being the first corner.
    template <int N>
    static double weight(const Parameters<N>& t, int begin, int count, int i) {
        if (i > 0) {
            return t[begin + i - 1];
        }
        double sum = 1;
        for (int j = 0; j < count - 1; ++j) {
            sum -= t[begin + j];
        }
        return sum;
    }

    template <unsigned A, unsigned B>
    [[nodiscard]] static bool is_inside(const Parameters<kUnknowns<A, B>>& t) {
        constexpr int kFirst = std::popcount(A);
        constexpr int kSecond = std::popcount(B);
        bool is_inside = true;
        for (int i = 0; i < kFirst; ++i) {
            is_inside &= weight(t, 0, kFirst, i) >= 0;
        }
        for (int j = 0; j < kSecond; ++j) {
            is_inside &= weight(t, kFirst - 1, kSecond, j) >= 0;
        }
        return is_inside;
    }

    template <unsigned A, unsigned B>
    void record(const Parameters<kUnknowns<A, B>>& t, const Vector<Dim>& difference) {
        const double squared = difference.squaredNorm();
        if (!(squared < best_.distance_squared)) {
            return;
        }
        constexpr int kFirst = std::popcount(A);
        constexpr int kSecond = std::popcount(B);
        best_.beta.setZero();
        for (int i = 0; i < kFirst; ++i) {
            best_.beta[corner(A, i)] = weight(t, 0, kFirst, i);
        }
        best_.alpha.setZero();
        for (int j = 0; j < kSecond; ++j) {
            best_.alpha[corner(B, j)] = weight(t, kFirst - 1, kSecond, j);
        }
        best_.difference = difference;
        best_.distance_squared = squared;
        best_.first_face = A;
        best_.second_face = B;
    }

    // Whether all of |offset + edges t|, |t_i| <= 1, is beyond the limit, by a bound that is cheap
    // where edges are nearly dependent: an edge that is nearly in the span of those before it moves
    // the part of the offset normal to that span by no more than its own normal part.
    template <int N>
    [[nodiscard]] bool is_apart(const Edges<N>& edges, Vector<Dim> offset) const {
        constexpr double kRounding = 1e-12;
        Edges<N> span = Edges<N>::Zero();  // orthonormal, the first few columns
        double slack = kRounding * offset.norm();
        int rank = 0;
        for (int i = 0; i < N; ++i) {
            Vector<Dim> normal = edges.col(i);
            const double length_squared = normal.squaredNorm();
            for (int j = 0; j < rank; ++j) {
                normal -= span.col(j).dot(normal) * span.col(j);
            }
            const double normal_squared = normal.squaredNorm();
            if (normal_squared > kDependent * length_squared) {
                const Vector<Dim> unit = normal / std::sqrt(normal_squared);
                offset -= unit.dot(offset) * unit;
                span.col(rank++) = unit;
            } else {
                slack += std::sqrt(normal_squared);
            }
        }
        const double apart = offset.norm() - slack;
        return apart > 0 && apart * apart >= best_.distance_squared;
    }

    // The same minimum by Gram-Schmidt orthogonalization; false where the edges are dependent to
    // rounding.
    template <int N>
    [[nodiscard, gnu::noinline]] static bool solve_stably(const Edges<N>& edges,
                                                          const Vector<Dim>& offset,
                                                          Parameters<N>& t) {
        constexpr double kRounding = 1e-14;
        Edges<N> frame = Edges<N>::Zero();  // edges = frame * upper
        Eigen::Matrix<double, N, N> upper = Eigen::Matrix<double, N, N>::Zero();
        Vector<Dim> rest = -offset;
        for (int i = 0; i < N; ++i) {
            Vector<Dim> normal = edges.col(i);
            for (int pass = 0; pass < 2; ++pass) {  // the second makes up for rounding in the first
                for (int j = 0; j < i; ++j) {
                    const double along = frame.col(j).dot(normal);
                    upper(j, i) += along;
                    normal -= along * frame.col(j);
                }
            }
            upper(i, i) = normal.norm();
            if (!(upper(i, i) > kRounding * edges.col(i).norm())) {
                return false;
            }
            frame.col(i) = normal / upper(i, i);
            t[i] = frame.col(i).dot(rest);
            rest -= t[i] * frame.col(i);
        }
        for (int i = N - 1; i >= 0; --i) {
            for (int j = i + 1; j < N; ++j) {
                t[i] -= upper(i, j) * t[j];
            }
            t[i] /= upper(i, i);
        }
        return true;
    }

    const Corners<Dim, K>& first_;
    const Corners<Dim, L>& second_;
    ClosestPoints<Dim, K, L> best_;
};

}  // namespace pent::contact
