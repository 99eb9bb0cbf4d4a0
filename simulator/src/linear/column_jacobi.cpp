#include "linear/preconditioner.h"

#include <pent/dimensions.h>

#include <Eigen/Cholesky>

#include <algorithm>
#include <cstddef>
#include <cstdint>

namespace pent::simulator {

namespace {

constexpr std::int64_t kChunkColumns = 128;

// Layers this far apart in a column may be coupled: 1 by linear elements, 2 by smoothed and by
// quadratic ones.
constexpr std::uint32_t kMaxBand = 2;

template <int Dim>
class ColumnJacobi final : public Preconditioner<Dim> {
public:
    template <typename Scalar>
    ColumnJacobi(const Workers& workers,
                 const BlockKernels& kernels,
                 const BlockMatrix<Dim, Scalar>& matrix,
                 const std::vector<std::uint32_t>& column_start)
        : kernels_(&kernels),
          column_start_(&column_start),
          band_(band_of(matrix.pattern(), column_start)),
          inverses_(static_cast<std::size_t>(matrix.rows()) * kEntries),
          couplings_(static_cast<std::size_t>(matrix.rows()) * band_ * kEntries) {
        std::vector<std::uint8_t> has_failed(column_start.size() - 1);
        workers.for_each(chunks(), [&](std::int64_t chunk) {
            const Range range = columns_of(chunk);
            factor(matrix,
                   {column_start.data(), band_, inverses_.data(), couplings_.data(), range.begin,
                    range.end},
                   has_failed.data());
            for (std::int64_t c = range.begin; c < range.end; ++c) {
                if (has_failed[static_cast<std::size_t>(c)] != 0) {
                    factor_alone(matrix, column_start[static_cast<std::size_t>(c)],
                                 column_start[static_cast<std::size_t>(c) + 1]);
                }
            }
        });
    }

    double apply(const Workers& workers,
                 const BlockVector<Dim>& r,
                 BlockVector<Dim>& z) const override {
        const std::vector<std::uint32_t>& start = *column_start_;
        return workers.sum(chunks(), [&](std::int64_t chunk) -> double {
            const Range columns = columns_of(chunk);
            kernels_->solve_columns({start.data(), band_, inverses_.data(), couplings_.data(),
                                     columns.begin, columns.end},
                                    r.data(), z.data());
            const Eigen::Index first = start[static_cast<std::size_t>(columns.begin)];
            const Eigen::Index count = start[static_cast<std::size_t>(columns.end)] - first;
            return r.middleCols(first, count).cwiseProduct(z.middleCols(first, count)).sum();
        });
    }

private:
    static constexpr std::size_t kEntries = std::size_t{Dim} * Dim;
    using Block = Eigen::Matrix<double, Dim, Dim>;
    using Floats = std::vector<float, LineAllocator<float>>;

    struct Range {
        std::int64_t begin;
        std::int64_t end;
    };

    [[nodiscard]] std::int64_t columns() const {
        return static_cast<std::int64_t>(column_start_->size()) - 1;
    }
    [[nodiscard]] std::int64_t chunks() const {
        return (columns() + kChunkColumns - 1) / kChunkColumns;
    }
    [[nodiscard]] Range columns_of(std::int64_t chunk) const {
        return {chunk * kChunkColumns, std::min((chunk + 1) * kChunkColumns, columns())};
    }

    // How many layers apart dofs of one column are coupled.
    static std::uint32_t band_of(const BlockPattern& pattern,
                                 const std::vector<std::uint32_t>& column_start) {
        std::uint32_t band = 0;
        for (std::size_t c = 0; c + 1 < column_start.size() && band < kMaxBand; ++c) {
            for (std::uint32_t k = column_start[c]; k < column_start[c + 1]; ++k) {
                const std::uint32_t most = std::min(kMaxBand, column_start[c + 1] - 1 - k);
                for (std::uint32_t j = band + 1; j <= most; ++j) {
                    band = find(pattern, k, k + j) >= 0 ? j : band;
                }
            }
        }
        return band;
    }

    // Index of a block a little above the diagonal, where columns increase; -1 if it is not there.
    static std::int64_t find(const BlockPattern& pattern, std::uint32_t row, std::uint32_t column) {
        for (std::int64_t k = pattern.row_start[row] + 1; k < pattern.row_start[row + 1]; ++k) {
            const std::uint32_t at = pattern.columns[static_cast<std::size_t>(k)];
            if (at >= column) {
                return at == column ? k : -1;
            }
        }
        return -1;
    }

    void factor(const BlockMatrix<Dim, float>& matrix,
                const ColumnFactors<float>& factors,
                std::uint8_t* has_failed) const {
        kernels_->factor_columns_float(matrix.all_rows(), factors, has_failed);
    }
    void factor(const BlockMatrix<Dim, double>& matrix,
                const ColumnFactors<float>& factors,
                std::uint8_t* has_failed) const {
        kernels_->factor_columns_double(matrix.all_rows(), factors, has_failed);
    }

    // Plain block Jacobi for one column, whose banded part is not positive definite: in a positive
    // definite matrix that takes couplings of layers further apart than the band.
    template <typename Scalar>
    void factor_alone(const BlockMatrix<Dim, Scalar>& matrix,
                      std::uint32_t begin,
                      std::uint32_t end) {
        const auto first =
            couplings_.begin() + static_cast<std::ptrdiff_t>(begin * band_ * kEntries);
        std::fill_n(first, (end - begin) * band_ * kEntries, 0.0F);
        for (std::uint32_t k = begin; k < end; ++k) {
            const Block diagonal = matrix.diagonal(k).template cast<double>();
            const Eigen::LLT<Block> factors(diagonal);
            Block solved = factors.solve(Block::Identity());
            if (factors.info() != Eigen::Success || !solved.allFinite()) {
                solved.setIdentity();
            }
            // Symmetric to the bit, as conjugate gradients want it.
            write_block<Dim, float>((0.5 * (solved + solved.transpose())).template cast<float>(),
                                    inverses_.data() + k * kEntries);
        }
    }

    const BlockKernels* kernels_;
    const std::vector<std::uint32_t>* column_start_;
    std::size_t band_;
    Floats inverses_;   // D_k^-1
    Floats couplings_;  // E_k,j, band_ of them for each dof
};

}  // namespace

template <int Dim, typename Scalar>
std::unique_ptr<Preconditioner<Dim>> column_jacobi(const Workers& workers,
                                                   const BlockKernels& kernels,
                                                   const BlockMatrix<Dim, Scalar>& matrix,
                                                   const std::vector<std::uint32_t>& column_start) {
    return std::make_unique<ColumnJacobi<Dim>>(workers, kernels, matrix, column_start);
}

#define PENT_INSTANTIATE(Dim, Scalar)                                         \
    template std::unique_ptr<Preconditioner<Dim>> column_jacobi(              \
        const Workers&, const BlockKernels&, const BlockMatrix<Dim, Scalar>&, \
        const std::vector<std::uint32_t>&);
PENT_FOR_EACH_DIMENSION(PENT_INSTANTIATE, float)
PENT_FOR_EACH_DIMENSION(PENT_INSTANTIATE, double)
#undef PENT_INSTANTIATE

}  // namespace pent::simulator
