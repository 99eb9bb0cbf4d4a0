// Iterations of the linear solver on the beam of the benchmarks. They are counted, not timed: the
// same on every machine but for rounding.

#include "linear/conjugate_gradients.h"
#include "linear/preconditioner.h"
#include "potentials/elements.h"
#include "scenes.h"

#include <pent/simulator/simulation.h>

#include <gtest/gtest.h>

namespace pent::simulator {
namespace {

// 50 x 6 x 6 x 6 cells of 0.1 m, layers along w thinner by `aspect`: 259,200 pentachora.
SimplexMesh<4> beam(double aspect) {
    SimplexMesh<4> mesh = pent::test::kuhn_box<4>({50, 6, 6, 6}, {5, 0.6, 0.6, 0.6 * aspect});
    constexpr std::uint32_t kBase = 51 * 7 * 7;
    for (std::uint32_t v = 0; v < mesh.vertex_count(); ++v) {
        mesh.columns.push_back(v % kBase);
        mesh.layers.push_back(v / kBase);
    }
    return mesh;
}

// The linear step (M + h^2 K) dx = h^2 f + h M v of a state, solved to 1e-3 from dx = 0.
int cold_iterations(const Scene& scene, const Simulation<4>& simulation) {
    const SimplexMesh<4>& mesh = simulation.mesh(0);
    std::vector<bool> is_held;
    for (Eigen::Index v = 0; v < mesh.vertex_count(); ++v) {
        is_held.push_back(mesh.positions(0, v) < 1e-6);
    }
    const DofMap dofs = number_dofs<4>(mesh.cells, is_held, {mesh.columns, mesh.layers});
    const BlockPattern pattern = make_pattern<4>(mesh.cells, dofs);
    const std::vector<CellRange> ranges = {{0, mesh.cell_count(), scene.bodies[0].material}};
    const Elements<4> elements(mesh.positions, mesh.cells, ranges, dofs, pattern);
    const Workers workers(2);
    const Kernels<4>& isa = kernels<4>(best_isa());
    const double h = scene.dt();
    BlockMatrix<4, float> A(pattern);
    BlockVector<4> b = BlockVector<4>::Zero(4, pattern.rows());
    elements.add_hessian(workers, isa, simulation.positions(0), target_in(A, h * h, Filter::Clamp));
    BlockVector<4> positions(4, pattern.rows());
    for (std::int64_t row = 0; row < pattern.rows(); ++row) {
        const std::uint32_t vertex = dofs.vertex_of(static_cast<std::uint32_t>(row));
        const double mass = simulation.masses(0)[vertex];
        A.add_to_diagonal(row, static_cast<float>(mass));
        positions.col(row) = simulation.positions(0).col(vertex);
        b.col(row) = h * h * simulation.forces(0).col(vertex)
                     + h * mass * simulation.velocities(0).col(vertex);
    }
    const Hierarchy hierarchy(
        make_hierarchy<4>(pattern, dofs.column_start(), at_dofs<4>(dofs, mesh.positions)), pattern);
    const auto preconditioner =
        multilevel(workers, isa.blocks, A, hierarchy, positions,
                   column_jacobi(workers, isa.blocks, A, dofs.column_start()));
    const LinearSolveReport report =
        ConjugateGradients<4>(workers, isa.blocks)
            .solve(A, *preconditioner, b, {.tolerance = 1e-3},
                   BlockVector<4>(BlockVector<4>::Zero(4, pattern.rows())))
            .report;
    EXPECT_TRUE(report.has_converged);
    return report.iterations;
}

struct BeamCase {
    double poisson;
    double aspect;
    int most;
};

class BeamSolve : public testing::TestWithParam<BeamCase> {};
// 1e7 Pa and 1000 kg/m^4 carry sound over 33 cells in a step.
INSTANTIATE_TEST_SUITE_P(LayerAspects,
                         BeamSolve,
                         testing::Values(BeamCase{0.28, 1, 30},
                                         BeamCase{0.28, 0.2, 30},
                                         BeamCase{0.28, 0.1, 40},
                                         BeamCase{0.32, 1, 50}));

TEST_P(BeamSolve, TakesFewIterationsWhateverTheThicknessOfLayers) {
    constexpr int kFrame = 8;
    Scene scene = test::box_scene<4>();
    scene.bodies[0].material.lame = lame_from_young(4, 1e7, GetParam().poisson);
    scene.gravity[1] = -9.8;
    scene.constraints = {test::hold(
        HalfSpaceSelection{.normal = Eigen::Vector4d(1, 0, 0, 0), .offset = 1e-6}, test::still(4))};
    scene.solver.tolerance = 1e-3;
    Simulation<4> simulation(scene, {beam(GetParam().aspect)}, {.threads = 2});
    for (int step = 0; step < kFrame; ++step) {
        ASSERT_TRUE(simulation.step().is_accepted);
    }
    EXPECT_LE(cold_iterations(scene, simulation), GetParam().most);
}

}  // namespace
}  // namespace pent::simulator
