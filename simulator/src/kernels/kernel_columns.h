#pragma once

#include "kernels/kernel_tensor.h"
#include "kernels/kernel_transpose.h"
#include "kernels/kernel_vertices.h"
#include "linear/block_kernels.h"

// Line Jacobi: factors the diagonal block of each extrusion column, a column a lane, and solves
// with the factors.
//
// Banded block L D L^T: with A_k,k+j the coupling of layers k and k + j <= k + band,
//   D_k = A_kk - sum over m of S_(k-m),k^T D_(k-m)^-1 S_(k-m),k
//   S_k,k+j = A_k,k+j - sum over m of S_(k-m),k^T D_(k-m)^-1 S_(k-m),k+j,   E_k,j = D_k^-1 S_k,k+j
// and L_k+j,k = E_k,j^T. D_k^-1 and E_k,j are stored, so that solves need products only.

// Tensors of lanes are filled entry by entry right after they are declared; zeroing them first
// would cost as much as using them. NOLINTBEGIN(cppcoreguidelines-pro-type-member-init)

namespace pent::simulator {
namespace {  // NOLINT(google-build-namespaces): see kernel_lanes.h

inline constexpr int kMaxBand = 2;

// One block a lane, in the order of block_order.h.
template <typename Real, int Dim>
struct LaneBlocks {
    static constexpr int kEntries = Dim * Dim;
    static constexpr int kCount = Lanes<Real>::kCount;

    alignas(64) double at[kCount][kEntries];

    template <typename Scalar>
    void set(int lane, const Scalar* block) {
        for (int entry = 0; entry < kEntries; ++entry) {
            at[lane][entry] = static_cast<double>(block[entry]);
        }
    }
    // Sets a lane to `diagonal` times the identity.
    void set(int lane, double diagonal) {
        for (int i = 0; i < Dim; ++i) {
            for (int j = 0; j < Dim; ++j) {
                at[lane][block_entry<Dim>(i, j)] = i == j ? diagonal : 0;
            }
        }
    }
    [[nodiscard]] Tensor<Real, Dim> load() const {
        alignas(64) double entries[kEntries][kCount];
        transpose(at, entries);
        Tensor<Real, Dim> blocks;
        for (int i = 0; i < Dim; ++i) {
            for (int j = 0; j < Dim; ++j) {
                blocks[i][j] = Lanes<Real>::load(entries[block_entry<Dim>(i, j)]);
            }
        }
        return blocks;
    }
    void store(const Tensor<Real, Dim>& blocks) {
        alignas(64) double entries[kEntries][kCount];
        for (int i = 0; i < Dim; ++i) {
            for (int j = 0; j < Dim; ++j) {
                Lanes<Real>::store(blocks[i][j], entries[block_entry<Dim>(i, j)]);
            }
        }
        transpose(entries, at);
    }
    void get(int lane, float* block) const {
        for (int entry = 0; entry < kEntries; ++entry) {
            block[entry] = static_cast<float>(at[lane][entry]);
        }
    }
};

// sum -= A^T B.
template <typename Real, int Dim>
void subtract_transposed_times(const Tensor<Real, Dim>& A,
                               const Tensor<Real, Dim>& B,
                               Tensor<Real, Dim>& sum) {
    for (int i = 0; i < Dim; ++i) {
        for (int j = 0; j < Dim; ++j) {
            for (int k = 0; k < Dim; ++k) {
                sum[i][j] -= A[k][i] * B[k][j];
            }
        }
    }
}

// Inverse of a symmetric matrix, of which the upper triangle is read, by L D L^T. Symmetric to the
// bit, as preconditioners of conjugate gradients have to be.
//
// @param is_definite  Set to 0 in lanes where a pivot or its inverse is not positive and finite.
template <typename Real, int Dim>
Tensor<Real, Dim> inverse_of(const Tensor<Real, Dim>& A, Real& is_definite) {
    using L = Lanes<Real>;
    const Real zero = Real(0.0);
    const Real most = Real(__DBL_MAX__);
    Tensor<Real, Dim> lower;  // unit triangle, then its inverse
    Real inverse_pivots[Dim];
    for (int j = 0; j < Dim; ++j) {
        Real scaled[Dim];  // row j times the pivots
        Real pivot = A[j][j];
        for (int k = 0; k < j; ++k) {
            scaled[k] = lower[j][k];
            lower[j][k] *= inverse_pivots[k];
            pivot -= lower[j][k] * scaled[k];
        }
        inverse_pivots[j] = Real(1.0) / pivot;
        is_definite = L::select(pivot > zero, is_definite, zero);
        is_definite = L::select(inverse_pivots[j] > zero, is_definite, zero);
        is_definite = L::select(most >= inverse_pivots[j], is_definite, zero);
        for (int i = j + 1; i < Dim; ++i) {
            Real entry = A[j][i];
            for (int k = 0; k < j; ++k) {
                entry -= lower[i][k] * lower[j][k];
            }
            lower[i][j] = entry;  // times the pivot
        }
    }
    for (int j = 0; j < Dim; ++j) {
        for (int i = j + 1; i < Dim; ++i) {
            Real entry = -lower[i][j];
            for (int k = j + 1; k < i; ++k) {
                entry -= lower[i][k] * lower[k][j];
            }
            lower[i][j] = entry;
        }
    }
    Tensor<Real, Dim> inverse;
    for (int i = 0; i < Dim; ++i) {
        for (int j = i; j < Dim; ++j) {
            Real sum = j == i ? inverse_pivots[j] : inverse_pivots[j] * lower[j][i];
            for (int k = j + 1; k < Dim; ++k) {
                sum += lower[k][i] * (inverse_pivots[k] * lower[k][j]);
            }
            inverse[i][j] = sum;
            inverse[j][i] = sum;
        }
    }
    return inverse;
}

// The row of one dof in the factors of its column, in every lane: entry j - 1 couples it with the
// j-th layer behind it.
template <typename Real, int Dim>
struct FactorRow {
    Tensor<Real, Dim> plain[kMaxBand];   // S
    Tensor<Real, Dim> scaled[kMaxBand];  // E
};

// As many columns as there are lanes, factored side by side. Short ones continue with identities
// until the longest ends.
template <int Dim, typename Real, typename Scalar>
class ColumnPack {
public:
    ColumnPack(const BlockRows<Scalar>& matrix,
               const ColumnFactors<float>& factors,
               std::int64_t column)
        : matrix_(&matrix), factors_(&factors), column_(column) {
        for (int lane = 0; lane < kWidth; ++lane) {
            const bool is_in = column + lane < factors.end;
            begin_[lane] = is_in ? factors.column_start[column + lane] : 0;
            length_[lane] = is_in ? factors.column_start[column + lane + 1] - begin_[lane] : 0;
            longest_ = length_[lane] > longest_ ? length_[lane] : longest_;
        }
    }

