#include "contact_scenes.h"
#include "elastic_box.h"
#include "model/rotation.h"
#include "potentials/gravity.h"
#include "potentials/mass_distance.h"
#include "potentials/rayleigh_damping.h"
#include "potentials/scene_energy.h"

#include <gtest/gtest.h>

#include <cmath>
#include <numeric>

// Every term of what a step minimizes, by itself: its gradient is the derivative of its value, its Hessian
// that of its gradient, in three and four dimensions, also where elements are flat, inside out or
// points; and what each conserves.

namespace pent::simulator {
namespace {

using test::cube;
using test::two_cubes;

template <typename T>
class PotentialsTest : public testing::Test {};
using Dimensions = testing::Types<std::integral_constant<int, 3>, std::integral_constant<int, 4>>;
TYPED_TEST_SUITE(PotentialsTest, Dimensions);

constexpr std::array kLaws = {Model::StableNeoHookean, Model::Arap, Model::StVenantKirchhoff,
                              Model::Linear};

// What terms stand on.
template <int Dim>
struct Setting {
    Scene scene;
    Workers workers{2};
    const Kernels<Dim>& isa = kernels<Dim>(best_isa());
    Bodies<Dim> bodies;
    DofMap dofs;

    Setting(const Scene& of, int cells)
        : scene(of),
          bodies(make_bodies<Dim>(
              scene, std::vector<SimplexMesh<Dim>>(scene.bodies.size(), cube<Dim>(cells)))),
          dofs(number_dofs(bodies, std::vector<bool>(bodies.count(), true))) {}
};

// Positions shaken by up to `size`, m.
template <int Dim>
Positions<Dim> shaken(const Positions<Dim>& positions, double size, unsigned seed) {
    std::mt19937 random(seed);
    std::uniform_real_distribution<double> shake(-size, size);
    return positions.unaryExpr([&](double x) { return x + shake(random); });
}

template <int Dim>
double value_of(Potential<Dim>& term, const Positions<Dim>& x) {
    Positions<Dim> gradient = Positions<Dim>::Zero(Dim, x.cols());
    return term.evaluate(x, gradient);
}

template <int Dim>
Positions<Dim> gradient_of(Potential<Dim>& term, const Positions<Dim>& x) {
    Positions<Dim> gradient = Positions<Dim>::Zero(Dim, x.cols());
    static_cast<void>(term.evaluate(x, gradient));
    return gradient;
}

// The Hessian of all dofs, times 3; a dense matrix.
template <int Dim>
Eigen::MatrixXd hessian_of(const Setting<Dim>& setting,
                           const BlockPattern& pattern,
                           Potential<Dim>& term,
                           const Positions<Dim>& x) {
    constexpr double kWeight = 3;
    NewtonSystem<Dim> system(setting.workers, setting.dofs, pattern, Precision::Double);
    system.begin(BlockVector<Dim>::Zero(Dim, setting.dofs.count()),
                 Positions<Dim>::Zero(Dim, x.cols()));
    static_cast<void>(value_of<Dim>(term, x));
    term.add_hessian(kWeight, Filter::None, system);
    system.finish();
    const auto& matrix = std::get<BlockMatrix<Dim, double>>(system.matrix());
    Eigen::MatrixXd sum = test::ElasticBox<Dim>::dense(matrix);
    if (matrix.coupling() != nullptr) {
        sum += test::ElasticBox<Dim>::dense(*matrix.coupling());
    }
    return sum / kWeight;
}

// The gradient and the Hessian in a few random directions against central differences, which lose
// half of the digits: to 1e-6 of the larger of the two.
template <int Dim>
void expect_derivatives(const Setting<Dim>& setting,
                        const BlockPattern& pattern,
                        Potential<Dim>& term,
                        const Positions<Dim>& x,
                        double step = 1e-5) {
    const Positions<Dim> gradient = gradient_of<Dim>(term, x);
    const Eigen::MatrixXd hessian = hessian_of<Dim>(setting, pattern, term, x);
    std::mt19937 random(7);
    std::normal_distribution<double> normal;
    for (int i = 0; i < 4; ++i) {
        Positions<Dim> way = Positions<Dim>::Zero(Dim, x.cols());
        for (const std::uint32_t vertex : setting.dofs.vertices()) {
            way.col(vertex) = Positions<Dim>::NullaryExpr(Dim, 1, [&] { return normal(random); });
        }
        way /= way.norm();
        const Positions<Dim> ahead = x + step * way;
        const Positions<Dim> behind = x - step * way;
        const double slope =
            (value_of<Dim>(term, ahead) - value_of<Dim>(term, behind)) / (2 * step);
        EXPECT_NEAR(slope, gradient.cwiseProduct(way).sum(),
                    1e-6 * (std::abs(slope) + gradient.norm()));
        const BlockVector<Dim> bend = at_dofs<Dim>(
            setting.dofs,
            (gradient_of<Dim>(term, ahead) - gradient_of<Dim>(term, behind)) / (2 * step));
        const Eigen::VectorXd expected = hessian * at_dofs<Dim>(setting.dofs, way).reshaped();
        EXPECT_LE((bend.reshaped() - expected).norm(), 1e-6 * (bend.norm() + hessian.norm()));
    }
    EXPECT_LT((hessian - hessian.transpose()).norm(), 1e-12 * (1 + hessian.norm()));
}

// The same of a term that couples what cells couple, or stencils.
template <int Dim>
void expect_derivatives(const Setting<Dim>& setting,
                        Potential<Dim>& term,
                        const Positions<Dim>& x,
                        double step = 1e-5) {
    expect_derivatives<Dim>(setting, make_pattern<Dim>(setting.bodies.cells, setting.dofs), term, x,
                            step);
}

template <int Dim>
Eigen::Matrix<double, Dim, Dim> any_rotation() {
    return plane_rotation<Dim>({0, 1}, 0.5) * plane_rotation<Dim>({1, 2}, -0.8)
           * plane_rotation<Dim>({0, Dim - 1}, 1.1);
}

// A body that moves as if rigid keeps its energy, and is pushed and turned by nothing.
template <int Dim>
void expect_invariance_under_rigid_motion(Potential<Dim>& term, const Positions<Dim>& x) {
    const double value = value_of<Dim>(term, x);
    const Positions<Dim> gradient = gradient_of<Dim>(term, x);
    const double size = gradient.norm() * x.norm();
    EXPECT_LT(gradient.rowwise().sum().norm(), 1e-12 * gradient.norm() * std::sqrt(x.cols()));
    const Eigen::Matrix<double, Dim, Dim> torque = gradient * x.transpose();
    EXPECT_LT((torque - torque.transpose()).norm(), 1e-11 * size);
    const Eigen::Matrix<double, Dim, Dim> turn = any_rotation<Dim>();
    const Positions<Dim> moved =
        (turn * x).colwise() + Eigen::Matrix<double, Dim, 1>::LinSpaced(0.1, 0.7);
    EXPECT_NEAR(value_of<Dim>(term, moved), value, 1e-11 * std::abs(value));
    EXPECT_LT((gradient_of<Dim>(term, moved) - turn * gradient).norm(), 1e-9 * gradient.norm());
}

TYPED_TEST(PotentialsTest, GravityIsMassTimesHeight) {
    constexpr int kDim = TypeParam::value;
    const Setting<kDim> setting(test::box_scene<kDim>(), 1);
    const Eigen::Matrix<double, kDim, 1> g = Eigen::Matrix<double, kDim, 1>::LinSpaced(-3, 1);
    Gravity<kDim> gravity(setting.workers, setting.bodies.masses, g);
    const Positions<kDim> x = shaken<kDim>(setting.bodies.rest, 0.1, 1);
    expect_derivatives<kDim>(setting, gravity, x);
    EXPECT_NEAR(value_of<kDim>(gravity, x), -g.dot(x * setting.bodies.masses), 1e-10);
    const Positions<kDim> up = x.colwise() + 0.3 * g;
    EXPECT_NEAR(value_of<kDim>(gravity, up) - value_of<kDim>(gravity, x),
                -0.3 * g.squaredNorm() * setting.bodies.masses.sum(), 1e-9);
}

TYPED_TEST(PotentialsTest, MassDistanceIsHalfTheSquaredDistanceOfWhatIsSolvedFor) {
    constexpr int kDim = TypeParam::value;
    Scene scene = test::box_scene<kDim>();
    scene.constraints = {
        test::hold(HalfSpaceSelection{.normal = Eigen::VectorXd::Unit(kDim, 0), .offset = 0.01},
                   test::still(kDim))};
    const Setting<kDim> setting(scene, 1);
    ASSERT_LT(setting.dofs.count(), setting.dofs.vertex_count());
    MassDistance<kDim> inertia(setting.workers, setting.dofs, setting.bodies.masses);
    const Positions<kDim> anchor = shaken<kDim>(setting.bodies.rest, 0.2, 2);
    inertia.set_anchor(anchor);
    const Positions<kDim> x = shaken<kDim>(setting.bodies.rest, 0.2, 3);
    expect_derivatives<kDim>(setting, inertia, x);
    double expected = 0;
    for (const std::uint32_t vertex : setting.dofs.vertices()) {
        expected += 0.5 * setting.bodies.masses[vertex]
                    * (x.col(vertex) - anchor.col(vertex)).squaredNorm();
    }
    EXPECT_NEAR(value_of<kDim>(inertia, x), expected, 1e-12 * expected);
    EXPECT_EQ(value_of<kDim>(inertia, anchor), 0);
}

// Flat, turned inside out, or all in one point: formulas hold there, too.
template <int Dim>
std::vector<Positions<Dim>> hard_states(const Positions<Dim>& rest) {
    Positions<Dim> flat = shaken<Dim>(rest, 0.02, 4);
    flat.row(1).setConstant(0.25);
    Positions<Dim> inside_out = shaken<Dim>(rest, 0.02, 5);
    inside_out.row(0) *= -1;
    Positions<Dim> line = shaken<Dim>(rest, 0.02, 6);
    line.bottomRows(Dim - 1).setZero();
    return {shaken<Dim>(rest, 0.05, 7), flat, inside_out, line};
}

TYPED_TEST(PotentialsTest, ElasticityHasTheDerivativesOfItsEnergyAlsoWhereElementsAreDegenerate) {
    constexpr int kDim = TypeParam::value;
    for (const ElementKind kind : {ElementKind::Linear, ElementKind::Smoothed}) {
        for (const Model law : kLaws) {
            Scene scene = test::box_scene<kDim>();
            scene.bodies[0].material.model = law;
            const Setting<kDim> setting(scene, 2);
            Elasticity<kDim> elasticity(setting.workers, setting.isa, setting.bodies, kind);
            for (const Positions<kDim>& x : hard_states<kDim>(setting.bodies.rest)) {
                if (law == Model::Arap && x.row(1).isConstant(x(1, 0))) {
                    continue;  // its rotation jumps where an element is flat
                }
                expect_derivatives<kDim>(setting, elasticity.pattern(), elasticity, x);
            }
        }
    }
}

TYPED_TEST(PotentialsTest, ElasticityDoesNotSeeRigidMotions) {
    constexpr int kDim = TypeParam::value;
    for (const ElementKind kind : {ElementKind::Linear, ElementKind::Smoothed}) {
        for (const Model law : kLaws) {
            if (law == Model::Linear) {
                continue;  // sees turns
            }
            Scene scene = test::box_scene<kDim>();
            scene.bodies[0].material.model = law;
            const Setting<kDim> setting(scene, 2);
            Elasticity<kDim> elasticity(setting.workers, setting.isa, setting.bodies, kind);
            expect_invariance_under_rigid_motion<kDim>(elasticity,
                                                       shaken<kDim>(setting.bodies.rest, 0.05, 8));
        }
    }
}

// Held ends, a body that sleeps: what the elastic term says of vertices without dofs stays what it is.
TYPED_TEST(PotentialsTest, ElasticityOfSleepingBodiesIsThatWithWhichTheyFellAsleep) {
    constexpr int kDim = TypeParam::value;
    Scene scene = two_cubes<kDim>(0.3);
    scene.contact.reset();
    Setting<kDim> setting(scene, 1);
    Elasticity<kDim> elasticity(setting.workers, setting.isa, setting.bodies, ElementKind::Linear);
    const Positions<kDim> x = shaken<kDim>(setting.bodies.rest, 0.05, 9);
    const double awake = value_of<kDim>(elasticity, x);
    const Positions<kDim> gradient = gradient_of<kDim>(elasticity, x);
    setting.dofs = number_dofs(setting.bodies, {false, true});
    elasticity.set_dofs(setting.dofs, {true, false}, x);
    EXPECT_NEAR(value_of<kDim>(elasticity, x), awake, 1e-12 * awake);
    EXPECT_LT((gradient_of<kDim>(elasticity, x) - gradient).norm(), 1e-12 * gradient.norm());
    expect_derivatives<kDim>(setting, elasticity.pattern(), elasticity, x);
}

TYPED_TEST(PotentialsTest, RayleighDampingIsAQuadraticOfTheTangentThatPullsBack) {
    constexpr int kDim = TypeParam::value;
    const Setting<kDim> setting(test::box_scene<kDim>(), 2);
    Elasticity<kDim> elasticity(setting.workers, setting.isa, setting.bodies, ElementKind::Linear);
    RayleighDamping<kDim> damping(setting.workers, setting.isa.blocks, elasticity, setting.dofs,
                                  Filter::Clamp);
    const Positions<kDim> start = shaken<kDim>(setting.bodies.rest, 0.05, 10);
    const Positions<kDim> still = Positions<kDim>::Zero(kDim, start.cols());
    static_cast<void>(value_of<kDim>(elasticity, start));
    damping.set_origin(start);
    static_cast<void>(damping.begin_step({start, still, still, 0.01, false}));
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

// Two bodies that see each other at a barrier, and obstacles of every kind at the vertices.
template <int Dim>
Scene barrier_scene() {
    Scene scene = two_cubes<Dim>(0.03);
    scene.contact->model = ContactModel::Barrier;
    scene.contact->filter = Filter::None;
    scene.solver.integrator = Integrator::NewtonEuler;
    const Eigen::VectorXd low = Eigen::VectorXd::Unit(Dim, 1);
    scene.obstacles = {{.shape = HalfSpaceObstacle{.normal = low, .offset = -0.02}}};
    return scene;
}

TYPED_TEST(PotentialsTest, ABarrierHasTheDerivativesOfItsEnergy) {
    constexpr int kDim = TypeParam::value;
    const Setting<kDim> setting(barrier_scene<kDim>(), 2);
    ContactPotential<kDim> contact(setting.workers, setting.scene, setting.bodies);
    const Positions<kDim> x = shaken<kDim>(setting.bodies.rest, 0.006, 12);
    ASSERT_GT(value_of<kDim>(contact, x), 0);
    ASSERT_GT(contact.contacts().pair_count, 0U);
    ASSERT_GT(contact.summary().obstacle, 0);
    expect_derivatives<kDim>(setting, contact, x, 1e-6);
}

TYPED_TEST(PotentialsTest, ABarrierBetweenBodiesPushesBothAlike) {
    constexpr int kDim = TypeParam::value;
    Scene scene = barrier_scene<kDim>();
    scene.obstacles.clear();
    const Setting<kDim> setting(scene, 2);
    ContactPotential<kDim> contact(setting.workers, setting.scene, setting.bodies);
    const Positions<kDim> x = shaken<kDim>(setting.bodies.rest, 0.006, 13);
    ASSERT_GT(value_of<kDim>(contact, x), 0);
    expect_invariance_under_rigid_motion<kDim>(contact, x);
}

// Two cubes, the second on a corner over the middle of the first, at a fraction of the distance of contact.
template <int Dim>
Positions<Dim> on_a_corner(const Bodies<Dim>& bodies) {
    Positions<Dim> x = bodies.rest;
    auto second = x.rightCols(bodies.vertices(1).size);
    const Eigen::Matrix<double, Dim, 1> middle = second.rowwise().mean();
    Eigen::Matrix<double, Dim, 1> diagonal = Eigen::Matrix<double, Dim, 1>::Ones().normalized();
    const auto turn = Eigen::Matrix<double, Dim, Dim>(
        Eigen::Matrix<double, Dim, Dim>::Identity()
        - 2 * (diagonal - Eigen::Matrix<double, Dim, 1>::Unit(1)).normalized()
              * (diagonal - Eigen::Matrix<double, Dim, 1>::Unit(1)).normalized().transpose());
    second = (turn * (second.colwise() - middle)).eval();  // mirrored, which a cube does not mind
    const double lowest = second.row(1).minCoeff();
    second.colwise() += Eigen::Matrix<double, Dim, 1>::Constant(0.23);
    second.row(1).array() += 0.5 + 0.02 - lowest - 0.23;
    return x;
}

template <int Dim>
std::vector<std::array<std::uint32_t, Dim + 1>> pairs_at(ContactPotential<Dim>& contact,
                                                         const Positions<Dim>& x) {
    static_cast<void>(value_of<Dim>(contact, x));
    std::vector<std::array<std::uint32_t, Dim + 1>> pairs;
    for (const contact::Contact<Dim>& pair : contact.contacts().list) {
        pairs.push_back(pair.vertices);
    }
    return pairs;
}

// Of a penalty the gradient is that of the energy between vertices and facets, but for the moment in
// which another facet becomes the nearest. Mixed pairs fade towards the
// ends of their edges by a share that is held; the Hessian holds the weights of closest points. Where
// neither moves, at obstacles, that is tested below.
TYPED_TEST(PotentialsTest, APenaltyOfVerticesAndFacetsHasTheGradientOfItsEnergy) {
    constexpr int kDim = TypeParam::value;
    constexpr double kStep = 1e-6;
    const Setting<kDim> setting(two_cubes<kDim>(0.03), 2);
    ContactPotential<kDim> contact(setting.workers, setting.scene, setting.bodies);
    int compared = 0;
    for (unsigned seed = 0; seed < 10; ++seed) {
        const Positions<kDim> x = shaken<kDim>(on_a_corner<kDim>(setting.bodies), 1e-3, seed);
        ASSERT_GT(value_of<kDim>(contact, x), 0);
        ASSERT_EQ(contact.summary().mixed, 0);
        expect_invariance_under_rigid_motion<kDim>(contact, x);
        const Positions<kDim> gradient = gradient_of<kDim>(contact, x);
        const Positions<kDim> way = shaken<kDim>(0 * x, 1, 200 + seed);
        const Positions<kDim> ahead = x + kStep * way;
        const Positions<kDim> behind = x - kStep * way;
        if (pairs_at<kDim>(contact, ahead) != pairs_at<kDim>(contact, behind)) {
            continue;
        }
        EXPECT_NEAR(
            (value_of<kDim>(contact, ahead) - value_of<kDim>(contact, behind)) / (2 * kStep),
            gradient.cwiseProduct(way).sum(), 1e-6 * gradient.norm() * way.norm());
        ++compared;
    }
    EXPECT_GT(compared, 5);
}

TYPED_TEST(PotentialsTest, APenaltyPushesBothBodiesAlikeAndDoesNotSeeRigidMotions) {
    constexpr int kDim = TypeParam::value;
    const Setting<kDim> setting(two_cubes<kDim>(0.03), 2);
    ContactPotential<kDim> contact(setting.workers, setting.scene, setting.bodies);
    const Positions<kDim> x = shaken<kDim>(setting.bodies.rest, 0.006, 14);
    ASSERT_GT(value_of<kDim>(contact, x), 0);
    ASSERT_GT(contact.summary().mixed, 0);
    expect_invariance_under_rigid_motion<kDim>(contact, x);
}

TYPED_TEST(PotentialsTest, AnObstacleHasTheDerivativesOfItsEnergy) {
    constexpr int kDim = TypeParam::value;
    const Eigen::VectorXd up = Eigen::VectorXd::Unit(kDim, 1);
    const Eigen::VectorXd middle = Eigen::VectorXd::Constant(kDim, 0.125);
    const std::vector<ObstacleShape> shapes = {
        HalfSpaceObstacle{.normal = up, .offset = 0.1},
        BallObstacle{.center = -0.3 * up, .radius = 0.4},
        CavityObstacle{.center = middle, .radius = 0.2},
        BowlObstacle{.center = middle, .radius = 0.2, .up = up},
        BoxObstacle{.center = middle - 0.2 * up, .sides = Eigen::VectorXd::Constant(kDim, 0.3)}};
    for (const ObstacleShape& shape : shapes) {
        Scene scene = test::box_scene<kDim>();
        scene.obstacles = {{.shape = shape, .distance = 0.05, .stiffness = 700}};
        scene.contact = Contact{.filter = Filter::None};
        const Setting<kDim> setting(scene, 1);
        ContactPotential<kDim> contact(setting.workers, setting.scene, setting.bodies);
        const Positions<kDim> x = shaken<kDim>(setting.bodies.rest, 0.02, 16);
        ASSERT_GT(value_of<kDim>(contact, x), 0);
        expect_derivatives<kDim>(setting, contact, x, 1e-6);
    }
}

TYPED_TEST(PotentialsTest, FrictionHasTheDerivativesOfItsEnergyAndNeverPushesAlongTheSlip) {
    constexpr int kDim = TypeParam::value;
    const Setting<kDim> setting(barrier_scene<kDim>(), 2);
    ContactPotential<kDim> contact(setting.workers, setting.scene, setting.bodies);
    const Positions<kDim> start = shaken<kDim>(setting.bodies.rest, 0.006, 17);
    ASSERT_GT(value_of<kDim>(contact, start), 0);
    const Positions<kDim> still = Positions<kDim>::Zero(kDim, start.cols());
    for (const double slip_speed : {1e-3, 1.0}) {  // sliding, and sticking
        FrictionPotential<kDim> friction(contact, {.coefficient = 0.4, .slip_speed = slip_speed});
        static_cast<void>(friction.begin_step({start, still, still, 0.01, false}));
        EXPECT_EQ(value_of<kDim>(friction, start), 0);
        const Positions<kDim> x = shaken<kDim>(start, 1e-3, 18);
        expect_derivatives<kDim>(setting, friction, x, 1e-7);
        const Positions<kDim> gradient = gradient_of<kDim>(friction, x);
        EXPECT_GT(gradient.cwiseProduct(x - start).sum(), 0);
        EXPECT_GT(value_of<kDim>(friction, x), 0);
    }
}

TYPED_TEST(PotentialsTest, FrictionBetweenBodiesKeepsTheirMomentum) {
    constexpr int kDim = TypeParam::value;
    Scene scene = barrier_scene<kDim>();
    scene.obstacles.clear();
    const Setting<kDim> setting(scene, 2);
    ContactPotential<kDim> contact(setting.workers, setting.scene, setting.bodies);
    const Positions<kDim> start = shaken<kDim>(setting.bodies.rest, 0.006, 19);
    ASSERT_GT(value_of<kDim>(contact, start), 0);
    FrictionPotential<kDim> friction(contact, {.coefficient = 0.4, .slip_speed = 1e-3});
    const Positions<kDim> still = Positions<kDim>::Zero(kDim, start.cols());
    static_cast<void>(friction.begin_step({start, still, still, 0.01, false}));
    const Positions<kDim> gradient = gradient_of<kDim>(friction, shaken<kDim>(start, 1e-3, 20));
    EXPECT_GT(gradient.norm(), 0);
    EXPECT_LT(gradient.rowwise().sum().norm(), 1e-12 * gradient.norm());
}

// The sum of a scene is that of its terms, with nothing in it that the scene does not ask for.
TYPED_TEST(PotentialsTest, TheSumHasTheTermsOfTheSceneAndNoOthers) {
    constexpr int kDim = TypeParam::value;
    const auto names = [](const Scene& scene) {
        const Setting<kDim> setting(scene, 1);
        SceneEnergy<kDim> energy(setting.workers, setting.isa, setting.bodies, setting.scene);
        energy.sum.update(setting.bodies.rest);
        std::vector<std::string> list;
        for (const TermEnergy& term : energy.sum.energies()) {
            list.emplace_back(term.name);
        }
        return list;
    };
    Scene scene = two_cubes<kDim>(0.03);
    scene.contact.reset();
    EXPECT_EQ(names(scene), (std::vector<std::string>{"gravity", "elastic"}));
    scene.contact = Contact{.distance = 0.05, .stiffness = 2e3, .friction = 0.3};
    EXPECT_EQ(names(scene),
              (std::vector<std::string>{"gravity", "elastic", "contact", "friction"}));
    scene.contact.reset();
    scene.obstacles = barrier_scene<kDim>().obstacles;
    EXPECT_EQ(names(scene), (std::vector<std::string>{"gravity", "elastic", "obstacle"}));
}

TYPED_TEST(PotentialsTest, TheSumIsThatOfItsTerms) {
    constexpr int kDim = TypeParam::value;
    Scene scene = barrier_scene<kDim>();
    scene.gravity[1] = -9.8;
    scene.contact->friction = 0.3;
    const Setting<kDim> setting(scene, 1);
    SceneEnergy<kDim> energy(setting.workers, setting.isa, setting.bodies, setting.scene);
    const Positions<kDim> x = shaken<kDim>(setting.bodies.rest, 0.006, 21);
    energy.sum.update(x);
    double value = 0;
    Positions<kDim> gradient = Positions<kDim>::Zero(kDim, x.cols());
    for (const auto& term : energy.sum.terms()) {
        value += value_of<kDim>(*term, x);
        gradient += gradient_of<kDim>(*term, x);
    }
    EXPECT_NEAR(energy.sum.value(), value, 1e-12 * std::abs(value));
    EXPECT_LT((energy.sum.gradient() - gradient).norm(), 1e-12 * gradient.norm());
    const std::vector<TermEnergy> parts = energy.sum.energies();
    EXPECT_NEAR(
        std::accumulate(parts.begin(), parts.end(), 0.0,
                        [](double sum, const TermEnergy& part) { return sum + part.energy; }),
        value, 1e-12 * std::abs(value));
}

}  // namespace
}  // namespace pent::simulator
