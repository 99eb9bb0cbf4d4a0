#include "linear/gauss_seidel.h"

#include "linear/coarse_solver.h"

#include <pent/dimensions.h>

#include <algorithm>

namespace pent::simulator {

namespace {

// Calls work(begin, end) for parts of the rows [begin, end), at the same time.
template <typename Work>
void for_each_part(const Workers& workers, std::int64_t begin, std::int64_t end, const Work& work) {
    constexpr std::int64_t kRows = 16;  // of a task
    workers.for_each((end - begin + kRows - 1) / kRows, [&](std::int64_t part) {
        work(begin + part * kRows, std::min(begin + (part + 1) * kRows, end));
    });
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
}

template <int Dim, typename Scalar>
void GaussSeidel<Dim, Scalar>::sweep_forth(const Workers& workers,
                                           const BlockKernels& kernels,
                                           const Vector& r,
                                           Vector& z,
                                           Vector& left) const {
    z.resize(r.size());
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
    A_->multiply(workers, kernels, BlockPart::AboveDiagonal, z, left);
    left = -left;
}

template <int Dim, typename Scalar>
void GaussSeidel<Dim, Scalar>::sweep_back(const Workers& workers,
                                          const BlockKernels& kernels,
                                          const Vector& r,
                                          Vector& z) const {
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
