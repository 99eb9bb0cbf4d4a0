#include "potentials/rayleigh_damping.h"

#include "potential_laws.h"

#include <Eigen/Eigenvalues>

namespace pent::simulator {
namespace {

using test::Dimensions;
using test::expect_derivatives;
using test::gradient_of;
using test::Setting;
using test::shaken;
using test::value_of;

template <typename T>
class RayleighDampingTest : public testing::Test {};
TYPED_TEST_SUITE(RayleighDampingTest, Dimensions);

TYPED_TEST(RayleighDampingTest, IsAQuadraticOfTheTangentThatPullsBack) {
    constexpr int kDim = TypeParam::value;
    const Scene scene = test::box_scene<kDim>();
    const Setting<kDim> setting(scene, 2);
    Elasticity<kDim> elasticity(setting.workers, setting.isa, setting.bodies, setting.held, scene);
    RayleighDamping<kDim> damping(setting.workers, setting.isa.blocks, elasticity,
                                  std::make_shared<const DofMap>(setting.dofs),
                                  setting.bodies.sharing, Filter::Clamp);
    const Positions<kDim> start = shaken<kDim>(setting.bodies.rest(), 0.05, 10);
    const Positions<kDim> still = Positions<kDim>::Zero(kDim, start.cols());
    static_cast<void>(value_of<kDim>(elasticity, start));
    static_cast<void>(damping.begin_step({start, still, start, still, 0.01, 100, false}));
    const Positions<kDim> x = shaken<kDim>(start, 0.05, 11);
    expect_derivatives<kDim>(setting, damping, x);
    EXPECT_GT(value_of<kDim>(damping, x), 0);
    EXPECT_EQ(value_of<kDim>(damping, start), 0);
    // Twice as far costs four times as much, and a shift of everything nothing.
    const Positions<kDim> far = start + 2 * (x - start);
    EXPECT_NEAR(value_of<kDim>(damping, far), 4 * value_of<kDim>(damping, x),
                1e-9 * value_of<kDim>(damping, far));
    const Positions<kDim> shifted = start.array() + 0.3;
    EXPECT_LT(std::abs(value_of<kDim>(damping, shifted)), 1e-9 * value_of<kDim>(damping, far));
}

// The tangent is that of the elements: those of cells, of edges, and of quadratic cells, which
// couple more.
TYPED_TEST(RayleighDampingTest, HasTheDerivativesOfItsEnergyWithElementsOfEveryKind) {
    constexpr int kDim = TypeParam::value;
    for (const ElementKind kind :
         {ElementKind::Linear, ElementKind::Smoothed, ElementKind::Quadratic}) {
        Scene scene = test::box_scene<kDim>();
        scene.solver.elements = kind;
        const Setting<kDim> setting(scene, 2);
        Elasticity<kDim> elasticity(setting.workers, setting.isa, setting.bodies, setting.held,
                                    scene);
        RayleighDamping<kDim> damping(setting.workers, setting.isa.blocks, elasticity,
                                      std::make_shared<const DofMap>(setting.dofs),
                                      setting.bodies.sharing, Filter::Clamp);
        const Positions<kDim> start = shaken<kDim>(setting.bodies.rest(), 0.05, 12);
        const Positions<kDim> still = Positions<kDim>::Zero(kDim, start.cols());
        static_cast<void>(value_of<kDim>(elasticity, start));
        static_cast<void>(damping.begin_step({start, still, start, still, 0.01, 100, false}));
        const Positions<kDim> x = shaken<kDim>(start, 0.05, 13);
        expect_derivatives<kDim>(setting, *elasticity.pattern(), damping, x);
        // Twice the energy is what its slope does along the way from the start.
        const double work = gradient_of<kDim>(damping, x).cwiseProduct(x - start).sum();
        EXPECT_NEAR(work, 2 * value_of<kDim>(damping, x), 1e-12 * work);
    }
}

// Vertices that a step takes along damp the others as they do where they are solved for: what is
// said of free vertices is the same, and so is what the value does from one place to another.
TYPED_TEST(RayleighDampingTest, CountsTheWayOfHeldVertices) {
    constexpr int kDim = TypeParam::value;
    Scene scene = test::box_scene<kDim>();
    const Setting<kDim> free(scene, 2);
    scene.constraints = {
        test::hold(HalfSpaceSelection{.normal = Eigen::VectorXd::Unit(kDim, 0), .offset = 1e-6},
                   test::still(kDim))};
    const Setting<kDim> held(scene, 2);
    const Positions<kDim> start = shaken<kDim>(free.bodies.rest(), 0.05, 10);
    const Positions<kDim> still = 0 * start;
    Positions<kDim> x = shaken<kDim>(start, 0.05, 11);
    Positions<kDim> other = shaken<kDim>(start, 0.05, 12);
    Positions<kDim> way = x - start;
    for (std::uint32_t vertex = 0; vertex < x.cols(); ++vertex) {
        if (held.held.is_held(vertex)) {
            other.col(vertex) = x.col(vertex);
        } else {
            way.col(vertex).setZero();
        }
    }
    struct Said {
        Positions<kDim> gradient;
        double rise;
    };
    const auto say = [&](const Setting<kDim>& of, const Positions<kDim>& prescribed) -> Said {
        Elasticity<kDim> elasticity(of.workers, of.isa, of.bodies, of.held, of.scene);
        RayleighDamping<kDim> damping(of.workers, of.isa.blocks, elasticity,
                                      std::make_shared<const DofMap>(of.dofs), of.bodies.sharing,
                                      Filter::Clamp);
        static_cast<void>(value_of<kDim>(elasticity, start));
        EXPECT_TRUE(damping.begin_step({start, still, start, prescribed, 0.01, 100, false}));
        return {gradient_of<kDim>(damping, x),
                value_of<kDim>(damping, x) - value_of<kDim>(damping, other)};
    };
    const Said whole = say(free, still);
    const Said part = say(held, way);
    EXPECT_NEAR(part.rise, whole.rise, 1e-11 * std::abs(whole.rise));
    for (const std::uint32_t vertex : held.dofs.vertices()) {
        EXPECT_LT((part.gradient - whole.gradient).col(vertex).norm(),
                  1e-12 * whole.gradient.norm());
    }
}

// Of a cube at the start of a step.
template <int Dim>
struct Damped {
    Scene scene = test::box_scene<Dim>();
    Setting<Dim> setting{scene, 2};
    Elasticity<Dim> elasticity{setting.workers, setting.isa, setting.bodies, setting.held, scene};
    RayleighDamping<Dim> damping;
    Positions<Dim> start;
    Positions<Dim> still = 0 * setting.bodies.rest();

