#include "linear/preconditioner.h"

#include <pent/dimensions.h>

#include <Eigen/Cholesky>

#include <algorithm>
#include <array>

namespace pent::simulator {

namespace {

constexpr std::size_t kChunkColumns = 128;

// Layers this far apart in a column may be coupled: 1 by linear elements, 2 by smoothed and by
// quadratic ones.
constexpr std::uint32_t kMaxBand = 2;

// Banded block L D L^T of each column: with A_k,k+j the coupling of layers k and k + j <= k + band,
//   D_k = A_kk - sum over m of S_(k-m),k^T D_(k-m)^-1 S_(k-m),k
//   S_k,k+j = A_k,k+j - sum over m of S_(k-m),k^T D_(k-m)^-1 S_(k-m),k+j,   E_k,j = D_k^-1 S_k,k+j.
template <int Dim>
class ColumnJacobi final : public Preconditioner<Dim> {
public:
    template <typename Scalar>
    ColumnJacobi(const Workers& workers,
                 const BlockMatrix<Dim, Scalar>& matrix,
                 const std::vector<std::uint32_t>& column_start)
        : column_start_(&column_start),
          band_(band_of(matrix.pattern(), column_start)),
          inverses_(static_cast<std::size_t>(matrix.rows())),
          couplings_(static_cast<std::size_t>(matrix.rows()) * band_) {
        for_each_column(workers, [&](std::uint32_t begin, std::uint32_t end) {
            if (!factor(matrix, begin, end)) {
                factor_alone(matrix, begin, end);
            }
        });
    }

    void apply(const Workers& workers,
               const BlockVector<Dim>& r,
               BlockVector<Dim>& z) const override {
        for_each_column(workers, [&](std::uint32_t begin, std::uint32_t end) {
            for (std::uint32_t k = begin; k < end; ++k) {
                Vector value = r.col(k);
                for (std::uint32_t m = 1; m <= std::min(band_, k - begin); ++m) {
                    value.noalias() -=
                        scaled(k - m, m).template cast<double>().transpose() * z.col(k - m);
                }
                z.col(k) = value;
            }
            for (std::uint32_t k = end; k-- > begin;) {
                Vector value = inverses_[k].template cast<double>() * z.col(k);
                for (std::uint32_t j = 1; j <= std::min(band_, end - 1 - k); ++j) {
                    value.noalias() -= scaled(k, j).template cast<double>() * z.col(k + j);
                }
                z.col(k) = value;
            }
        });
    }

private:
    using Vector = Eigen::Matrix<double, Dim, 1>;
    using Block = Eigen::Matrix<double, Dim, Dim>;
    using Stored = Eigen::Matrix<float, Dim, Dim>;

    template <typename Work>
    void for_each_column(const Workers& workers, const Work& work) const {
        const std::size_t columns = column_start_->size() - 1;
        workers.for_each(
            static_cast<int>((columns + kChunkColumns - 1) / kChunkColumns), [&](int chunk) {
                const std::size_t first = static_cast<std::size_t>(chunk) * kChunkColumns;
                const std::size_t last = std::min(first + kChunkColumns, columns);
                for (std::size_t c = first; c < last; ++c) {
                    work((*column_start_)[c], (*column_start_)[c + 1]);
                }
            });
    }

    // How far apart in one column dofs are coupled.
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

    template <typename Scalar>
    static Block coupling(const BlockMatrix<Dim, Scalar>& matrix,
                          std::uint32_t row,
                          std::uint32_t column) {
        const std::int64_t at = find(matrix.pattern(), row, column);
        return at >= 0 ? Block(matrix.block(at).template cast<double>()) : Block(Block::Zero());
    }

    // E_k,j.
    [[nodiscard]] Stored& scaled(std::uint32_t k, std::uint32_t j) {
        return couplings_[std::size_t{k} * band_ + j - 1];
    }
    [[nodiscard]] const Stored& scaled(std::uint32_t k, std::uint32_t j) const {
        return couplings_[std::size_t{k} * band_ + j - 1];
    }

