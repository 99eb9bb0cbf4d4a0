#include "linear/stencil_assembly.h"

#include "elastic_box.h"

#include <gtest/gtest.h>

#include <algorithm>

namespace pent::simulator {
namespace {

using test::ElasticBox;

constexpr double kScale = 0.37;

// Random stencils over the vertices of a box of which some have no dof: a third with a whole matrix
// of its own, a third with values and vectors, the others with weights and one block; every fifth
// with a point that is none.
template <int Dim>
struct Stencils {
    ElasticBox<Dim> box{{.lame = {.lambda = 1, .mu = 1}}, {1, 4}};
    std::vector<std::vector<std::uint32_t>> vertices;
    std::vector<Eigen::VectorXd> weights;
    std::vector<Eigen::MatrixXd> matrices;
    std::vector<Eigen::VectorXd> spectra;
    std::vector<HessianStencil> list;
    Positions<Dim> displacement;

    explicit Stencils(int count) {
        std::mt19937 random(3);
        std::uniform_real_distribution<double> uniform(-1, 1);
        const auto any = [&] { return uniform(random); };
        const auto total = static_cast<std::uint32_t>(box.mesh.vertex_count());
        std::vector<std::uint32_t> all(total);
        for (std::uint32_t v = 0; v < total; ++v) {
            all[v] = v;
        }
        for (int s = 0; s < count; ++s) {
            std::shuffle(all.begin(), all.end(), random);
            const int corners = 1 + s % (Dim + 1);
            vertices.emplace_back(all.begin(), all.begin() + corners);
            if (s % 5 == 0) {
                vertices.back()[0] = kNoVertex;
            }
            weights.emplace_back(Eigen::VectorXd::NullaryExpr(corners, any));
            const Eigen::Index size = s % 3 < 2 ? Dim * corners : Dim;
            const Eigen::MatrixXd half = Eigen::MatrixXd::NullaryExpr(size, size, any);
            matrices.emplace_back(half + half.transpose());
            const Eigen::Index rank = 1 + s % (Dim * Dim);
            spectra.emplace_back(Eigen::VectorXd::NullaryExpr(rank * (1 + Dim * corners), any));
            if (s % 3 == 1) {
                matrices.back() = matrix_of(spectra.back(), rank);
            }
        }
        for (int s = 0; s < count; ++s) {
            const auto i = static_cast<std::size_t>(s);
            list.push_back({.vertices = vertices[i].data(),
                            .weights = s % 3 < 2 ? nullptr : weights[i].data(),
                            .numbers = s % 3 == 1 ? spectra[i].data() : matrices[i].data(),
                            .count = static_cast<std::int32_t>(vertices[i].size()),
                            .rank = s % 3 == 1 ? 1 + s % (Dim * Dim) : 0,
                            .stride = static_cast<std::int32_t>(matrices[i].rows()),
                            .scale = kScale});
        }
        displacement = Positions<Dim>::NullaryExpr(Dim, total, any);
    }

    static Eigen::MatrixXd matrix_of(const Eigen::VectorXd& spectrum, Eigen::Index rank) {
        const Eigen::Index corners = (spectrum.size() / rank - 1) / Dim;
        Eigen::MatrixXd matrix = Eigen::MatrixXd::Zero(Dim * corners, Dim * corners);
        for (Eigen::Index k = 0; k < rank; ++k) {
            Eigen::VectorXd vector(Dim * corners);
            for (Eigen::Index i = 0; i < corners; ++i) {
                vector.segment(Dim * i, Dim) = spectrum.segment(rank + Dim * (rank * i + k), Dim);
            }
            matrix += spectrum[k] * vector * vector.transpose();
        }
        return matrix;
    }

