#pragma once

#include "linear/aggregate_matrix.h"
#include "springy_box.h"

#include <random>
#include <utility>
#include <vector>

namespace pent::simulator::test {

inline constexpr int kModeCount = kModes<4>;

inline Aggregates stripes(std::uint32_t children, std::uint32_t pieces) {
    std::vector<std::uint32_t> of_child;
    for (std::uint32_t child = 0; child < children; ++child) {
        of_child.push_back(child * 7 % pieces);
    }
    return {std::move(of_child), pieces};
}

inline Aggregates by_number(std::uint32_t children, std::uint32_t most) {
    std::vector<std::uint32_t> of_child;
    for (std::uint32_t child = 0; child < children; ++child) {
        of_child.push_back(child / most);
    }
    return {std::move(of_child), (children + most - 1) / most};
}

inline Arms<4> random_arms(std::size_t count, unsigned seed) {
    std::mt19937 random(seed);
    std::normal_distribution<double> normal;
    Arms<4> arms(count);
    for (Arm<4>& arm : arms) {
        arm.x = Eigen::Vector4d::NullaryExpr([&] { return normal(random); });
        arm.ratio = 0.5 + std::abs(normal(random));
    }
    return arms;
}

// All modes of all aggregates as columns, from their definition.
inline Eigen::MatrixXd dense_modes(const Aggregates& aggregates, const Arms<4>& arms, int rows) {
    Eigen::MatrixXd P = Eigen::MatrixXd::Zero(rows * static_cast<Eigen::Index>(arms.size()),
                                              kModeCount * aggregates.count());
    for (std::size_t child = 0; child < arms.size(); ++child) {
        const Eigen::Index row = rows * static_cast<Eigen::Index>(child);
        const Eigen::Index column = kModeCount * aggregates.of_child()[child];
        P.block<4, 4>(row, column).setIdentity();
        int k = 4;
        for (int p = 0; p < 4; ++p) {
            for (int q = p + 1; q < 4; ++q, ++k) {
                P(row + q, column + k) = arms[child].x[p];
                P(row + p, column + k) = -arms[child].x[q];
                if (rows > 4) {
                    P(row + k, column + k) = arms[child].ratio;
                }
            }
        }
    }
    return P;
}

template <int Dim, typename Scalar>
Eigen::MatrixXd dense(const AggregateMatrix<Dim, Scalar>& A) {
    constexpr int kSize = kModes<Dim>;
    const Eigen::Index rows = A.pattern->rows();
    Eigen::MatrixXd full = Eigen::MatrixXd::Zero(kSize * rows, kSize * rows);
    for (Eigen::Index row = 0; row < rows; ++row) {
        for (std::int64_t k = A.pattern->row_start[static_cast<std::size_t>(row)];
             k < A.pattern->row_start[static_cast<std::size_t>(row) + 1]; ++k) {
            const Eigen::Index column = A.pattern->columns[static_cast<std::size_t>(k)];
            const Eigen::MatrixXd block = A.block(k).template cast<double>();
            full.block<kSize, kSize>(kSize * column, kSize * row) = block.transpose();
            full.block<kSize, kSize>(kSize * row, kSize * column) = block;
        }
    }
    return full;
}

// Two levels of the matrix of a box with a spring between far corners.
template <typename Scalar>
struct TwoLevels {
    SpringyBox problem;
    const BlockMatrix<4, Scalar>& A;
    Aggregates fine;
    Aggregates coarse = stripes(9, 4);
    Arms<4> fine_arms;
    Arms<4> coarse_arms = random_arms(9, 2);
    AggregatePattern fine_pattern;
    AggregatePattern coarse_pattern;
    AggregateMatrix<4, Scalar> first;
    AggregateMatrix<4, Scalar> second;

    explicit TwoLevels(Precision precision, int threads = 2, Isa isa = Isa::Baseline)
        : problem(precision),
          A(std::get<BlockMatrix<4, Scalar>>(problem.system.matrix())),
          fine(stripes(static_cast<std::uint32_t>(A.rows()), 9)),
          fine_arms(random_arms(static_cast<std::size_t>(A.rows()), 1)),
          fine_pattern(make_aggregate_pattern(fine, A.pattern(), &A.coupling()->pattern())),
          coarse_pattern(make_aggregate_pattern(coarse, fine_pattern)) {
        const Workers workers(threads);
        const BlockKernels& blocks = kernels<4>(isa).blocks;
        first = galerkin_product(workers, blocks, A, fine, fine_arms, fine_pattern);
        second = galerkin_product(workers, blocks, first, coarse, coarse_arms, coarse_pattern);
    }
};

}  // namespace pent::simulator::test
