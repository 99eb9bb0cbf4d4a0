#include "linear/coarse_solver.h"

#include <pent/dimensions.h>

#include <algorithm>
#include <limits>
#include <utility>

namespace pent::simulator {

namespace {

// The connected components of the aggregates.
std::vector<std::vector<std::uint32_t>> components_of(const AggregatePattern& pattern) {
    std::vector<std::vector<std::uint32_t>> components;
    std::vector<bool> is_seen(static_cast<std::size_t>(pattern.rows()), false);
    for (std::uint32_t root = 0; root < is_seen.size(); ++root) {
        if (is_seen[root]) {
            continue;
        }
        is_seen[root] = true;
        std::vector<std::uint32_t> rows = {root};
        for (std::size_t next = 0; next < rows.size(); ++next) {
            for_each_in_row(pattern, rows[next],
                            [&](std::uint32_t column, std::int64_t /*block*/, bool /*transposed*/) {
                                if (!is_seen[column]) {
                                    is_seen[column] = true;
                                    rows.push_back(column);
                                }
                            });
        }
        std::sort(rows.begin(), rows.end());
        components.push_back(std::move(rows));
    }
    return components;
}

// How many blocks a row has in both triangles.
std::int64_t blocks_of(const AggregatePattern& pattern, std::uint32_t row) {
    return pattern.row_start[row + 1] - pattern.row_start[row] + pattern.above_start[row + 1]
           - pattern.above_start[row];
}

// Some rows as a dense matrix: the lower triangle, which is all that a factorization reads.
template <int Dim, typename Scalar>
Eigen::MatrixXd dense(const AggregateMatrix<Dim, Scalar>& A,
                      const std::vector<std::uint32_t>& rows) {
    constexpr int kSize = kModes<Dim>;
    const auto size = static_cast<Eigen::Index>(kSize * rows.size());
    Eigen::MatrixXd part = Eigen::MatrixXd::Zero(size, size);
    for (std::size_t i = 0; i < rows.size(); ++i) {
        const auto begin = static_cast<std::size_t>(A.pattern->row_start[rows[i]]);
        const auto end = static_cast<std::size_t>(A.pattern->row_start[rows[i] + 1]);
        for (std::size_t k = begin; k < end; ++k) {
            const auto j =
                std::lower_bound(rows.begin(), rows.end(), A.pattern->columns[k]) - rows.begin();
            part.block<kSize, kSize>(kSize * static_cast<Eigen::Index>(i), kSize * j) =
                A.block(static_cast<std::int64_t>(k)).template cast<double>();
        }
    }
    return part;
}

}  // namespace

template <int Dim, typename Scalar>
CoarseSolver<Dim, Scalar>::CoarseSolver(const Workers& workers,
                                        const AggregateMatrix<Dim, Scalar>& A) {
    for (std::vector<std::uint32_t>& rows : components_of(*A.pattern)) {
        components_.push_back({std::move(rows), {}, {}});
    }
    workers.for_each(components_.size(), [&](std::size_t c) {
        Component& component = components_[c];
        if (component.rows.size() <= kMaxDense) {
            Eigen::MatrixXd part = dense(A, component.rows);
            make_definite<Scalar>(part);
            component.factors.compute(part);
            if (component.factors.info() == Eigen::Success) {
                return;
            }
        }
        for (const std::uint32_t row : component.rows) {
            component.inverses.push_back(inverse_of_diagonal(A, row)
                                         / static_cast<double>(blocks_of(*A.pattern, row)));
        }
    });
}

template <int Dim, typename Scalar>
void CoarseSolver<Dim, Scalar>::solve(const Workers& workers, const Vector& r, Vector& z) const {
    constexpr int kSize = kModes<Dim>;
    z.resize(r.size());
    workers.for_each(components_.size(), [&](std::size_t c) {
        const Component& component = components_[c];
        const auto& rows = component.rows;
        if (!component.inverses.empty()) {
            for (std::size_t i = 0; i < rows.size(); ++i) {
                const Eigen::Matrix<double, kSize, 1> part =
                    r.template segment<kSize>(kSize * rows[i]).template cast<double>();
                z.template segment<kSize>(kSize * rows[i]) =
                    (component.inverses[i] * part).template cast<Scalar>();
            }
            return;
        }
        Eigen::VectorXd part(static_cast<Eigen::Index>(kSize * rows.size()));
        for (std::size_t i = 0; i < rows.size(); ++i) {
            part.segment<kSize>(kSize * static_cast<Eigen::Index>(i)) =
                r.template segment<kSize>(kSize * rows[i]).template cast<double>();
        }
        component.factors.solveInPlace(part);
        for (std::size_t i = 0; i < rows.size(); ++i) {
            z.template segment<kSize>(kSize * rows[i]) =
                part.segment<kSize>(kSize * static_cast<Eigen::Index>(i)).template cast<Scalar>();
        }
    });
}

template <int Dim, typename Scalar>
Eigen::Matrix<double, kModes<Dim>, kModes<Dim>> inverse_of_diagonal(
    const AggregateMatrix<Dim, Scalar>& A, std::uint32_t row) {
    using Block = Eigen::Matrix<double, kModes<Dim>, kModes<Dim>>;
    Block block = A.block(A.pattern->diagonal[row]).template cast<double>();
    make_definite<Scalar>(block);
    const Eigen::LLT<Block> factors(block);
    const Block solved = factors.solve(Block::Identity());
    if (factors.info() != Eigen::Success || !solved.allFinite()) {
        return block.diagonal().cwiseInverse().asDiagonal();
    }
    return 0.5 * (solved + solved.transpose());
}

#define PENT_INSTANTIATE(Dim, Scalar)                                             \
    template class CoarseSolver<Dim, Scalar>;                                     \
    template Eigen::Matrix<double, kModes<Dim>, kModes<Dim>> inverse_of_diagonal( \
        const AggregateMatrix<Dim, Scalar>&, std::uint32_t);
PENT_FOR_EACH_DIMENSION(PENT_INSTANTIATE, float)
PENT_FOR_EACH_DIMENSION(PENT_INSTANTIATE, double)
#undef PENT_INSTANTIATE

}  // namespace pent::simulator
