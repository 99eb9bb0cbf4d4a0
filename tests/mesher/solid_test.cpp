#include <pent/error.h>
#include <pent/mesher/primitives.h>

#include <Eigen/QR>
#include <gtest/gtest.h>

#include <cmath>
#include <functional>
#include <limits>
#include <random>

namespace pent::mesher {
namespace {

using Eigen::Vector4d;

struct Named {
    const char* name;
    Solid solid;
};

// One of each that has a distance for a function.
std::vector<Named> all_solids() {
    std::vector<Named> all = {{"ball", ball_solid(1)},
                              {"box", box_solid({1, 0.8, 1.2, 0.9})},
                              {"capsule", capsule_solid(0.5, 0.8)},
                              {"spherinder", spherinder_solid(0.8, 1.1)},
                              {"cubinder", cubinder_solid(0.7, {1, 1.3})},
                              {"duocylinder", duocylinder_solid({0.7, 0.9})},
                              {"spheritorus", spheritorus_solid(0.8, 0.3)},
                              {"torisphere", torisphere_solid(0.7, 0.3)},
                              {"tiger", tiger_solid({0.7, 0.6}, 0.3)},
                              {"ditorus", ditorus_solid({0.7, 0.4}, 0.2)},
                              {"clifford torus", clifford_torus_solid(1, 0.5)},
                              {"half-space", half_space_solid({1, 2, 0, -1}, 0.3)}};
    for (const int cells : {5, 8, 16, 24, 120, 600}) {
        all.push_back({"polytope", polytope_solid(cells, 1)});
    }
    all.push_back({"union", unite(ball_solid(0.8), box_solid({2, 0.5, 0.5, 0.5}), 0.2)});
    all.push_back({"difference", subtract(box_solid({1, 1, 1, 1}), ball_solid(0.6), 0.1)});
    all.push_back({"intersection", intersect(ball_solid(0.8), box_solid({1, 1, 1, 1}))});
    return all;
}

Vector4d random_point(std::mt19937& random) {
    std::uniform_real_distribution<double> uniform(-1.5, 1.5);
    return Vector4d(uniform(random), uniform(random), uniform(random), uniform(random));
}

TEST(Solid, ChangesByNoMoreThanThePointMoves) {
    std::mt19937 random(1);
    for (const Named& named : all_solids()) {
        for (int i = 0; i < 200; ++i) {
            const Vector4d a = random_point(random);
            const Vector4d b = a + 0.2 * random_point(random);
            const double change = std::abs(named.solid.value(a) - named.solid.value(b));
            // Values of about 1 are rounded by some 1e-16.
            EXPECT_LE(change, (a - b).norm() + 1e-14) << named.name;
        }
    }
}

TEST(Solid, BoundsItsValuesWithinABall) {
    std::mt19937 random(2);
    for (const Named& named : all_solids()) {
        for (int i = 0; i < 100; ++i) {
            const Vector4d center = random_point(random);
            const ValueRange range = named.solid.values_within(center, 0.3);
            const double value =
                named.solid.value(center + 0.3 * random_point(random).normalized());
            EXPECT_GE(value, range.low - 1e-14) << named.name;
            EXPECT_LE(value, range.high + 1e-14) << named.name;
        }
    }
}

TEST(Solid, HoldsItsInsideWithinItsBounds) {
    std::mt19937 random(3);
    for (const Named& named : all_solids()) {
        const Box4& box = named.solid.bounds();
        for (int i = 0; i < 500; ++i) {
            const Vector4d p = random_point(random);
            if (named.solid.value(p) < 0) {
                EXPECT_TRUE((p.array() >= box.low.array()).all()
                            && (p.array() <= box.high.array()).all())
                    << named.name;
            }
        }
    }
}

// A point of the solid that is far along an axis, by climbing there in random steps.
Vector4d farthest(const Solid& solid, Vector4d p, int axis, double sign, std::mt19937& random) {
    int failures = 0;
    for (double step = 0.3; step > 1e-3;) {
        const Vector4d next = p + step * random_point(random);
        if (solid.value(next) < 0 && sign * next[axis] > sign * p[axis]) {
            p = next;
            failures = 0;
        } else if (++failures > 30) {
            step /= 2;
            failures = 0;
        }
    }
    return p;
}

// Two of a kind make one that is larger by a quarter of `smooth` across each side: at corners that
// is more.
TEST(Solid, HoldsWhatABlendAddsWithinItsBounds) {
    std::mt19937 random(6);
    for (const Named& named : all_solids()) {
        if (!named.solid.is_bounded()) {
            continue;
        }
        Eigen::Matrix4d rotation = Eigen::Matrix4d::Identity();
        for (const bool is_turned : {false, true}) {
            if (is_turned) {
                rotation = Eigen::Matrix4d(Eigen::Matrix4d::NullaryExpr(
                                               [&] { return random_point(random)[0]; }))
                               .householderQr()
                               .householderQ();
            }
            const Vector4d middle(0.1, 0.2, 0, -0.3);
            const Solid one = place(named.solid, 0.7, rotation, middle);
            const Solid two = unite(one, one, 1);
            const Solid four = place(unite(two, two, 0.4), 1.5, rotation, -middle);
            for (const Solid& solid : {two, four}) {
                Vector4d start = random_point(random);
                while (solid.value(start) >= 0) {
                    start = random_point(random);
                }
                for (int axis = 0; axis < 4; ++axis) {
                    EXPECT_GE(farthest(solid, start, axis, -1, random)[axis],
                              solid.bounds().low[axis])
                        << named.name;
                    EXPECT_LE(farthest(solid, start, axis, 1, random)[axis],
                              solid.bounds().high[axis])
                        << named.name;
                }
            }
        }
    }
}

TEST(Solid, IsDecidedByItsPieces) {
    std::mt19937 random(4);
    for (const Named& named : all_solids()) {
        for (int i = 0; i < 50; ++i) {
            const Vector4d p = random_point(random);
            const std::vector<int> pieces = named.solid.pieces_near(p, 1e-12);
            ASSERT_FALSE(pieces.empty()) << named.name;
            EXPECT_LT(pieces.back(), named.solid.piece_count());
            for (const int piece : pieces) {
                EXPECT_NEAR(named.solid.piece_value(piece, p), named.solid.value(p), 1e-11)
                    << named.name;
            }
        }
    }
}

// Central differences over a millionth have an error of some 1e-9, unless a ridge is between them.
void expect_slope(const ValueSlope& found,
                  const std::function<double(const Vector4d&)>& value,
                  const Vector4d& p,
                  const char* name) {
    constexpr double kStep = 1e-6;
    EXPECT_NEAR(found.value, value(p), 1e-14) << name;
    for (int axis = 0; axis < 4; ++axis) {
        const Vector4d step = kStep * Vector4d::Unit(axis);
        const double before = (value(p) - value(p - step)) / kStep;
        const double after = (value(p + step) - value(p)) / kStep;
        if (std::abs(after - before) < 1e-4) {
            EXPECT_NEAR(found.slope[axis], (before + after) / 2, 1e-8) << name;
        }
    }
}

TEST(Solid, KnowsItsSlope) {
    std::mt19937 random(7);
    std::vector<Named> solids = all_solids();
    solids.push_back(
        {"formula", expression_solid("x^2 + sin(y) * z - w",
                                     {Vector4d::Constant(-2), Vector4d::Constant(2)})});
    const Eigen::Matrix4d turn = Eigen::HouseholderQR<Eigen::Matrix4d>(
                                     Eigen::Matrix4d::Identity() + 0.3 * Eigen::Matrix4d::Ones())
                                     .householderQ();
    for (const Named& named : solids) {
        const Solid placed = place(named.solid, 1.3, turn, {0.1, 0.2, -0.1, 0});
        for (const Solid& solid : {named.solid, placed}) {
            for (int i = 0; i < 30; ++i) {
                const Vector4d p = random_point(random);
                expect_slope(
                    solid.value_slope(p, 1e-6), [&](const Vector4d& q) { return solid.value(q); },
                    p, named.name);
                const int piece = i % solid.piece_count();
                expect_slope(
                    solid.piece_slope(piece, p, 1e-6),
                    [&](const Vector4d& q) { return solid.piece_value(piece, q); }, p, named.name);
            }
        }
    }
    // On an axis there is none.
    EXPECT_EQ(tiger_solid({0.7, 0.6}, 0.3).value_slope({0, 0, 0.6, 0}, 1e-6).slope.tail<2>().norm(),
              0);
}

TEST(Solid, IsScaledThenRotatedThenMoved) {
    std::mt19937 random(5);
    Eigen::Matrix4d quarter_turn = Eigen::Matrix4d::Identity();  // x towards w
    quarter_turn(0, 0) = quarter_turn(3, 3) = 0;
    quarter_turn(3, 0) = 1;
    quarter_turn(0, 3) = -1;
    const Vector4d translation(0.1, 0.2, 0.3, 0.4);
    for (const Named& named : all_solids()) {
        const Solid placed = place(named.solid, 2, quarter_turn, translation);
        for (int i = 0; i < 20; ++i) {
            const Vector4d p = random_point(random);
            EXPECT_NEAR(placed.value(quarter_turn * (2 * p) + translation),
                        2 * named.solid.value(p), 1e-13)
                << named.name;
        }
        EXPECT_DOUBLE_EQ(placed.smallest_width(), 2 * named.solid.smallest_width());
    }
}

TEST(Solid, HasNoBoundsWhereWhatIsIntersectedLiesApart) {
    const Eigen::Matrix4d as_it_is = Eigen::Matrix4d::Identity();
    const Solid nothing =
        intersect(ball_solid(1), place(ball_solid(1), 1, as_it_is, 5 * Vector4d::Unit(0)));
    const Solid moved = place(nothing, 2, as_it_is, Vector4d::Ones());
    for (const Solid& solid : {nothing, moved}) {
        EXPECT_LT((solid.bounds().high - solid.bounds().low).minCoeff(), 0);
    }
    const Box4 box = unite(ball_solid(1), moved).bounds();
    EXPECT_EQ(box.low, -Vector4d::Ones());
    EXPECT_EQ(box.high, Vector4d::Ones());
}

TEST(Solid, HasTheNamedExtentsInTheNamedAxes) {
    EXPECT_DOUBLE_EQ(spherinder_solid(1, 3).value({0, 0, 0, 2}), 0.5);
    EXPECT_DOUBLE_EQ(capsule_solid(1, 3).value({0, 0, 0, 2}), -0.5);
    EXPECT_DOUBLE_EQ(cubinder_solid(1, {3, 5}).value({0, 0, 0, 3}), 0.5);
    EXPECT_DOUBLE_EQ(duocylinder_solid({1, 2}).value({0, 0, 3, 0}), 1);
    EXPECT_DOUBLE_EQ(spheritorus_solid(2, 1).value({2, 0, 0, 0}), -1);
    EXPECT_DOUBLE_EQ(torisphere_solid(2, 1).value({0, 0, 2, 0.5}), -0.5);
    EXPECT_DOUBLE_EQ(tiger_solid({2, 3}, 1).value({0, 2, 3, 0}), -1);
    EXPECT_DOUBLE_EQ(ditorus_solid({4, 2}, 1).value({4, 0, 2, 0.5}), -0.5);
    EXPECT_NEAR(clifford_torus_solid(1, 0.5).value(Vector4d::Constant(0.5)), -0.25, 1e-15);
    EXPECT_DOUBLE_EQ(half_space_solid({0, 2, 0, 0}, 4).value({0, 3, 0, 0}), 1);
}

TEST(RegularPolytopes, HaveTheirVerticesAtTheirRadius) {
    for (const int cells : {5, 8, 16, 24, 120, 600}) {
        const Solid solid = polytope_solid(cells, 1);
        EXPECT_EQ(solid.piece_count(), cells);
        const double center = solid.value(Vector4d::Zero());
        // Along a ray the value is linear, as the cell that is nearest to the ray decides it.
        const auto surface_along = [&](const Vector4d& direction) {
            return -center / (solid.value(direction) - center);
        };
        // Climbs to the farthest point of the surface by ever smaller random steps.
        std::mt19937 random(6);
        Vector4d best = random_point(random).normalized();
        for (int i = 0; i < 4000; ++i) {
            const double step = std::pow(0.997, i);
            const Vector4d next = (best + step * random_point(random)).normalized();
            best = surface_along(next) > surface_along(best) ? next : best;
        }
        // The last steps are some 1e-5 long, and the surface is at most 4 times as steep as that.
        EXPECT_NEAR(surface_along(best), 1, 1e-3) << cells;
        EXPECT_LE(surface_along(best), 1 + 1e-12) << cells;
    }
}

// Groups on either side, within groups, are what their values say.
TEST(Solid, CombinesWhatIsCombined) {
    const std::vector<Solid> parts = {
        ball_solid(0.9), box_solid({1, 1.4, 0.8, 1.2}), tiger_solid({0.7, 0.6}, 0.4),
        place(duocylinder_solid({0.5, 0.8}), 1, Eigen::Matrix4d::Identity(), {0.3, 0, 0.2, 0})};
    const Solid left = subtract(parts[0], parts[1]);
    const Solid right = unite(parts[2], intersect(parts[3], parts[0]));
    const Solid both = unite(left, right);
    const Solid less = subtract(both, intersect(right, left));
    std::mt19937 random(7);
    for (int i = 0; i < 500; ++i) {
        const Vector4d p = random_point(random);
        std::vector<double> v;
        for (const Solid& part : parts) {
            v.push_back(part.value(p));
        }
        const double of_left = std::max(v[0], -v[1]);
        const double of_right = std::min(v[2], std::max(v[3], v[0]));
        EXPECT_EQ(both.value(p), std::min(of_left, of_right));
        EXPECT_EQ(less.value(p),
                  std::max(std::min(of_left, of_right), -std::max(of_left, of_right)));
    }
}

TEST(Solid, IsAsThinAsItsThinnestPart) {
    const Solid thin = spherinder_solid(1, 0.2);
    const Solid thick = ball_solid(1);
    for (const Solid& solid : {unite(thin, thick), unite(thick, thin), intersect(thick, thin),
                               subtract(thick, thin), subtract(thin, thick)}) {
        EXPECT_EQ(solid.smallest_width(), 0.2);
        EXPECT_EQ(place(solid, 3, Eigen::Matrix4d::Identity(), {1, 2, 3, 4}).smallest_width(),
                  3 * 0.2);
    }
}

TEST(Solid, BlendsSmoothlyAndOnlyWhereBothAreNear) {
    const Solid a = half_space_solid({1, 0, 0, 0}, 0);
    const Solid b = half_space_solid({0, 1, 0, 0}, 0);
    const Solid blended = unite(a, b, 0.4);
    EXPECT_DOUBLE_EQ(blended.value({0, 0, 0, 0}), -0.1);  // a quarter of it where both are equal
    EXPECT_DOUBLE_EQ(blended.value({-0.5, 0, 0, 0}), -0.5);
    EXPECT_DOUBLE_EQ(blended.value({-0.4, 0, 0, 0}), -0.4);
    const double before = blended.value({-0.4 + 1e-6, 0, 0, 0});
    EXPECT_NEAR((before + 0.4) / 1e-6, 1, 1e-5);  // the slope goes on
    EXPECT_LE(blended.values_within({0, 0, 0, 0}, 0).low, -0.1);
    EXPECT_GE(intersect(a, b, 0.4).values_within({0, 0, 0, 0}, 0).high, 0.1);
}

TEST(Solid, TakesAnExpressionWithinItsBox) {
    const Solid solid = expression_solid("x^2 + y^2 + z^2 + sqrt(w^4) - 1",
                                         {Vector4d::Constant(-2), Vector4d::Constant(2)});
    EXPECT_DOUBLE_EQ(solid.value({0.5, 0, 0, 0.5}), -0.5);
    EXPECT_DOUBLE_EQ(solid.value({0, 0, 0, 3}), 8);
    EXPECT_EQ(solid.values_within({0, 0, 0, 0}, 0.1).high, std::numeric_limits<double>::infinity());
}

TEST(Solid, RefusesLengthsThatMakeNoShape) {
    EXPECT_THROW((void)ball_solid(0), Error);
    EXPECT_THROW((void)ball_solid(std::nan("")), Error);
    EXPECT_THROW((void)box_solid({1, 1, -1, 1}), Error);
    EXPECT_THROW((void)tiger_solid({1, 0.5}, 0.5), Error);
    EXPECT_THROW((void)ditorus_solid({1, 0.7}, 0.3), Error);
    EXPECT_THROW((void)half_space_solid(Vector4d::Zero(), 1), Error);
    EXPECT_THROW((void)polytope_solid(7, 1), Error);
    EXPECT_THROW((void)expression_solid("x +", {-Vector4d::Ones(), Vector4d::Ones()}), Error);
    EXPECT_THROW((void)expression_solid("x, y", {-Vector4d::Ones(), Vector4d::Ones()}), Error);
    EXPECT_THROW((void)expression_solid("x", {Vector4d::Ones(), Vector4d::Ones()}), Error);
}

}  // namespace
}  // namespace pent::mesher
