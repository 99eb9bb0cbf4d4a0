#pragma once

#include "kernels/kernel_lanes.h"

#include <pent/simulator/solver_options.h>

// Small dense algebra, a matrix a lane: cofactors, singular values, filtered symmetric matrices.

// Tensors of lanes are filled entry by entry right after they are declared; zeroing them first
// would cost as much as using them. NOLINTBEGIN(cppcoreguidelines-pro-type-member-init)

namespace pent::simulator {
namespace {  // NOLINT(google-build-namespaces): see kernel_lanes.h

template <typename Real, int Dim>
struct Tensor {
    Real at[Dim][Dim];  // [row][column]

    Real* operator[](int row) { return at[row]; }
    const Real* operator[](int row) const { return at[row]; }
};

/// Cofactor matrix d det(F) / dF, and det F.
template <typename Real, int Dim>
struct Cofactor {
    Tensor<Real, Dim> matrix;
    Real det;
};

template <typename Real>
Cofactor<Real, 2> cofactor(const Tensor<Real, 2>& F) {
    Cofactor<Real, 2> result;
    result.matrix[0][0] = F[1][1];
    result.matrix[0][1] = -F[1][0];
    result.matrix[1][0] = -F[0][1];
    result.matrix[1][1] = F[0][0];
    result.det = F[0][0] * F[1][1] - F[0][1] * F[1][0];
    return result;
}

template <typename Real>
Cofactor<Real, 3> cofactor(const Tensor<Real, 3>& F) {
    Cofactor<Real, 3> result;
    for (int i = 0; i < 3; ++i) {
        const int i1 = (i + 1) % 3;
        const int i2 = (i + 2) % 3;
        for (int j = 0; j < 3; ++j) {
            const int j1 = (j + 1) % 3;
            const int j2 = (j + 2) % 3;
            result.matrix[i][j] = F[i1][j1] * F[i2][j2] - F[i1][j2] * F[i2][j1];
        }
    }
    result.det = F[0][0] * result.matrix[0][0] + F[0][1] * result.matrix[0][1]
                 + F[0][2] * result.matrix[0][2];
    return result;
}

// Laplace expansion along two pairs of rows: the six 2 x 2 minors of each pair are shared.
template <typename Real>
Cofactor<Real, 4> cofactor(const Tensor<Real, 4>& F) {
    const auto minor = [&](int r, int s, int i, int j) {
        return F[r][i] * F[s][j] - F[r][j] * F[s][i];
    };
    const Real a01 = minor(0, 1, 0, 1), a02 = minor(0, 1, 0, 2), a03 = minor(0, 1, 0, 3);
    const Real a12 = minor(0, 1, 1, 2), a13 = minor(0, 1, 1, 3), a23 = minor(0, 1, 2, 3);
    const Real b01 = minor(2, 3, 0, 1), b02 = minor(2, 3, 0, 2), b03 = minor(2, 3, 0, 3);
    const Real b12 = minor(2, 3, 1, 2), b13 = minor(2, 3, 1, 3), b23 = minor(2, 3, 2, 3);
    Cofactor<Real, 4> result;
    Tensor<Real, 4>& C = result.matrix;
    C[0][0] = F[1][1] * b23 - F[1][2] * b13 + F[1][3] * b12;
    C[0][1] = F[1][2] * b03 - F[1][0] * b23 - F[1][3] * b02;
    C[0][2] = F[1][0] * b13 - F[1][1] * b03 + F[1][3] * b01;
    C[0][3] = F[1][1] * b02 - F[1][0] * b12 - F[1][2] * b01;
    C[1][0] = F[0][2] * b13 - F[0][1] * b23 - F[0][3] * b12;
    C[1][1] = F[0][0] * b23 - F[0][2] * b03 + F[0][3] * b02;
    C[1][2] = F[0][1] * b03 - F[0][0] * b13 - F[0][3] * b01;
    C[1][3] = F[0][0] * b12 - F[0][1] * b02 + F[0][2] * b01;
    C[2][0] = F[3][1] * a23 - F[3][2] * a13 + F[3][3] * a12;
    C[2][1] = F[3][2] * a03 - F[3][0] * a23 - F[3][3] * a02;
    C[2][2] = F[3][0] * a13 - F[3][1] * a03 + F[3][3] * a01;
    C[2][3] = F[3][1] * a02 - F[3][0] * a12 - F[3][2] * a01;
    C[3][0] = F[2][2] * a13 - F[2][1] * a23 - F[2][3] * a12;
    C[3][1] = F[2][0] * a23 - F[2][2] * a03 + F[2][3] * a02;
    C[3][2] = F[2][1] * a03 - F[2][0] * a13 - F[2][3] * a01;
    C[3][3] = F[2][0] * a12 - F[2][1] * a02 + F[2][2] * a01;
    result.det = a01 * b23 - a02 * b13 + a03 * b12 + a12 * b03 - a13 * b02 + a23 * b01;
    return result;
}

template <typename Real, int Dim>
Tensor<Real, Dim> identity() {
    Tensor<Real, Dim> matrix;
    for (int i = 0; i < Dim; ++i) {
        for (int j = 0; j < Dim; ++j) {
            matrix[i][j] = Real(i == j ? 1.0F : 0.0F);
        }
    }
    return matrix;
}

/// What counts as zero:
///
///     kOrthogonal     the cosine between two columns, or an off-diagonal entry beside the largest
///                     entry, at which Jacobi iterations stop
///     kRankDeficient  a singular value beside the largest
///     kLeastSquare    squares below it lose precision, or are zero
///     kTiny           what keeps divisors from zero
template <typename Number>
struct Precise;
template <>
struct Precise<float> {
    static constexpr float kOrthogonal = 3e-7F;
    static constexpr float kRankDeficient = 1e-5F;
    static constexpr float kTiny = 1e-37F;
    static constexpr float kLeastSquare = 1e-36F;
};
template <>
struct Precise<double> {
    static constexpr double kOrthogonal = 4e-16;
    static constexpr double kRankDeficient = 1e-13;
    static constexpr double kTiny = 1e-300;
    static constexpr double kLeastSquare = 1e-300;
};

inline constexpr int kMaxSweeps = 12;

/// F = U diag(sigma) V^T with rotations U and V: the smallest sigma has the sign of det F.
template <typename Real, int Dim>
struct SignedSvd {
    Tensor<Real, Dim> U;
    Real sigma[Dim];
    Tensor<Real, Dim> turned_rest;  // `rest` V, with the matrix `rest` passed in
};

template <typename Real>
struct PlaneRotation {
    Real cosine;
    Real sine;
};

// The Jacobi rotation that makes a symmetric 2 x 2 matrix diagonal, by at most 45 degrees; the
// identity in lanes that are not to be turned.
//
// With d and t the difference and twice the off-diagonal entry, h = |d| + sqrt(d^2 + t^2) gives its
// tangent t / h, so cosine and sine are h and t over sqrt(h^2 + t^2): one division and two roots.
//
// @param difference  Of the diagonal, the second entry less the first.
// @param twice       The entry beside the diagonal, times 2; where lanes are turned, neither its
//                    square nor those of the others leave the range of the type.
template <typename Real>
PlaneRotation<Real> diagonalizing_rotation(const Real& difference,
                                           const Real& twice,
                                           const typename Lanes<Real>::Mask& is_turned) {
    using L = Lanes<Real>;
    using Number = typename L::Number;
    const Real zero = Real(Number(0));
    const Real one = Real(Number(1));
    const Real twice_squared = twice * twice;
    const Real h = L::abs(difference) + L::root(difference * difference + twice_squared);
    const Real inverse = one / L::root(h * h + twice_squared);
    const Real signed_twice = L::select(difference < zero, -twice, twice);
    return {L::select(is_turned, h * inverse, one),
            L::select(is_turned, signed_twice * inverse, zero)};
}

// Applies the plane rotation (c, s) to columns i and j of A.
template <typename Real, int Dim>
void turn_columns(Tensor<Real, Dim>& A, int i, int j, const Real& c, const Real& s) {
    for (int row = 0; row < Dim; ++row) {
        const Real left = A[row][i];
        const Real right = A[row][j];
        A[row][i] = c * left - s * right;
        A[row][j] = s * left + c * right;
    }
}

template <typename Real, int Dim>
void turn_rows(Tensor<Real, Dim>& A, int i, int j, const Real& c, const Real& s) {
    for (int column = 0; column < Dim; ++column) {
        const Real upper = A[i][column];
        const Real lower = A[j][column];
        A[i][column] = c * upper - s * lower;
        A[j][column] = s * upper + c * lower;
    }
}

// The largest absolute entry; a tiny number if all are zero.
template <typename Real, int Dim>
Real largest_entry(const Tensor<Real, Dim>& A) {
    using L = Lanes<Real>;
    Real largest = Real(Precise<typename L::Number>::kTiny);
    for (int i = 0; i < Dim; ++i) {
        for (int j = 0; j < Dim; ++j) {
            largest = L::max(largest, L::abs(A[i][j]));
        }
    }
    return largest;
}

template <typename Real, int Dim>
void multiply_by(const Real& factor, Tensor<Real, Dim>& A) {
    for (int i = 0; i < Dim; ++i) {
        for (int j = 0; j < Dim; ++j) {
            A[i][j] *= factor;
        }
    }
}

// One lane of U where columns belong to singular values of zero: those are replaced so that U is
// orthonormal. Any choice gives the same Hessian, for the modes they span have equal eigenvalues.
template <typename Real, int Dim>
void complete_basis(Tensor<Real, Dim>& U, const Real (&sigma)[Dim], int lane) {
    using L = Lanes<Real>;
    using Number = typename L::Number;
    Number columns[Dim][Dim];
    Number size[Dim];
    bool done[Dim] = {};
    Number largest = 0;
    for (int j = 0; j < Dim; ++j) {
        size[j] = L::lane(sigma[j], lane);
        largest = size[j] > largest ? size[j] : largest;
        for (int i = 0; i < Dim; ++i) {
            columns[j][i] = L::lane(U[i][j], lane);
        }
    }
    for (int j = 0; j < Dim; ++j) {
        done[j] = size[j] > Precise<Number>::kRankDeficient * largest && largest > 0;
    }
    for (int j = 0; j < Dim; ++j) {
        if (done[j]) {
            continue;
        }
        Number best_norm = 0;
        Number best[Dim] = {};
        for (int axis = 0; axis < Dim; ++axis) {  // the axis that is farthest from the span so far
            Number candidate[Dim] = {};
            candidate[axis] = 1;
            for (int pass = 0; pass < 2; ++pass) {
                for (int k = 0; k < Dim; ++k) {
                    if (!done[k]) {
                        continue;
                    }
                    Number dot = 0;
                    for (int i = 0; i < Dim; ++i) {
                        dot += columns[k][i] * candidate[i];
                    }
                    for (int i = 0; i < Dim; ++i) {
                        candidate[i] -= dot * columns[k][i];
                    }
                }
            }
            Number norm = 0;
            for (int i = 0; i < Dim; ++i) {
                norm += candidate[i] * candidate[i];
            }
            if (norm > best_norm) {
                best_norm = norm;
                for (int i = 0; i < Dim; ++i) {
                    best[i] = candidate[i];
                }
            }
        }
        const Number scale = 1 / Lanes<Number>::root(best_norm);
        for (int i = 0; i < Dim; ++i) {
            columns[j][i] = scale * best[i];
            L::set_lane(U[i][j], lane, columns[j][i]);
        }
        done[j] = true;
    }
}

// A sweep of Jacobi takes every pair of columns once, in rounds of pairs (i, i ^ Round). Pairs of
// one round share no column, so that none waits for the roots of another.
template <int Round, int Dim, typename Visit>
[[gnu::always_inline]] inline void for_each_pair(const Visit& visit) {
#pragma GCC unroll 4
    for (int i = 0; i < Dim; ++i) {
        const int j = i ^ Round;
        if (j > i && j < Dim) {
            visit(i, j);
        }
    }
}

// One round of one-sided Jacobi: makes pairs of columns of F orthogonal. The largest entry of F is
// near 1, so that what is too small to be squared belongs to columns of no size.
//
// @return  Whether any was not orthogonal yet.
template <int Round, typename Real, int Dim>
[[gnu::always_inline]] inline bool turn_round(Tensor<Real, Dim>& F, Tensor<Real, Dim>& rest) {
    using L = Lanes<Real>;
    using Number = typename L::Number;
    constexpr Number kOrthogonal = Precise<Number>::kOrthogonal;
    Real difference[Dim];  // of the first column of each pair
    Real twice[Dim];
    typename L::Mask is_turned[Dim];
    typename L::Mask is_any_turned = Real(Number(1)) < Real(Number(0));
    for_each_pair<Round, Dim>([&](int i, int j) {
        Real a = F[0][i] * F[0][i];
        Real b = F[0][j] * F[0][j];
        Real c = F[0][i] * F[0][j];
        for (int row = 1; row < Dim; ++row) {
            a += F[row][i] * F[row][i];
            b += F[row][j] * F[row][j];
            c += F[row][i] * F[row][j];
        }
        difference[i] = b - a;
        twice[i] = c + c;
        is_turned[i] = c * c > L::max(Real(kOrthogonal * kOrthogonal) * a * b,
                                      Real(Precise<Number>::kLeastSquare));
        is_any_turned = is_any_turned || is_turned[i];
    });
    if (!L::any(is_any_turned)) {
        return false;
    }
    for_each_pair<Round, Dim>([&](int i, int j) {
        const PlaneRotation<Real> rotation =
            diagonalizing_rotation(difference[i], twice[i], is_turned[i]);
        turn_columns(F, i, j, rotation.cosine, rotation.sine);
        turn_columns(rest, i, j, rotation.cosine, rotation.sine);
    });
    return true;
}

/// Singular value decomposition by one-sided Jacobi: the columns of F are rotated until they are
/// orthogonal [golub2013, 8.6.3]; they are then those of U, times sigma. The rotations make V,
/// which is applied to `rest` instead of being formed.
///
/// @param rest  The identity gives V.
template <typename Real, int Dim>
SignedSvd<Real, Dim> signed_svd(Tensor<Real, Dim> F, Tensor<Real, Dim> rest) {
    using L = Lanes<Real>;
    using Number = typename L::Number;
    using Limits = Precise<Number>;
    const Real one = Real(Number(1));
    const Real tiny = Real(Limits::kTiny);
    const Real scale = largest_entry(F);
    multiply_by(one / scale, F);
    bool is_turned = true;
    for (int sweep = 0; sweep < kMaxSweeps && is_turned; ++sweep) {
        is_turned = turn_round<1>(F, rest);
        if constexpr (Dim > 2) {
            is_turned |= turn_round<2>(F, rest);
            is_turned |= turn_round<3>(F, rest);
        }
    }
    SignedSvd<Real, Dim> svd;
    svd.turned_rest = rest;
    Real largest = Real(Number(0));
    Real smallest = Real(Number(0));
    for (int j = 0; j < Dim; ++j) {
        Real a = F[0][j] * F[0][j];
        for (int row = 1; row < Dim; ++row) {
            a += F[row][j] * F[row][j];
        }
        svd.sigma[j] = L::root(a);
        largest = j == 0 ? svd.sigma[j] : L::max(largest, svd.sigma[j]);
        smallest = j == 0 ? svd.sigma[j] : -L::max(-smallest, -svd.sigma[j]);
        const Real inverse = one / L::max(svd.sigma[j], tiny);
        for (int row = 0; row < Dim; ++row) {
            svd.U[row][j] = F[row][j] * inverse;
        }
    }
    const auto is_deficient = !(smallest > Real(Limits::kRankDeficient) * largest);
    if (L::any(is_deficient)) {
        for (int lane = 0; lane < L::kCount; ++lane) {
            if (!(L::lane(smallest, lane) > Limits::kRankDeficient * L::lane(largest, lane))) {
                complete_basis(svd.U, svd.sigma, lane);
            }
        }
    }
    const Real sign = L::select(cofactor(svd.U).det < Real(Number(0)), -one, one);
    Real pending = sign;  // for the first column with the smallest sigma
    for (int j = 0; j < Dim; ++j) {
        const Real factor = L::select(svd.sigma[j] == smallest, pending, one);
        pending = L::select(svd.sigma[j] == smallest, one, pending);
        svd.sigma[j] *= factor * scale;
        for (int row = 0; row < Dim; ++row) {
            svd.U[row][j] *= factor;
        }
    }
    return svd;
}

/// max(value, 0), |value| or value.
///
/// @param changed  Set to 1 in lanes in which that is another value.
template <typename Real>
Real filtered(const Real& value, Filter filter, Real& changed) {
    using L = Lanes<Real>;
    if (filter != Filter::None) {
        changed =
            L::select(value < Real(typename L::Number(0)), Real(typename L::Number(1)), changed);
    }
    switch (filter) {
        case Filter::Clamp:
            return L::max(value, Real(typename L::Number(0)));
        case Filter::Absolute:
            return L::abs(value);
        case Filter::None:
            break;
    }
    return value;
}

// 1 in lanes in which the symmetric matrix has a negative pivot in L D L^T, else 0: by Sylvester's
// law of inertia a cheap test for negative eigenvalues.
template <typename Real, int Dim>
Real has_negative_pivot(Tensor<Real, Dim> A) {
    using L = Lanes<Real>;
    using Number = typename L::Number;
    Real found = Real(Number(0));
    for (int k = 0; k < Dim; ++k) {
        found = L::select(A[k][k] >= Real(Number(0)), found, Real(Number(1)));
        const Real inverse = Real(Number(1)) / L::max(A[k][k], Real(Precise<Number>::kTiny));
        for (int i = k + 1; i < Dim; ++i) {
            const Real factor = A[i][k] * inverse;
            for (int j = k + 1; j < Dim; ++j) {
                A[i][j] -= factor * A[k][j];
            }
        }
    }
    return found;
}

// One round of two-sided Jacobi: makes entries (i, i ^ Round) of A zero. The largest entry of A is
// near 1.
//
// @return  Whether any was not zero yet.
template <int Round, typename Real, int Dim>
[[gnu::always_inline]] inline bool diagonalize_round(Tensor<Real, Dim>& A, Tensor<Real, Dim>& Q) {
    using L = Lanes<Real>;
    using Number = typename L::Number;
    PlaneRotation<Real> rotations[Dim];  // of the first row of each pair
    typename L::Mask is_any_turned = Real(Number(1)) < Real(Number(0));
    for_each_pair<Round, Dim>([&](int i, int j) {
        const auto is_turned = L::abs(A[i][j]) > Real(Precise<Number>::kOrthogonal);
        is_any_turned = is_any_turned || is_turned;
    });
    if (!L::any(is_any_turned)) {
        return false;
    }
    for_each_pair<Round, Dim>([&](int i, int j) {
        const auto is_turned = L::abs(A[i][j]) > Real(Precise<Number>::kOrthogonal);
        rotations[i] = diagonalizing_rotation(A[j][j] - A[i][i], A[i][j] + A[i][j], is_turned);
    });
    for_each_pair<Round, Dim>([&](int i, int j) {
        turn_columns(A, i, j, rotations[i].cosine, rotations[i].sine);
        turn_columns(Q, i, j, rotations[i].cosine, rotations[i].sine);
    });
    for_each_pair<Round, Dim>(
        [&](int i, int j) { turn_rows(A, i, j, rotations[i].cosine, rotations[i].sine); });
    return true;
}

/// The symmetric matrix with filtered eigenvalues; untouched if clamping has nothing to do.
///
/// Eigenvectors by two-sided Jacobi [golub2013, 8.5].
///
/// @param changed  Set to 1 in lanes in which an eigenvalue was negative.
template <typename Real, int Dim>
Tensor<Real, Dim> filtered(const Tensor<Real, Dim>& matrix, Filter filter, Real& changed) {
    using L = Lanes<Real>;
    using Number = typename L::Number;
    if (filter == Filter::None) {
        return matrix;
    }
    const Real is_negative = has_negative_pivot(matrix);
    if (!L::any(is_negative > Real(Number(0)))) {
        return matrix;
    }
    changed = L::max(changed, is_negative);
    const Real scale = largest_entry(matrix);
    Tensor<Real, Dim> A = matrix;
    multiply_by(Real(Number(1)) / scale, A);
    Tensor<Real, Dim> Q = identity<Real, Dim>();
    bool is_turned = true;
    for (int sweep = 0; sweep < kMaxSweeps && is_turned; ++sweep) {
        is_turned = diagonalize_round<1>(A, Q);
        if constexpr (Dim > 2) {
            is_turned |= diagonalize_round<2>(A, Q);
            is_turned |= diagonalize_round<3>(A, Q);
        }
    }
    Tensor<Real, Dim> result;
    for (int k = 0; k < Dim; ++k) {
        const Real value = scale * filtered(A[k][k], filter, changed);
        for (int i = 0; i < Dim; ++i) {
            const Real part = value * Q[i][k];
            for (int j = i; j < Dim; ++j) {
                result[i][j] = k == 0 ? part * Q[j][k] : result[i][j] + part * Q[j][k];
            }
        }
    }
    for (int i = 0; i < Dim; ++i) {
        for (int j = 0; j < i; ++j) {
            result[i][j] = result[j][i];
        }
    }
    return result;
}

}  // namespace
}  // namespace pent::simulator

// NOLINTEND(cppcoreguidelines-pro-type-member-init)
