// Quadratic elements with mean dilatation: what holds for them and not for
// linear ones, and that the rest of a simulation takes them as it takes those. Their kernels are
// tested in kernels_test.cpp.

#include "contact_scenes.h"
#include "elastic_box.h"
#include "kernel_reference.h"
#include "potential_laws.h"
#include "scenes.h"

#include <pent/simulator/energy.h>
#include <pent/simulator/simulation.h>
#include <pent/simulator/words.h>

#include <Eigen/Eigenvalues>
#include <gtest/gtest.h>

namespace pent::simulator {
namespace {

using pent::test::quadratic_kuhn_box;
using test::Dimensions;
using test::ElasticBox;
using test::quadratic_cube;

template <typename T>
class QuadraticBodyTest : public testing::Test {};
TYPED_TEST_SUITE(QuadraticBodyTest, Dimensions);

// Corners moved at random, middles halfway or moved, too.
template <int Dim>
SimplexMesh<Dim> distorted(SimplexMesh<Dim> mesh, double size, bool is_straight) {
    const QuadraticSimplices<Dim> simplices = quadratic_simplices<Dim>(mesh, "box");
    mesh.positions = test::shaken<Dim>(mesh.positions, size, 5);
    int middle = Dim + 1;
    for (int a = 0; is_straight && a <= Dim; ++a) {
        for (int b = a + 1; b <= Dim; ++b, ++middle) {
            for (Eigen::Index s = 0; s < simplices.cols(); ++s) {
                mesh.positions.col(simplices(middle, s)) =
                    0.5
                    * (mesh.positions.col(simplices(a, s)) + mesh.positions.col(simplices(b, s)));
            }
        }
    }
    return mesh;
}

Material soft(Model model, double lambda = 1.3) {
    return {.model = model, .lame = {.lambda = lambda, .mu = 0.7}, .second_invariant = 0.4};
}

// Motions that cost no energy at rest: the rigid ones and no other, also of a single simplex.
template <int Dim>
void expect_rigid_modes_alone(const SimplexMesh<Dim>& mesh) {
    const ElasticBox<Dim> box(mesh, soft(Model::StableNeoHookean), ElementKind::Quadratic);
    const Eigen::MatrixXd K = box.template stiffness<double>(best_isa(), Filter::None);
    const Eigen::VectorXd values = Eigen::SelfAdjointEigenSolver<Eigen::MatrixXd>(K).eigenvalues();
    constexpr int kRigid = Dim * (Dim + 1) / 2;
    EXPECT_LT(values.head(kRigid).cwiseAbs().maxCoeff(), 1e-12 * values.maxCoeff());
    EXPECT_GT(values[kRigid], 1e-6 * values.maxCoeff());
}

// The children of the first quadratic cell alone.
template <int Dim>
SimplexMesh<Dim> one_parent() {
    const SimplexMesh<Dim> all = quadratic_cube<Dim>();
    SimplexMesh<Dim> one;
    std::vector<std::uint32_t> number(static_cast<std::size_t>(all.vertex_count()), 0);
    for (Eigen::Index cell = 0; cell < all.cell_count(); ++cell) {
        if (all.parents[static_cast<std::size_t>(cell)] != all.parents[0]) {
            continue;
        }
        one.cells.conservativeResize(Dim + 1, one.cells.cols() + 1);
        for (int a = 0; a <= Dim; ++a) {
            std::uint32_t& own = number[all.cells(a, cell)];
            if (own == 0) {
                one.positions.conservativeResize(Dim, one.positions.cols() + 1);
                one.positions.rightCols(1) = all.positions.col(all.cells(a, cell));
                own = static_cast<std::uint32_t>(one.positions.cols());
            }
            one.cells(a, one.cells.cols() - 1) = own - 1;
        }
    }
    return one;
}

TYPED_TEST(QuadraticBodyTest, GivesWayToRigidMotionsAndNoOthers) {
    constexpr int kDim = TypeParam::value;
    expect_rigid_modes_alone<kDim>(one_parent<kDim>());
    expect_rigid_modes_alone<kDim>(distorted<kDim>(one_parent<kDim>(), 0.04, false));
    expect_rigid_modes_alone<kDim>(distorted<kDim>(quadratic_cube<kDim>(), 0.04, true));
}

// Affine motions: linear children have the same energy and the same forces in sum, and inside all
// forces cancel (the patch test), whatever the shape of straight cells.
TYPED_TEST(QuadraticBodyTest, SeesAffineMotionsAsItsLinearChildrenDo) {
    constexpr int kDim = TypeParam::value;
    const SimplexMesh<kDim> mesh = distorted<kDim>(quadratic_cube<kDim>(2), 0.05, true);
    std::vector<bool> is_outside(static_cast<std::size_t>(mesh.vertex_count()), false);
    const SimplexMesh<kDim> regular = quadratic_cube<kDim>(2);
    for (Eigen::Index v = 0; v < mesh.vertex_count(); ++v) {
        const auto place = regular.positions.col(v).array();
        is_outside[static_cast<std::size_t>(v)] = place.minCoeff() == 0 || place.maxCoeff() == 1;
    }
    std::mt19937 random(11);
    std::normal_distribution<double> normal(0, 0.4);
    for (const Model law : values<Model>()) {
        const ElasticBox<kDim> quadratic(mesh, soft(law), ElementKind::Quadratic);
        const ElasticBox<kDim> linear(mesh, soft(law), ElementKind::Linear);
        const Eigen::Matrix<double, kDim, kDim> A =
            Eigen::Matrix<double, kDim, kDim>::Identity()
            + Eigen::Matrix<double, kDim, kDim>::NullaryExpr([&] { return normal(random); });
        const Positions<kDim> moved = A * mesh.positions;
        Positions<kDim> forces;
        Positions<kDim> of_linear;
        const double energy = quadratic.forces(best_isa(), moved, forces).energy;
        const double expected = linear.forces(best_isa(), moved, of_linear).energy;
        EXPECT_NEAR(energy, expected, 1e-12 * expected);
        EXPECT_LT(
            (forces * mesh.positions.transpose() - of_linear * mesh.positions.transpose()).norm(),
            1e-11 * of_linear.norm());
        for (Eigen::Index v = 0; v < mesh.vertex_count(); ++v) {
            if (!is_outside[static_cast<std::size_t>(v)]) {
                EXPECT_LT(forces.col(v).norm(), 1e-12 * forces.norm());
            }
        }
    }
}

// The strain energy of a displacement of degree 2 where nothing acts on the mean: an integral of a
// polynomial of degree 2, here by Gauss's rule with two points an axis.
TYPED_TEST(QuadraticBodyTest, IsExactForQuadraticDisplacementsWhereLambdaIsSmall) {
    constexpr int kDim = TypeParam::value;
    using Vector = Eigen::Matrix<double, kDim, 1>;
    using Square = Eigen::Matrix<double, kDim, kDim>;
    std::mt19937 random(2);
    std::normal_distribution<double> normal(0, 0.3);
    std::vector<Square> forms(kDim);  // u_i = x . form_i x
    for (Square& form : forms) {
        form = Square::NullaryExpr([&] { return normal(random); });
    }
    const Material material = soft(Model::Linear, 0.3);
    const SimplexMesh<kDim> mesh = quadratic_cube<kDim>(1);
    const ElasticBox<kDim> box(mesh, material, ElementKind::Quadratic);
    Positions<kDim> moved = mesh.positions;
    for (Eigen::Index v = 0; v < mesh.vertex_count(); ++v) {
        const Vector x = mesh.positions.col(v);
        for (int i = 0; i < kDim; ++i) {
            moved(i, v) += x.dot(forms[static_cast<std::size_t>(i)] * x);
        }
    }
    double expected = 0;
    for (int corner = 0; corner < 1 << kDim; ++corner) {
        Vector x;
        for (int axis = 0; axis < kDim; ++axis) {
            x[axis] = 0.5 + ((corner >> axis & 1) != 0 ? 0.5 : -0.5) / std::sqrt(3.0);
        }
        Eigen::MatrixXd F = Eigen::MatrixXd::Identity(kDim, kDim);
        for (int i = 0; i < kDim; ++i) {
            const Square& form = forms[static_cast<std::size_t>(i)];
            F.row(i) += (form * x + form.transpose() * x).transpose();
        }
        expected += energy_density(material, F) / (1 << kDim);
    }
    Positions<kDim> unused;
    EXPECT_NEAR(box.forces(best_isa(), moved, unused).energy, expected, 1e-12 * expected);
}

// The energy of every law, where lambda is at most mu / 2, is the sum of its densities at the
// points, which know nothing of one another; where it is more the mean dilatation is in it, but for
// arap, which has none.
TYPED_TEST(QuadraticBodyTest, IsPlainWhereLambdaIsSmallWhateverTheLaw) {
    constexpr int kDim = TypeParam::value;
    const SimplexMesh<kDim> mesh = distorted<kDim>(quadratic_cube<kDim>(1), 0.05, true);
    const auto elements = test::reference_elements<kDim>(mesh, ElementKind::Quadratic);
    const Positions<kDim> x = test::shaken<kDim>(mesh.positions, 0.1, 6);
    for (const Model law : values<Model>()) {
        for (const double lambda : {0.0, 0.35, 1.3}) {
            const Material material = soft(law, lambda);
            double plain = 0;
            for (const auto& element : elements) {
                for (const auto& point : element.points) {
                    plain += point.volume * energy_density(material, x * point.gradients);
                }
            }
            const ElasticBox<kDim> box(mesh, material, ElementKind::Quadratic);
            Positions<kDim> unused;
            const double energy = box.forces(best_isa(), x, unused).energy;
            if (lambda <= 0.5 * material.lame.mu || law == Model::Arap) {
                EXPECT_NEAR(energy, plain, 1e-12 * plain) << word_of(law) << ", " << lambda;
            } else {
                EXPECT_LT(energy, 0.99 * plain) << word_of(law);
            }
        }
    }
}

// Where middles have moved the volume is that of the curved simplices.
TYPED_TEST(QuadraticBodyTest, KnowsTheVolumeOfCurvedCells) {
    constexpr int kDim = TypeParam::value;
    SimplexMesh<kDim> mesh = quadratic_cube<kDim>(1);
    // x -> x + 0.2 y (1 - y) shears the cube and keeps its volume, and so do the quadratic cells.
    for (Eigen::Index v = 0; v < mesh.vertex_count(); ++v) {
        const double y = mesh.positions(1, v);
        mesh.positions(0, v) += 0.2 * y * (1 - y);
    }
    const ElasticBox<kDim> box(mesh, soft(Model::Linear, 0), ElementKind::Quadratic);
    Positions<kDim> unused;
    const double energy = box.forces(best_isa(), 2 * mesh.positions, unused).energy;
    EXPECT_NEAR(energy, 0.7 * kDim, 1e-12);  // mu |e|^2 with e = 1
}

template <int Dim>
void expect_hessian_of_forces_through_inversion(const SimplexMesh<Dim>& mesh) {
    for (const Model law :
         {Model::StableNeoHookean, Model::MooneyRivlin, Model::StVenantKirchhoff, Model::Linear}) {
        ElasticBox<Dim> box(mesh, soft(law), ElementKind::Quadratic);
        const Positions<Dim> direction =
            test::shaken<Dim>(box.mesh.positions, 1, 9) - box.mesh.positions;
        for (const double J : {-1.0, -0.5, 0.0, 0.5, 1.0}) {
            box.positions = test::shaken<Dim>(box.mesh.positions, 0.02, 8);
            box.positions.row(Dim - 1) *= J;
            const double h = 1e-5;  // error h^2 of the difference, and 1e-16 / h of rounding
            Positions<Dim> after;
            Positions<Dim> before;
            box.forces(best_isa(), box.positions + h * direction, after);
            box.forces(best_isa(), box.positions - h * direction, before);
            const Positions<Dim> slope = (before - after) / (2 * h);
            Eigen::VectorXd along(Dim * box.mesh.vertex_count());
            Eigen::VectorXd expected(along.size());
            for (std::uint32_t v = 0; v < box.mesh.vertex_count(); ++v) {
                const auto at = Dim * static_cast<Eigen::Index>(box.dofs.dof_of(v));
                along.segment<Dim>(at) = direction.col(v);
                expected.segment<Dim>(at) = slope.col(v);
            }
            const Eigen::MatrixXd K = box.template stiffness<double>(best_isa(), Filter::None);
            EXPECT_LT((K * along - expected).norm(), 1e-6 * expected.norm()) << J;
            const Eigen::VectorXd values =
                Eigen::SelfAdjointEigenSolver<Eigen::MatrixXd>(
                    box.template stiffness<double>(best_isa(), Filter::Clamp),
                    Eigen::EigenvaluesOnly)
                    .eigenvalues();
            EXPECT_GT(values.minCoeff(), -1e-12 * values.maxCoeff()) << J;
        }
    }
}

// Pressed flat and turned inside out: the Hessian is the slope of the forces, and filtered it has
// no negative eigenvalue. arap, which has no mean dilatation, is not asked: it has kinks there.
TYPED_TEST(QuadraticBodyTest, HasTheHessianOfItsForcesThroughInversion) {
    constexpr int kDim = TypeParam::value;
    expect_hessian_of_forces_through_inversion<kDim>(quadratic_cube<kDim>(1));
}

TYPED_TEST(QuadraticBodyTest, HasTheHessianOfItsForcesThroughInversionWhereCellsAreCurved) {
    constexpr int kDim = TypeParam::value;
    expect_hessian_of_forces_through_inversion<kDim>(
        distorted<kDim>(quadratic_cube<kDim>(1), 0.04, false));
}

template <int Dim>
Scene swinging_bar(Integrator integrator) {
    Scene scene = test::box_scene<Dim>();
    scene.gravity[1] = -9.8;
    scene.solver.elements = ElementKind::Quadratic;
    scene.solver.integrator = integrator;
    scene.constraints = {
        test::hold(HalfSpaceSelection{.normal = Eigen::VectorXd::Unit(Dim, 0), .offset = 1e-6},
                   test::still(Dim))};
    return scene;
}

template <int Dim>
SimplexMesh<Dim> bar(int length) {
    std::array<int, Dim> counts{};
    std::array<double, Dim> sizes{};
    counts.fill(1);
    sizes.fill(0.25);
    counts[0] = length;
    sizes[0] = 0.25 * length;
    return quadratic_kuhn_box<Dim>(counts, sizes);
}

TYPED_TEST(QuadraticBodyTest, IsTheSameToTheBitForAnyNumberOfThreadsWithEveryIntegrator) {
    constexpr int kDim = TypeParam::value;
    const SimplexMesh<kDim> mesh = bar<kDim>(12);
    for (const Integrator integrator : {Integrator::LinearEuler, Integrator::NewtonEuler,
                                        Integrator::Bdf2, Integrator::Quasistatic}) {
        Scene scene = swinging_bar<kDim>(integrator);
        scene.gravity *= 0.1;  // so that statics take few steps
        if (integrator != Integrator::Quasistatic) {
            scene.damping = Damping{.mass = 0.1, .stiffness = 0.01};
        }
        Positions<kDim> of_one;
        for (const int threads : {1, 2, 3}) {
            Simulation<kDim> simulation(scene, {mesh}, {.threads = threads});
            for (int step = 0; step < 3; ++step) {
                ASSERT_TRUE(simulation.step().is_accepted);
            }
            if (threads == 1) {
                of_one = simulation.positions(0);
                EXPECT_NE(of_one, mesh.positions);
            }
            EXPECT_EQ(simulation.positions(0), of_one) << threads;
        }
    }
}

TYPED_TEST(QuadraticBodyTest, HasTheElementsOfItsParentsAndTheMassesOfItsChildren) {
    constexpr int kDim = TypeParam::value;
    const SimplexMesh<kDim> mesh = bar<kDim>(2);
    Scene scene = swinging_bar<kDim>(Integrator::LinearEuler);
    scene.constraints.clear();
    Simulation<kDim> quadratic(scene, {mesh});
    scene.solver.elements = ElementKind::Linear;
    const Simulation<kDim> linear(scene, {mesh});
    EXPECT_EQ(quadratic.size().elements, mesh.cell_count() >> kDim);
    EXPECT_EQ(quadratic.step().hessians, mesh.cell_count() >> kDim);
    EXPECT_EQ(quadratic.masses(0), linear.masses(0));
}

// Points may be right where a child is inside out; the report counts cells.
TYPED_TEST(QuadraticBodyTest, ReportsEveryCellThatIsInsideOut) {
    constexpr int kDim = TypeParam::value;
    Scene scene = swinging_bar<kDim>(Integrator::LinearEuler);
    scene.frames_per_second = 1e6;  // so that a step hardly moves anything
    Simulation<kDim> simulation(scene, {bar<kDim>(3)}, {.threads = 2});
    const SimplexMesh<kDim>& mesh = simulation.mesh(0);
    EXPECT_EQ(simulation.step().inverted, 0);
    Positions<kDim> positions = mesh.positions;
    positions(0, mesh.vertex_count() / 2) += 0.15;
    simulation.set_state(0, positions, Positions<kDim>::Zero(kDim, mesh.vertex_count()));
    const StepReport report = simulation.step();
    ASSERT_TRUE(report.is_accepted);
    std::int64_t inverted = 0;
    for (Eigen::Index cell = 0; cell < mesh.cell_count(); ++cell) {
        inverted += cell_volume<kDim>(simulation.positions(0), mesh.cells, cell) > 0 ? 0 : 1;
    }
    EXPECT_GT(inverted, 0);
    EXPECT_EQ(report.inverted, inverted);
}

}  // namespace
}  // namespace pent::simulator
