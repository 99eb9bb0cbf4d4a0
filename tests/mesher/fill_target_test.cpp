#include "fill_target.h"

#include "support/messages.h"

#include <gtest/gtest.h>

#include <cmath>

namespace pent::mesher {
namespace {

// A filling of which nothing but the number of tetrahedra matters.
Tetrahedra filling_of(double tetrahedra) {
    Tetrahedra filling;
    filling.mesh.cells.setZero(4, std::llround(tetrahedra));
    return filling;
}

TEST(FillToTarget, FindsTheLengthWhateverThePowerThatTheNumberGoesWith) {
    for (const double power : {-1.5, -3.0, -6.0}) {
        const TargetFilling found = fill_to_target(
            [&](double length) { return filling_of(1000 * std::pow(length, power)); }, 5000, 2.0);
        EXPECT_NEAR(static_cast<double>(found.tetrahedra.mesh.cell_count()), 5000, 0.02 * 5000);
        EXPECT_NEAR(1000 * std::pow(found.edge_length, power), 5000, 0.02 * 5000 + 0.5);
        EXPECT_LE(found.fillings, 8) << power;
    }
}

TEST(FillToTarget, FindsASteepStepBetweenNumbersThatAreFarOff) {
    // Ten tetrahedra between 1 and 1.001 m, a hundred below and one above: only halving gets there.
    const TargetFilling found = fill_to_target(
        [](double length) {
            return filling_of(length < 1 ? 100 : length < 1.001 ? 10 : 1);
        },
        10, 3.0);
    EXPECT_EQ(found.tetrahedra.mesh.cell_count(), 10);
    EXPECT_GE(found.edge_length, 1);
    EXPECT_LT(found.edge_length, 1.001);
}

TEST(FillToTarget, NamesTheNearestNumberWhereTheWantedOneIsJumpedOver) {
    const auto jump = [](double length) { return filling_of(length < 1 ? 14 : 3); };
    test::expect_contains(
        test::error_of([&] { static_cast<void>(fill_to_target(jump, 10, 2.0)); }),
        {"no filling with 10 tetrahedra", "the nearest has 14", "ask for another number"});
}

}  // namespace
}  // namespace pent::mesher
