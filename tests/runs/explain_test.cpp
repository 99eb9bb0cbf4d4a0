#include "explain/doubts.h"
#include "simulator/scenes.h"
#include "support/messages.h"
#include "support/temp_folder.h"

#include <pent/pent_file.h>
#include <pent/runs/explain.h>
#include <pent/runs/run.h>
#include <pent/simulator/step_failures.h>

#include <gtest/gtest.h>

#include <cmath>
#include <numbers>

namespace pent::runs {
namespace {

using namespace simulator;
namespace test = simulator::test;

using pent::test::expect_contains;
using pent::test::kuhn_box;
using pent::test::TempFolder;

// Two boxes of 2 x 1 x 1 x 1 unit cells, the second moved along x.
Scene two_boxes(const TempFolder& folder, double distance) {
    write_mesh(folder / "box.pent", kuhn_box<4>({2, 1, 1, 1}, {2, 1, 1, 1}));
    Scene scene = test::box_scene<4>();
    scene.bodies[0].mesh = (folder / "box.pent").string();
    scene.bodies.push_back(scene.bodies[0]);
    scene.bodies[1].name = "other";
    scene.bodies[1].place.translate[0] = distance;
    return scene;
}

const Term& term(const Explanation& explanation, const std::string& name) {
    for (const Term& t : explanation.terms) {
        if (t.name == name) {
            return t;
        }
    }
    ADD_FAILURE() << name;
    return explanation.terms.front();
}

std::string advice(const Explanation& explanation) {
    std::string all;
    for (const std::string& line : explanation.advice) {
        all += line + "\n";
    }
    return all;
}

TEST(Explain, ListsEveryTermWithWhatSwitchesIt) {
    const TempFolder folder;
    Scene scene = two_boxes(folder, 5);
    const Explanation off = explain(scene, 1);
    for (const std::string name :
         {"gravity", "damping", "constraints", "contact between bodies", "contact within bodies",
          "obstacles", "friction", "sleeping", "output"}) {
        EXPECT_FALSE(term(off, name).is_on) << name;
        EXPECT_EQ(term(off, name).seconds, 0) << name;
        EXPECT_EQ(term(off, name).bytes, 0) << name;
    }
    for (const std::string name : {"inertia", "elasticity of box", "elasticity of other"}) {
        EXPECT_TRUE(term(off, name).is_on) << name;
    }
    EXPECT_EQ(off.unknowns, 4 * 2 * 3 * 8);  // 3 x 2 x 2 x 2 vertices each
    scene.gravity[1] = -9.8;
    scene.damping = Damping{.mass = 0.1};
    scene.contact = ContactSettings{.self = true, .friction = 0.4};
    scene.obstacles = {
        {.shape = HalfSpaceObstacle{.normal = Eigen::Vector4d::UnitY(), .offset = -9}}};
    scene.sleep = Sleep{};
    scene.output.vertex = {simulator::VertexQuantity::ContactForce};
    scene.constraints = {test::hold(EverythingSelection{}, test::still(4))};
    const Explanation on = explain(scene, 1);
    for (const std::string name :
         {"gravity", "damping", "constraints", "contact between bodies", "contact within bodies",
          "obstacles", "friction", "sleeping", "output", "elasticity of other"}) {
        EXPECT_TRUE(term(on, name).is_on) << name;
    }
    EXPECT_FALSE(term(on, "elasticity of box").is_on);  // all of it is held
    EXPECT_EQ(on.unknowns, off.unknowns / 2);
    EXPECT_EQ(term(on, "elasticity of other").unknowns, on.unknowns);
    EXPECT_GT(term(on, "contact between bodies").bytes, 0);
    EXPECT_GT(term(on, "contact between bodies").seconds, 0);
    EXPECT_EQ(term(on, "contact within bodies").seconds, 0);  // found together: counted once
    expect_contains(explanation_text(on),
                    {"elasticity of other", "stable-neo-hookean", "a step", "coefficient 0.4",
                     "filter clamp", "contact_force of every vertex, no pairs"});
}

TEST(Explain, CountsTheMemoryOfATermOnce) {
    const TempFolder folder;
    Scene scene = two_boxes(folder, 5);
    scene.contact = ContactSettings{.self = true};
    const Explanation explanation = explain(scene, 1);
    std::int64_t bytes = 0;
    double seconds = 0;
    for (const Term& t : explanation.terms) {
        bytes += t.bytes;
        seconds += t.seconds;
    }
    EXPECT_LE(bytes, explanation.bytes);
    EXPECT_GT(bytes, explanation.bytes / 2);
    EXPECT_LE(seconds, explanation.seconds_per_step);
}

// A step of 1/30 s over many cells' worth of sound: a float matrix would drown the masses.
TEST(Explain, CountsTheDoubleMatrixThatStandsInForTheFloatOne) {
    const TempFolder folder;
    Scene scene = two_boxes(folder, 5);
    const Explanation soft = explain(scene, 1);
    for (Body& body : scene.bodies) {
        body.material.lame = lame_from_young(4, 1e12, 0.28);
    }
    const Explanation stiff = explain(scene, 1);
    constexpr std::int64_t kFloatBlock = 16 * 4 + 4;  // and an index
    const std::int64_t blocks = term(soft, "linear solver").bytes / kFloatBlock;
    EXPECT_EQ(term(soft, "linear solver").bytes, blocks * kFloatBlock);
    EXPECT_EQ(term(stiff, "linear solver").bytes, blocks * (kFloatBlock + 16 * 8));
    EXPECT_EQ(stiff.bytes - soft.bytes, blocks * 16 * 8);
}

TEST(Explain, TellsThePartsOfTheBarrierAndOfDampingWithNewtonsMethod) {
    const TempFolder folder;
    Scene scene = two_boxes(folder, 2.01);
    scene.contact = ContactSettings{.model = ContactModel::Barrier, .distance = 0.02};
    scene.solver.integrator = Integrator::NewtonEuler;
    scene.damping = Damping{.mass = 0, .stiffness = 0.01};
    scene.obstacles = {
        {.shape = HalfSpaceObstacle{.normal = Eigen::Vector4d::UnitY(), .offset = -1}}};
    const Explanation explanation = explain(scene, 1);
    expect_contains(term(explanation, "contact between bodies").why, {"barrier", "crosses"});
    expect_contains(term(explanation, "obstacles").why, {"1, barrier", "0 vertices touch"});
    EXPECT_GT(term(explanation, "damping").bytes, 0);
    EXPECT_GT(term(explanation, "damping").seconds, 0);
    EXPECT_EQ(advice(explanation).find("could go"), std::string::npos);
}

TEST(Explain, HasNoInertiaWhereEveryStepIsAnEquilibrium) {
    const TempFolder folder;
    Scene scene = two_boxes(folder, 5);
    scene.bodies.pop_back();
    scene.solver.integrator = Integrator::Quasistatic;
    scene.constraints = {test::hold(
        HalfSpaceSelection{.normal = Eigen::Vector4d(1, 0, 0, 0), .offset = 0.1}, test::still(4))};
    const Explanation explanation = explain(scene, 1);
    EXPECT_FALSE(term(explanation, "inertia").is_on);
    expect_contains(term(explanation, "inertia").why, {"quasistatic", "equilibrium"});
    EXPECT_TRUE(term(explanation, "elasticity of box").is_on);
}

TEST(Explain, GivesTheCostOfContactToTheFirstKindThatIsOn) {
    const TempFolder folder;
    Scene scene = two_boxes(folder, 5);
    scene.bodies.pop_back();
    scene.contact = ContactSettings{.self = true};
    const Explanation explanation = explain(scene, 1);
    EXPECT_FALSE(term(explanation, "contact between bodies").is_on);
    EXPECT_GT(term(explanation, "contact within bodies").bytes, 0);
    EXPECT_GT(term(explanation, "contact within bodies").seconds, 0);
}

TEST(Explain, SaysThatTheFirstStepFailsAndWhy) {
    const TempFolder folder;
    Scene scene = two_boxes(folder, 5);
    scene.gravity[1] = -9.8;
    scene.constraints = {test::hold(
        HalfSpaceSelection{.normal = Eigen::Vector4d(1, 0, 0, 0), .offset = 0.1}, test::still(4))};
    EXPECT_EQ(advice(explain(scene, 1)).find("the first step fails"), std::string::npos);
    scene.solver.max_iterations = 1;
    scene.solver.tolerance = 1e-12;
    expect_contains(advice(explain(scene, 1)),
                    {"the first step fails: the linear solver did not reach its tolerance"});
}

TEST(Explain, RepeatsTheWarningsOfTheSimulation) {
    const TempFolder folder;
    Scene scene = two_boxes(folder, 5);
    scene.contact = ContactSettings{.distance = 1};
    expect_contains(advice(explain(scene, 1)),
                    {"contact distance 1 m is more than half of the mean surface edge"});
}

TEST(Explain, SaysThatContactBetweenBodiesFarApartCouldGo) {
    const TempFolder folder;
    Scene scene = two_boxes(folder, 5);
    scene.contact = ContactSettings{.distance = 0.1};
    expect_contains(advice(explain(scene, 1)), {"3 m apart", "0.1 m", "[contact] could go"});
    scene = two_boxes(folder, 2.05);
    scene.contact = ContactSettings{.distance = 0.1};
    EXPECT_EQ(advice(explain(scene, 1)).find("could go"), std::string::npos);
}

// Who passes through whom on purpose is not too fast, nor too heavy for the other.
TEST(Explain, SaysNothingOfBodiesThatDoNotSeeEachOther) {
    const TempFolder folder;
    Scene scene = two_boxes(folder, 3);
    scene.bodies[0].velocity = Eigen::Vector4d(60, 0, 0, 0);
    scene.contact = ContactSettings{.distance = 0.1, .stiffness = 1e-3};
    expect_contains(advice(explain(scene, 1)),
                    {"can pass through one another", "[contact] stiffness is 0.001"});
    scene.contact->ignore = {{"box", "other"}};
    std::string lines = advice(explain(scene, 1));
    expect_contains(lines, {"[contact] has nothing to do: no body that moves sees another one"});
    for (const char* wrong : {"pass through", "stiffness is"}) {
        EXPECT_EQ(lines.find(wrong), std::string::npos) << lines;
    }
    // Of three, those that see each other count, and no nearer ones.
    scene.bodies.push_back(scene.bodies[1]);
    scene.bodies[2].name = "third";
    scene.bodies[2].place.translate[0] = 9;
    expect_contains(advice(explain(scene, 1)), {"box and third move 2 m a step"});
    EXPECT_EQ(advice(explain(scene, 1)).find("box and other"), std::string::npos);
}

TEST(Explain, SaysThatContactIsMissingWhereBodiesOverlap) {
    const TempFolder folder;
    expect_contains(advice(explain(two_boxes(folder, 1), 1)), {"overlap", "no [contact]"});
    EXPECT_EQ(advice(explain(two_boxes(folder, 5), 1)).find("overlap"), std::string::npos);
}

TEST(Explain, WarnsOfLockingOfThinBodiesAndOfIdleTerms) {
    const TempFolder folder;
    Scene scene = two_boxes(folder, 5);
    scene.damping = Damping{};
    scene.gravity[0] = 2;
    const std::string lines = advice(explain(scene, 1));
    expect_contains(lines, {"box is 1 cell thick", "lock", "[damping] is all zero",
                            "falls, 11.1 m"});  // 2/2 (100/30)^2
    scene.loads = {{.body = "box", .select = {EverythingSelection{}}}};
    scene.loads[0].force = Eigen::Vector4d(-4, 0, 0, 0);
    EXPECT_EQ(advice(explain(scene, 1)).find("falls"), std::string::npos);  // who knows
}

// Smoothed elements lock where there is one cell, or poisson is near the limit of 1/3; not from
// four on.
TEST(Explain, NamesSmoothedElementsWhereTheyHelp) {
    const TempFolder folder;
    Scene scene = two_boxes(folder, 5);
    scene.bodies.pop_back();
    const std::string mesh = (folder / "thick.pent").string();
    write_mesh(mesh, pent::test::kuhn_box<4>({4, 4, 4, 4}, {1, 1, 1, 1}));
    const auto says = [&](ElementKind kind) {
        scene.solver.elements = kind;
        return advice(explain(scene, 1));
    };
    expect_contains(says(ElementKind::Linear), {"take elements = \"smoothed\""});
    expect_contains(says(ElementKind::Smoothed),
                    {"even smoothed elements lock", "take elements = \"quadratic\""});
    scene.bodies[0].mesh = mesh;
    expect_contains(says(ElementKind::Linear),
                    {"4 to 5 cells thick", "take elements = \"smoothed\""});
    EXPECT_EQ(says(ElementKind::Smoothed).find("lock"), std::string::npos);
    scene.bodies[0].material.lame = lame_from_young(4, 1e5, 0.33);
    expect_contains(says(ElementKind::Smoothed), {"even smoothed elements lock"});
    scene.activations = {{.body = "box", .select = {EverythingSelection{}}, .stretch = 1.1}};
    const std::string with_muscle = says(ElementKind::Linear);
    expect_contains(with_muscle, {"lock", "take elements = \"quadratic\""});
    EXPECT_EQ(with_muscle.find("smoothed"), std::string::npos);  // which refuse activations
    EXPECT_THROW(says(ElementKind::Smoothed), Error);
    scene.activations.clear();
    write_mesh(mesh, pent::test::quadratic_kuhn_box<4>({1, 1, 1, 1}, {1, 1, 1, 1}));
    expect_contains(says(ElementKind::Linear), {"or \"quadratic\" with a mesh of pent-mesh"});
    EXPECT_EQ(says(ElementKind::Quadratic).find("lock"), std::string::npos);
}

TEST(Explain, TellsOfMeshesForQuadraticElementsThatAreNotUsed) {
    const TempFolder folder;
    Scene scene = two_boxes(folder, 5);
    const auto says = [&](ElementKind kind) {
        scene.solver.elements = kind;
        return advice(explain(scene, 1)).find("every mesh was made for quadratic elements")
               != std::string::npos;
    };
    const std::string mesh = (folder / "quadratic.pent").string();
    write_mesh(mesh, pent::test::quadratic_kuhn_box<4>({1, 1, 1, 1}, {1, 1, 1, 1}));
    scene.bodies[0].mesh = mesh;
    EXPECT_FALSE(says(ElementKind::Linear));  // the other body's is not
    scene.bodies[1].mesh = mesh;
    EXPECT_TRUE(says(ElementKind::Linear));
    EXPECT_TRUE(says(ElementKind::Smoothed));
    EXPECT_FALSE(says(ElementKind::Quadratic));
}

TEST(Explain, WarnsOfTurnsTooFarForALinearStep) {
    const TempFolder folder;
    Scene scene = two_boxes(folder, 5);
    Motion turn = test::still(4);
    turn.rotate = {{.plane = {0, 3}, .degrees_per_s = 900}};  // 30 degrees a step
    scene.constraints = {
        test::hold(HalfSpaceSelection{.normal = Eigen::Vector4d(1, 0, 0, 0), .offset = 0.1}, turn)};
    expect_contains(advice(explain(scene, 1)), {"30 degrees a step", "linear_euler"});
    scene.solver.integrator = Integrator::NewtonEuler;
    EXPECT_EQ(advice(explain(scene, 1)).find("degrees a step"), std::string::npos);
}

TEST(Explain, SaysWhatContactObstaclesAndSleepHaveNothingToDo) {
    const TempFolder folder;
    Scene scene = two_boxes(folder, 5);
    scene.bodies.pop_back();
    scene.contact = ContactSettings{};
    const HalfSpaceObstacle floor{.normal = Eigen::Vector4d::UnitY(), .offset = -1};
    scene.obstacles = {{.shape = floor}};
    scene.sleep = Sleep{.speed = 1e-3, .time = 0.1};
    expect_contains(advice(explain(scene, 1)),
                    {"[contact] has nothing to do: there is one body", "[[obstacle]] could go",
                     "sleep.time is 0.1 s, 3 steps"});
    scene.contact->friction = 0.5;  // of the obstacle, which the body now moves towards
    scene.bodies[0].velocity = Eigen::Vector4d(0, -1, 0, 0);
    scene.sleep->time = 1;
    const std::string lines = advice(explain(scene, 1));
    for (const char* idle : {"nothing to do", "could go", "sleep.time"}) {
        EXPECT_EQ(lines.find(idle), std::string::npos) << idle;
    }
}

TEST(Explain, KeepsWhatFrictionOfBodiesAndLaterLoadsNeed) {
    const TempFolder folder;
    Scene scene = two_boxes(folder, 5);
    scene.bodies.pop_back();
    const HalfSpaceObstacle floor{.normal = Eigen::Vector4d::UnitY(), .offset = -1};
    scene.obstacles = {{.shape = floor}};
    scene.contact = ContactSettings{};
    scene.bodies[0].friction = 0.5;
    expect_contains(term(explain(scene, 1), "friction").why, {"1 body or obstacle has its own"});
    EXPECT_EQ(advice(explain(scene, 1)).find("nothing to do"), std::string::npos);
    scene.contact.reset();
    expect_contains(term(explain(scene, 1), "friction").why, {"1 body or obstacle has its own"});
    EXPECT_NE(advice(explain(scene, 1)).find("[[obstacle]] could go"), std::string::npos);
    scene.loads = {{.body = scene.bodies[0].name,
                    .select = {EverythingSelection{}},
                    .force = Eigen::Vector4d(0, -1, 0, 0),
                    .keyframes = {{.time = 1, .factor = 0}, {.time = 2, .factor = 1}}}};
    EXPECT_EQ(advice(explain(scene, 1)).find("could go"), std::string::npos);
}

TEST(Explain, SaysThatNothingPushesBodiesThatAreHeldEverywhere) {
    const TempFolder folder;
    Scene scene = two_boxes(folder, 5);
    scene.contact = ContactSettings{};
    scene.constraints = {test::hold(EverythingSelection{}, test::still(4)),
                         test::hold(EverythingSelection{}, test::still(4))};
    scene.constraints[1].body = "other";
    expect_contains(advice(explain(scene, 1)),
                    {"[contact] has nothing to do: all bodies are held everywhere"});
    scene.obstacles = {
        {.shape = HalfSpaceObstacle{.normal = Eigen::Vector4d::UnitY(), .offset = -1}}};
    expect_contains(advice(explain(scene, 1)),
                    {"[[obstacle]] has nothing to do: all bodies are held everywhere"});
}

TEST(Explain, WarnsOfBodiesTooFastForASoftContact) {
    const TempFolder folder;
    Scene scene = two_boxes(folder, 5);
    scene.contact = ContactSettings{.distance = 0.1};
    scene.bodies[0].velocity = Eigen::Vector4d(30, 0, 0, 0);  // 1 m a step
    expect_contains(advice(explain(scene, 1)),
                    {"box and other move 1 m a step", "10 steps_per_frame"});
    scene.bodies[1].velocity = scene.bodies[0].velocity;  // side by side
    EXPECT_EQ(advice(explain(scene, 1)).find("a step past"), std::string::npos);
}

TEST(Explain, DoubtsUnitsThatDoNotFitOneAnother) {
    const TempFolder folder;
    Scene scene = two_boxes(folder, 5);
    scene.bodies.pop_back();
    const auto says = [&](const auto& change) {
        Scene other = scene;
        change(other);
        return advice(explain(other, 1));
    };
    EXPECT_EQ(says([](Scene&) {}).find("as meant"), std::string::npos);
    expect_contains(says([](Scene& s) { s.contact = ContactSettings{.distance = 0.11}; }),
                    {"[contact] distance = 0.11 m is more than a tenth of \"box\"", "1 m thick"});
    expect_contains(
        says([](Scene& s) {
            s.obstacles = {
                {.shape = BallObstacle{.center = Eigen::Vector4d(0, -9, 0, 0), .radius = 1},
                 .distance = 0.2}};
        }),
        {"[[obstacle]] 1 distance = 0.2 m"});
    // A pascal in place of a gigapascal: 1e-3 J/m^4 make waves of 1 mm/s.
    expect_contains(
        says([](Scene& s) { s.bodies[0].material.lame = lame_from_young(4, 1e-9, 0.28); }),
        {"a wave crosses \"box\"", "young (Pa)"});
    expect_contains(says([](Scene& s) { s.bodies[0].place.scale = 1e-3; }),
                    {"\"box\" weighs 2e-09 kg"});  // 2 mm^4 of 1000 kg/m^4
}

TEST(Explain, SaysWhatOverlapsAtTheStart) {
    const TempFolder folder;
    Scene scene = two_boxes(folder, 1.9);
    scene.bodies[1].place.translate.tail(3).setConstant(0.05);
    scene.contact = ContactSettings{};
    scene.obstacles = {
        {.shape = HalfSpaceObstacle{.normal = Eigen::Vector4d::UnitY(), .offset = 0.3}}};
    expect_contains(advice(explain(scene, 1)),
                    {"\"box\" and \"other\" overlap at the start, by 0.05 m",
                     "\"box\" and [[obstacle]] 1 overlap at the start, by 0.3 m"});
    scene = two_boxes(folder, 2);  // face to face
    scene.contact = ContactSettings{};
    EXPECT_EQ(advice(explain(scene, 1)).find("overlap"), std::string::npos);
}

// A stiff floor, which something comes to in steps of more than a tenth of its thickness: how deep
// it is in at the end of one is chance, and no stiffness would do.
TEST(Explain, SaysAfterARunWhichStepsWouldDo) {
    const TempFolder folder;
    int deep = 0;
    for (int i = 0; i < 16; ++i) {
        Scene scene = two_boxes(folder, 5);
        scene.bodies.pop_back();
        scene.bodies[0].place.translate[1] = 1 + 0.1 * i;
        scene.gravity[1] = -9.8;
        scene.frames = 30;
        scene.obstacles = {
            {.shape = HalfSpaceObstacle{.normal = Eigen::Vector4d::UnitY()}, .stiffness = 1e7}};
        const std::string said = run(scene, {.folder = folder / "run", .force = true}).penetration;
        if (said.empty()) {
            continue;
        }
        ++deep;
        const std::string before = "most of it in one step; steps_per_frame = ";
        const std::size_t at = said.find(before);
        ASSERT_NE(at, std::string::npos) << i << ": " << said;
        expect_contains(said, {"model = \"barrier\" with integrator = \"newton_euler\""});
        scene.steps_per_frame = std::stoi(said.substr(at + before.size()));
        EXPECT_LE(scene.steps_per_frame, 8);
        EXPECT_EQ(run(scene, {.folder = folder / "run", .force = true}).penetration, "") << i;
    }
    EXPECT_GT(deep, 4);
}

// With all else turned as it is, a plate goes as deep into a floor, and is as thick.
TEST(Explain, SaysTheSameOfAPlateAndAFloorThatAreTurned) {
    const TempFolder folder;
    write_mesh(folder / "plate.pent", kuhn_box<4>({2, 1, 2, 2}, {1, 0.1, 1, 1}));
    std::vector<RunReport> reports;
    for (const double degrees : {0.0, 30.0}) {
        const double angle = degrees * std::numbers::pi / 180;
        const Eigen::Vector4d up(-std::sin(angle), std::cos(angle), 0, 0);
        Scene scene = test::box_scene<4>();
        scene.bodies[0].mesh = (folder / "plate.pent").string();
        scene.bodies[0].place.rotate = {{.plane = {0, 1}, .degrees = degrees}};
        scene.bodies[0].place.translate = 0.02 * up;
        scene.gravity = -9.8 * up;
        scene.frames = 5;
        scene.steps_per_frame = 4;
        scene.solver.integrator = Integrator::NewtonEuler;
        scene.obstacles = {{.shape = HalfSpaceObstacle{.normal = up}}};
        reports.push_back(run(scene, {.folder = folder / "run", .force = true}));
        EXPECT_NEAR(reports.back().thinnest, 0.1, 1e-9);
        EXPECT_NE(reports.back().penetration, "");
    }
    EXPECT_EQ(reports[0].penetration, reports[1].penetration);
}

// The recipe of docs/contact.md on three scenes: a box that lies on a floor, one that falls on it,
// and one that flies at another. With the default it goes deep, with what is said to do it does
// not.
TEST(Explain, SaysWhichStiffnessWouldDo) {
    const TempFolder folder;
    Scene lying = two_boxes(folder, 5);
    lying.bodies.pop_back();
    lying.bodies[0].material.lame = lame_from_young(4, 1e6, 0.28);
    lying.gravity[1] = -9.8;
    lying.frames = 30;
    lying.steps_per_frame = 4;
    lying.solver.integrator = Integrator::NewtonEuler;
    lying.obstacles = {{.shape = HalfSpaceObstacle{.normal = Eigen::Vector4d::UnitY()}}};
    Scene falling = lying;
    falling.bodies[0].place.translate[1] = 0.5;
    Scene flying = two_boxes(folder, 2.1);
    for (Body& body : flying.bodies) {
        body.material = lying.bodies[0].material;
    }
    // Not face to face, where vertices would slide in along the sides.
    flying.bodies[1].place.translate.tail(3).setConstant(0.3);
    flying.bodies[0].velocity = Eigen::Vector4d(3, 0, 0, 0);
    flying.frames = 10;
    flying.steps_per_frame = 10;
    flying.solver.integrator = Integrator::NewtonEuler;
    flying.contact = ContactSettings{};
    for (Scene* scene : {&lying, &falling, &flying}) {
        const auto deepest = [&] {
            const RunReport report = run(*scene, {.folder = folder / "run", .force = true});
            EXPECT_EQ(report.verdict, RunVerdict::Finished) << report.message;
            double most = 0;
            for (const StepReport& step : report.steps) {
                most = std::max(most, step.contact.deepest);
            }
            EXPECT_EQ(report.penetration.empty(), most <= 0.1);
            return most;
        };
        const std::string lines = advice(explain(*scene, 1));
        const std::string before = " N/m, about ";
        const std::size_t at = lines.find(before);
        ASSERT_NE(at, std::string::npos) << lines;
        EXPECT_GT(deepest(), 0.1);
        const double stiffness = std::stod(lines.substr(at + before.size()));
        if (scene->contact) {
            scene->contact->stiffness = stiffness;
        } else {
            scene->obstacles[0].stiffness = stiffness;
        }
        EXPECT_LE(deepest(), 0.1);  // a tenth of 1 m
        EXPECT_EQ(advice(explain(*scene, 1)).find("would do"), std::string::npos);
    }
}

TEST(Remedy, SaysWhatToHoldWhereABodyMayTurnInEquilibrium) {
    const std::string failure(simulator::kIndefiniteFailure);
    Scene scene;
    scene.solver.integrator = Integrator::Quasistatic;
    expect_contains(remedy(scene, failure, {}), {"4 vertices that are not in one plane"});
    scene.dimension = 3;
    expect_contains(remedy(scene, failure, {}), {"3 vertices that are not in one line"});
    expect_contains(remedy(scene, failure, {"mm?"}), {"units first: mm?"});
    scene.solver.integrator = Integrator::NewtonEuler;
    EXPECT_EQ(remedy(scene, failure, {}).find("hold more"), std::string::npos);
}

}  // namespace
}  // namespace pent::runs
