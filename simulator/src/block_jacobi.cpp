#include "preconditioner.h"

#include <Eigen/LU>

namespace pent::simulator {

namespace {

template <int Dim>
class BlockJacobi final : public Preconditioner<Dim> {
public:
    template <typename Scalar>
    BlockJacobi(const Workers& workers, const BlockMatrix<Dim, Scalar>& matrix)
        : inverses_(static_cast<std::size_t>(matrix.rows())) {
        matrix.for_each_row_chunk(workers, [&](std::int64_t begin, std::int64_t end) {
            for (std::int64_t row = begin; row < end; ++row) {
                const Block block = matrix.diagonal(row).template cast<double>();
                inverses_[static_cast<std::size_t>(row)] = block.inverse();
            }
        });
    }

    void apply(const Workers& workers,
               const BlockVector<Dim>& r,
               BlockVector<Dim>& z) const override {
        constexpr std::int64_t kChunk = BlockPattern::kChunkRows;
        const auto rows = static_cast<std::int64_t>(inverses_.size());
        workers.for_each(static_cast<int>((rows + kChunk - 1) / kChunk), [&](int chunk) {
            const std::int64_t end = std::min((chunk + 1) * kChunk, rows);
            for (std::int64_t row = chunk * kChunk; row < end; ++row) {
                z.col(row).noalias() = inverses_[static_cast<std::size_t>(row)] * r.col(row);
            }
        });
    }

private:
    using Block = Eigen::Matrix<double, Dim, Dim>;
    std::vector<Block> inverses_;
};

}  // namespace

template <int Dim, typename Scalar>
std::unique_ptr<Preconditioner<Dim>> block_jacobi(const Workers& workers,
                                                  const BlockMatrix<Dim, Scalar>& matrix) {
    return std::make_unique<BlockJacobi<Dim>>(workers, matrix);
}

template std::unique_ptr<Preconditioner<3>> block_jacobi(const Workers&,
                                                         const BlockMatrix<3, float>&);
template std::unique_ptr<Preconditioner<3>> block_jacobi(const Workers&,
                                                         const BlockMatrix<3, double>&);
template std::unique_ptr<Preconditioner<4>> block_jacobi(const Workers&,
                                                         const BlockMatrix<4, float>&);
template std::unique_ptr<Preconditioner<4>> block_jacobi(const Workers&,
                                                         const BlockMatrix<4, double>&);

}  // namespace pent::simulator
