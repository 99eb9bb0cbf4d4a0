#include "spectra_lanes.h"

#include "lanes.h"

#include <Eigen/Eigenvalues>
#include <gtest/gtest.h>

#include <array>
#include <cmath>
#include <limits>
#include <random>
#include <vector>

namespace pent::contact {
namespace {

constexpr std::array<LanesIsa, 3> kAll{LanesIsa::Baseline, LanesIsa::Avx2, LanesIsa::Avx512};

using Batch = std::vector<Eigen::MatrixXd>;  // kSpectra symmetric matrices of one size

struct Found {
    std::vector<Eigen::VectorXd> values;
    std::vector<Eigen::MatrixXd> vectors;
};

// Only what is above the diagonals and on them is handed over.
Found find(LanesIsa isa, const Batch& batch) {
    const auto size = static_cast<std::size_t>(batch[0].rows());
    const auto place = [&](Eigen::Index row, Eigen::Index column, std::size_t lane) {
        return (size * static_cast<std::size_t>(row) + static_cast<std::size_t>(column)) * kSpectra
               + lane;
    };
    std::vector<double> matrices(size * size * kSpectra, std::nan(""));
    std::vector<double> vectors = matrices;
    const auto n = static_cast<Eigen::Index>(size);
    for (std::size_t lane = 0; lane < kSpectra; ++lane) {
        for (Eigen::Index i = 0; i < n; ++i) {
            for (Eigen::Index j = i; j < n; ++j) {
                matrices[place(i, j, lane)] = batch[lane](i, j);
            }
        }
    }
    lanes_kernels<4>(isa).find_spectra(static_cast<int>(size), matrices.data(), vectors.data());
    Found found;
    for (std::size_t lane = 0; lane < kSpectra; ++lane) {
        found.values.emplace_back(n);
        found.vectors.emplace_back(n, n);
        for (Eigen::Index i = 0; i < n; ++i) {
            found.values[lane][i] = matrices[place(i, i, lane)];
            for (Eigen::Index j = 0; j < n; ++j) {
                found.vectors[lane](j, i) = vectors[place(i, j, lane)];
            }
        }
    }
    return found;
}

// In units of the norm of the matrix: some tens of roundings.
constexpr double kRounding = 3e-14;

void expect_spectrum(const Eigen::MatrixXd& matrix,
                     const Eigen::VectorXd& values,
                     const Eigen::MatrixXd& vectors) {
    const auto n = matrix.rows();
    const double most = std::max(matrix.cwiseAbs().maxCoeff(), std::numeric_limits<double>::min());
    const Eigen::MatrixXd unit = matrix / most;  // where squares of its numbers exist
    EXPECT_LT((vectors.transpose() * vectors - Eigen::MatrixXd::Identity(n, n)).norm(), kRounding);
    EXPECT_LE((vectors * (values / most).asDiagonal() * vectors.transpose() - unit).norm(),
              kRounding * unit.norm());
    Eigen::VectorXd sorted = values / most;
    std::sort(sorted.begin(), sorted.end());
    const Eigen::SelfAdjointEigenSolver<Eigen::MatrixXd> solver(unit, Eigen::EigenvaluesOnly);
    EXPECT_LE((sorted - solver.eigenvalues()).norm(), kRounding * unit.norm());
}

class SpectraLanes : public testing::TestWithParam<LanesIsa> {
protected:
    void SetUp() override {
        if (!is_supported(GetParam())) {
            GTEST_SKIP() << "not on this machine";
        }
    }

    [[nodiscard]] Eigen::MatrixXd matrix(Eigen::Index size, Eigen::Index rank) {
        Eigen::MatrixXd sum = Eigen::MatrixXd::Zero(size, size);
        for (Eigen::Index k = 0; k < rank; ++k) {
            const Eigen::VectorXd vector =
                Eigen::VectorXd::NullaryExpr(size, [&] { return number(); });
            sum += number() * vector * vector.transpose();
        }
        return sum;
    }
    double number() { return normal_(random_); }

