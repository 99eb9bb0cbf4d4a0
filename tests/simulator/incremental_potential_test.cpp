#include "step/incremental_potential.h"

#include "potential_laws.h"
#include "potentials/scene_energy.h"
#include "step/newton.h"

#include <Eigen/Cholesky>
#include <gtest/gtest.h>

#include <cmath>
#include <memory>

// The weighted sum that a step minimizes, over the vertices that are solved for.

namespace pent::simulator {
namespace {

using test::barrier_scene;
using test::Dimensions;
using test::Setting;
using test::shaken;

template <typename T>
class IncrementalPotentialTest : public testing::Test {};
TYPED_TEST_SUITE(IncrementalPotentialTest, Dimensions);

// Two bodies in contact with friction and damping, one of them held at a side that moves, at the
// start of a step.
template <int Dim>
struct Step {
    Setting<Dim> setting;
    SceneEnergy<Dim> energy;
    IncrementalPotential<Dim> potential;
    Positions<Dim> start;
    Positions<Dim> velocities;
    Positions<Dim> displacement;
    std::shared_ptr<StepProblem<Dim>> problem;

    explicit Step(const Scene& scene, Isa isa = best_isa())
        : setting(scene, 2),
          energy(setting.workers, kernels<Dim>(isa), setting.bodies, setting.held, setting.scene),
          potential(setting.workers,
                    kernels<Dim>(isa),
                    setting.bodies,
                    setting.held,
                    setting.scene,
                    energy),
          start(shaken<Dim>(setting.bodies.rest(), 0.006, 1)),
          velocities(shaken<Dim>(0 * start, 0.3, 2)),
          displacement(0 * start),
          problem(
              std::make_shared<StepProblem<Dim>>(euler_problem<Dim>({start, velocities}, 0.01))) {
        for (const DirichletSet<Dim>& set : setting.held.sets()) {
            for (const std::uint32_t vertex : set.vertices) {
                displacement.col(vertex).setConstant(1e-3);
                problem->prescribed.vertices.push_back(vertex);
            }
        }
        problem->prescribed.places =
            (start + displacement)(Eigen::all, problem->prescribed.vertices);
        begin();
    }

