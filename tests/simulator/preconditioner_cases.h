#pragma once

#include "elastic_box.h"
#include "linear/preconditioner.h"
#include "model/rotation.h"
#include "scenes.h"

#include <pent/simulator/simulation.h>

#include <gtest/gtest.h>

#include <random>

namespace pent::simulator::test {

// A matrix, and something to solve for.
struct ScrambledBox {
    ElasticBox<4> box{{.lame = {.lambda = 2, .mu = 1}}};
    BlockMatrix<4, double> A{box.pattern};
    Workers workers{1};
    BlockVector<4> r;

    ScrambledBox() {
        box.scramble(0.05, 1);
        box.elements->add_hessian(workers, kernels<4>(Isa::Baseline), box.positions,
                                  target_in(A, 1, Filter::Clamp));
        for (std::int64_t row = 0; row < A.rows(); ++row) {
            A.add_to_diagonal(row, 0.1);
        }
        std::mt19937 random(2);
        std::normal_distribution<double> normal;
        r = BlockVector<4>::NullaryExpr(4, A.rows(), [&]() { return normal(random); });
    }
};

struct Bar {
    double thickness = 0.4;  // m, of four layers along w; cells are 0.1 m long
    double young = 1e7;
    bool has_columns = true;
    double unrest = 0;  // how far vertices stray, m
};

// One linear step of a bar that is held at one end.
inline int iterations(PreconditionerKind kind, const Bar& bar) {
    Scene scene = box_scene<4>();
    scene.bodies[0].material.lame = lame_from_young(4, bar.young, 0.28);
    scene.gravity[1] = -9.8;
    scene.constraints = {
        hold(HalfSpaceSelection{.normal = Eigen::Vector4d(1, 0, 0, 0), .offset = bar.unrest + 1e-6},
             still(4))};
    scene.solver.preconditioner = kind;
    scene.solver.tolerance = 1e-3;
    SimplexMesh<4> mesh = pent::test::kuhn_box<4>({16, 4, 4, 4}, {1.6, 0.4, 0.4, bar.thickness});
    std::mt19937 random(1);
    std::uniform_real_distribution<double> stray(-bar.unrest, bar.unrest);
    mesh.positions = mesh.positions.unaryExpr([&](double x) { return x + stray(random); }).eval();
    const std::uint32_t base = 17 * 5 * 5;
    for (std::uint32_t v = 0; bar.has_columns && v < mesh.vertex_count(); ++v) {
        mesh.columns.push_back(v % base);
        mesh.layers.push_back(v / base);
    }
    Simulation<4> simulation(scene, {mesh});
    const StepReport report = simulation.step();
    EXPECT_TRUE(report.is_accepted);
    return report.iterations;
}

}  // namespace pent::simulator::test