    // Their sum over all vertices, in the vertices' own order.
    [[nodiscard]] Eigen::MatrixXd oracle() const {
        const Eigen::Index size = Dim * box.mesh.vertex_count();
        Eigen::MatrixXd sum = Eigen::MatrixXd::Zero(size, size);
        for (std::size_t s = 0; s < list.size(); ++s) {
            for (int i = 0; i < list[s].count; ++i) {
                for (int j = 0; j < list[s].count; ++j) {
                    const std::uint32_t a = vertices[s][static_cast<std::size_t>(i)];
                    const std::uint32_t b = vertices[s][static_cast<std::size_t>(j)];
                    if (a == kNoVertex || b == kNoVertex) {
                        continue;
                    }
                    if (s % 3 < 2) {
                        sum.block<Dim, Dim>(Dim * a, Dim * b) +=
                            kScale * matrices[s].block<Dim, Dim>(Dim * i, Dim * j);
                    } else {
                        sum.block<Dim, Dim>(Dim * a, Dim * b) +=
                            kScale * weights[s][i] * weights[s][j] * matrices[s];
                    }
                }
            }
        }
        return sum;
    }
};

template <int Dim>
void expect_the_sum_over_stencils(int threads) {
    const Stencils<Dim> stencils(120);
    const DofMap& dofs = stencils.box.dofs;
    BlockMatrix<Dim, double> matrix(stencils.box.pattern);
    BlockVector<Dim> right = BlockVector<Dim>::Zero(Dim, stencils.box.pattern.rows());
    const auto coupling = assemble_stencils<Dim, double>(Workers(threads), dofs, stencils.list,
                                                         stencils.displacement, matrix, right);
    ASSERT_NE(coupling, nullptr);
    const Eigen::MatrixXd full = stencils.oracle();
    const auto dense = ElasticBox<Dim>::template dense<double>;
    const Eigen::MatrixXd sum = dense(matrix) + dense(coupling->matrix);
    const double size = full.norm();
    Eigen::VectorXd expected_right = Eigen::VectorXd::Zero(Dim * stencils.box.pattern.rows());
    for (std::uint32_t row = 0; row < dofs.count(); ++row) {
        const Eigen::Index at = Dim * dofs.vertex_of(row);
        for (std::uint32_t vertex = 0; vertex < dofs.vertex_count(); ++vertex) {
            const auto block = full.block<Dim, Dim>(at, Dim * vertex);
            if (dofs.has_dof(vertex)) {
                EXPECT_LT(
                    (sum.block<Dim, Dim>(Dim * row, Dim * dofs.dof_of(vertex)) - block).norm(),
                    1e-13 * size);
            } else {
                expected_right.segment<Dim>(Dim * row) -= block * stencils.displacement.col(vertex);
            }
        }
    }
    EXPECT_LT((right.reshaped() - expected_right).norm(), 1e-13 * size);
    EXPECT_GT(expected_right.norm(), 1e-2 * size);

    // Products include what is left over; what the pattern has a place for is in the first matrix.
    EXPECT_GT(dense(matrix).norm(), 0.1 * size);
    matrix.set_coupling(&coupling->matrix);
    const BlockVector<Dim> x = BlockVector<Dim>::Random(Dim, stencils.box.pattern.rows());
    BlockVector<Dim> product(Dim, x.cols());
    matrix.multiply(Workers(threads), kernels<Dim>(best_isa()).blocks, x, product);
    EXPECT_LT((product.reshaped() - sum * x.reshaped()).norm(), 1e-12 * size * x.norm());
}

TEST(StencilAssembly, IsTheSumOverStencilsLessTheShareOfVerticesWithoutDofs) {
    for (const int threads : {1, 3}) {
        expect_the_sum_over_stencils<3>(threads);
        expect_the_sum_over_stencils<4>(threads);
    }
}

TEST(StencilAssembly, LeavesNothingOverWhereThePatternHasAPlaceForEverything) {
    ElasticBox<4> box({.lame = {.lambda = 1, .mu = 1}}, {1});
    const Eigen::Matrix<double, 5, 1> weights(1, -0.25, -0.25, -0.25, -0.25);
    const Eigen::Matrix4d block = Eigen::Matrix4d::Identity();
    BlockMatrix<4, float> matrix(box.pattern);
    BlockVector<4> right = BlockVector<4>::Zero(4, box.pattern.rows());
    const Eigen::Matrix<std::uint32_t, 5, 1> corners = box.mesh.cells.col(0);
    const std::vector<HessianStencil> one = {{.vertices = corners.data(),
                                              .weights = weights.data(),
                                              .numbers = block.data(),
                                              .count = 5,
                                              .stride = 4}};
    const Positions<4> still = Positions<4>::Zero(4, box.mesh.vertex_count());
    for (const std::vector<HessianStencil>& stencils : {one, std::vector<HessianStencil>()}) {
        const auto coupling =
            assemble_stencils<4, float>(Workers(1), box.dofs, stencils, still, matrix, right);
        EXPECT_EQ(coupling, nullptr);
    }
    EXPECT_GT(ElasticBox<4>::dense(matrix).norm(), 1);
}

TEST(StencilAssembly, IsTheSameToTheBitForAnyNumberOfThreads) {
    const Stencils<4> stencils(400);
    std::vector<Eigen::MatrixXd> sums;
    for (const int threads : {1, 2, 3, 8}) {
        BlockMatrix<4, double> matrix(stencils.box.pattern);
        BlockVector<4> right = BlockVector<4>::Zero(4, stencils.box.pattern.rows());
        const auto coupling =
            assemble_stencils<4, double>(Workers(threads), stencils.box.dofs, stencils.list,
                                         stencils.displacement, matrix, right);
        sums.emplace_back(ElasticBox<4>::dense(matrix) + ElasticBox<4>::dense(coupling->matrix));
        EXPECT_EQ(sums.back(), sums.front()) << threads;
    }
}

}  // namespace
}  // namespace pent::simulator
