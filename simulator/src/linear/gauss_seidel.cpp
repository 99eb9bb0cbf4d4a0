#include "linear/gauss_seidel.h"

#include "linear/coarse_solver.h"
#include "linear/parts.h"

#include <pent/dimensions.h>

#include <algorithm>
#include <cmath>

namespace pent::simulator {

namespace {

// How strong the coupling to other ranks may be without damping. Below 1, the limit at which errors
// stop becoming smaller.
constexpr double kUndamped = 0.5;

// A bound of |D_i^-1/2 A_ij D_j^-1/2| without roots of matrices: the eighth root of the sum of the
// eighth powers of its singular values, which is a trace. At least the largest of the 10 (6 in 3D),
// and at most 10^(1/8) = 1.33 times that.
template <typename Block>
double coupling_norm(const Block& inverse_i, const Block& A_ij, const Block& inverse_j) {
    const Block squared = inverse_i * A_ij * inverse_j * A_ij.transpose();
    const Block fourth = squared * squared;
    const double eighth = fourth.cwiseProduct(fourth.transpose()).sum();
    return std::pow(std::max(eighth, 0.0), 1.0 / 8);
}

}  // namespace

template <int Dim, typename Scalar>
GaussSeidel<Dim, Scalar>::GaussSeidel(const Workers& workers, const AggregateMatrix<Dim, Scalar>& A)
    : A_(&A), inverses_(static_cast<std::size_t>(kEntries * A.pattern->rows())) {
    for_each_part(
        workers, 0, A.pattern->rows(), kModeRows, [&](std::int64_t begin, std::int64_t end) {
            for (std::int64_t row = begin; row < end; ++row) {
                const Eigen::Matrix<Scalar, kSize, kSize> inverse =
                    inverse_of_diagonal(A, static_cast<std::uint32_t>(row)).template cast<Scalar>();
                write_modes<kSize>(inverse, inverses_.data() + kEntries * row);
            }
        });
    if (A.ghosts != nullptr) {
        damp(workers);
    }
}

template <int Dim, typename Scalar>
void GaussSeidel<Dim, Scalar>::damp(const Workers& workers) {
    const AggregatePattern& pattern = *A_->pattern;
    inverses_.resize(static_cast<std::size_t>(kEntries * pattern.column_count()));
    A_->ghosts->update(inverses_.data(), kEntries);
    kept_.resize(static_cast<std::size_t>(pattern.rows()));
    using Block = Eigen::Matrix<double, kSize, kSize>;
    const auto inverse_of = [&](std::int64_t column) -> Block {
        return read_modes<kSize>(inverses_.data() + kEntries * column).template cast<double>();
    };
    for_each_part(workers, 0, pattern.rows(), kModeRows, [&](std::int64_t begin, std::int64_t end) {
        for (std::int64_t row = begin; row < end; ++row) {
            const auto r = static_cast<std::size_t>(row);
            const Block inverse = inverse_of(row);
            double sum = 0;
            for (std::int64_t k = pattern.row_start[r + 1] - 1; k > pattern.diagonal[r]; --k) {
                sum +=
                    coupling_norm<Block>(inverse, A_->block(k).template cast<double>(),
                                         inverse_of(pattern.columns[static_cast<std::size_t>(k)]));
            }
            const double t = std::max(0.0, sum - kUndamped) / 2;
            kept_[r] = static_cast<Scalar>(t / (1 + t));
        }
    });
    inverses_.resize(static_cast<std::size_t>(kEntries * pattern.rows()));
    for (std::size_t i = 0; i < inverses_.size(); ++i) {
        inverses_[i] *= 1 - kept_[i / static_cast<std::size_t>(kEntries)];
    }
}

template <int Dim, typename Scalar>
void GaussSeidel<Dim, Scalar>::sweep_forth(const Workers& workers,
                                           const BlockKernels& kernels,
                                           const Vector& r,
                                           Vector& z,
                                           Vector& left,
                                           Shares& shares) const {
    z.resize(static_cast<Eigen::Index>(kSize * A_->pattern->column_count()));
    left.resize(r.size());
    const std::vector<std::int64_t>& batches = A_->pattern->batches;
    for (std::size_t i = 0; i + 1 < batches.size(); ++i) {
        for_each_part(workers, batches[i], batches[i + 1], kModeRows,
                      [&](std::int64_t begin, std::int64_t end) {
                          mode_kernels_of<Scalar>(kernels).sweep_forth(
                              A_->mode_rows(begin, end, shares), diagonal(), r.data(), z.data(),
                              left.data());
                      });
    }
    A_->update_ghosts(z);
    A_->subtract_above(workers, kernels, z, left, shares);
}

template <int Dim, typename Scalar>
void GaussSeidel<Dim, Scalar>::sweep_back(const Workers& workers,
                                          const BlockKernels& kernels,
                                          const Vector& r,
                                          Vector& z,
                                          Shares& shares) const {
    A_->update_ghosts(z);
    const std::vector<std::int64_t>& batches = A_->pattern->batches;
    for (std::size_t i = batches.size() - 1; i > 0; --i) {
        for_each_part(workers, batches[i - 1], batches[i], kModeRows,
                      [&](std::int64_t begin, std::int64_t end) {
                          mode_kernels_of<Scalar>(kernels).sweep_back(
                              A_->mode_rows(begin, end, shares), diagonal(), r.data(), z.data());
                      });
    }
}

#define PENT_INSTANTIATE(Dim)               \
    template class GaussSeidel<Dim, float>; \
    template class GaussSeidel<Dim, double>;
PENT_FOR_EACH_DIMENSION(PENT_INSTANTIATE)
#undef PENT_INSTANTIATE

}  // namespace pent::simulator
