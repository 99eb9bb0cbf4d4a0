#include "contact_scenes.h"
#include "potential_laws.h"
#include "support/messages.h"

#include <pent/error.h>
#include <pent/simulator/picking.h>

#include <gtest/gtest.h>

#include <cmath>
#include <limits>
#include <random>
#include <string>
#include <utility>

namespace pent::simulator {
namespace {

using test::cube;
using test::Dimensions;

template <typename T>
class Picking : public testing::Test {};
TYPED_TEST_SUITE(Picking, Dimensions);

// Cells are larger by 1e-12 of their size, so that no ray goes between two of them; a ray at a
// small angle to a facet comes to it some times that sooner.
constexpr double kRounding = 1e-9;

// Cubes of [0, 0.5]^n and, 0.04 m aside, [0.53, 1.03] along y above it.
template <int Dim>
Simulation<Dim> two_cubes() {
    return Simulation<Dim>(test::two_cubes<Dim>(0.03), {cube<Dim>(), cube<Dim>()});
}

// Against the boxes that the bodies are, by slabs, on both sides of the origin.
TYPED_TEST(Picking, FindsWhatARayComesToFirst) {
    constexpr int kDim = TypeParam::value;
    Simulation<kDim> simulation = two_cubes<kDim>();
    const Vector<kDim> shift = Vector<kDim>::LinSpaced(-0.8, 0.2);
    for (int body = 0; body < 2; ++body) {
        const Positions<kDim> moved = simulation.positions(body).colwise() + shift;
        simulation.set_state(body, moved, simulation.velocities(body));
    }
    std::mt19937 random(3);
    std::uniform_real_distribution<double> place(-1, 2);
    int hits = 0;
    for (int i = 0; i < 400; ++i) {
        Ray<kDim> ray;
        ray.origin = Vector<kDim>::NullaryExpr([&] { return place(random); });
        const Vector<kDim> aim = Vector<kDim>::Constant(0.3)
                                 + 0.2 * Vector<kDim>::NullaryExpr([&] { return place(random); });
        ray.direction = aim - ray.origin;
        ray.origin += shift;
        double expected = std::numeric_limits<double>::infinity();
        int expected_body = -1;
        for (int body = 0; body < 2; ++body) {
            const Vector<kDim> low = simulation.positions(body).rowwise().minCoeff();
            const Vector<kDim> high = simulation.positions(body).rowwise().maxCoeff();
            const Vector<kDim> a = (low - ray.origin).cwiseQuotient(ray.direction);
            const Vector<kDim> b = (high - ray.origin).cwiseQuotient(ray.direction);
            const double begin = std::max(0.0, a.cwiseMin(b).maxCoeff());
            if (begin <= a.cwiseMax(b).minCoeff() && begin < expected) {
                expected = begin;
                expected_body = body;
            }
        }
        const auto found = pick(simulation, ray);
        ASSERT_EQ(found.has_value(), expected_body >= 0) << i;
        if (!found) {
            continue;
        }
        ++hits;
        EXPECT_EQ(found->point.body, expected_body);
        EXPECT_NEAR(found->distance, expected * ray.direction.norm(), kRounding);
        EXPECT_LT((found->place - ray.origin - expected * ray.direction).norm(), kRounding);
        EXPECT_LT((place_of(simulation, found->point) - found->place).norm(), 1e-15);
        EXPECT_NEAR(found->point.weights.sum(), 1, 1e-15);
        EXPECT_GE(found->point.weights.minCoeff(), 0);
    }
    EXPECT_GT(hits, 100);
}

TYPED_TEST(Picking, IsTheSameForDirectionsAndNormalsOfAnyLength) {
    constexpr int kDim = TypeParam::value;
    const Simulation<kDim> simulation = two_cubes<kDim>();
    Ray<kDim> ray;
    ray.origin = Vector<kDim>::Constant(0.2);
    ray.origin[0] = -1;
    ray.direction = Vector<kDim>::Unit(0) + 0.01 * Vector<kDim>::Ones();
    const Vector<kDim> normal = Vector<kDim>::Unit(kDim - 1);
    const auto wanted = pick(simulation, ray);
    const auto in_slice = pick(simulation, Hyperplane<kDim>{.normal = normal, .offset = 0.2}, ray);
    ASSERT_TRUE(wanted && in_slice);
    for (const double length : {1e-200, 1e-170, 1e200}) {
        Ray<kDim> scaled = ray;
        scaled.direction *= length;
        const auto found = pick(simulation, scaled);
        ASSERT_TRUE(found);
        EXPECT_NEAR(found->distance, wanted->distance, kRounding);
        const Hyperplane<kDim> slice{.normal = length * normal, .offset = 0.2 * length};
        const auto again = pick(simulation, slice, scaled);
        ASSERT_TRUE(again);
        EXPECT_NEAR(again->distance, in_slice->distance, kRounding);
    }
}

// A pointer at a slice: rays of the hyperplane of w = 0.1, from its shadow too.
TEST(PickingInASlice, IsPickingByTheShadowOfTheRay) {
    const Simulation<4> simulation = two_cubes<4>();
    const Hyperplane<4> slice{.normal = {0, 0, 0, 2}, .offset = 0.2};
    const Ray<4> ray{.origin = {0.2, 0.3, -1, 0.1}, .direction = {0, 0, 1, 0}};
    const auto found = pick(simulation, slice, ray);
    ASSERT_TRUE(found.has_value());
    EXPECT_LT((found->place - Eigen::Vector4d(0.2, 0.3, 0, 0.1)).norm(), kRounding);
    Ray<4> aslant = ray;
    aslant.origin[3] = 5;
    aslant.direction[3] = -3;
    EXPECT_LT((pick(simulation, slice, aslant)->place - found->place).norm(), kRounding);
    // Out of the body in w.
    EXPECT_FALSE(pick(simulation, {.normal = {0, 0, 0, 2}, .offset = 2}, ray).has_value());
    // Turned: the hyperplane x = w, in which the ray along (1, 0, 0, 1) goes.
    const auto turned = pick(simulation, {.normal = {1, 0, 0, -1}, .offset = 0},
                             {.origin = {-1, 0.1, 0.1, -1}, .direction = {1, 0, 0, 1}});
    ASSERT_TRUE(turned.has_value());
    EXPECT_LT((turned->place - Eigen::Vector4d(0, 0.1, 0.1, 0)).norm(), kRounding);
    EXPECT_NEAR(turned->distance, std::sqrt(2.0), kRounding);
}

TYPED_TEST(Picking, FindsBodiesWhereTheyAreNow) {
    constexpr int kDim = TypeParam::value;
    Simulation<kDim> simulation = two_cubes<kDim>();
    Positions<kDim> moved = simulation.positions(0);
    moved.row(0).array() += 3;
    simulation.set_state(0, moved, simulation.velocities(0));
    Ray<kDim> ray{Vector<kDim>::Constant(0.1), Vector<kDim>::Unit(0)};
    ray.origin[0] = -1;
    const auto found = pick(simulation, ray);
    ASSERT_TRUE(found.has_value());
    EXPECT_NEAR(found->distance, 4, kRounding);
    ray.direction = -ray.direction;
    EXPECT_FALSE(pick(simulation, ray).has_value());
}

TYPED_TEST(Picking, IsThePointItselfWithinABody) {
    constexpr int kDim = TypeParam::value;
    const Simulation<kDim> simulation = two_cubes<kDim>();
    const Ray<kDim> ray{Vector<kDim>::LinSpaced(0.1, 0.3), Vector<kDim>::Unit(1)};
    const auto found = pick(simulation, ray);
    ASSERT_TRUE(found.has_value());
    EXPECT_EQ(found->distance, 0);
    EXPECT_LT((found->place - ray.origin).norm(), kRounding);
}

TYPED_TEST(Picking, RefusesWhatIsNoRayAndNoHyperplane) {
    constexpr int kDim = TypeParam::value;
    const Simulation<kDim> simulation = two_cubes<kDim>();
    const Vector<kDim> some = Vector<kDim>::Ones();
    const Vector<kDim> none = Vector<kDim>::Zero();
    const auto refused = [&](const Ray<kDim>& ray, const Hyperplane<kDim>& slice) {
        return pent::test::error_of([&] { static_cast<void>(pick(simulation, slice, ray)); });
    };
    pent::test::expect_contains(refused({some, none}, {some, 0}), {"direction", "not 0"});
    pent::test::expect_contains(pent::test::error_of([&] {
                                    static_cast<void>(pick(simulation, Ray<kDim>{some, none}));
                                }),
                                {"direction", "not 0"});
    pent::test::expect_contains(refused({some / 0, some}, {some, 0}), {"finite origin"});
    pent::test::expect_contains(refused({some, some}, {none, 0}), {"normal", "not 0"});
    pent::test::expect_contains(refused({some, some}, {some, 0}), {"along the normal"});
    pent::test::expect_contains(refused({some, Vector<kDim>::Unit(0)}, {some, INFINITY}),
                                {"finite offset"});
    pent::test::expect_contains(refused({some, some}, {some / 0, 0}), {"finite normal"});
    const std::int64_t cells = simulation.mesh(1).cell_count();
    for (const auto& [body, cell] :
         {std::pair<int, std::int64_t>{2, 0}, {-1, 0}, {1, cells}, {1, -1}}) {
        pent::test::expect_contains(
            pent::test::error_of([&, body = body, cell = cell] {
                static_cast<void>(place_of(simulation, {.body = body, .cell = cell}));
            }),
            {"no cell " + std::to_string(cell) + " of a body " + std::to_string(body)});
    }
}

}  // namespace
}  // namespace pent::simulator
