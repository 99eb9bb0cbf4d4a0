#include "host_scenes.h"

#include <gtest/gtest.h>

#include <array>

// What a host does beside contact, sleep, every kind of elements, attachments and constraints:
// steps go on, to the bit for any number of threads and from every saved state.

namespace pent::simulator {
namespace {

using test::corner;
using test::Dimensions;
using test::expect_same;
using test::kWithInertia;
using test::low_side;

template <typename T>
class HostPairs : public testing::Test {};
TYPED_TEST_SUITE(HostPairs, Dimensions);

// Two cubes on the ground, one on the other, that may sleep, with a tie and a hold that ends.
template <int Dim>
Scene scene_of(Integrator integrator, ElementKind elements, ContactModel model) {
    Scene scene = test::two_cubes<Dim>(0.03);
    scene.gravity[1] = -9.8;
    scene.solver.integrator = integrator;
    scene.solver.elements = elements;
    scene.contact->model = model;
    scene.contact->friction = 0.2;
    scene.sleep = Sleep{.speed = 1e-2, .time = 0.05};
    scene.damping = Damping{.mass = 1, .stiffness = 1e-3};
    scene.obstacles = {
        {.shape = HalfSpaceObstacle{.normal = Eigen::VectorXd::Unit(Dim, 1), .offset = -0.03}}};
    Attachment tie;
    tie.body = "a";
    tie.select = {HalfSpaceSelection{.normal = Eigen::VectorXd::Unit(Dim, 0), .offset = 1e-6}};
    tie.stiffness = 100;
    tie.damping = 1;
    scene.attachments = {tie};
    Constraint hold{.body = "b", .select = tie.select, .motion = {test::still(Dim)}};
    hold.select = {HalfSpaceSelection{.normal = Eigen::VectorXd::Unit(Dim, 0), .offset = 0.05}};
    hold.motion[0].translate[0] = 0.2;
    hold.from = 0.02;
    hold.to = 0.06;
    scene.constraints = {hold};
    Region stiff;
    stiff.name = "stiff";
    stiff.select = {BallSelection{Eigen::VectorXd::Constant(Dim, 0.5), 0.7}};
    stiff.material.lame = lame_from_young(Dim, 5e5, 0.2);
    scene.bodies[1].regions = {stiff};
    if (elements != ElementKind::Smoothed) {
        Activation muscle;
        muscle.body = "b";
        muscle.select = {EverythingSelection{}};
        muscle.stretch = 0.9;
        muscle.signal = Signal::Sine;
        muscle.frequency = 5;
        scene.activations = {muscle};
    }
    return scene;
}

// What the host does before step i.
template <int Dim>
void drive(Simulation<Dim>& simulation, int i) {
    if (i == 1) {
        Grab<Dim> grab = corner(simulation, 1, 400);
        grab.damping = 5;
        static_cast<void>(simulation.add_grab(grab));
    } else if (i > 1 && i < 8) {
        const Vector<Dim> anchor = simulation.host().grabs[0].grab.anchor;
        simulation.move_grab(1, anchor + Vector<Dim>::LinSpaced(0.01, 0.02));
    } else if (i == 10) {
        simulation.remove_grab(1);
        simulation.set_gravity(-4 * Vector<Dim>::Unit(1));
    }
    const auto side = low_side(simulation, 0, Dim - 1);
    if (i == 3) {
        Positions<Dim> forces = Positions<Dim>::Zero(Dim, simulation.masses(0).size());
        forces.row(0).setConstant(2);
        simulation.set_forces(0, forces);
    } else if (i == 4 || i == 5) {
        Positions<Dim> targets = test::places_of(simulation, 0, side);
        targets.row(0).array() += 0.004;
        simulation.set_targets(0, side, targets);
        // Held by a constraint, too, from step 2 to 5.
        simulation.set_targets(1, {0, 1}, test::places_of<Dim>(simulation, 1, {0, 1}));
    } else if (i == 7) {
        simulation.release(0, side);
        simulation.release(1, {1, 0});
    }
}

// A cube of 0.5 m with as few cells as there can be.
template <int Dim>
SimplexMesh<Dim> coarse_cube(const Scene& scene) {
    if (scene.solver.elements == ElementKind::Quadratic) {
        return test::quadratic_cube<Dim>(1, 0.5);
    }
    std::array<int, Dim> count{};
    std::array<double, Dim> size{};
    count.fill(1);
    size.fill(0.5);
    return pent::test::kuhn_box<Dim>(count, size);
}

template <int Dim>
void expect_the_same_from_every_state(const Scene& scene) {
    const auto mesh = coarse_cube<Dim>(scene);
    Simulation<Dim> whole(scene, {mesh, mesh}, {.threads = 3});
    Simulation<Dim> two(scene, {mesh, mesh}, {.threads = 2});
    Simulation<Dim> often(scene, {mesh, mesh});
    for (int i = 0; i < 14; ++i) {
        for (Simulation<Dim>* simulation : {&whole, &two, &often}) {
            drive(*simulation, i);
            const StepReport report = simulation->step();
            ASSERT_TRUE(report.is_accepted) << i << ": " << report.failure;
        }
        expect_same(whole, often);
        expect_same(whole, two);
        Simulation<Dim> next(scene, {mesh, mesh});
        next.restore(often.save());
        EXPECT_EQ(next.size().free_vertices, often.size().free_vertices) << i;
        EXPECT_EQ(next.energies().total(), often.energies().total()) << i;
        often = std::move(next);
    }
}

TYPED_TEST(HostPairs, GoOnToTheBitWithContactByPenalties) {
    for (const Integrator integrator : kWithInertia) {
        for (const ElementKind elements :
             {ElementKind::Linear, ElementKind::Smoothed, ElementKind::Quadratic}) {
            SCOPED_TRACE(static_cast<int>(integrator) * 10 + static_cast<int>(elements));
            expect_the_same_from_every_state<TypeParam::value>(
                scene_of<TypeParam::value>(integrator, elements, ContactModel::Penalty));
        }
    }
}

TYPED_TEST(HostPairs, GoOnToTheBitWithABarrier) {
    for (const Integrator integrator : {Integrator::NewtonEuler, Integrator::Bdf2}) {
        for (const ElementKind elements : {ElementKind::Linear, ElementKind::Quadratic}) {
            if (TypeParam::value == 4 && elements == ElementKind::Quadratic) {
                continue;  // a minute, and nothing that three dimensions do not have
            }
            SCOPED_TRACE(static_cast<int>(integrator) * 10 + static_cast<int>(elements));
            expect_the_same_from_every_state<TypeParam::value>(
                scene_of<TypeParam::value>(integrator, elements, ContactModel::Barrier));
        }
    }
}

// What a simulation that was put into a state says of it, whatever it did before.
template <int Dim>
void expect_same_report(const Simulation<Dim>& a, const Simulation<Dim>& b) {
    expect_same(a, b);
    for (int body = 0; body < a.body_count(); ++body) {
        EXPECT_EQ(a.forces(body), b.forces(body)) << "body " << body;
        EXPECT_EQ(a.contact_forces(body), b.contact_forces(body)) << "body " << body;
    }
    const Energies of_a = a.energies();
    const Energies of_b = b.energies();
    for (const TermEnergy& term : of_a.terms) {
        EXPECT_EQ(term.energy, of_b.of(term.name)) << term.name;
    }
}

TYPED_TEST(HostPairs, SayOfAStateWhatIsOfNoOther) {
    constexpr int kDim = TypeParam::value;
    for (const Integrator integrator : kWithInertia) {
        for (const ContactModel model : {ContactModel::Penalty, ContactModel::Barrier}) {
            if (integrator == Integrator::LinearEuler && model == ContactModel::Barrier) {
                continue;
            }
            Scene scene = scene_of<kDim>(integrator, ElementKind::Linear, model);
            scene.sleep.reset();
            const Eigen::VectorXd zero = Eigen::VectorXd::Zero(kDim);
            Load press{.body = "b",
                       .select = {HalfSpaceSelection{.normal = Eigen::VectorXd::Unit(kDim, 0),
                                                     .offset = 0.3}}};
            press.force = zero;
            press.pressure = 200;
            scene.loads = {press};
            const std::vector<SimplexMesh<kDim>> meshes(2, test::cube<kDim>());
            Simulation<kDim> simulation(scene, meshes);
            Simulation<kDim> other(scene, meshes);
            test::throw_up(other, 1, 3);
            for (int i = 0; i < 6; ++i) {
                drive(simulation, i);
                ASSERT_TRUE(simulation.step().is_accepted);
                ASSERT_TRUE(other.step().is_accepted);
            }
            EXPECT_GT(simulation.contact_forces(0).norm(), 1);
            const Snapshot<kDim> state = simulation.save();
            Simulation<kDim> fresh(scene, meshes);
            fresh.restore(state);
            other.restore(state);
            expect_same_report(fresh, other);
            // The same where it is put there body by body, and with nothing behind it to hold.
            Positions<kDim> moved = fresh.positions(1);
            moved.row(0).array() += 0.01;
            ASSERT_TRUE(other.step().is_accepted);
            ASSERT_TRUE(fresh.step().is_accepted);
            other.set_state(1, moved, 0 * moved);
            fresh.set_state(1, moved, 0 * moved);
            const Snapshot<kDim> put = fresh.save();
            fresh.restore(state);
            fresh.restore(put);
            expect_same_report(fresh, other);
        }
    }
}

// A body that is pulled against another one, and against the floor, by far too long a spring: a
// barrier holds, and penalties refuse nothing.
TYPED_TEST(HostPairs, PullBodiesIntoEachOtherAndNothingCrosses) {
    constexpr int kDim = TypeParam::value;
    for (const ContactModel model : {ContactModel::Penalty, ContactModel::Barrier}) {
        Scene scene = scene_of<kDim>(Integrator::NewtonEuler, ElementKind::Linear, model);
        scene.constraints.clear();
        Simulation<kDim> simulation(scene, {coarse_cube<kDim>(scene), coarse_cube<kDim>(scene)});
        Grab<kDim> grab = corner(simulation, 1, 5000);
        grab.anchor[1] -= 3;
        static_cast<void>(simulation.add_grab(grab));
        for (int i = 0; i < 40; ++i) {
            const StepReport report = simulation.step();
            ASSERT_TRUE(report.is_accepted) << i << ": " << report.failure;
            if (model == ContactModel::Barrier) {
                EXPECT_GT(report.contact.smallest_distance, 0);
            }
        }
        EXPECT_LT(simulation.positions(1).row(1).minCoeff(), 0.53);
    }
}

// A sleeping body is grabbed through another that touches it: both are awake.
TYPED_TEST(HostPairs, WakeWhatTouchesWhatIsGrabbed) {
    constexpr int kDim = TypeParam::value;
    Scene scene =
        scene_of<kDim>(Integrator::LinearEuler, ElementKind::Linear, ContactModel::Penalty);
    scene.activations.clear();  // one that changes keeps its body awake
    scene.constraints.clear();
    scene.attachments.clear();
    Simulation<kDim> simulation(scene, {coarse_cube<kDim>(scene), coarse_cube<kDim>(scene)});
    for (int i = 0; i < 30; ++i) {
        const StepReport report = simulation.step();
        ASSERT_TRUE(report.is_accepted) << report.failure;
    }
    Snapshot<kDim> snapshot = simulation.save();  // whatever they do: at rest, and asleep
    snapshot.velocities.setZero();
    snapshot.sleep.assign(2, {.is_asleep = true});
    simulation.restore(snapshot);
    ASSERT_EQ(simulation.step().asleep, 2);
    ASSERT_FALSE(simulation.contacts().empty());
    Grab<kDim> grab = corner(simulation, 1);
    grab.anchor[1] += 0.2;
    static_cast<void>(simulation.add_grab(grab));
    const StepReport report = simulation.step();
    ASSERT_TRUE(report.is_accepted) << report.failure;
    EXPECT_FALSE(simulation.sleep()[0].is_asleep);
    EXPECT_FALSE(simulation.sleep()[1].is_asleep);
}

}  // namespace
}  // namespace pent::simulator
