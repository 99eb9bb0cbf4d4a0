#include "elastic_box.h"
#include "linear/block_kernels.h"

#include <Eigen/Cholesky>
#include <gtest/gtest.h>

#include <limits>
#include <random>

namespace pent::simulator {
namespace {

constexpr double kNan = std::numeric_limits<double>::quiet_NaN();
constexpr auto kRoom = static_cast<Eigen::Index>(kFrontRoom);

// A positive definite matrix of which the first columns are a panel, and an update that has been
// added up before; above the diagonals nothing that may be read.
struct DenseFront {
    Eigen::Index width;
    Eigen::MatrixXd whole;
    Eigen::MatrixXd before;
    Eigen::MatrixXd panel;
    Eigen::MatrixXd update;

    DenseFront(Eigen::Index columns, Eigen::Index below, std::mt19937& random) : width(columns) {
        std::normal_distribution<double> normal;
        const Eigen::Index size = columns + below;
        const Eigen::MatrixXd any =
            Eigen::MatrixXd::NullaryExpr(size, size, [&] { return normal(random); });
        whole = any * any.transpose() + Eigen::MatrixXd::Identity(size, size);
        before = Eigen::MatrixXd::NullaryExpr(below, below, [&] { return normal(random); });
        panel.setZero(size + kRoom, columns);
        panel.topRows(size) = whole.leftCols(columns);
        panel.topRows(columns).triangularView<Eigen::StrictlyUpper>().setConstant(kNan);
        update.setZero(below + kRoom, below);
        update.topRows(below) = before;
        update.topRows(below).triangularView<Eigen::StrictlyUpper>().setConstant(kNan);
    }

    [[nodiscard]] bool eliminate(Isa isa) {
        const auto below = static_cast<std::size_t>(update.cols());
        return kernels<4>(isa).blocks.eliminate_front(
            {panel.data(), static_cast<std::size_t>(panel.rows()), static_cast<std::size_t>(width),
             below, update.data(), below + kFrontRoom});
    }
};

// With all remainders of registers and of columns, for each instruction set.
TEST(Front, IsEliminatedAsTheDenseFactorsAre) {
    for (const Isa isa : test::supported_isas()) {
        std::mt19937 random(1);
        for (Eigen::Index width = 1; width <= 14; ++width) {
            for (Eigen::Index below = 0; below <= 29; ++below) {
                DenseFront front(width, below, random);
                ASSERT_TRUE(front.eliminate(isa));
                const Eigen::MatrixXd L = Eigen::MatrixXd(front.whole.llt().matrixL());
                const Eigen::MatrixXd panel =
                    front.panel.topRows(width).triangularView<Eigen::Lower>();
                const double rounding = 1e-12 * front.whole.norm();
                EXPECT_LT((panel - L.topLeftCorner(width, width)).norm(), rounding);
                EXPECT_LT((front.panel.middleRows(width, below) - L.bottomLeftCorner(below, width))
                              .norm(),
                          rounding);
                const Eigen::MatrixXd left = front.before
                                             - L.bottomLeftCorner(below, width)
                                                   * L.bottomLeftCorner(below, width).transpose();
                const Eigen::MatrixXd update = front.update.topRows(below) - left;
                EXPECT_LT(Eigen::MatrixXd(update.triangularView<Eigen::Lower>()).norm(), rounding)
                    << width << " " << below;
                EXPECT_TRUE(front.panel.bottomRows(kRoom).isZero(0));
                EXPECT_TRUE(front.update.bottomRows(kRoom).isZero(0));
            }
        }
    }
}

// Wherever a pivot is not positive or not a number; below the panel nothing is a pivot.
TEST(Front, IsNotEliminatedByAPivotThatIsNotPositive) {
    constexpr Eigen::Index kWidth = 7;
    for (const Isa isa : test::supported_isas()) {
        std::mt19937 random(2);
        for (Eigen::Index at = 0; at < kWidth; ++at) {
            for (const double wrong : {-1.0, kNan, std::numeric_limits<double>::infinity()}) {
                DenseFront front(kWidth, 5, random);
                const DenseFront sound = front;
                front.panel(at, at) = wrong;
                EXPECT_FALSE(front.eliminate(isa)) << at << " " << wrong;
                front = sound;
                front.update.setConstant(wrong);
                EXPECT_TRUE(front.eliminate(isa)) << at << " " << wrong;
            }
            // Its pivot becomes zero in the middle of the elimination but for rounding.
            DenseFront front(kWidth, 5, random);
            const Eigen::MatrixXd L = Eigen::MatrixXd(front.whole.llt().matrixL());
            front.panel(at, at) -= 1.001 * L(at, at) * L(at, at);
            EXPECT_FALSE(front.eliminate(isa)) << at;
        }
    }
}

}  // namespace
}  // namespace pent::simulator
