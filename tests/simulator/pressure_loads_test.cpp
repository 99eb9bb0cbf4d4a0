#include "potentials/pressure_loads.h"

#include "potential_laws.h"

#include <pent/error.h>
#include <pent/facets.h>

#include <Eigen/Eigenvalues>
#include <Eigen/LU>

#include <algorithm>
#include <functional>
#include <vector>

namespace pent::simulator {
namespace {

using test::any_rotation;
using test::Dimensions;
using test::expect_derivatives;
using test::expect_invariance_under_rigid_motion;
using test::gradient_of;
using test::hessian_of;
using test::Setting;
using test::shaken;
using test::value_of;

constexpr double kPressure = 7;

template <typename T>
class PressureLoadsTest : public testing::Test {};
TYPED_TEST_SUITE(PressureLoadsTest, Dimensions);

template <int Dim>
Scene pressed_scene(const Selection& selection) {
    Scene scene = test::box_scene<Dim>();
    scene.loads = {{.body = "box",
                    .select = {selection},
                    .force = {},
                    .pressure = kPressure,
                    .keyframes = {}}};
    return scene;
}

// The facets at x_0 <= 0.
template <int Dim>
Selection one_side() {
    return HalfSpaceSelection{.normal = Eigen::VectorXd::Unit(Dim, 0), .offset = 1e-9};
}

// One side and half of those around it: a rim with corners.
template <int Dim>
Selection one_half() {
    return HalfSpaceSelection{.normal = Eigen::VectorXd::Unit(Dim, 0), .offset = 0.3};
}

template <int Dim>
void begin(PressureLoads<Dim>& loads, const Positions<Dim>& x) {
    const Positions<Dim> none = Positions<Dim>::Zero(Dim, x.cols());
    EXPECT_TRUE(loads.begin_step({x, none, x, none, 0.01, 100, false}));
}

// -p n on each unit of every selected facet, by cofactors of its edges.
template <int Dim>
Positions<Dim> expected_forces(const Setting<Dim>& setting,
                               const Positions<Dim>& x,
                               const std::function<bool(std::uint32_t)>& is_selected) {
    Positions<Dim> forces = Positions<Dim>::Zero(Dim, x.cols());
    const auto& mesh = setting.bodies.meshes[0];
    const Simplices<Dim> facets = match_facets<Dim>(mesh.cells, mesh.vertex_count()).boundary;
    for (const auto& facet : facets.colwise()) {
        if (!std::all_of(facet.begin(), facet.end(), is_selected)) {
            continue;
        }
        Eigen::Matrix<double, Dim, Dim> edges;  // n . v = det[v, edges] / (Dim - 1)!
        for (int k = 1; k < Dim; ++k) {
            edges.col(k) = x.col(facet[k]) - x.col(facet[0]);
        }
        for (int axis = 0; axis < Dim; ++axis) {
            edges.col(0) = Eigen::Matrix<double, Dim, 1>::Unit(axis);
            for (const std::uint32_t vertex : facet) {
                forces(axis, vertex) -=
                    kPressure * edges.determinant() / ((Dim == 3 ? 2 : 6) * Dim);
            }
        }
    }
    return forces;
}

template <int Dim>
double volume_of(const Setting<Dim>& setting, const Positions<Dim>& x) {
    double volume = 0;
    for (Eigen::Index cell = 0; cell < setting.bodies.cells().cols(); ++cell) {
        volume += cell_volume<Dim>(x, setting.bodies.cells(), cell);
    }
    return volume;
}

TYPED_TEST(PressureLoadsTest, OnAClosedSurfaceIsPressureTimesVolumeAndNeitherPushesNorTurns) {
    constexpr int kDim = TypeParam::value;
    const Setting<kDim> setting(pressed_scene<kDim>(EverythingSelection{}), 2);
    PressureLoads<kDim> loads(setting.workers, setting.scene, setting.bodies, setting.held);
    const Positions<kDim> x = shaken<kDim>(setting.bodies.rest(), 0.05, 1);
    const double expected = kPressure * volume_of<kDim>(setting, x);
    EXPECT_NEAR(value_of<kDim>(loads, x), expected, 1e-13 * expected);
    expect_derivatives<kDim>(setting, loads, x);
    expect_invariance_under_rigid_motion<kDim>(loads, x);
    const Positions<kDim> forces =
        expected_forces<kDim>(setting, x, [](std::uint32_t) { return true; });
    EXPECT_LT((gradient_of<kDim>(loads, x) + forces).norm(), 1e-13 * forces.norm());
    EXPECT_EQ(loads.energies().at(0).name, "pressure");
    EXPECT_TRUE(loads.energies().at(0).is_stored);
}

// Where facets have no area left, and where the body is inside out.
TYPED_TEST(PressureLoadsTest, HasItsDerivativesWhereTheBodyIsFlatInsideOutOrAPoint) {
    constexpr int kDim = TypeParam::value;
    const std::vector<Selection> selections = {EverythingSelection{}, one_half<kDim>()};
    for (const Selection& selection : selections) {
        const Setting<kDim> setting(pressed_scene<kDim>(selection), 2);
        PressureLoads<kDim> loads(setting.workers, setting.scene, setting.bodies, setting.held);
        Positions<kDim> flat = shaken<kDim>(setting.bodies.rest(), 0.02, 4);
        flat.row(1).setConstant(0.25);
        Positions<kDim> inside_out = shaken<kDim>(setting.bodies.rest(), 0.02, 5);
        inside_out.row(0) *= -1;
        const std::vector<Positions<kDim>> states = {flat, inside_out};
        for (const Positions<kDim>& x : states) {
            expect_derivatives<kDim>(setting, loads, x);
        }
        const Positions<kDim> point = Positions<kDim>::Zero(kDim, flat.cols());
        begin<kDim>(loads, point);
        for (const Filter filter : {Filter::None, Filter::Clamp, Filter::Absolute}) {
            const auto pattern = make_pattern<kDim>(setting.bodies.cells(), setting.dofs);
            EXPECT_TRUE(hessian_of<kDim>(setting, pattern, loads, point, filter).allFinite());
        }
    }
}

TYPED_TEST(PressureLoadsTest, OnAnOpenSurfaceIsNormalToEachFacetAsItIsAtTheStartOfAStep) {
    constexpr int kDim = TypeParam::value;
    for (const double offset : {1e-9, 0.3}) {
        const Selection selection = offset > 0.1 ? one_half<kDim>() : one_side<kDim>();
        const Setting<kDim> setting(pressed_scene<kDim>(selection), 2);
        PressureLoads<kDim> loads(setting.workers, setting.scene, setting.bodies, setting.held);
        const auto is_selected = [&](std::uint32_t v) {
            return setting.bodies.rest()(0, v) <= offset;
        };
        const std::vector<Positions<kDim>> states = {setting.bodies.rest(),
                                                     shaken<kDim>(setting.bodies.rest(), 0.05, 2),
                                                     any_rotation<kDim>() * setting.bodies.rest()};
        for (const Positions<kDim>& x : states) {
            begin<kDim>(loads, x);
            const Positions<kDim> forces = expected_forces<kDim>(setting, x, is_selected);
            EXPECT_LT((gradient_of<kDim>(loads, x) + forces).norm(), 1e-13 * forces.norm());
            // Behind the start it is the gradient of its energy all the same.
            expect_derivatives<kDim>(setting, loads, shaken<kDim>(x, 0.03, 3));
        }
        EXPECT_EQ(loads.energies().at(0).name, "open_pressure");
        EXPECT_FALSE(loads.energies().at(0).is_stored);
    }
}

// Vertices inside of a rim are pushed as they should be wherever they go within the step; a rim
// that is held for good makes all of it an energy.
TYPED_TEST(PressureLoadsTest, WithinAFixedRimFollowsTheSurfaceExactly) {
    constexpr int kDim = TypeParam::value;
    Scene scene = pressed_scene<kDim>(one_half<kDim>());
    // All but the side x_0 = 0: the rim and what is behind it.
    const HalfSpaceSelection behind{.normal = -Eigen::VectorXd::Unit(kDim, 0), .offset = -0.1};
    scene.constraints = {{.body = "box", .select = {behind}, .motion = {}}};
    const Setting<kDim> setting(scene, 2);
    PressureLoads<kDim> loads(setting.workers, setting.scene, setting.bodies, setting.held);
    EXPECT_TRUE(loads.energies().at(0).is_stored);
    Positions<kDim> x = setting.bodies.rest();
    for (const std::uint32_t vertex : setting.dofs.vertices()) {
        x.col(vertex) = shaken<kDim>(x.col(vertex), 0.1, 7 + vertex);
    }
    const Positions<kDim> forces = expected_forces<kDim>(
        setting, x, [&](std::uint32_t v) { return setting.bodies.rest()(0, v) <= 0.3; });
    const Positions<kDim> gradient = gradient_of<kDim>(loads, x);
    for (const std::uint32_t vertex : setting.dofs.vertices()) {
        EXPECT_LT((gradient.col(vertex) + forces.col(vertex)).norm(), 1e-13 * forces.norm());
    }
    begin<kDim>(loads, x);
    const double value = value_of<kDim>(loads, x);
    begin<kDim>(loads, setting.bodies.rest());
    EXPECT_NEAR(value_of<kDim>(loads, x), value, 1e-13 * std::abs(value));
    // Of a rim that is carried along it is none, nor of one that is let go.
    scene.constraints[0].motion = {test::still(kDim)};
    const Setting<kDim> moving(scene, 2);
    EXPECT_FALSE(PressureLoads<kDim>(moving.workers, scene, moving.bodies, moving.held)
                     .energies()
                     .at(0)
                     .is_stored);
    scene.constraints[0].motion.clear();
    scene.constraints[0].to = 1;
    const Setting<kDim> held_once(scene, 2);
    EXPECT_FALSE(PressureLoads<kDim>(held_once.workers, scene, held_once.bodies, held_once.held)
                     .energies()
                     .at(0)
                     .is_stored);
}

// Each is as it is alone: what is stored of one, and of another that is open.
TYPED_TEST(PressureLoadsTest, OfSeveralPartsAreTheSumOfTheseAndNamedByWhatIsStored) {
    constexpr int kDim = TypeParam::value;
    const Load closed = pressed_scene<kDim>(EverythingSelection{}).loads[0];
    Load open = pressed_scene<kDim>(one_half<kDim>()).loads[0];
    open.pressure = -3;
    const auto made = [](const std::vector<Load>& loads) {
        Scene scene = test::box_scene<kDim>();
        scene.loads = loads;
        return scene;
    };
    const Setting<kDim> both(made({open, closed}), 2);
    const Setting<kDim> first(made({open}), 2);
    const Setting<kDim> second(made({closed}), 2);
    PressureLoads<kDim> sum(both.workers, both.scene, both.bodies, both.held);
    PressureLoads<kDim> lagged(first.workers, first.scene, first.bodies, first.held);
    PressureLoads<kDim> stored(second.workers, second.scene, second.bodies, second.held);
    const Positions<kDim> x = shaken<kDim>(both.bodies.rest(), 0.05, 9);
    const double of_lagged = value_of<kDim>(lagged, x);
    const double of_stored = value_of<kDim>(stored, x);
    EXPECT_EQ(value_of<kDim>(sum, x), of_stored + of_lagged);
    const std::vector<TermEnergy> parts = sum.energies();
    ASSERT_EQ(parts.size(), 2);
    EXPECT_EQ(parts[0].name, "pressure");
    EXPECT_EQ(parts[0].energy, of_stored);
    EXPECT_EQ(parts[1].name, "open_pressure");
    EXPECT_EQ(parts[1].energy, of_lagged);
    const Positions<kDim> gradient = gradient_of<kDim>(lagged, x) + gradient_of<kDim>(stored, x);
    EXPECT_LT((gradient_of<kDim>(sum, x) - gradient).norm(), 1e-14 * gradient.norm());
    const auto pattern = make_pattern<kDim>(both.bodies.cells(), both.dofs);
    const Eigen::MatrixXd hessian =
        hessian_of<kDim>(first, pattern, lagged, x) + hessian_of<kDim>(second, pattern, stored, x);
    EXPECT_LT((hessian_of<kDim>(both, pattern, sum, x) - hessian).norm(), 1e-14 * hessian.norm());
}

TYPED_TEST(PressureLoadsTest, FollowsItsKeyframesAndSaysThatTheBodyIsDriven) {
    constexpr int kDim = TypeParam::value;
    Scene scene = pressed_scene<kDim>(one_half<kDim>());
    scene.bodies.insert(scene.bodies.begin(), scene.bodies[0]);
    scene.bodies[0].name = "other";
    const Setting<kDim> steady(scene, 2);
    PressureLoads<kDim> whole(steady.workers, steady.scene, steady.bodies, steady.held);
    const Positions<kDim> x = shaken<kDim>(steady.bodies.rest(), 0.05, 3);
    const Positions<kDim> full = gradient_of<kDim>(whole, x);
    const Eigen::Index half = steady.bodies.first_vertex[1];
    EXPECT_TRUE(full.leftCols(half).isZero(0));
    EXPECT_GT(full.rightCols(half).norm(), 0.1);
    scene.loads[0].keyframes = {{1, 0.25}, {2, 0.5}};
    const Setting<kDim> setting(scene, 2);
    PressureLoads<kDim> loads(setting.workers, setting.scene, setting.bodies, setting.held);
    EXPECT_TRUE(loads.set_time({0, 0.5}));  // before the first, as there
    EXPECT_LT((gradient_of<kDim>(loads, x) - 0.25 * full).norm(), 1e-14 * full.norm());
    const auto driven = [&] {
        Couplings couplings;
        loads.add_couplings(couplings);
        return couplings.driven;
    };
    EXPECT_TRUE(driven().empty());
    EXPECT_TRUE(loads.set_time({1, 2}));
    EXPECT_LT((gradient_of<kDim>(loads, x) - 0.5 * full).norm(), 1e-14 * full.norm());
    EXPECT_EQ(driven(), std::vector<std::size_t>{1});
    EXPECT_FALSE(loads.set_time({2, 3}));
    EXPECT_TRUE(driven().empty());
}

// A body under pressure from all sides moves as a whole for nothing, in its filtered Hessian, too:
// there is none. Filtered facet by facet it would not be so.
TYPED_TEST(PressureLoadsTest, HasAHessianThatLetsABodyMoveAsAWholeAndNoneWhereItIsFiltered) {
    constexpr int kDim = TypeParam::value;
    const Setting<kDim> setting(pressed_scene<kDim>(EverythingSelection{}), 2);
    PressureLoads<kDim> loads(setting.workers, setting.scene, setting.bodies, setting.held);
    const auto pattern = make_pattern<kDim>(setting.bodies.cells(), setting.dofs);
    const Positions<kDim> x = shaken<kDim>(setting.bodies.rest(), 0.05, 9);
    const Eigen::MatrixXd exact = hessian_of<kDim>(setting, pattern, loads, x);
    const Eigen::VectorXd values =
        Eigen::SelfAdjointEigenSolver<Eigen::MatrixXd>(exact).eigenvalues();
    EXPECT_LT(values.minCoeff(), -1e-2 * values.maxCoeff());
    for (int axis = 0; axis < kDim; ++axis) {
        const Positions<kDim> way =
            Eigen::Matrix<double, kDim, 1>::Unit(axis).replicate(1, x.cols());
        EXPECT_LT((exact * way.reshaped()).norm(), 1e-12 * exact.norm() * way.norm());
    }
    for (const Filter filter : {Filter::Clamp, Filter::Absolute}) {
        EXPECT_TRUE(hessian_of<kDim>(setting, pattern, loads, x, filter).isZero(0));
    }
}

TYPED_TEST(PressureLoadsTest, RefusesASelectionWithoutAWholeFacet) {
    constexpr int kDim = TypeParam::value;
    Scene scene =
        pressed_scene<kDim>(BallSelection{.center = Eigen::VectorXd::Zero(kDim), .radius = 0.01});
    scene.loads[0].source = "scene.toml:7:3";
    try {
        const Setting<kDim> setting(scene, 2);
        const PressureLoads<kDim> loads(setting.workers, setting.scene, setting.bodies,
                                        setting.held);
        FAIL();
    } catch (const Error& error) {
        EXPECT_EQ(std::string(error.what()),
                  "scene.toml:7:3: load on \"box\" has a pressure, but no facet of the boundary"
                  " with all of its "
                      + std::to_string(kDim) + " vertices selected; select more of the boundary");
    }
}

}  // namespace
}  // namespace pent::simulator