    void begin() {
        energy.sum.update(start);
        potential.begin_step(problem, {start, velocities, problem->origin, displacement, 0.01,
                                       problem->rate, false});
    }
};

template <int Dim>
Scene busy_scene() {
    Scene scene = barrier_scene<Dim>();
    scene.gravity[1] = -9.8;
    scene.contact->friction = 0.3;
    scene.damping = Damping{.mass = 2, .stiffness = 0.003};
    scene.solver.filter = Filter::None;
    scene.solver.precision = Precision::Double;
    scene.constraints = {
        {.body = "b",
         .select = {HalfSpaceSelection{.normal = -Eigen::VectorXd::Unit(Dim, 1), .offset = -0.95}},
         .motion = {}}};
    return scene;
}

TYPED_TEST(IncrementalPotentialTest, HasTheGradientOfItsValueAndNoneWhereNothingIsSolvedFor) {
    constexpr int kDim = TypeParam::value;
    Step<kDim> step(busy_scene<kDim>());
    const DofMap& dofs = step.potential.dofs();
    ASSERT_LT(dofs.count(), dofs.vertex_count());
    const Positions<kDim> x = shaken<kDim>(step.start, 1e-3, 3);
    const Positions<kDim> gradient = step.potential.evaluate(x).gradient;
    constexpr double kStep = 1e-6;
    for (unsigned seed = 4; seed < 8; ++seed) {
        Positions<kDim> way = shaken<kDim>(0 * x, 1, seed);
        for (std::uint32_t vertex = 0; vertex < dofs.vertex_count(); ++vertex) {
            if (!dofs.has_dof(vertex)) {
                EXPECT_EQ(gradient.col(vertex).norm(), 0);
                way.col(vertex).setZero();
            }
        }
        const double slope = (step.potential.evaluate(x + kStep * way).value
                              - step.potential.evaluate(x - kStep * way).value)
                             / (2 * kStep);
        EXPECT_NEAR(slope, gradient.cwiseProduct(way).sum(), 1e-6 * gradient.norm() * way.norm());
    }
}

// With the Hessian as it is, near the lowest point: H d = -g, H being the difference of gradients.
TYPED_TEST(IncrementalPotentialTest, SolvesForTheDirectionThatItsGradientsAskFor) {
    constexpr int kDim = TypeParam::value;
    Scene scene = busy_scene<kDim>();
    scene.solver.filter = Filter::Clamp;
    scene.contact->filter = Filter::Clamp;
    scene.solver.tolerance = 1e-8;
    Step<kDim> step(scene);
    Positions<kDim> x = step.start;
    const auto report =
        newton<kDim>(step.potential, {.tolerance = 1e-9, .min_correction = 0, .arrival = 1e-12}, x);
    ASSERT_TRUE(report.has_converged) << report.failure_reason;
    // Friction of contacts whose slip turned around on the way there has a secant for its curvature
    // in the next few solves, which is more than the true one; a step that begins knows of none.
    step.begin();
    x = shaken<kDim>(x, 1e-9, 9);
    step.problem->prescribed.put_into(x);
    const Positions<kDim> gradient = step.potential.evaluate(x).gradient;
    const NewtonDirection<kDim> direction =
        step.potential.solve(gradient, step.potential.prescribed_displacement(x), 0);
    ASSERT_EQ(direction.failure_reason, "");
    const Positions<kDim> after = step.potential.evaluate(x + direction.step).gradient;
    EXPECT_LT(after.norm(), 1e-3 * gradient.norm());
}

// What breaks down on the Hessian as it is is solved for again with the filtered one.
TYPED_TEST(IncrementalPotentialTest, TellsTheResidualOfTheSolveThatCounts) {
    constexpr int kDim = TypeParam::value;
    Scene scene = busy_scene<kDim>();
    scene.contact.reset();
    scene.obstacles.clear();
    scene.solver.tolerance = 1e-8;
    for (Body& body : scene.bodies) {
        body.material.lame = lame_from_young(kDim, 1e8, 0.28);
    }
    Step<kDim> step(scene);
    const Positions<kDim> crumpled = shaken<kDim>(step.start, 0.3, 5);
    const Positions<kDim> gradient = step.potential.evaluate(crumpled).gradient;
    static_cast<void>(step.potential.take_work());
    const NewtonDirection<kDim> direction = step.potential.solve(gradient, 0 * gradient, 0);
    ASSERT_EQ(direction.failure_reason, "");
    const SolveWork work = step.potential.take_work();
    ASSERT_EQ(work.hessians, 2 * step.energy.elasticity->element_count());
    EXPECT_LE(work.residual, scene.solver.tolerance);
}

// The part of the Hessian between what is solved for and what is moved goes to the right side.
TYPED_TEST(IncrementalPotentialTest, CarriesTheMotionOfPrescribedVerticesIntoTheOthers) {
    constexpr int kDim = TypeParam::value;
    Scene scene = busy_scene<kDim>();
    scene.contact.reset();
    scene.obstacles.clear();
    scene.bodies[0].material.model = Model::Linear;
    scene.bodies[1].material.model = Model::Linear;
    scene.solver.tolerance = 1e-12;
    Step<kDim> step(scene);
    const Positions<kDim> displacement = step.potential.prescribed_displacement(step.start);
    EXPECT_GT(displacement.norm(), 0);
    const Positions<kDim> gradient = step.potential.evaluate(step.start).gradient;
    const NewtonDirection<kDim> direction = step.potential.solve(gradient, displacement, 0);
    ASSERT_EQ(direction.failure_reason, "");
    // A quadratic: its lowest point in one step, with the others where they were to go.
    const Positions<kDim> end = step.start + direction.step;
    EXPECT_LT((step.potential.prescribed_displacement(end)).norm(), 1e-15);
    const double before = step.potential.evaluate(step.start + displacement).gradient.norm();
    EXPECT_LT(step.potential.evaluate(end).gradient.norm(), 1e-9 * before);
}

// Two free bodies of linear energy, as stiff as asked for: a quadratic of which masses alone decide
// about rigid motions.
template <int Dim>
Scene free_scene(double young, Precision precision) {
    Scene scene = busy_scene<Dim>();
    scene.contact.reset();
    scene.obstacles.clear();
    scene.constraints.clear();
    scene.damping = {};
    for (Body& body : scene.bodies) {
        body.material.model = Model::Linear;
        body.material.lame = lame_from_young(Dim, young, 0.2);
    }
    scene.solver.precision = precision;
    scene.solver.tolerance = 1e-12;
    return scene;
}

template <int Dim>
Positions<Dim> direction_of(Step<Dim>& step) {
    const Positions<Dim> gradient = step.potential.evaluate(step.start).gradient;
    const NewtonDirection<Dim> direction = step.potential.solve(gradient, 0 * step.start, 0);
    EXPECT_EQ(direction.failure_reason, "");
    return direction.step;
}

// The lowest point of a quadratic by dense algebra: each column of its Hessian is the difference of
// two gradients.
template <int Dim>
Positions<Dim> dense_direction(Step<Dim>& step) {
    const Positions<Dim> at = step.potential.evaluate(step.start).gradient;
    Eigen::MatrixXd hessian(at.size(), at.size());
    for (Eigen::Index i = 0; i < at.size(); ++i) {
        Positions<Dim> x = step.start;
        x.reshaped()[i] += 1;
        hessian.col(i) = (step.potential.evaluate(x).gradient - at).reshaped();
    }
    const Eigen::VectorXd step_of_all = -hessian.ldlt().solve(Eigen::VectorXd(at.reshaped()));
    return step_of_all.reshaped(Dim, at.cols());
}

TYPED_TEST(IncrementalPotentialTest, SolvesInDoubleWhereFloatsWouldLoseTheMasses) {
    constexpr int kDim = TypeParam::value;
    Step<kDim> soft(free_scene<kDim>(1e5, Precision::Float));
    Step<kDim> soft_double(free_scene<kDim>(1e5, Precision::Double));
    EXPECT_NE(direction_of(soft), direction_of(soft_double));  // of these floats are enough
    Step<kDim> stiff(free_scene<kDim>(1e12, Precision::Float));
    Step<kDim> stiff_double(free_scene<kDim>(1e12, Precision::Double));
    const Positions<kDim> direction = direction_of(stiff);
    EXPECT_EQ(direction, direction_of(stiff_double));
    // The residual is 1e-12 of forces that are 1e7 times those of inertia; ten times that.
    const Positions<kDim> expected = dense_direction(stiff);
    EXPECT_LT((direction - expected).norm(), 1e-4 * expected.norm());
}

// From soft to where doubles take over, centers of mass move as doubles move them, and so does all
// else but for what the rounding of blocks adds to rotations. What floats are let round of a mass
// is 2e-3 of it, counted as one rounding of the whole stiffness. A vertex inside has the sum of
// (Dim + 1)! cells: so many roundings by half a digit, of sums that grow evenly, and of either
// sign.
template <int Dim>
void expect_motion_in_floats(Isa isa) {
    const double cells = std::tgamma(Dim + 2);
    const double rounded = 2e-3 * std::sqrt(cells / 3) / 2;
    double young = 1e5;
    int in_floats = 0;
    for (;; young *= 2) {
        SCOPED_TRACE(young);
        Step<Dim> step(free_scene<Dim>(young, Precision::Float), isa);
        Step<Dim> reference(free_scene<Dim>(young, Precision::Double), isa);
        const Positions<Dim> found = direction_of(step);
        const Positions<Dim> expected = direction_of(reference);
        if (found == expected) {
            break;
        }
        ++in_floats;
        const Bodies<Dim>& bodies = step.setting.bodies;
        for (std::size_t body = 0; body < bodies.count(); ++body) {
            const auto range = bodies.vertices(body);
            const auto masses = bodies.masses.segment(range.begin, range.size);
            const Eigen::Matrix<double, Dim, 1> by_float =
                found.middleCols(range.begin, range.size) * masses;
            const Eigen::Matrix<double, Dim, 1> by_double =
                expected.middleCols(range.begin, range.size) * masses;
            EXPECT_LT((by_float - by_double).norm(), rounded * by_double.norm()) << body;
        }
        EXPECT_LT((found - expected).norm(), 1e-2 * expected.norm());
    }
    EXPECT_GT(in_floats, 5);
}

// Kernels with fused multiply-add round in other places than those without.
TYPED_TEST(IncrementalPotentialTest, MovesBodiesInFloatsAsInDoubles) {
    for (const Isa isa : {Isa::Baseline, best_isa()}) {
        SCOPED_TRACE(isa_name(isa));
        expect_motion_in_floats<TypeParam::value>(isa);
    }
}

// Damping by masses that are next to nothing is next to nothing beside inertia, too.
TYPED_TEST(IncrementalPotentialTest, TakesFloatsHoweverSmallMassesDamp) {
    constexpr int kDim = TypeParam::value;
    Scene scene = free_scene<kDim>(1e7, Precision::Float);
    Step<kDim> undamped(scene);
    scene.damping = Damping{.mass = 1e-9};
    Step<kDim> damped(scene);
    scene.solver.precision = Precision::Double;
    Step<kDim> in_doubles(scene);
    const Positions<kDim> expected = direction_of(undamped);
    const Positions<kDim> found = direction_of(damped);
    EXPECT_LT((found - expected).norm(), 1e-6 * expected.norm());
    EXPECT_NE(found, direction_of(in_doubles));
}

TYPED_TEST(IncrementalPotentialTest, LeavesOutBodiesThatSleep) {
    constexpr int kDim = TypeParam::value;
    Scene scene = busy_scene<kDim>();
    scene.solver.filter = Filter::Clamp;
    scene.contact->filter = Filter::Clamp;
    Step<kDim> step(scene);
    const std::uint32_t all = step.potential.dofs().count();
    step.potential.renumber(step.setting.held, {true, false}, step.start);
    const DofMap& dofs = step.potential.dofs();
    EXPECT_LT(dofs.count(), all);
    step.energy.sum.update(step.start);
    step.potential.begin_step(step.problem, {step.start, step.velocities, step.problem->origin,
                                             step.displacement, 0.01, step.problem->rate, false});
    const Evaluation<kDim> at = step.potential.evaluate(step.start);
    const auto first = step.setting.bodies.vertices(0);
    EXPECT_EQ(at.gradient.middleCols(first.begin, first.size).norm(), 0);
    EXPECT_GT(at.gradient.norm(), 0);
    const NewtonDirection<kDim> direction = step.potential.solve(at.gradient, 0 * step.start, 0);
    ASSERT_EQ(direction.failure_reason, "");
    EXPECT_EQ(direction.step.middleCols(first.begin, first.size).norm(), 0);
}

}  // namespace
}  // namespace pent::simulator
