#include "linear/linear_solver.h"
#include "springy_box.h"

#include <gtest/gtest.h>

#include <limits>

namespace pent::simulator {
namespace {

using test::SpringyBox;

constexpr int kDim = test::kBoxDim;

TEST(DirectSolver, LeavesTheResidualOfRoundingWhateverBlocksAreStoredIn) {
    for (const Precision precision : {Precision::Float, Precision::Double}) {
        const SpringyBox problem(precision);
        const LinearSolution<kDim> solution = problem.solve(*make_direct_solver<kDim>(), 0.5);
        // Backward stable: the solution of a matrix a few roundings in double away.
        const double roundings = 4 * std::numeric_limits<double>::epsilon();
        EXPECT_LT(solution.report.residual * problem.system.right().norm(),
                  roundings * problem.dense().norm() * solution.x.norm());
    }
}

}  // namespace
}  // namespace pent::simulator
