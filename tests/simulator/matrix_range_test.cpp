#include "step/matrix_range.h"

#include "potential_laws.h"

#include <pent/simulator/simulation.h>
#include <pent/simulator/words.h>

#include <cmath>

// Bodies of all sizes and masses: no motion depends on the units in which it is told.

namespace pent::simulator {
namespace {

using test::cube_for;
using test::Dimensions;

template <typename T>
class MatrixRangeTest : public testing::Test {};
TYPED_TEST_SUITE(MatrixRangeTest, Dimensions);

// A cube that is held at one side and sags.
template <int Dim>
Scene hanging_cube(ElementKind elements, Precision precision) {
    Scene scene = test::two_cubes<Dim>(0.3);
    scene.bodies.resize(1);
    scene.contact.reset();
    scene.gravity[1] = -9.8;
    scene.solver.elements = elements;
    scene.solver.precision = precision;
    scene.solver.tolerance = 1e-6;
    scene.damping = Damping{.mass = 0.3, .stiffness = 0.003};
    scene.constraints = {
        {.body = scene.bodies[0].name,
         .select = {HalfSpaceSelection{.normal = Vector<Dim>::UnitX(), .offset = 0.05}},
         .motion = {test::still(Dim)}}};
    return scene;
}

// The same in other units, of length and of mass.
template <int Dim>
Scene scaled(Scene scene, double length, double mass) {
    const double pressure = mass * std::pow(length, 2 - Dim);
    scene.gravity *= length;
    scene.bodies[0].place.scale *= length;
    Material& material = scene.bodies[0].material;
    material.lame.mu *= pressure;
    material.lame.lambda *= pressure;
    material.density *= mass * std::pow(length, -Dim);
    std::get<HalfSpaceSelection>(scene.constraints[0].select[0]).offset *= length;
    return scene;
}

template <int Dim>
Positions<Dim> moved(const Scene& scene) {
    Simulation<Dim> simulation(scene, {cube_for<Dim>(scene, 2)});
    for (int k = 0; k < 3; ++k) {
        EXPECT_TRUE(simulation.step().is_accepted);
    }
    return simulation.positions(0);
}

TYPED_TEST(MatrixRangeTest, MotionIsTheSameInAllUnits) {
    constexpr int kDim = TypeParam::value;
    for (const Integrator integrator : {Integrator::LinearEuler, Integrator::Quasistatic}) {
        for (const ElementKind elements :
             {ElementKind::Linear, ElementKind::Smoothed, ElementKind::Quadratic}) {
            for (const Precision precision : {Precision::Float, Precision::Double}) {
                Scene scene = hanging_cube<kDim>(elements, precision);
                scene.solver.integrator = integrator;
                const Positions<kDim> expected = moved<kDim>(scene);
                const auto expect_same = [&](double length, double mass) {
                    const Positions<kDim> found =
                        moved<kDim>(scaled<kDim>(scene, length, mass)) / length;
                    EXPECT_LT((found - expected).cwiseAbs().maxCoeff(), 1e-5)
                        << word_of(elements) << ", " << word_of(precision) << ", "
                        << word_of(integrator) << ", " << length << " m, " << mass << " kg";
                };
                for (const int power : {-40, -33, -26, -20, 20, 30, 40}) {
                    const double length = std::ldexp(1.0, power);
                    expect_same(length, std::pow(length, kDim));      // of the same density
                    expect_same(length, std::pow(length, kDim - 2));  // of the same stiffness
                }
                expect_same(std::ldexp(1.0, 63), std::ldexp(1.0, 160));
                expect_same(1, std::ldexp(1.0, -80));
                expect_same(1, std::ldexp(1.0, 80));
            }
        }
    }
}

// Bodies of a usual size and of one far from it in one scene.
TYPED_TEST(MatrixRangeTest, MotionIsTheSameBesideABodyInOtherUnits) {
    constexpr int kDim = TypeParam::value;
    const Scene alone = hanging_cube<kDim>(ElementKind::Linear, Precision::Float);
    const Positions<kDim> expected = moved<kDim>(alone);
    const double length = std::ldexp(1.0, -33);
    Scene both = alone;
    both.bodies.push_back(scaled<kDim>(alone, length, std::pow(length, kDim)).bodies[0]);
    both.bodies[1].name = "small";
    Simulation<kDim> simulation(both, {cube_for<kDim>(both, 2), cube_for<kDim>(both, 2)});
    for (int k = 0; k < 3; ++k) {
        EXPECT_TRUE(simulation.step().is_accepted);
    }
    EXPECT_LT((simulation.positions(0) - expected).cwiseAbs().maxCoeff(), 1e-5);
    // Free: all of it falls alike.
    const Positions<kDim> small = simulation.positions(1);
    const Positions<kDim> start =
        Simulation<kDim>(both, {cube_for<kDim>(both, 2), cube_for<kDim>(both, 2)}).positions(1);
    const Positions<kDim> fall = small - start;
    EXPECT_LT((fall.colwise() - fall.col(0)).cwiseAbs().maxCoeff(), 1e-6 * length);
}

TEST(MatrixRange, LeavesUsualScenesAsTheyAre) {
    const Material rubber{.lame = lame_from_young(4, 1e5, 0.28), .density = 1000};
    const std::vector<CellRange> ranges = {{.begin = 0, .end = 1, .material = rubber}};
    for (const double size : {1e-4, 1.0, 1e4}) {
        const Eigen::VectorXd masses = Eigen::VectorXd::Constant(5, 1000 * std::pow(size, 4));
        const MatrixRange range(4, masses, ranges);
        EXPECT_EQ(range.unit(1, 1e-3), 1);
        EXPECT_TRUE(range.is_in_float(1, 1e-3));
    }
    // Nor is there anything to save of a stiffness that is none beside the masses.
    const Material soft{.lame = lame_from_young(4, 1e-25, 0.28), .density = 1000};
    const MatrixRange range(4, Eigen::VectorXd::Constant(5, 1000),
                            {{.begin = 0, .end = 1, .material = soft}});
    EXPECT_EQ(range.unit(1, 1e-3), 1);
    EXPECT_TRUE(range.is_in_float(1, 1e-3));
    EXPECT_FALSE(range.is_in_float(0, 1));
}

}  // namespace
}  // namespace pent::simulator