    void factor(std::uint8_t* has_failed) {
        const auto band = static_cast<int>(factors_->band);
        Real is_definite = Real(1.0);
        FactorRow<Real, Dim> rows[kMaxBand + 1];  // ring buffer of the last layers
        for (std::uint32_t k = 0; k < longest_; ++k) {
            const auto row_above = [&](int m) -> const FactorRow<Real, Dim>& {
                return rows[(k + kMaxBand + 1 - static_cast<std::uint32_t>(m)) % (kMaxBand + 1)];
            };
            const int above = k < factors_->band ? static_cast<int>(k) : band;
            Tensor<Real, Dim> diagonal = load(k, 0);
            for (int m = 1; m <= above; ++m) {
                const FactorRow<Real, Dim>& row = row_above(m);
                subtract_transposed_times(row.plain[m - 1], row.scaled[m - 1], diagonal);
            }
            const Tensor<Real, Dim> inverse = inverse_of(diagonal, is_definite);
            store(inverse, k, factors_->inverses, 1, 0);
            FactorRow<Real, Dim>& own = rows[k % (kMaxBand + 1)];
            for (int j = 1; j <= band; ++j) {
                Tensor<Real, Dim> next = load(k, j);
                for (int m = 1; m <= above && m + j <= band; ++m) {
                    const FactorRow<Real, Dim>& row = row_above(m);
                    subtract_transposed_times(row.scaled[m - 1], row.plain[m + j - 1], next);
                }
                own.plain[j - 1] = next;
                own.scaled[j - 1] = times(inverse, next);
                store(own.scaled[j - 1], k, factors_->couplings, band, j - 1);
            }
        }
        for (int lane = 0; lane < kWidth && column_ + lane < factors_->end; ++lane) {
            has_failed[column_ + lane] = Lanes<Real>::lane(is_definite, lane) > 0 ? 0 : 1;
        }
    }

private:
    static constexpr int kWidth = Lanes<Real>::kCount;
    static constexpr int kEntries = Dim * Dim;

    static Tensor<Real, Dim> times(const Tensor<Real, Dim>& A, const Tensor<Real, Dim>& B) {
        Tensor<Real, Dim> product;
        for (int i = 0; i < Dim; ++i) {
            for (int j = 0; j < Dim; ++j) {
                Real sum = A[i][0] * B[0][j];
                for (int k = 1; k < Dim; ++k) {
                    sum += A[i][k] * B[k][j];
                }
                product[i][j] = sum;
            }
        }
        return product;
    }

    // The blocks that couple layer k with the j-th behind it, zero where there is none; the
    // identity on the diagonal of columns that have ended.
    Tensor<Real, Dim> load(std::uint32_t k, int j) {
        for (int lane = 0; lane < kWidth; ++lane) {
            const std::uint32_t row = begin_[lane] + k;
            const auto ahead = static_cast<std::uint32_t>(j);
            const Scalar* block = k + ahead < length_[lane] ? find(row, row + ahead) : nullptr;
            if (block != nullptr) {
                staged_.set(lane, block);
            } else {
                staged_.set(lane, j == 0 ? 1.0 : 0.0);
            }
        }
        return staged_.load();
    }

