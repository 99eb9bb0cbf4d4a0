#include "host_scenes.h"
#include "support/messages.h"

#include <pent/error.h>
#include <pent/simulator/crossing_error.h>
#include <pent/simulator/seen_pairs.h>

#include <gtest/gtest.h>

#include <memory>
#include <optional>
#include <string>
#include <utility>
#include <vector>

// Bodies and obstacles that a host adds and removes between steps.

namespace pent::simulator {
namespace {

using test::all_vertices;
using test::corner;
using test::cube;
using test::Dimensions;
using test::expect_same;
using test::kWithInertia;

template <typename T>
class Edit : public testing::Test {};
TYPED_TEST_SUITE(Edit, Dimensions);

template <int Dim>
void take_steps(Simulation<Dim>& simulation, int count) {
    for (int i = 0; i < count; ++i) {
        const StepReport report = simulation.step();
        ASSERT_TRUE(report.is_accepted) << report.failure;
    }
}

// Cubes "a", "b" and "c" of one cell one above the other, 0.02 m apart.
template <int Dim>
Scene tower(Integrator integrator = Integrator::NewtonEuler) {
    Scene scene = test::two_cubes<Dim>(0.02);
    scene.bodies[1].place.translate[1] = 0.27;
    scene.bodies.push_back(scene.bodies[1]);
    scene.bodies[2].name = "c";
    scene.bodies[2].place.translate[1] = 0.54;
    scene.bodies[2].place.rotate = {{.plane = {0, 2}, .degrees = 20}};
    scene.gravity[1] = -9.8;
    scene.solver.integrator = integrator;
    scene.obstacles = {
        {.shape = HalfSpaceObstacle{.normal = Eigen::VectorXd::Unit(Dim, 1), .offset = -0.02}}};
    return scene;
}

template <int Dim>
Simulation<Dim> start(const Scene& scene, int threads = 1) {
    return Simulation<Dim>(scene, std::vector<SimplexMesh<Dim>>(scene.bodies.size(), cube<Dim>(1)),
                           {.threads = threads});
}

// Through steps of every integrator, states that are set and restored: one address, and what it
// shows is the state of the time.
TYPED_TEST(Edit, ViewsShowTheStateWhereverAStepTakesIt) {
    constexpr int kDim = TypeParam::value;
    for (const Integrator integrator : kWithInertia) {
        Simulation<kDim> simulation = start<kDim>(tower<kDim>(integrator));
        const auto positions = simulation.positions(1);
        const auto velocities = simulation.velocities(1);
        const auto forces = simulation.forces(1);
        const Snapshot<kDim> begin = simulation.save();
        const auto expect_current = [&] {
            EXPECT_EQ(positions.data(), simulation.positions(1).data());
            EXPECT_EQ(velocities.data(), simulation.velocities(1).data());
            EXPECT_EQ(forces.data(), simulation.forces(1).data());
        };
        take_steps(simulation, 3);
        expect_current();
        EXPECT_NE(positions,
                  begin.positions.middleCols(simulation.first_vertex(1), positions.cols()));
        simulation.set_state(1, 1.01 * positions, 2 * velocities);
        expect_current();
        simulation.restore(begin);
        expect_current();
        EXPECT_EQ(positions,
                  begin.positions.middleCols(simulation.first_vertex(1), positions.cols()));
    }
}

TYPED_TEST(Edit, ViewsThatAreKeptShowWhatWasThereLast) {
    constexpr int kDim = TypeParam::value;
    std::optional<Simulation<kDim>> simulation(start<kDim>(tower<kDim>()));
    const auto positions = simulation->positions(2);
    const std::shared_ptr<const void> kept = simulation->arrays();
    take_steps(*simulation, 1);
    const Positions<kDim> last = positions;
    simulation->remove_body(0);
    take_steps(*simulation, 1);
    EXPECT_NE(simulation->positions(1).data(), positions.data());
    EXPECT_EQ(positions, last);
    simulation.reset();
    EXPECT_EQ(positions, last);
}

// A body that is added at the start is one of the scene.
TYPED_TEST(Edit, AddsABodyAsASceneHasIt) {
    constexpr int kDim = TypeParam::value;
    for (const Integrator integrator : kWithInertia) {
        Scene scene = tower<kDim>(integrator);
        scene.bodies[2].velocity = Vector<kDim>::Unit(0);
        scene.bodies[2].spin = {{.plane = {0, 1}, .degrees_per_s = 90}};
        Simulation<kDim> whole = start<kDim>(scene);
        Scene two = scene;
        two.bodies.pop_back();
        Simulation<kDim> grown = start<kDim>(two);
        grown.add_body(scene.bodies[2], cube<kDim>(1));
        EXPECT_EQ(grown.scene().bodies[2].name, "c");
        take_steps(whole, 12);
        take_steps(grown, 12);
        expect_same(whole, grown);
    }
}

// Without contact a body that comes or goes is nothing to the others, but for BDF2, which begins
// anew where one is added.
TYPED_TEST(Edit, LeavesTheOthersAlone) {
    constexpr int kDim = TypeParam::value;
    for (const Integrator integrator : {Integrator::LinearEuler, Integrator::NewtonEuler}) {
        Scene scene = tower<kDim>(integrator);
        scene.contact.reset();
        scene.solver.linear = LinearSolverKind::Direct;  // no tolerance of all bodies together
        scene.solver.precision = Precision::Double;
        const Body third = scene.bodies[2];
        scene.bodies.pop_back();
        Simulation<kDim> alone = start<kDim>(scene);
        Simulation<kDim> visited = start<kDim>(scene);
        take_steps(alone, 4);
        take_steps(visited, 2);
        visited.add_body(third, cube<kDim>(1));
        take_steps(visited, 2);
        for (const int body : {0, 1}) {
            EXPECT_LT((visited.positions(body) - alone.positions(body)).norm(), 1e-9);
        }
        visited.remove_body(2);
        EXPECT_LT((visited.velocities(1) - alone.velocities(1)).norm(), 1e-7);
        take_steps(alone, 3);
        take_steps(visited, 3);
        for (const int body : {0, 1}) {
            EXPECT_LT((visited.positions(body) - alone.positions(body)).norm(), 1e-9);
        }
    }
}

// A scene in which everything refers to bodies by name, with springs that break, holds that begin
// later, and what a host does.
template <int Dim>
Scene tangled(Integrator integrator, ContactModel model) {
    Scene scene = tower<Dim>(integrator);
    scene.contact->model = model;
    scene.contact->friction = 0.3;
    scene.contact->ignore = {{"a", "c"}, {"a", "a"}};
    scene.sleep = Sleep{.speed = 1e-3, .time = 0.1};
    const auto tie = [&](const char* body, const char* target, double break_force) {
        Attachment attachment;
        attachment.body = body;
        attachment.select = {EverythingSelection{}};
        attachment.target = target;
        attachment.max_distance = 1;
        attachment.break_force = break_force;
        attachment.stiffness = 50;
        scene.attachments.push_back(attachment);
    };
    tie("a", "b", 0.01);
    tie("b", "c", 0.02);
    tie("c", "", 0.5);
    for (const char* name : {"a", "b", "c"}) {
        Constraint hold{.body = name, .select = {LayerSelection{}}, .motion = {}};
        hold.select = {HalfSpaceSelection{.normal = Eigen::VectorXd::Unit(Dim, 0), .offset = 0.1}};
        hold.from = 0.05;
        hold.to = 0.08;
        scene.constraints.push_back(hold);
        Load load;
        load.body = name;
        load.select = {EverythingSelection{}};
        load.force = 5 * Eigen::VectorXd::Unit(Dim, 0);
        scene.loads.push_back(load);
    }
    return scene;
}

template <int Dim>
void do_as_a_host(Simulation<Dim>& simulation) {
    for (int body = 0; body < 3; ++body) {
        Grab<Dim> grab = corner(simulation, body, 200);
        grab.anchor[1] += 0.02 * body;
        grab.damping = 2;
        static_cast<void>(simulation.add_grab(grab));
        const Positions<Dim> forces =
            Positions<Dim>::Constant(Dim, simulation.masses(body).size(), 0.3 * body);
        simulation.set_forces(body, forces);
        Positions<Dim> target = simulation.positions(body).rightCols(1);
        target(0, 0) += 0.001;
        simulation.set_targets(
            body, {static_cast<std::uint32_t>(simulation.masses(body).size() - 1)}, target);
    }
    simulation.set_gravity(-5 * Vector<Dim>::Unit(1));
}

// Bodies without the one that was removed are to the bit what they are in a simulation that never
// had it and is put into their state.
TYPED_TEST(Edit, RemovesABodyWithAllThatHasToDoWithIt) {
    constexpr int kDim = TypeParam::value;
    for (const ContactModel model : {ContactModel::Penalty, ContactModel::Barrier}) {
        for (const int removed : {0, 1, 2}) {
            if (kDim == 4 && removed != 1) {
                continue;  // slow, and nothing that three dimensions do not have
            }
            const Scene scene = tangled<kDim>(Integrator::Bdf2, model);
            Simulation<kDim> simulation = start<kDim>(scene);
            take_steps(simulation, 4);
            do_as_a_host(simulation);
            take_steps(simulation, 3);
            const Snapshot<kDim> before = simulation.save();
            std::vector<Positions<kDim>> kept;
            for (int body = 0; body < 3; ++body) {
                if (body != removed) {
                    kept.push_back(simulation.positions(body));
                }
            }
            simulation.remove_body(removed);
            const Snapshot<kDim> after = simulation.save();
            EXPECT_EQ(simulation.positions(0), kept[0]);
            EXPECT_EQ(simulation.positions(1), kept[1]);
            EXPECT_EQ(after.previous_positions.cols(), after.positions.cols());
            EXPECT_EQ(after.host.grabs.size(), 2U);
            EXPECT_EQ(after.host.grabs[1].grab.point.body, 1);
            EXPECT_EQ(after.host.next_grab, 4U);
            EXPECT_EQ(after.host.held.size(), 2U);
            EXPECT_EQ(simulation.scene().loads.size(), 2U);
            EXPECT_EQ(simulation.scene().constraints.size(), 2U);
            EXPECT_EQ(simulation.scene().attachments.size(), removed == 0 ? 2U : 1U);
            // Another one, made of what is left.
            Scene left = simulation.scene();
            Simulation<kDim> made(left, {simulation.mesh(0), simulation.mesh(1)});
            made.restore(after);
            take_steps(simulation, 8);
            take_steps(made, 8);
            expect_same(simulation, made);
            pent::test::expect_contains(pent::test::error_of([&] { simulation.restore(before); }),
                                        {"vertices"});
        }
    }
}

TYPED_TEST(Edit, IsTheSameForAnyNumberOfThreadsAndAfterEverySavedState) {
    constexpr int kDim = TypeParam::value;
    for (const ContactModel model : {ContactModel::Penalty, ContactModel::Barrier}) {
        for (const Integrator integrator : kWithInertia) {
            const bool is_barrier = model == ContactModel::Barrier;
            if ((is_barrier && integrator == Integrator::LinearEuler)
                || (kDim == 4 && is_barrier != (integrator == Integrator::Bdf2))) {
                continue;  // what is not there, and what is slow and three dimensions have as well
            }
            const Scene scene = tangled<kDim>(integrator, model);
            Simulation<kDim> one = start<kDim>(scene);
            Simulation<kDim> three = start<kDim>(scene, 3);
            Body fourth = scene.bodies[2];
            fourth.name = "d";
            fourth.place.translate[1] = 1.5;
            for (int i = 0; i < 14; ++i) {
                for (Simulation<kDim>* simulation : {&one, &three}) {
                    if (i == 2) {
                        do_as_a_host(*simulation);
                    } else if (i == 4) {
                        simulation->move_grab(2, Vector<kDim>::Constant(0.4));
                    } else if (i == 6) {
                        simulation->remove_body(1);
                    } else if (i == 8) {
                        simulation->add_body(fourth, cube<kDim>(1));
                    } else if (i == 9) {
                        simulation->remove_obstacle(0);
                    } else if (i == 11) {
                        simulation->remove_grab(1);
                        simulation->release(1, all_vertices(*simulation, 1));
                        simulation->set_gravity(Vector<kDim>::Zero());
                    }
                    take_steps(*simulation, 1);
                }
                expect_same(one, three);
                // Put into another one, it goes on from there.
                std::vector<SimplexMesh<kDim>> meshes;
                for (int body = 0; body < one.body_count(); ++body) {
                    meshes.push_back(one.mesh(body));
                }
                Scene now = one.scene();
                for (Body& body : now.bodies) {  // meshes are placed
                    body.place = Placement();
                    body.place.translate.setZero(kDim);
                }
                Simulation<kDim> next(now, meshes);
                next.restore(one.save());
                one = std::move(next);
            }
        }
    }
}

// What a body lay on is gone: it falls, though it slept.
TYPED_TEST(Edit, WakesWhatLayOnWhatIsRemoved) {
    constexpr int kDim = TypeParam::value;
    for (const ContactModel model : {ContactModel::Penalty, ContactModel::Barrier}) {
        for (const bool is_obstacle : {false, true}) {
            Scene scene = tower<kDim>();
            scene.contact->model = model;
            scene.sleep = Sleep{};
            scene.bodies.pop_back();
            scene.bodies[1].place.translate.setZero();
            scene.bodies[1].place.translate[1] = 0.27;
            // b lies on a, which is held, or both on the ground.
            if (is_obstacle) {
                scene.bodies[1].place.translate *= 0;
                scene.bodies[1].place.translate[0] = 1;
            } else {
                scene.constraints = {
                    {.body = "a", .select = {EverythingSelection{}}, .motion = {}}};
            }
            Simulation<kDim> simulation = start<kDim>(scene);
            for (int i = 0; i < 50 && simulation.contacts().empty(); ++i) {
                take_steps(simulation, 1);
            }
            Snapshot<kDim> snapshot = simulation.save();
            snapshot.velocities.setZero();
            snapshot.sleep[1].is_asleep = true;
            snapshot.sleep[1].contact_stiffness = snapshot.contact_stiffness;
            simulation.restore(snapshot);
            take_steps(simulation, 3);
            ASSERT_TRUE(simulation.sleep()[1].is_asleep);
            const Positions<kDim> before = simulation.positions(1);
            if (is_obstacle) {
                simulation.remove_obstacle(0);
            } else {
                simulation.remove_body(0);
            }
            take_steps(simulation, 10);  // backward Euler: g h^2 10 11 / 2
            const Positions<kDim> now = simulation.positions(simulation.body_count() - 1);
            EXPECT_NEAR((now - before).row(1).mean(), -9.8e-4 * 55, 2e-3);
        }
    }
}

// Whatever comes or goes in the middle: friction with the first obstacle that rubs, obstacles that
// move, the last that there is. Nothing else is made anew: views stay where they are.
TYPED_TEST(Edit, GoesOnWithOtherObstaclesAsASceneThatHasThem) {
    constexpr int kDim = TypeParam::value;
    for (const ContactModel model : {ContactModel::Penalty, ContactModel::Barrier}) {
        for (const Integrator integrator : kWithInertia) {
            Scene scene = tower<kDim>(integrator);
            if (model == ContactModel::Barrier && integrator == Integrator::LinearEuler) {
                continue;  // a barrier wants Newton's method
            }
            scene.contact->model = model;
            scene.bodies[0].friction = 0.4;
            Simulation<kDim> edited = start<kDim>(scene);
            take_steps(edited, 4);
            Snapshot<kDim> adapted = edited.save();
            adapted.contact_stiffness *= 4;  // of a barrier, as after deeper contact; else 0
            edited.restore(adapted);
            // It comes up to them meanwhile.
            const double low = edited.save().positions.row(kDim - 1).minCoeff();
            Obstacle wall{
                .shape = HalfSpaceObstacle{.normal = Eigen::VectorXd::Unit(kDim, kDim - 1),
                                           .offset = low - 0.03},
                .friction = 0.5};
            wall.motion.resize(1);
            wall.motion[0].translate = 0.3 * Eigen::VectorXd::Unit(kDim, kDim - 1);
            const auto positions = edited.positions(1);
            const auto forces = edited.forces(1);
            const auto expect_as_one_of_the_scene = [&](const Snapshot<kDim>& before) {
                Simulation<kDim> opened = start<kDim>(scene);
                opened.restore(before);
                for (int i = 0; i < 4; ++i) {
                    expect_same(edited, opened);
                    for (int body = 0; body < edited.body_count(); ++body) {
                        EXPECT_EQ(edited.forces(body), opened.forces(body)) << body;
                    }
                    EXPECT_EQ(edited.energies().total(), opened.energies().total());
                    take_steps(edited, 1);
                    take_steps(opened, 1);
                }
                EXPECT_EQ(edited.positions(1).data(), positions.data());
                EXPECT_EQ(edited.forces(1).data(), forces.data());
                EXPECT_EQ(edited.scene().obstacles.size(), scene.obstacles.size());
                EXPECT_EQ(edited.obstacles().size(), scene.obstacles.size());
            };
            Snapshot<kDim> before = edited.save();
            edited.add_obstacle(wall);
            scene.obstacles.push_back(wall);
            expect_as_one_of_the_scene(before);
            // What it says of itself opens the same: its meshes are placed already.
            std::vector<SimplexMesh<kDim>> meshes;
            for (int body = 0; body < edited.body_count(); ++body) {
                meshes.push_back(edited.mesh(body));
            }
            Simulation<kDim> copy(edited.scene(), meshes);
            copy.restore(edited.save());
            take_steps(copy, 1);
            take_steps(edited, 1);
            expect_same(edited, copy);
            while (!scene.obstacles.empty()) {
                before = edited.save();
                edited.remove_obstacle(0);
                scene.obstacles.erase(scene.obstacles.begin());
                expect_as_one_of_the_scene(before);
            }
        }
    }
}

// One that was apart from the bodies at the start of the scene and is not now, and the other way
// round.
TYPED_TEST(Edit, LooksAtAnAddedObstacleWhereItIsByThen) {
    constexpr int kDim = TypeParam::value;
    Scene scene = tower<kDim>();
    scene.contact->model = ContactModel::Barrier;
    Simulation<kDim> simulation = start<kDim>(scene);
    take_steps(simulation, 4);
    const Snapshot<kDim> before = simulation.save();
    const Eigen::VectorXd up = Eigen::VectorXd::Unit(kDim, kDim - 1);
    const double low = before.positions.row(kDim - 1).minCoeff();
    const auto wall = [&](double offset, double by_now) {
        Obstacle made{.shape = HalfSpaceObstacle{.normal = up, .offset = offset}};
        made.motion.resize(1);
        made.motion[0].translate = by_now / simulation.time() * up;
        return made;
    };
    EXPECT_THROW(simulation.add_obstacle(wall(low - 0.05, 0.1)), CrossingError<kDim>);
    EXPECT_EQ(simulation.scene().obstacles.size(), 1U);
    EXPECT_EQ(simulation.obstacles().size(), 1U);
    EXPECT_EQ(simulation.save().positions, before.positions);
    simulation.add_obstacle(wall(low + 0.05, -0.1));
    EXPECT_EQ(simulation.obstacles().size(), 2U);
    take_steps(simulation, 1);
}

TYPED_TEST(Edit, WakesWhatAnAddedObstacleTouches) {
    constexpr int kDim = TypeParam::value;
    Scene scene = test::box_scene<kDim>();
    scene.sleep = Sleep{};
    Simulation<kDim> simulation(scene, {cube<kDim>(1)});
    Snapshot<kDim> snapshot = simulation.save();
    snapshot.sleep[0].is_asleep = true;
    simulation.restore(snapshot);
    const auto wall = [](double offset) {
        return Obstacle{
            .shape = HalfSpaceObstacle{.normal = Eigen::VectorXd::Unit(kDim, 1), .offset = offset}};
    };
    simulation.add_obstacle(wall(-1));
    EXPECT_TRUE(simulation.sleep()[0].is_asleep);
    simulation.add_obstacle(wall(-0.01));
    EXPECT_FALSE(simulation.sleep()[0].is_asleep);
    EXPECT_EQ(simulation.obstacles().size(), 2U);
    take_steps(simulation, 1);
    EXPECT_GT(simulation.velocities(0).row(1).maxCoeff(), 0);
}

// Two grounds, and a body asleep on each: where one goes the other body sleeps on.
TYPED_TEST(Edit, WakesNothingThatLiesElsewhere) {
    constexpr int kDim = TypeParam::value;
    Scene scene = test::two_cubes<kDim>(0.5);
    scene.contact.reset();
    scene.sleep = Sleep{};
    scene.bodies[0].place.translate.setZero();
    scene.bodies[1].place.translate[0] = 3;
    for (const double x : {0.125, 3.125}) {
        Eigen::VectorXd center = Eigen::VectorXd::Zero(kDim);
        center[0] = x;
        center[1] = x < 1 ? -1 : 0;
        scene.obstacles.push_back({.shape = BallObstacle{.center = center, .radius = 1}});
    }
    scene.bodies[1].place.translate[1] = 1;
    for (const int removed : {0, 1}) {
        Simulation<kDim> simulation = start<kDim>(scene);
        Snapshot<kDim> snapshot = simulation.save();
        for (SleepState& state : snapshot.sleep) {
            state.is_asleep = true;
        }
        simulation.restore(snapshot);
        ASSERT_FALSE(simulation.contacts().empty());
        simulation.remove_obstacle(removed);
        EXPECT_EQ(simulation.sleep()[0].is_asleep, removed == 1);
        EXPECT_EQ(simulation.sleep()[1].is_asleep, removed == 0);
    }
}

// Which of its springs are broken, and where a constraint took its vertices up, goes with each part
// of a scene, whatever is taken out before it. What is there from the start has no such place.
TYPED_TEST(Edit, LeavesEverySpringAndHoldItsOwnState) {
    constexpr int kDim = TypeParam::value;
    Scene scene = tower<kDim>();
    scene.contact.reset();
    const auto hold = [](const char* body, double from) {
        return Constraint{
            .body = body,
            .select = {HalfSpaceSelection{.normal = Eigen::VectorXd::Unit(kDim, 0), .offset = 0.1}},
            .motion = {},
            .from = from,
            .to = from > 0 ? 1 : 0.015};
    };
    scene.constraints = {hold("a", 0.02), hold("a", 0), hold("b", 0),
                         hold("b", 0.03), hold("c", 0), hold("c", 0.02)};
    const auto tie = [&](const char* body, const char* target, bool does_break) {
        Attachment attachment;
        attachment.body = body;
        attachment.select = {EverythingSelection{}};
        attachment.target = target;
        attachment.max_distance = 1;
        attachment.break_force = does_break ? 1e-9 : 1e9;
        scene.attachments.push_back(attachment);
    };
    tie("a", "", false);
    tie("a", "b", true);
    tie("b", "", true);
    tie("c", "b", false);
    tie("c", "", true);
    Activation swelling;
    swelling.select = {EverythingSelection{}};
    swelling.stretch = 1.001;
    for (const char* body : {"a", "b", "c"}) {
        swelling.body = body;
        scene.activations.push_back(swelling);
    }
    for (const int removed : {0, 1, 2}) {
        const std::string name = scene.bodies[static_cast<std::size_t>(removed)].name;
        Simulation<kDim> simulation = start<kDim>(scene);
        take_steps(simulation, 5);
        Positions<kDim> places(kDim, 0);
        for (const Constraint& constraint : scene.constraints) {
            const auto body = static_cast<int>(index_of(scene, constraint.body));
            if (constraint.from == 0 || body == removed) {
                continue;
            }
            for (const std::uint32_t v : all_vertices(simulation, body)) {  // held, where it was
                if (simulation.mesh(body).positions(0, v) < 0.1) {
                    places.conservativeResize(kDim, places.cols() + 1);
                    places.rightCols(1) = simulation.positions(body).col(v);
                }
            }
        }
        const std::vector<std::uint8_t> before = simulation.save().broken_springs;
        std::vector<std::uint8_t> broken;
        constexpr std::ptrdiff_t kSprings = std::ptrdiff_t{1} << kDim;  // of each
        for (std::size_t k = 0; k < scene.attachments.size(); ++k) {
            const Attachment& attachment = scene.attachments[k];
            const auto first = before.begin() + static_cast<std::ptrdiff_t>(k) * kSprings;
            EXPECT_EQ(*(first + kSprings - 1), attachment.break_force < 1 ? 1 : 0) << k;
            if (attachment.body != name && attachment.target != name) {
                broken.insert(broken.end(), first, first + kSprings);
            }
        }
        simulation.remove_body(removed);
        EXPECT_EQ(simulation.save().broken_springs, broken);
        EXPECT_EQ(simulation.save().hold_places, places);
        EXPECT_EQ(simulation.scene().activations.size(), 2U);
        take_steps(simulation, 2);
    }
}

// Whoever is left sees whom it saw before. An empty `only` would let all see each other.
TEST(EditOfPairs, LetsAllOthersSeeWhomTheySawBefore) {
    for (const auto& [ignore, only] :
         std::vector<std::pair<std::vector<BodyPair>, std::vector<BodyPair>>>{
             {{}, {}},
             {{}, {{"a", "b"}}},
             {{}, {{"a", "b"}, {"b", "c"}}},
             {{{"a", "c"}}, {}},
             {{{"b", "b"}, {"a", "b"}}, {}}}) {
        for (const bool self : {false, true}) {
            for (const std::size_t removed : {0U, 1U, 2U}) {
                Scene scene = tower<3>();
                scene.contact->self = self;
                scene.contact->ignore = ignore;
                scene.contact->only = only;
                Simulation<3> simulation = start<3>(scene);
                simulation.remove_body(static_cast<int>(removed));
                const SeenPairs before(scene);
                const SeenPairs after(simulation.scene());
                for (const std::size_t a : {0U, 1U}) {
                    for (const std::size_t b : {0U, 1U}) {
                        EXPECT_EQ(after.may_touch(a, b),
                                  before.may_touch(a + (a >= removed ? 1 : 0),
                                                   b + (b >= removed ? 1 : 0)));
                    }
                }
            }
        }
    }
}

TEST(EditsThatAreWrong, AreRefusedAndChangeNothing) {
    Scene scene = tower<4>();
    scene.contact->model = ContactModel::Barrier;
    Simulation<4> simulation = start<4>(scene);
    take_steps(simulation, 2);
    const auto before = simulation.save();
    Body other = scene.bodies[0];
    pent::test::expect_contains(
        pent::test::error_of([&] { simulation.add_body(other, cube<4>(1)); }), {"\"a\""});
    other.name = "d";
    EXPECT_THROW(simulation.add_body(other, cube<4>(1)), CrossingError<4>);
    SimplexMesh<4> broken = cube<4>(1);
    broken.cells(0, 0) = 99;
    other.place.translate[1] = 4;
    pent::test::expect_contains(pent::test::error_of([&] { simulation.add_body(other, broken); }),
                                {"\"d\"", "99"});
    const Obstacle flat{.shape =
                            HalfSpaceObstacle{.normal = Eigen::Vector4d::UnitY(), .offset = 0.3}};
    EXPECT_THROW(simulation.add_obstacle(flat), CrossingError<4>);
    EXPECT_EQ(simulation.body_count(), 3);
    EXPECT_EQ(simulation.save().positions, before.positions);
    take_steps(simulation, 1);
}

}  // namespace
}  // namespace pent::simulator