    Damped(Filter filter, const Matrix<Dim>& map, double shake)
        : damping(setting.workers,
                  setting.isa.blocks,
                  elasticity,
                  std::make_shared<const DofMap>(setting.dofs),
                  setting.bodies.sharing,
                  filter),
          start(map * shaken<Dim>(setting.bodies.rest(), shake, 12)) {
        static_cast<void>(value_of<Dim>(elasticity, start));
        static_cast<void>(damping.begin_step({start, still, start, still, 0.01, 100, false}));
    }
};

// The smallest eigenvalue of the Hessian as a part of its size.
template <int Dim>
double smallest_eigenvalue(Damped<Dim>& body) {
    const Eigen::MatrixXd hessian =
        test::hessian_of<Dim>(body.setting, *body.elasticity.pattern(), body.damping, body.start);
    return Eigen::SelfAdjointEigenSolver<Eigen::MatrixXd>(hessian, Eigen::EigenvaluesOnly)
               .eigenvalues()[0]
           / hessian.norm();
}

// Flat, turned inside out, in one line: the tangent is filtered there, so that it takes energy, and
// what damps a body from within pushes it nowhere.
TYPED_TEST(RayleighDampingTest, TakesEnergyAndNoMomentumFromFlatAndInvertedStarts) {
    constexpr int kDim = TypeParam::value;
    Matrix<kDim> flat = Matrix<kDim>::Identity();
    flat(1, 1) = 0;
    Matrix<kDim> inside_out = Matrix<kDim>::Identity();
    inside_out(0, 0) = -1;
    const Matrix<kDim> line = Vector<kDim>::Unit(0).asDiagonal();
    for (const Matrix<kDim>& map : {flat, inside_out, line}) {
        Damped<kDim> unfiltered(Filter::None, map, 0.03);
        if (kDim == 3 || map != line) {  // det F has no second derivative at a line in 4D
            EXPECT_LT(smallest_eigenvalue(unfiltered), -1e-3);
        }
        for (const Filter filter : {Filter::Clamp, Filter::Absolute}) {
            Damped<kDim> body(filter, map, 0.03);
            EXPECT_GT(smallest_eigenvalue(body), -1e-14);
            for (unsigned seed = 20; seed < 24; ++seed) {
                const Positions<kDim> x = shaken<kDim>(body.start, 0.05, seed);
                EXPECT_GE(value_of<kDim>(body.damping, x), 0);
                const Positions<kDim> gradient = gradient_of<kDim>(body.damping, x);
                EXPECT_LT(gradient.rowwise().sum().norm(), 1e-12 * gradient.norm());
            }
            expect_derivatives<kDim>(body.setting, body.damping,
                                     shaken<kDim>(body.start, 0.05, 24));
        }
    }
}

// A body that is not strained, however it lies: no turn about any point, taken to first order, is
// damped, so that nothing is turned; and what is damped turns with the body.
TYPED_TEST(RayleighDampingTest, TakesNoAngularMomentumAndTurnsWithTheBody) {
    constexpr int kDim = TypeParam::value;
    const Matrix<kDim> turn = test::any_rotation<kDim>();
    Damped<kDim> upright(Filter::Clamp, Matrix<kDim>::Identity(), 0);
    Damped<kDim> turned(Filter::Clamp, turn, 0);
    const Positions<kDim> way = shaken<kDim>(upright.still, 0.05, 30);
    const Positions<kDim> x = turned.start + turn * way;
    const Positions<kDim> gradient = gradient_of<kDim>(turned.damping, x);
    EXPECT_LT(gradient.rowwise().sum().norm(), 1e-12 * gradient.norm());
    const Matrix<kDim> torque = gradient * turned.start.transpose();
    EXPECT_LT((torque - torque.transpose()).norm(), 1e-11 * gradient.norm() * turned.start.norm());
    const double value = value_of<kDim>(upright.damping, upright.start + way);
    EXPECT_GT(value, 0);
    EXPECT_NEAR(value_of<kDim>(turned.damping, x), value, 1e-11 * value);
    const Positions<kDim> of_upright = gradient_of<kDim>(upright.damping, upright.start + way);
    EXPECT_LT((gradient - turn * of_upright).norm(), 1e-11 * gradient.norm());
    // A slow turn by 0.1 in the plane of the first and the last axis.
    Matrix<kDim> spin = Matrix<kDim>::Zero();
    spin(0, kDim - 1) = -0.1;
    spin(kDim - 1, 0) = 0.1;
    EXPECT_LT(value_of<kDim>(turned.damping, turned.start + spin * turned.start), 1e-12 * value);
    expect_derivatives<kDim>(turned.setting, turned.damping, x);
}

}  // namespace
}  // namespace pent::simulator