    // Columns increase within a row, the diagonal comes first.
    const Scalar* find(std::uint32_t row, std::uint32_t column) const {
        for (std::int64_t at = matrix_->row_start[row]; at < matrix_->row_start[row + 1]; ++at) {
            if (matrix_->columns[at] >= column) {
                return matrix_->columns[at] == column ? matrix_->values + at * kEntries : nullptr;
            }
        }
        return nullptr;
    }

    // Stores into block `place` of the `blocks` that each dof has in an array.
    void store(
        const Tensor<Real, Dim>& values, std::uint32_t k, float* array, int blocks, int place) {
        staged_.store(values);
        for (int lane = 0; lane < kWidth; ++lane) {
            if (k < length_[lane]) {
                const std::int64_t dof = std::int64_t{begin_[lane]} + k;
                staged_.get(lane, array + (dof * blocks + place) * kEntries);
            }
        }
    }

    const BlockRows<Scalar>* matrix_;
    const ColumnFactors<float>* factors_;
    std::int64_t column_;
    std::uint32_t begin_[kWidth];
    std::uint32_t length_[kWidth];
    std::uint32_t longest_ = 0;
    LaneBlocks<Real, Dim> staged_;
};

template <int Dim, typename Real, typename Scalar>
void factor_columns(const BlockRows<Scalar>& matrix,
                    const ColumnFactors<float>& factors,
                    std::uint8_t* has_failed) {
    for (std::int64_t column = factors.begin; column < factors.end; column += Lanes<Real>::kCount) {
        ColumnPack<Dim, Real, Scalar>(matrix, factors, column).factor(has_failed);
    }
}

// Prefetches the factors of the dof 64 further on, in the next page: see ReadAhead.
template <int Dim>
[[gnu::always_inline]] inline void prefetch_factors(const ColumnFactors<const float>& factors,
                                                    std::size_t dof) {
    constexpr std::size_t kEntries = std::size_t{Dim} * Dim;
    constexpr std::size_t kAhead = 64;
    __builtin_prefetch(factors.inverses + (dof + kAhead) * kEntries);
    for (std::size_t m = 0; m < factors.band; ++m) {
        __builtin_prefetch(factors.couplings + ((dof + kAhead) * factors.band + m) * kEntries);
    }
}

// Forward and backward substitution. Within a column each layer waits for the one before, so
// several columns are solved layer by layer side by side, to hide the latency.
template <int Dim, bool IsVectorized>
void solve_columns(const ColumnFactors<const float>& factors, const double* r, double* z) {
    using Vertex = typename VertexOf<Dim, IsVectorized>::Type;
    constexpr std::size_t kEntries = std::size_t{Dim} * Dim;
    constexpr std::int64_t kTogether = 4;
    const std::size_t band = factors.band;
    for (std::int64_t first = factors.begin; first < factors.end; first += kTogether) {
        const std::uint32_t* start = factors.column_start + first;
        const std::int64_t left = factors.end - first;
        const std::int64_t count = left < kTogether ? left : kTogether;
        std::size_t longest = 0;
        for (std::int64_t c = 0; c < count; ++c) {
            const std::size_t length = start[c + 1] - start[c];
            longest = length > longest ? length : longest;
        }
        for (std::size_t layer = 0; layer < longest; ++layer) {
            for (std::int64_t c = 0; c < count; ++c) {
                const std::size_t k = start[c] + layer;
                if (k >= start[c + 1]) {
                    continue;
                }
                prefetch_factors<Dim>(factors, k);
                auto value = loaded<Vertex>(r + k * Dim);
                for (std::size_t m = 1; m <= band && m <= layer; ++m) {
                    const float* coupling = factors.couplings + ((k - m) * band + m - 1) * kEntries;
                    value -= transposed_times(coupling, loaded<Vertex>(z + (k - m) * Dim));
                }
                store(value, z + k * Dim);
            }
        }
        for (std::size_t layer = 1; layer <= longest; ++layer) {  // from the last one
            for (std::int64_t c = 0; c < count; ++c) {
                const std::size_t end = start[c + 1];
                if (layer > end - start[c]) {
                    continue;
                }
                const std::size_t k = end - layer;
                Vertex value =
                    block_times(factors.inverses + k * kEntries, loaded<Vertex>(z + k * Dim));
                for (std::size_t j = 1; j <= band && k + j < end; ++j) {
                    const float* coupling = factors.couplings + (k * band + j - 1) * kEntries;
                    value -= block_times(coupling, loaded<Vertex>(z + (k + j) * Dim));
                }
                store(value, z + k * Dim);
            }
        }
    }
}

}  // namespace
}  // namespace pent::simulator

// NOLINTEND(cppcoreguidelines-pro-type-member-init)