    void expect_all(const Batch& batch) {
        const Found found = find(GetParam(), batch);
        for (std::size_t lane = 0; lane < kSpectra; ++lane) {
            expect_spectrum(batch[lane], found.values[lane], found.vectors[lane]);
        }
    }

private:
    std::mt19937 random_{7};
    std::normal_distribution<double> normal_;
};

TEST_P(SpectraLanes, AreThoseOfADenseSolver) {
    for (Eigen::Index size = 1; size <= 16; ++size) {
        for (int round = 0; round < 10; ++round) {
            Batch batch;
            for (int lane = 0; lane < kSpectra; ++lane) {
                batch.push_back(matrix(size, 1 + (lane + round) % size));
            }
            expect_all(batch);
        }
    }
}

TEST_P(SpectraLanes, OfMatricesOfAnySizeOfNumbers) {
    Batch batch;
    for (const double scale : {1e-280, 1e-160, 1e-20, 1.0, 1e20, 1e160, 1e290, 0.0}) {
        batch.push_back(scale * matrix(7, 5));
    }
    expect_all(batch);
    for (std::size_t lane = 0; lane < kSpectra; ++lane) {  // numbers of all sizes in one
        Eigen::VectorXd scales =
            Eigen::VectorXd::NullaryExpr(7, [&] { return std::pow(10, 4 * number()); });
        batch[lane] = scales.asDiagonal() * matrix(7, 7) * scales.asDiagonal();
    }
    expect_all(batch);
}

TEST_P(SpectraLanes, OfDegenerateMatrices) {
    const Eigen::VectorXd u = Eigen::VectorXd::Ones(7);
    Eigen::MatrixXd chain = Eigen::MatrixXd::Zero(7, 7);
    chain.diagonal(1).setOnes();
    chain.diagonal(-1).setOnes();
    Eigen::MatrixXd negligible = Eigen::MatrixXd::Identity(7, 7);
    negligible(0, 1) = negligible(1, 0) = 1e-17;
    const Batch batch{Eigen::MatrixXd::Zero(7, 7),
                      Eigen::MatrixXd::Identity(7, 7),
                      -Eigen::MatrixXd::Identity(7, 7),
                      u * u.transpose(),
                      Eigen::MatrixXd::Identity(7, 7) - u * u.transpose(),
                      chain,
                      negligible,
                      Eigen::VectorXd::LinSpaced(7, -3, 3).asDiagonal()};
    expect_all(batch);
    const Found found = find(GetParam(), batch);
    EXPECT_EQ(found.values[0], Eigen::VectorXd::Zero(7));
    for (int k = 1; k <= 7; ++k) {  // a chain of seven: 2 cos(k pi / 8)
        EXPECT_LT(
            (found.values[5].array() - 2 * std::cos(k * std::acos(-1.0) / 8)).abs().minCoeff(),
            1e-14);
    }
}

TEST_P(SpectraLanes, DoNotDependOnThoseBeside) {
    const Eigen::MatrixXd one = matrix(7, 4);
    Eigen::MatrixXd infinite = one;
    infinite(2, 3) = infinite(3, 2) = std::numeric_limits<double>::infinity();
    Eigen::MatrixXd not_numbers = one;
    not_numbers(1, 1) = std::nan("");
    const Found alone = find(GetParam(), Batch(kSpectra, one));
    Batch among{matrix(7, 7),
                infinite,
                one,
                not_numbers,
                1e300 * matrix(7, 3),
                Eigen::MatrixXd::Zero(7, 7),
                one,
                Eigen::MatrixXd::Identity(7, 7)};
    const Found beside = find(GetParam(), among);
    for (const std::size_t lane : {2, 6}) {
        EXPECT_EQ(beside.values[lane], alone.values[0]);
        EXPECT_EQ(beside.vectors[lane], alone.vectors[0]);
    }
    EXPECT_FALSE(beside.values[1].allFinite());
    EXPECT_FALSE(beside.values[3].allFinite());
}

TEST_P(SpectraLanes, AreTheSameForEachInstructionSet) {
    for (const Eigen::Index size : {5, 7, 9, 16}) {
        Batch batch;
        for (int lane = 0; lane < kSpectra; ++lane) {
            batch.push_back(matrix(size, size - lane % 3));
        }
        const Found found = find(GetParam(), batch);
        const Found expected = find(LanesIsa::Baseline, batch);
        EXPECT_EQ(found.values, expected.values);
        EXPECT_EQ(found.vectors, expected.vectors);
    }
}

INSTANTIATE_TEST_SUITE_P(All, SpectraLanes, testing::ValuesIn(kAll));

}  // namespace
}  // namespace pent::contact