    static bool invert(const Block& block, Stored& inverse) {
        const Eigen::LLT<Block> factors(block);
        const Block solved = factors.solve(Block::Identity());
        // Symmetric to the bit, as conjugate gradients want it.
        inverse = (0.5 * (solved + solved.transpose())).template cast<float>();
        return factors.info() == Eigen::Success && solved.allFinite();
    }

    // Rows of one dof in its column's factors: toward the j-th behind it.
    struct Row {
        std::array<Block, kMaxBand> plain;   // S
        std::array<Block, kMaxBand> scaled;  // D^-1 S
    };

    // False if the column, taken out of the matrix, is not positive definite: that cannot be unless
    // layers further apart than the band are coupled.
    template <typename Scalar>
    bool factor(const BlockMatrix<Dim, Scalar>& matrix, std::uint32_t begin, std::uint32_t end) {
        std::array<Row, kMaxBand + 1> rows;  // the last ones
        for (std::uint32_t k = begin; k < end; ++k) {
            const auto row_above = [&](std::uint32_t m) -> const Row& {
                return rows[(k - m) % rows.size()];
            };
            const std::uint32_t above = std::min(band_, k - begin);
            Block diagonal = matrix.diagonal(k).template cast<double>();
            for (std::uint32_t m = 1; m <= above; ++m) {
                const Row& row = row_above(m);
                diagonal.noalias() -= row.plain[m - 1].transpose() * row.scaled[m - 1];
            }
            diagonal = (0.5 * (diagonal + diagonal.transpose())).eval();
            if (!invert(diagonal, inverses_[k])) {
                return false;
            }
            const Eigen::LLT<Block> factors(diagonal);
            for (std::uint32_t j = 1; j <= band_; ++j) {
                Block next = k + j < end ? coupling(matrix, k, k + j) : Block(Block::Zero());
                for (std::uint32_t m = 1; m <= above && m + j <= band_; ++m) {
                    const Row& row = row_above(m);
                    next.noalias() -= row.scaled[m - 1].transpose() * row.plain[m + j - 1];
                }
                Row& own = rows[k % rows.size()];
                own.plain[j - 1] = next;
                own.scaled[j - 1] = factors.solve(next);
                scaled(k, j) = own.scaled[j - 1].template cast<float>();
            }
        }
        return true;
    }

    // Plain block Jacobi for one column.
    template <typename Scalar>
    void factor_alone(const BlockMatrix<Dim, Scalar>& matrix,
                      std::uint32_t begin,
                      std::uint32_t end) {
        for (std::uint32_t k = begin; k < end; ++k) {
            for (std::uint32_t j = 1; j <= band_; ++j) {
                scaled(k, j).setZero();
            }
            if (!invert(matrix.diagonal(k).template cast<double>(), inverses_[k])) {
                inverses_[k].setIdentity();
            }
        }
    }

    const std::vector<std::uint32_t>* column_start_;
    std::uint32_t band_;
    std::vector<Stored> inverses_;   // D_k^-1
    std::vector<Stored> couplings_;  // E_k,j, `band_` a dof
};

}  // namespace

template <int Dim, typename Scalar>
std::unique_ptr<Preconditioner<Dim>> column_jacobi(const Workers& workers,
                                                   const BlockMatrix<Dim, Scalar>& matrix,
                                                   const std::vector<std::uint32_t>& column_start) {
    return std::make_unique<ColumnJacobi<Dim>>(workers, matrix, column_start);
}

#define PENT_INSTANTIATE(Dim, Scalar)                            \
    template std::unique_ptr<Preconditioner<Dim>> column_jacobi( \
        const Workers&, const BlockMatrix<Dim, Scalar>&, const std::vector<std::uint32_t>&);
PENT_FOR_EACH_DIMENSION(PENT_INSTANTIATE, float)
PENT_FOR_EACH_DIMENSION(PENT_INSTANTIATE, double)
#undef PENT_INSTANTIATE

}  // namespace pent::simulator
