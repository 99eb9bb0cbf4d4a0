// Scenes on ranks that are threads of this process, beside the same scenes on one alone.

#include "barrier_scenes.h"
#include "contact_scenes.h"
#include "cut_meshes.h"
#include "scenes.h"
#include "support/messages.h"
#include "thread_ranks.h"

#include <pent/simulator/simulation.h>

#include <gtest/gtest.h>

namespace pent::simulator {
namespace {

template <int Dim>
struct Case {
    Scene scene;
    std::vector<SimplexMesh<Dim>> meshes;
};

// What a scene has come to.
template <int Dim>
struct State {
    Positions<Dim> positions;
    Positions<Dim> forces;
    Eigen::RowVectorXd densities;  // of energy, one a vertex
    std::vector<StepReport> steps;
    SimulationSize size;
};

template <int Dim>
State<Dim> simulate(Simulation<Dim> simulation, int steps) {
    State<Dim> state;
    for (int i = 0; i < steps; ++i) {
        state.steps.push_back(simulation.step());
    }
    const Snapshot<Dim> end = simulation.save();
    state.positions = end.positions;
    state.forces.resize(Dim, end.positions.cols());
    state.densities.resize(end.positions.cols());
    for (int body = 0; body < simulation.body_count(); ++body) {
        const Eigen::Index first = simulation.first_vertex(body);
        const Eigen::Index count = simulation.mesh(body).vertex_count();
        state.forces.middleCols(first, count) = simulation.forces(body);
        state.densities.middleCols(first, count) =
            simulation.vertex_values(VertexQuantity::EnergyDensity, body);
    }
    state.size = simulation.size();
    return state;
}

template <int Dim>
State<Dim> simulate(const Case<Dim>& of, int steps, const std::shared_ptr<const Ranks>& ranks) {
    return simulate(Simulation<Dim>(of.scene, of.meshes, {.ranks = ranks}), steps);
}

// The same of ranks of which none has a whole mesh.
template <int Dim>
State<Dim> simulate_parts(const Case<Dim>& of,
                          int steps,
                          const std::shared_ptr<const Ranks>& ranks) {
    return simulate(Simulation<Dim>(of.scene, test::cut_meshes<Dim>(of.scene, of.meshes, *ranks),
                                    {.ranks = ranks}),
                    steps);
}

// A bar that is turned, falls and is damped, to eight digits.
Case<4> swing(Integrator integrator, ElementKind elements = ElementKind::Linear) {
    Case<4> made{test::swinging_bar(), {test::bar()}};
    made.scene.solver.integrator = integrator;
    made.scene.solver.elements = elements;
    made.scene.solver.precision = Precision::Double;
    made.scene.solver.tolerance = 1e-10;
    made.scene.solver.newton_tolerance = 1e-9;
    return made;
}

// Every rank has what one alone has, but for rounding and for what the solver leaves; all ranks
// have the same to the bit.
template <int Dim>
void expect_same_on_ranks(const Case<Dim>& of, int steps, double tolerance) {
    const State<Dim> alone = simulate<Dim>(of, steps, nullptr);
    ASSERT_TRUE(alone.steps.back().is_accepted) << alone.steps.back().failure;
    double motion = 0;
    double force = alone.forces.norm();
    {
        const Simulation<Dim> start(of.scene, of.meshes);
        motion = (alone.positions - start.save().positions).norm();
    }
    ASSERT_GT(motion, 0);
    for (const int count : {1, 2, 3, 4}) {
        SCOPED_TRACE(count);
        std::vector<State<Dim>> all(static_cast<std::size_t>(count));
        test::on_ranks(count, [&](const std::shared_ptr<const Ranks>& ranks) {
            all[static_cast<std::size_t>(ranks->rank())] = simulate<Dim>(of, steps, ranks);
        });
        for (const State<Dim>& state : all) {
            EXPECT_EQ(state.positions, all.front().positions);
            EXPECT_EQ(state.forces, all.front().forces);
            EXPECT_EQ(state.densities, all.front().densities);
            EXPECT_EQ(state.steps.back().iterations, all.front().steps.back().iterations);
        }
        const State<Dim>& state = all.front();
        test::on_ranks(count, [&](const std::shared_ptr<const Ranks>& ranks) {
            const State<Dim> of_parts = simulate_parts<Dim>(of, steps, ranks);
            EXPECT_EQ(of_parts.positions, state.positions);
            EXPECT_EQ(of_parts.forces, state.forces);
            EXPECT_EQ(of_parts.densities, state.densities);
            EXPECT_EQ(of_parts.size.elements, state.size.elements);
        });
        EXPECT_LT((state.positions - alone.positions).norm(), tolerance * motion);
        EXPECT_LT((state.forces - alone.forces).norm(), 100 * tolerance * force);
        // A joule is nothing beside a strain that anybody sees.
        EXPECT_LT((state.densities - alone.densities).norm(),
                  100 * tolerance * (alone.densities.norm() + 1));
        EXPECT_EQ(state.size.elements, alone.size.elements);
        EXPECT_EQ(state.size.free_vertices, alone.size.free_vertices);
        for (std::size_t i = 0; i < alone.steps.size(); ++i) {
            const StepReport& own = state.steps[i];
            const StepReport& other = alone.steps[i];
            EXPECT_EQ(own.is_accepted, other.is_accepted);
            EXPECT_EQ(own.inverted, other.inverted);
            EXPECT_EQ(own.asleep, other.asleep);
            EXPECT_EQ(own.contact.point_facet, other.contact.point_facet);
            EXPECT_EQ(own.contact.obstacle, other.contact.obstacle);
            ASSERT_EQ(own.energies.terms.size(), other.energies.terms.size());
            const double scale = other.energies.kinetic + std::abs(other.energies.total()) + 1e-9;
            for (std::size_t term = 0; term < other.energies.terms.size(); ++term) {
                EXPECT_NEAR(own.energies.terms[term].energy, other.energies.terms[term].energy,
                            100 * tolerance * scale)
                    << other.energies.terms[term].name;
            }
        }
    }
}

TEST(SharedSimulation, TakesLinearSteps) {
    expect_same_on_ranks(swing(Integrator::LinearEuler), 3, 1e-7);
}

TEST(SharedSimulation, TakesNewtonStepsWithDamping) {
    expect_same_on_ranks(swing(Integrator::NewtonEuler), 2, 1e-7);
}

TEST(SharedSimulation, LooksTwoStepsBack) {
    expect_same_on_ranks(swing(Integrator::Bdf2), 3, 1e-7);
}

TEST(SharedSimulation, FindsEquilibria) {
    expect_same_on_ranks(swing(Integrator::Quasistatic), 1, 1e-6);
}

TEST(SharedSimulation, HasSmoothedElements) {
    expect_same_on_ranks(swing(Integrator::NewtonEuler, ElementKind::Smoothed), 1, 1e-7);
}

TEST(SharedSimulation, HasQuadraticElements) {
    Case<3> made{test::box_scene<3>(), {pent::test::quadratic_kuhn_box<3>({3, 2, 2}, {1, 1, 1})}};
    made.scene.gravity[1] = -9.8;
    made.scene.constraints = {test::hold(
        HalfSpaceSelection{.normal = Eigen::Vector3d(1, 0, 0), .offset = 1e-6}, test::still(3))};
    made.scene.solver.elements = ElementKind::Quadratic;
    made.scene.solver.precision = Precision::Double;
    made.scene.solver.tolerance = 1e-10;
    expect_same_on_ranks(made, 2, 1e-7);
}

// Rows of float blocks are summed in other orders, and Jacobi has other columns.
TEST(SharedSimulation, HasFloatMatricesAndOtherPreconditioners) {
    for (const PreconditionerKind kind :
         {PreconditionerKind::BlockJacobi, PreconditionerKind::RigidModes}) {
        Case<4> made = swing(Integrator::LinearEuler);
        made.scene.solver.precision = Precision::Float;
        made.scene.solver.preconditioner = kind;
        made.scene.solver.tolerance = 1e-7;
        expect_same_on_ranks(made, 1, 1e-5);
    }
}

// Every rank weighs forces alike, also those on vertices of which others have the cells.
TEST(SharedSimulation, HasMaterialsThatDifferAMillionfold) {
    for (const Integrator integrator : {Integrator::LinearEuler, Integrator::NewtonEuler}) {
        Case<4> made = swing(integrator);
        Region soft;
        soft.name = "soft";
        soft.select = {HalfSpaceSelection{-Eigen::Vector4d::UnitX(), -0.7}};
        soft.material.lame = lame_from_young(4, 0.1, 0.28);
        soft.material.density = 1e-3;
        made.scene.bodies[0].regions = {soft};
        expect_same_on_ranks(made, 2, 1e-7);
    }
}

TEST(SharedSimulation, HasLoadsActivationsAndAttachments) {
    Case<4> made = swing(Integrator::NewtonEuler);
    Scene& scene = made.scene;
    const HalfSpaceSelection right{.normal = Eigen::Vector4d(-1, 0, 0, 0), .offset = -1.4};
    scene.loads = {{.body = "box", .select = {right}, .force = Eigen::Vector4d(0, 0, 3, 0)},
                   {.body = "box", .select = {right}, .pressure = 50}};
    scene.activations = {{.body = "box",
                          .select = {EverythingSelection{}},
                          .stretch = 1.1,
                          .fibers = Fibers::Constant,
                          .direction = Eigen::Vector4d(0, 1, 0, 0),
                          .signal = Signal::Sine}};
    Attachment attachment;
    attachment.body = "box";
    attachment.select = {right};
    attachment.stiffness = 20;
    attachment.damping = 0.1;
    scene.attachments = {attachment};
    expect_same_on_ranks(made, 2, 1e-7);
}

// By labels and fibers of cells that ranks have in part, in a wave that comes to a rank when it has
// left another; sleep asks all which bodies change.
TEST(SharedSimulation, HasActivationsAlongFibersOfTheMesh) {
    for (const ElementKind kind : {ElementKind::Linear, ElementKind::Quadratic}) {
        Case<4> made = swing(Integrator::NewtonEuler, kind);
        SimplexMesh<4>& mesh = made.meshes[0];
        if (kind == ElementKind::Quadratic) {
            mesh = pent::test::quadratic_kuhn_box<4>({3, 1, 1, 1}, {1.5, 0.5, 0.5, 0.5});
        }
        mesh.fibers.resize(4, mesh.cell_count());
        for (Eigen::Index cell = 0; cell < mesh.cell_count(); ++cell) {
            const auto parent = mesh.parents.empty() ? static_cast<std::uint32_t>(cell)
                                                     : mesh.parents[static_cast<std::size_t>(cell)];
            mesh.regions.push_back(static_cast<std::uint16_t>(parent % 3));
            mesh.fibers.col(cell) << 1, 0.1 * (parent % 7), 0.2 * (parent % 5), 0;
        }
        made.scene.sleep = Sleep{.speed = 1e-9, .time = 1};
        made.scene.activations = {
            {.body = "box",
             .select = {RegionSelection{.region = 1}},
             .stretch = 1.1,
             .fibers = Fibers::Mesh,
             .signal = Signal::Pulses,
             .frequency = 3,
             .duty = 0.3,
             .wave = Eigen::Vector4d(0.7, 0, 0, 0)},
            {.body = "box",
             .select = {HalfSpaceSelection{.normal = Eigen::Vector4d(1, 0, 0, 0), .offset = 0.8}},
             .stretch = 0.95}};
        expect_same_on_ranks(made, 2, 1e-7);
    }
}

// Away from cells with a label, in a wave that runs along the body.
TEST(SharedSimulation, HasActivationsAlongFibersByDistances) {
    for (const ElementKind kind : {ElementKind::Linear, ElementKind::Quadratic}) {
        Case<4> made = swing(Integrator::NewtonEuler, kind);
        SimplexMesh<4>& mesh = made.meshes[0];
        mesh = pent::test::quadratic_kuhn_box<4>({3, 1, 1, 1}, {1.5, 0.5, 0.5, 0.5});
        mesh.regions.assign(32, 1);
        mesh.regions.resize(static_cast<std::size_t>(mesh.cell_count()), 0);
        made.scene.activations = {{.body = "box",
                                   .select = {EverythingSelection{}},
                                   .stretch = 0.9,
                                   .fibers = Fibers::Distance,
                                   .away_from = {RegionSelection{.region = 1}},
                                   .signal = Signal::Sine,
                                   .frequency = 3,
                                   .distance_wave = 0.5}};
        expect_same_on_ranks(made, 2, 1e-7);
    }
}

// Vertices of one cube tied to the cells of another, wherever these are; the second one has a
// muscle where its cells are labeled for it, which ranks have in part behind those of the first.
TEST(SharedSimulation, HasAttachmentsOfOneBodyToAnother) {
    SimplexMesh<4> mesh = test::cube<4>();
    for (Eigen::Index cell = 0; cell < mesh.cell_count(); ++cell) {
        mesh.regions.push_back(static_cast<std::uint16_t>(cell / 24 % 3));
    }
    Case<4> made{test::two_cubes<4>(0.1), {mesh, mesh}};
    Scene& scene = made.scene;
    scene.activations = {{.body = scene.bodies[1].name,
                          .select = {RegionSelection{.region = 1}},
                          .stretch = 0.9,
                          .signal = Signal::Sine,
                          .frequency = 3}};
    scene.contact.reset();
    scene.gravity[1] = -9.8;
    scene.solver.precision = Precision::Double;
    scene.solver.tolerance = 1e-10;
    Attachment attachment;
    attachment.body = scene.bodies[1].name;
    attachment.target = scene.bodies[0].name;
    attachment.select = {EverythingSelection{}};
    attachment.stiffness = 20;
    attachment.max_distance = 10;
    scene.attachments = {attachment};
    expect_same_on_ranks(made, 2, 1e-7);
}

// Two materials and a load, by the labels of cells that ranks have in part.
TEST(SharedSimulation, HasRegionsAndWhatLabelsSelect) {
    Case<4> made = swing(Integrator::NewtonEuler);
    for (Eigen::Index cell = 0; cell < made.meshes[0].cell_count(); ++cell) {
        made.meshes[0].regions.push_back(static_cast<std::uint16_t>(cell / 24 % 3));
    }
    Region stiff{.name = "stiff",
                 .select = {RegionSelection{.region = 2}},
                 .material = made.scene.bodies[0].material};
    stiff.material.lame.mu *= 5;
    stiff.material.density *= 2;
    made.scene.bodies[0].regions = {stiff};
    made.scene.loads = {{.body = "box",
                         .select = {RegionSelection{.region = 1}},
                         .force = Eigen::Vector4d(0, 0, 3, 0)}};
    expect_same_on_ranks(made, 2, 1e-7);
}

// Ranks have the cells of their own vertices alone.
TEST(SharedSimulation, HasLoadsWhereRanksHaveTheirOwnCells) {
    Case<4> made = swing(Integrator::NewtonEuler);
    const HalfSpaceSelection right{.normal = Eigen::Vector4d(-1, 0, 0, 0), .offset = -1.4};
    const HalfSpaceSelection upper{.normal = Eigen::Vector4d(0, -1, 0, 0), .offset = -0.49};
    made.scene.loads = {{.body = "box", .select = {right}, .force = Eigen::Vector4d(0, 0, 3, 0)},
                        {.body = "box", .select = {upper}, .pressure = 50}};
    expect_same_on_ranks(made, 2, 1e-7);
}

// What touches is on other ranks than what it touches: the bodies are cut beside one another. A
// single linear solve: at the kinks of penalties Newton's method ends where it comes to first.
TEST(SharedSimulation, HasContactWithFrictionAcrossRanks) {
    Case<4> made{test::two_cubes<4>(0.02), {test::cube<4>(), test::cube<4>()}};
    made.scene.gravity[1] = -9.8;
    // Askew, so that no two facets are as near.
    made.scene.bodies[1].place.translate = Eigen::Vector4d(0.041, 0.52, 0.033, 0.057);
    made.scene.contact->friction = 0.3;
    made.scene.bodies[1].velocity = Eigen::Vector4d(0.4, -0.5, 0, 0);
    made.scene.bodies[0].velocity = Eigen::Vector4d(0, 9.8 / 100, 0, 0);
    made.scene.solver.precision = Precision::Double;
    made.scene.solver.tolerance = 1e-10;
    const State<4> alone = simulate<4>(made, 1, nullptr);
    EXPECT_GT(alone.steps[0].contact.point_facet, 0);
    EXPECT_GT(alone.steps[0].contact.friction, 0);
    expect_same_on_ranks(made, 1, 1e-7);
}

TEST(SharedSimulation, HasABarrierThatNothingCrosses) {
    test::BarrierScene<3> barrier;
    const SimplexMesh<3> cube = test::cube<3>();
    barrier.add(cube, test::vector<3>(0, 0));
    barrier.add(cube, test::vector<3>(0.1, 0.53)).velocity = test::vector<3>(0.3, -2);
    barrier.scene.contact->friction = 0.2;
    barrier.scene.solver.precision = Precision::Double;
    barrier.scene.solver.tolerance = 1e-10;
    barrier.scene.solver.newton_tolerance = 1e-9;
    expect_same_on_ranks<3>({barrier.scene, barrier.meshes}, 3, 1e-5);
}

TEST(SharedSimulation, FallsAsleepAndWakesAlike) {
    Case<3> made{test::two_cubes<3>(0.2), {test::cube<3>(), test::cube<3>()}};
    made.scene.sleep = Sleep{.speed = 1e-3, .time = 0.02};
    made.scene.bodies[1].velocity = Eigen::Vector3d(0, -4, 0);
    made.scene.solver.precision = Precision::Double;
    made.scene.solver.tolerance = 1e-10;
    const State<3> alone = simulate<3>(made, 6, nullptr);
    ASSERT_EQ(alone.steps[3].asleep, 1);
    ASSERT_EQ(alone.steps[5].asleep, 0);
    expect_same_on_ranks(made, 6, 1e-2);  // behind a kink of penalties
}

TEST(SharedSimulation, GoesOnFromASnapshotOfOneAloneAndGivesOneBack) {
    const Case<4> made = swing(Integrator::Bdf2);
    Simulation<4> alone(made.scene, made.meshes);
    static_cast<void>(alone.step());
    static_cast<void>(alone.step());
    const Snapshot<4> middle = alone.save();
    static_cast<void>(alone.step());
    Snapshot<4> shared;
    test::on_ranks(3, [&](const std::shared_ptr<const Ranks>& ranks) {
        Simulation<4> simulation(made.scene, made.meshes, {.ranks = ranks});
        simulation.restore(middle);
        static_cast<void>(simulation.step());
        if (ranks->rank() == 0) {
            shared = simulation.save();
        }
    });
    const double motion = (alone.save().positions - middle.positions).norm();
    EXPECT_LT((shared.positions - alone.save().positions).norm(), 1e-6 * motion);
    EXPECT_EQ(shared.steps, 3U);
}

// 1512 vertices: two levels, and on four ranks half of the vertices have a neighbor on another.
TEST(SharedSimulation, TakesAtMost15PercentMoreIterationsOnMoreRanks) {
    Case<4> made{test::box_scene<4>(),
                 {pent::test::kuhn_box<4>({6, 5, 5, 5}, {0.6, 0.5, 0.5, 0.5})}};
    made.scene.bodies[0].material.lame = lame_from_young(4, 1e7, 0.28);
    made.scene.gravity[1] = -9.8;
    made.scene.constraints = {test::hold(
        HalfSpaceSelection{.normal = Eigen::Vector4d(1, 0, 0, 0), .offset = 1e-6}, test::still(4))};
    made.scene.solver.tolerance = 1e-6;
    const int alone = simulate<4>(made, 1, nullptr).steps[0].iterations;
    for (const int count : {1, 2, 4}) {
        test::on_ranks(count, [&](const std::shared_ptr<const Ranks>& ranks) {
            const int shared = simulate<4>(made, 1, ranks).steps[0].iterations;
            EXPECT_LE(shared, (count == 1 ? 1 : 1.15) * alone);
        });
    }
}

TEST(SharedSimulation, HasTheSameBitsForAnyThreads) {
    const Case<4> made = swing(Integrator::NewtonEuler);
    const auto end = [&](int threads) {
        Positions<4> positions;
        test::on_ranks(3, [&](const std::shared_ptr<const Ranks>& ranks) {
            Simulation<4> simulation(made.scene, made.meshes, {.threads = threads, .ranks = ranks});
            static_cast<void>(simulation.step());
            if (ranks->rank() == 0) {
                positions = simulation.save().positions;
            }
        });
        return positions;
    };
    EXPECT_EQ(end(1), end(3));
}

TEST(SharedSimulation, RefusesADirectSolveAndOtherMeshes) {
    test::on_ranks(2, [&](const std::shared_ptr<const Ranks>& ranks) {
        Case<4> direct = swing(Integrator::LinearEuler);
        direct.scene.solver.linear = LinearSolverKind::Direct;
        pent::test::expect_contains(
            pent::test::error_of(
                [&] { Simulation<4>(direct.scene, direct.meshes, {.ranks = ranks}); }),
            {"solver.linear", "\"cg\"", "pent-sim"});
        Case<4> other = swing(Integrator::LinearEuler);
        if (ranks->rank() == 1) {
            other.meshes[0].positions(0, 0) -= 1e-3;
        }
        pent::test::expect_contains(pent::test::error_of([&] {
                                        Simulation<4>(other.scene, other.meshes, {.ranks = ranks});
                                    }),
                                    {"rank 1 has other meshes than rank 0", "same files"});
    });
}

}  // namespace
}  // namespace pent::simulator
