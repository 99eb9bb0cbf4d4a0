#include "linear/preconditioner.h"

#include <Eigen/Cholesky>

#include <algorithm>

namespace pent::simulator {

namespace {

constexpr std::size_t kChunkColumns = 128;

// Block-tridiagonal L D L^T of each column: with T_k the coupling of layers k and k + 1,
//   D_0 = A_00,  D_k = A_kk - T_(k-1)^T D_(k-1)^-1 T_(k-1),  E_k = D_k^-1 T_k.
template <int Dim>
class ColumnJacobi final : public Preconditioner<Dim> {
public:
    template <typename Scalar>
    ColumnJacobi(const Workers& workers,
                 const BlockMatrix<Dim, Scalar>& matrix,
                 const std::vector<std::uint32_t>& column_start)
        : column_start_(&column_start),
          inverses_(static_cast<std::size_t>(matrix.rows())),
          couplings_(static_cast<std::size_t>(matrix.rows())) {
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
            z.col(begin) = r.col(begin);
            for (std::uint32_t k = begin + 1; k < end; ++k) {
                z.col(k).noalias() =
                    r.col(k) - couplings_[k - 1].template cast<double>().transpose() * z.col(k - 1);
            }
            Vector above = Vector::Zero();
            for (std::uint32_t k = end; k-- > begin;) {
                Vector value = inverses_[k].template cast<double>() * z.col(k);
                if (k + 1 < end) {
                    value.noalias() -= couplings_[k].template cast<double>() * above;
                }
                z.col(k) = value;
                above = value;
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

    // The block that couples an unknown with the next one; zero if they share no cell.
    template <typename Scalar>
    static Block coupling(const BlockMatrix<Dim, Scalar>& matrix, std::uint32_t k) {
        const BlockPattern& pattern = matrix.pattern();
        const std::int64_t next = pattern.row_start[k] + 1;  // the lowest column above the diagonal
        const bool is_there = next < pattern.row_start[k + 1]
                              && pattern.columns[static_cast<std::size_t>(next)] == k + 1;
        return is_there ? Block(matrix.block(next).template cast<double>()) : Block(Block::Zero());
    }

    static bool invert(const Block& block, Stored& inverse) {
        const Eigen::LLT<Block> factors(block);
        const Block solved = factors.solve(Block::Identity());
        // Symmetric to the bit, as conjugate gradients want it.
        inverse = (0.5 * (solved + solved.transpose())).template cast<float>();
        return factors.info() == Eigen::Success && solved.allFinite();
    }

    // False if the column, taken out of the matrix, is not positive definite: that cannot be unless
    // layers two apart are coupled, which an extruded mesh does not have.
    template <typename Scalar>
    bool factor(const BlockMatrix<Dim, Scalar>& matrix, std::uint32_t begin, std::uint32_t end) {
        Block diagonal = matrix.diagonal(begin).template cast<double>();
        for (std::uint32_t k = begin;; ++k) {
            if (!invert(diagonal, inverses_[k])) {
                return false;
            }
            couplings_[k].setZero();
            if (k + 1 == end) {
                return true;
            }
            const Block next = coupling(matrix, k);
            const Block scaled = diagonal.llt().solve(next);
            couplings_[k] = scaled.template cast<float>();
            diagonal = matrix.diagonal(k + 1).template cast<double>();
            diagonal.noalias() -= next.transpose() * scaled;
            diagonal = (0.5 * (diagonal + diagonal.transpose())).eval();
        }
    }

    // Plain block Jacobi for one column.
    template <typename Scalar>
    void factor_alone(const BlockMatrix<Dim, Scalar>& matrix,
                      std::uint32_t begin,
                      std::uint32_t end) {
        for (std::uint32_t k = begin; k < end; ++k) {
            couplings_[k].setZero();
            if (!invert(matrix.diagonal(k).template cast<double>(), inverses_[k])) {
                inverses_[k].setIdentity();
            }
        }
    }

    const std::vector<std::uint32_t>* column_start_;
    std::vector<Stored> inverses_;   // D_k^-1
    std::vector<Stored> couplings_;  // E_k
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
PENT_INSTANTIATE(3, float)
PENT_INSTANTIATE(3, double)
PENT_INSTANTIATE(4, float)
PENT_INSTANTIATE(4, double)
#undef PENT_INSTANTIATE

}  // namespace pent::simulator
