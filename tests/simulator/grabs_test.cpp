#include "potentials/grabs.h"

#include "potential_laws.h"

#include <gtest/gtest.h>

// The springs of a host as a function of positions; host_grab_test.cpp has them in motion.

namespace pent::simulator {
namespace {

using test::Dimensions;
using test::expect_derivatives;
using test::gradient_of;
using test::Setting;
using test::shaken;
using test::value_of;

template <typename T>
class GrabsTest : public testing::Test {};
TYPED_TEST_SUITE(GrabsTest, Dimensions);

// A point inside cell 5 of the second of two cubes, held 0.3 m away from where it is at rest, by an
// anchor that comes from 0.1 m further off.
template <int Dim>
typename HostState<Dim>::Holding holding(const Bodies<Dim>& bodies, double max_force = 1e9) {
    typename HostState<Dim>::Holding made;
    made.id = 1;
    made.grab.point = {.body = 1, .cell = 5};
    made.grab.point.weights = Eigen::Matrix<double, Dim + 1, 1>::LinSpaced(1, 2);
    made.grab.point.weights /= made.grab.point.weights.sum();
    made.grab.stiffness = 300;
    made.grab.damping = 7;
    made.grab.max_force = max_force;
    const auto range = bodies.vertices(1);
    made.grab.anchor = Vector<Dim>::Constant(0.3 / std::sqrt(Dim));
    for (int i = 0; i <= Dim; ++i) {
        made.grab.anchor += made.grab.point.weights[i]
                            * bodies.rest().col(range.begin + bodies.meshes[1].cells(i, 5));
    }
    made.from = made.grab.anchor + 0.1 * Vector<Dim>::Unit(0);
    return made;
}

template <int Dim>
Setting<Dim> two_bodies() {
    Scene scene = test::two_cubes<Dim>(0.03);
    scene.contact.reset();
    return Setting<Dim>(scene, 2);
}

// In a step that begins at 0, of 10 ms; nothing moves at its start.
template <int Dim>
void begin(Grabs<Dim>& grabs, const Positions<Dim>& x) {
    static_cast<void>(grabs.set_time({0, 0.01}));
    static_cast<void>(grabs.begin_step({x, 0 * x, x, 0 * x, 0.01, 100, false}));
}

TYPED_TEST(GrabsTest, HaveTheirDerivativesInAStepAndBetweenSteps) {
    constexpr int kDim = TypeParam::value;
    for (const double max_force : {1e9, 20.0}) {  // and where they are weakened to 20 N
        const Setting<kDim> setting = two_bodies<kDim>();
        Grabs<kDim> grabs(setting.scene, setting.bodies);
        grabs.set({holding<kDim>(setting.bodies, max_force)}, 0);
        const Positions<kDim> x = shaken<kDim>(setting.bodies.rest(), 0.05, 1);
        begin<kDim>(grabs, x);
        expect_derivatives<kDim>(setting, grabs, shaken<kDim>(x, 0.02, 2));
        // Between steps there are forces alone.
        EXPECT_TRUE(grabs.set_time({0, 0.01}));
        const Positions<kDim> gradient = gradient_of<kDim>(grabs, x);
        const Positions<kDim> way = shaken<kDim>(0 * x, 1e-5, 3);
        const double slope = (value_of<kDim>(grabs, x + way) - value_of<kDim>(grabs, x - way)) / 2;
        EXPECT_NEAR(slope, gradient.cwiseProduct(way).sum(), 1e-6 * std::abs(slope));
    }
}

// Of one that is where its anchor is, there is no direction; beside one that pulls.
TYPED_TEST(GrabsTest, HaveTheirDerivativesWhereASpringHasNoLength) {
    constexpr int kDim = TypeParam::value;
    for (const double max_force : {1e9, 20.0}) {
        const Setting<kDim> setting = two_bodies<kDim>();
        const Positions<kDim>& x = setting.bodies.rest();
        auto slack = holding<kDim>(setting.bodies, max_force);
        slack.grab.anchor.array() -= 0.3 / std::sqrt(kDim);
        slack.grab.damping = 0;
        slack.from = slack.grab.anchor;
        Grabs<kDim> grabs(setting.scene, setting.bodies);
        grabs.set({slack}, 0);
        for (const bool is_in_step : {false, true}) {
            if (is_in_step) {
                begin<kDim>(grabs, x);
            } else {
                static_cast<void>(grabs.set_time({0, 0.01}));
            }
            // 300 N/m and some roundings of a meter.
            EXPECT_LT(gradient_of<kDim>(grabs, x).norm(), 300 * 1e-14);
        }
        auto pulling = holding<kDim>(setting.bodies, max_force);
        pulling.id = 2;
        pulling.grab.point.body = 0;  // its anchor is near the other
        grabs.set({slack, pulling}, 0);
        begin<kDim>(grabs, x);
        EXPECT_GT(gradient_of<kDim>(grabs, x).norm(), 1);
        expect_derivatives<kDim>(setting, grabs, x);
    }
}

// All forces together are one at the point, whatever its cell is deformed to; and where all is
// turned and moved, anchors too, nothing has changed but the directions.
TYPED_TEST(GrabsTest, PullAtTheirPointAndTurnNothingAboutIt) {
    constexpr int kDim = TypeParam::value;
    const Setting<kDim> setting = two_bodies<kDim>();
    auto held = holding<kDim>(setting.bodies);
    held.grab.damping = 0;
    Grabs<kDim> grabs(setting.scene, setting.bodies);
    grabs.set({held}, 0);
    const Positions<kDim> x = shaken<kDim>(setting.bodies.rest(), 0.05, 1);
    begin<kDim>(grabs, x);
    Vector<kDim> point = Vector<kDim>::Zero();
    for (int i = 0; i <= kDim; ++i) {
        point += held.grab.point.weights[i]
                 * x.col(setting.bodies.first_vertex[1] + setting.bodies.meshes[1].cells(i, 5));
    }
    const double value = value_of<kDim>(grabs, x);
    const Positions<kDim> gradient = gradient_of<kDim>(grabs, x);
    const Vector<kDim> force = -gradient.rowwise().sum();
    EXPECT_LT((force - 300 * (held.grab.anchor - point)).norm(), 1e-11 * force.norm());
    EXPECT_NEAR(value, 150 * (held.grab.anchor - point).squaredNorm(), 1e-12 * value);
    const Positions<kDim> arms = x.colwise() - point;
    const Matrix<kDim> moment = gradient * arms.transpose();
    EXPECT_LT((moment - moment.transpose()).norm(), 1e-12 * gradient.norm() * arms.norm());
    const Matrix<kDim> turn = test::any_rotation<kDim>();
    const auto moved = [&](const auto& points) {
        return Positions<kDim>((turn * points).colwise() + Vector<kDim>::LinSpaced(0.1, 0.7));
    };
    held.grab.anchor = moved(held.grab.anchor);
    held.from = moved(held.from);
    grabs.set({held}, 0);
    begin<kDim>(grabs, moved(x));
    EXPECT_NEAR(value_of<kDim>(grabs, moved(x)), value, 1e-11 * value);
    EXPECT_LT((gradient_of<kDim>(grabs, moved(x)) - turn * gradient).norm(),
              1e-9 * gradient.norm());
}

// 300 N/m times 0.3 m would be 90 N; with 7 N s/m at 10 m/s of the anchor it would be more.
TYPED_TEST(GrabsTest, PullNoHarderThanTheyMayHoweverFarAndFastTheirAnchorGoes) {
    constexpr int kDim = TypeParam::value;
    const Setting<kDim> setting = two_bodies<kDim>();
    const Positions<kDim>& x = setting.bodies.rest();
    for (const double far : {0.0, 1.0, 1e6}) {
        auto held = holding<kDim>(setting.bodies, 20);
        held.grab.anchor[1] += far;
        Grabs<kDim> grabs(setting.scene, setting.bodies);
        grabs.set({held}, 0);
        const auto force = [&] { return gradient_of<kDim>(grabs, x).rowwise().sum().norm(); };
        static_cast<void>(grabs.set_time({0, 0.01}));
        EXPECT_NEAR(force(), 20, 1e-9);
        begin<kDim>(grabs, x);
        EXPECT_NEAR(force(), 20, 1e-9);
    }
}

// Between steps the energy of a pull goes on from that of the spring where it is at its limit, and
// grows by what the limit does on the way.
TYPED_TEST(GrabsTest, HaveAnEnergyWithoutAJumpWhereTheyAreAtTheirLimit) {
    constexpr int kDim = TypeParam::value;
    const Setting<kDim> setting = two_bodies<kDim>();
    const Positions<kDim>& x = setting.bodies.rest();
    auto held = holding<kDim>(setting.bodies, 30);  // at a stretch of 0.1 m
    held.grab.anchor = held.from;
    Grabs<kDim> grabs(setting.scene, setting.bodies);
    grabs.set({held}, 0);
    static_cast<void>(grabs.set_time({0, 0.01}));
    Grabs<kDim> one(setting.scene, setting.bodies);
    auto still = held;
    still.grab.max_force = 1e9;
    one.set({still}, 0);
    static_cast<void>(one.set_time({0, 0.01}));
    const Vector<kDim> force = gradient_of<kDim>(one, x).rowwise().sum();
    const Vector<kDim> along = force.normalized();
    const auto at = [&](double stretch) {
        return Positions<kDim>(x.colwise() + (stretch - force.norm() / 300) * along);
    };
    EXPECT_NEAR(value_of<kDim>(grabs, at(0.0999)), 150 * 0.0999 * 0.0999, 1e-9);
    EXPECT_NEAR(value_of<kDim>(grabs, at(0.1001)), 1.5 + 30 * 0.0001, 1e-9);
    EXPECT_NEAR(value_of<kDim>(grabs, at(0.7)), 1.5 + 30 * 0.6, 1e-9);
}

// Where the point goes along with the anchor nothing is damped: 0.1 m in 10 ms.
TYPED_TEST(GrabsTest, DampWhatMovesOtherwiseThanTheirAnchor) {
    constexpr int kDim = TypeParam::value;
    const Setting<kDim> setting = two_bodies<kDim>();
    const double dt = setting.scene.dt();
    const Positions<kDim>& x = setting.bodies.rest();
    auto held = holding<kDim>(setting.bodies);
    held.grab.anchor = held.from + 0.1 * Vector<kDim>::Unit(1);
    Grabs<kDim> grabs(setting.scene, setting.bodies);
    grabs.set({held}, 0);
    static_cast<void>(grabs.set_time({0, dt}));
    const Positions<kDim> still = 0 * x;
    static_cast<void>(grabs.begin_step({x, still, x, still, dt, 1 / dt, false}));
    Positions<kDim> along = x;
    along.row(1).array() += 0.1;
    static_cast<void>(value_of<kDim>(grabs, along));
    EXPECT_NEAR(grabs.energies()[1].energy, 0, 1e-12);
    EXPECT_GT(grabs.energies()[0].energy, 1);
    static_cast<void>(value_of<kDim>(grabs, x));
    EXPECT_NEAR(grabs.energies()[1].energy, 0.5 * 7 * dt * std::pow(0.1 / dt, 2), 1e-9);
    // The step begins with another value than there was without damping, or with all of the force.
    for (const double damping : {0.0, 7.0}) {
        for (const double most : {1e9, 20.0}) {
            held.grab.damping = damping;
            held.grab.max_force = most;
            grabs.set({held}, 0);
            static_cast<void>(grabs.set_time({0, dt}));
            EXPECT_EQ(grabs.begin_step({x, still, x, still, dt, 1 / dt, false}),
                      damping > 0 || most < 90);
            // Nor is it that once the step is over.
            EXPECT_EQ(grabs.set_time({0, dt}), damping > 0 || most < 90);
            EXPECT_FALSE(grabs.set_time({0, dt}));
        }
    }
}

TYPED_TEST(GrabsTest, TakeTheirAnchorStraightToItsPlaceAndWakeMeanwhile) {
    constexpr int kDim = TypeParam::value;
    const Setting<kDim> setting = two_bodies<kDim>();
    auto held = holding<kDim>(setting.bodies);
    held.grab.damping = 0;
    Grabs<kDim> grabs(setting.scene, setting.bodies);
    const double dt = setting.scene.dt();
    grabs.set({held}, 7 * dt);
    const auto pull = [&](double end) {
        static_cast<void>(grabs.set_time({7 * dt, end}));
        return Vector<kDim>(gradient_of<kDim>(grabs, setting.bodies.rest()).rowwise().sum() / 300);
    };
    const auto driven = [&] {
        Couplings couplings;
        grabs.add_couplings(couplings);
        return couplings.driven;
    };
    const Vector<kDim> at_end = pull(8 * dt);
    EXPECT_LT((pull(7.25 * dt) - at_end + 0.075 * Vector<kDim>::Unit(0)).norm(), 1e-12);
    EXPECT_EQ(driven(), std::vector<std::size_t>{1});
    grabs.arrive();
    EXPECT_EQ(pull(8 * dt), at_end);
    EXPECT_EQ(pull(9 * dt), at_end);
    EXPECT_TRUE(driven().empty());
}

// (2 mu + |lambda|) V^((n - 1) / n): at the inner vertex of a cube of 2^n cells of 0.25 m, all of
// which are around it; n! simplices have a corner there for each of its 2 cells along the diagonal
// through it, and those of the other cells fewer, 24 and 120 in all.
TYPED_TEST(GrabsTest, BearWhatStrainsTheCellsAroundTheirPoint) {
    constexpr int kDim = TypeParam::value;
    const Setting<kDim> setting = two_bodies<kDim>();
    const auto& mesh = setting.bodies.meshes[0];
    const Vector<kDim> middle = Vector<kDim>::Constant(0.25);
    for (Eigen::Index cell = 0; cell < mesh.cell_count(); ++cell) {
        for (int i = 0; i <= kDim; ++i) {
            if ((mesh.positions.col(mesh.cells(i, cell)) - middle).norm() > 1e-9) {
                continue;
            }
            BodyPoint<kDim> point{.body = 0, .cell = cell};
            point.weights[i] = 1;
            const Lame& lame = setting.scene.bodies[0].material.lame;
            const int around = kDim == 3 ? 24 : 120;
            const int in_a_cube = kDim == 3 ? 6 : 24;
            const double volume = around * std::pow(0.25, kDim) / in_a_cube;
            EXPECT_NEAR(bearable_force(setting.bodies, point)
                            / ((2 * lame.mu + lame.lambda) * std::pow(volume, 1 - 1.0 / kDim)),
                        1, 1e-12);
            return;
        }
    }
    FAIL() << "the cube has no inner vertex";
}

// Of the material of the cell, in whichever body and region it is.
TYPED_TEST(GrabsTest, BearWhatStrainsTheMaterialAtTheirPoint) {
    constexpr int kDim = TypeParam::value;
    Scene scene = test::two_cubes<kDim>(0.03);
    scene.contact.reset();
    const Setting<kDim> soft(scene, 2);
    Material stiff = scene.bodies[1].material;
    stiff.lame = lame_from_young(kDim, 1e7, 0.2);
    scene.bodies[1].regions = {
        {.name = "stiff",
         .select = {HalfSpaceSelection{.normal = Eigen::VectorXd::Unit(kDim, 1), .offset = 0.78}},
         .material = stiff}};
    const Setting<kDim> mixed(scene, 2);
    for (Body& body : scene.bodies) {
        body.regions.clear();
        body.material = stiff;
    }
    const Setting<kDim> hard(scene, 2);
    for (int body = 0; body < 2; ++body) {
        const auto& mesh = mixed.bodies.meshes[static_cast<std::size_t>(body)];
        for (Eigen::Index cell = 0; cell < mesh.cell_count(); ++cell) {
            BodyPoint<kDim> point{.body = body, .cell = cell};
            point.weights.setConstant(1.0 / (kDim + 1));
            const double height = mesh.positions(1, mesh.cells.col(cell)).mean();
            const Setting<kDim>& alike = body == 1 && height < 0.78 ? hard : soft;
            EXPECT_NEAR(bearable_force(mixed.bodies, point) / bearable_force(alike.bodies, point),
                        1, 1e-12);
        }
    }
}

TYPED_TEST(GrabsTest, DoNothingWithoutAny) {
    constexpr int kDim = TypeParam::value;
    const Setting<kDim> setting = two_bodies<kDim>();
    Grabs<kDim> grabs(setting.scene, setting.bodies);
    EXPECT_FALSE(grabs.set_time({1, 2}));
    EXPECT_EQ(value_of<kDim>(grabs, setting.bodies.rest()), 0);
    EXPECT_TRUE(grabs.energies().empty());
}

}  // namespace
}  // namespace pent::simulator
