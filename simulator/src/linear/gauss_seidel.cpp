#include "linear/gauss_seidel.h"

#include "linear/coarse_solver.h"

#include <pent/dimensions.h>

#include <algorithm>
#include <cmath>

namespace pent::simulator {

namespace {

// What of the coupling to other ranks does without damping. Below 1, so that errors become smaller
// indeed.
constexpr double kUndamped = 0.5;

// Calls work(begin, end) for parts of the rows [begin, end), at the same time.
template <typename Work>
void for_each_part(const Workers& workers, std::int64_t begin, std::int64_t end, const Work& work) {
    constexpr std::int64_t kRows = 16;  // of a task
    workers.for_each((end - begin + kRows - 1) / kRows, [&](std::int64_t part) {
        work(begin + part * kRows, std::min(begin + (part + 1) * kRows, end));
    });
}

// At least the largest singular value of D_i^-1/2 A_ij D_j^-1/2, and no more than 10^(1/8) = 1.33
// times that: the eighth root of the sum of their eighth powers, which is a trace.
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
    : A_(&A), inverses_(static_cast<std::size_t>(A.pattern->rows())) {
    for_each_part(workers, 0, A.pattern->rows(), [&](std::int64_t begin, std::int64_t end) {
        for (std::int64_t row = begin; row < end; ++row) {
            inverses_[static_cast<std::size_t>(row)] =
                inverse_of_diagonal(A, static_cast<std::uint32_t>(row)).template cast<Scalar>();
        }
    });
    if (A.ghosts != nullptr) {
        damp(workers);
    }
}

template <int Dim, typename Scalar>
void GaussSeidel<Dim, Scalar>::damp(const Workers& workers) {
    const AggregatePattern& pattern = *A_->pattern;
    inverses_.resize(static_cast<std::size_t>(pattern.column_count()));
    A_->ghosts->update(inverses_.empty() ? nullptr : inverses_.data()->data(), kSize * kSize);
    damping_.resize(static_cast<std::size_t>(pattern.rows()));
    using Block = Eigen::Matrix<double, kSize, kSize>;
    for_each_part(workers, 0, pattern.rows(), [&](std::int64_t begin, std::int64_t end) {
        for (auto row = static_cast<std::size_t>(begin); row < static_cast<std::size_t>(end);
             ++row) {
            const Block inverse = inverses_[row].template cast<double>();
            double sum = 0;
            for (std::int64_t k = pattern.row_start[row + 1] - 1; k >= pattern.above[row]; --k) {
                const std::uint32_t column = pattern.columns[static_cast<std::size_t>(k)];
                if (column < pattern.rows()) {
                    break;
                }
                sum += coupling_norm<Block>(inverse, A_->block(k).template cast<double>(),
                                            inverses_[column].template cast<double>());
            }
            damping_[row] = static_cast<Scalar>(std::max(0.0, sum - kUndamped) / 2);
            inverses_[row] /= 1 + damping_[row];
        }
    });
    inverses_.resize(static_cast<std::size_t>(pattern.rows()));
}

template <int Dim, typename Scalar>
void GaussSeidel<Dim, Scalar>::sweep_forth(const Workers& workers,
                                           const BlockKernels& kernels,
                                           const Vector& r,
                                           Vector& z,
                                           Vector& left) const {
    z.resize(static_cast<Eigen::Index>(kSize * A_->pattern->column_count()));
    const std::vector<std::int64_t>& batches = A_->pattern->batches;
    for (std::size_t i = 0; i + 1 < batches.size(); ++i) {
        for_each_part(workers, batches[i], batches[i + 1],
                      [&](std::int64_t begin, std::int64_t end) {
                          // Into z itself: rows below the diagonal read batches before alone.
                          A_->multiply_rows(kernels, BlockPart::BelowDiagonal, {begin, end},
                                            z.data(), z.data());
                          for (std::int64_t row = begin; row < end; ++row) {
                              auto at = z.template segment<kSize>(kSize * row);
                              at = inverses_[static_cast<std::size_t>(row)]
                                   * (r.template segment<kSize>(kSize * row) - at).eval();
                          }
                      });
    }
    A_->update_ghosts(z);
    A_->multiply(workers, kernels, BlockPart::AboveDiagonal, z, left);
    left = -left;
    for (std::size_t row = 0; row < damping_.size(); ++row) {
        if (damping_[row] > 0) {
            const auto at = static_cast<Eigen::Index>(kSize * row);
            left.template segment<kSize>(at).noalias() +=
                damping_[row]
                * (A_->block(A_->pattern->diagonal[row]) * z.template segment<kSize>(at));
        }
    }
}

template <int Dim, typename Scalar>
void GaussSeidel<Dim, Scalar>::sweep_back(const Workers& workers,
                                          const BlockKernels& kernels,
                                          const Vector& r,
                                          Vector& z) const {
    A_->update_ghosts(z);
    Vector product(r.size());
    const std::vector<std::int64_t>& batches = A_->pattern->batches;
    for (std::size_t i = batches.size() - 1; i > 0; --i) {
        for_each_part(workers, batches[i - 1], batches[i],
                      [&](std::int64_t begin, std::int64_t end) {
                          A_->multiply_rows(kernels, BlockPart::Whole, {begin, end}, z.data(),
                                            product.data());
                          for (std::int64_t row = begin; row < end; ++row) {
                              z.template segment<kSize>(kSize * row).noalias() +=
                                  inverses_[static_cast<std::size_t>(row)]
                                  * (r.template segment<kSize>(kSize * row)
                                     - product.template segment<kSize>(kSize * row));
                          }
                      });
    }
}

#define PENT_INSTANTIATE(Dim)               \
    template class GaussSeidel<Dim, float>; \
    template class GaussSeidel<Dim, double>;
PENT_FOR_EACH_DIMENSION(PENT_INSTANTIATE)
#undef PENT_INSTANTIATE

}  // namespace pent::simulator
