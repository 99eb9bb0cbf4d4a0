#include "beams.h"
#include "cases.h"
#include "dense_oracle.h"
#include "linear/aggregate_matrix.h"
#include "step_work.h"

#include <pent/formatted.h>
#include <pent/simulator/simulation.h>
#include <pent/stopwatch.h>

#include <bit>

namespace pent::simulator::bench {

namespace {

// A scene at the start of one of its steps, which is taken again and again.
template <int Dim>
class Replay {
public:
    Replay(const Scene& scene, const SimplexMesh<Dim>& mesh, int threads, int warm_up)
        : simulation_(scene, {mesh}, {.threads = threads, .isa = ""}) {
        for (int i = 0; i < warm_up; ++i) {
            report_ = simulation_.step();
        }
        start_ = simulation_.save();
    }

    double step() {
        simulation_.restore(start_);
        report_ = simulation_.step();
        return report_.is_accepted ? report_.seconds : 0;
    }

    [[nodiscard]] const StepReport& report() const { return report_; }
    [[nodiscard]] SimulationSize size() const { return simulation_.size(); }

    // FNV-1a over the bits of all coordinates: a faster wrong answer has another one.
    [[nodiscard]] std::uint32_t hash() const {
        std::uint32_t hash = 2166136261U;
        for (const double x : simulation_.positions(0).reshaped()) {
            const auto bits = std::bit_cast<std::uint64_t>(x);
            for (int byte = 0; byte < 8; ++byte) {
                hash = (hash ^ static_cast<std::uint32_t>(bits >> (8 * byte) & 0xff)) * 16777619U;
            }
        }
        return hash;
    }

    [[nodiscard]] std::string note() const {
        return formatted("%d iterations, %d Newton, assembly %.1f ms, solve %.1f ms, %.0f MB, %08x",
                         report_.iterations, report_.newton_iterations,
                         1e3 * report_.assembly_seconds, 1e3 * report_.solve_seconds,
                         1e-6 * static_cast<double>(simulation_.size().bytes), hash());
    }

private:
    Simulation<Dim> simulation_;
    Snapshot<Dim> start_;
    StepReport report_;
};

constexpr int kFrame = 8;

// Of the finest aggregates.
double aggregate_blocks(const SimplexMesh<4>& mesh) {
    const std::vector<bool> is_held(static_cast<std::size_t>(mesh.vertex_count()), false);
    const DofMap dofs = number_dofs<4>(mesh.cells, is_held, {mesh.columns, mesh.layers});
    const BlockPattern pattern = make_pattern<4>(mesh.cells, dofs);
    const auto levels =
        make_hierarchy<4>(pattern, dofs.column_start(), at_dofs<4>(dofs, mesh.positions));
    return static_cast<double>(make_aggregate_pattern(levels[0], pattern, nullptr).columns.size());
}

Case beam_case(const std::string& name, const Scene& scene, double thickness, int threads) {
    const SimplexMesh<4> mesh = beam(thickness);
    const auto replay = std::make_shared<Replay<4>>(scene, mesh, threads, kFrame);
    const StepWork work{replay->size(), count_flops(ElementKind::Linear), aggregate_blocks(mesh)};
    Case c{.name = name, .threads = threads};
    c.run = [replay] { return replay->step(); };
    c.bound = [replay, work](const Ceilings& ceilings) {
        const StepReport& report = replay->report();
        return work.least_step_seconds(ceilings, 1 + report.newton_iterations, report.iterations);
    };
    c.note = [replay] { return replay->note(); };
    return c;
}

// 23,040 tetrahedra, where the yardstick has 22,706: no gravity can stretch it, so a step is
// assembly, set-up and the few iterations that find a translation.
Case fall_case() {
    Scene scene = beam_scene();
    scene.dimension = 3;
    scene.gravity = Eigen::Vector3d(0, -9.8, 0);
    scene.bodies[0].place.translate = Eigen::Vector3d::Zero();
    scene.bodies[0].material.lame = lame_from_young(3, 1e7, 0.28);
    scene.constraints.clear();
    scene.solver.tolerance = 1e-4;
    const SimplexMesh<3> mesh = pent::test::kuhn_box<3>({15, 16, 16}, {1.5, 1.6, 1.6});
    const auto replay = std::make_shared<Replay<3>>(scene, mesh, 1, 1);
    Case c{.name = "3D: 23,040 tetrahedra in free fall, to 1e-4"};
    c.run = [replay] { return replay->step(); };
    c.note = [replay] { return replay->note(); };
    return c;
}

// A step from rest beside the plain way, on a beam small enough for that.
Case small_beam_case() {
    const SimplexMesh<4> mesh = box({12, 3, 3, 3});
    Scene scene = beam_scene();
    scene.solver.tolerance = 1e-6;
    const auto replay = std::make_shared<Replay<4>>(scene, mesh, 1, 0);
    Case c{.name = "step of a beam of 7,776 pentachora from rest, to 1e-6"};
    c.run = [replay] { return replay->step(); };
    c.oracle = [scene, mesh] {
        const Stopwatch watch;
        static_cast<void>(oracle_step(mesh, scene.bodies[0].material, scene.gravity, scene.dt()));
        return watch.seconds();
    };
    c.note = [replay] { return replay->note(); };
    return c;
}

// The beam once more, on the same vertices and columns, of cells that have parents.
Case elements_case(const std::string& name, ElementKind kind) {
    SimplexMesh<4> mesh = beam();
    mesh.parents = pent::test::quadratic_kuhn_box<4>({25, 3, 3, 3}, {5, 0.6, 0.6, 0.6}).parents;
    Scene scene = beam_scene();
    scene.solver.elements = kind;
    const auto replay = std::make_shared<Replay<4>>(scene, mesh, 1, kFrame);
    Case c{.name = "beam, linear_euler, " + name + " elements"};
    c.run = [replay] { return replay->step(); };
    c.note = [replay] { return replay->note(); };
    return c;
}

}  // namespace

std::vector<Case> step_cases(int threads) {
    Scene newton = beam_scene();
    newton.solver.integrator = Integrator::NewtonEuler;
    return {beam_case("beam, linear_euler", beam_scene(), 0.1, 1),
            beam_case("beam, linear_euler", beam_scene(), 0.1, threads),
            beam_case("beam, linear_euler, layers of a tenth", beam_scene(), 0.01, threads),
            beam_case("beam, linear_euler, nu = 0.32", beam_scene(0.32), 0.1, threads),
            beam_case("beam, newton_euler to 1e-4", newton, 0.1, threads),
            elements_case("smoothed", ElementKind::Smoothed),
            elements_case("quadratic", ElementKind::Quadratic),
            fall_case(),
            small_beam_case()};
}

}  // namespace pent::simulator::bench
