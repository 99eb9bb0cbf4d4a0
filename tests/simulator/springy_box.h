#pragma once

#include "elastic_box.h"
#include "linear/linear_solver.h"

#include <array>
#include <memory>

namespace pent::simulator::test {

inline constexpr int kBoxDim = 4;

// The system of a step of a scrambled box: its stiffness, masses, and a spring between two far
// corners, which share no cell.
struct SpringyBox {
    ElasticBox<kBoxDim> box{{.lame = {.lambda = 2, .mu = 1}}, {3, 7}};
    Workers workers{2};
    Eigen::VectorXd masses;
    Positions<kBoxDim> displacement;
    BlockVector<kBoxDim> b;
    std::array<std::uint32_t, 2> ends{};
    std::array<double, 2> weights = {1, -1};
    Eigen::Matrix4d spring = 3 * Eigen::Matrix4d::Identity();
    NewtonSystem<kBoxDim> system;

    explicit SpringyBox(Precision precision, double mass = 0.01)
        : system(workers, box.dofs, box.pattern, precision) {
        box.scramble(0.1, 1);
        std::mt19937 random(2);
        std::normal_distribution<double> normal;
        const Eigen::Index total = box.mesh.vertex_count();
        masses.setConstant(total, mass);
        displacement = Positions<kBoxDim>::Zero(kBoxDim, total);
        displacement.col(3).setConstant(0.1);
        b = BlockVector<kBoxDim>::NullaryExpr(kBoxDim, box.pattern.rows(),
                                              [&] { return normal(random); });
        ends = {0, static_cast<std::uint32_t>(total - 1)};
        system.begin(b, displacement);
        std::visit(
            [&](auto& matrix) {
                auto target = target_in(matrix, 1, Filter::Clamp);
                target.prescribed_displacement = displacement.data();
                target.right = system.right().data();
                box.elements->add_hessian(workers, kernels<kBoxDim>(best_isa()), box.positions,
                                          target);
            },
            system.matrix());
        system.add_masses(2, masses);
        system.add_stencil({.vertices = ends.data(),
                            .weights = weights.data(),
                            .numbers = spring.data(),
                            .count = 2,
                            .stride = kBoxDim});
        system.weigh_masses();
        system.finish();
    }

    [[nodiscard]] Eigen::MatrixXd dense() const {
        return std::visit(
            [](const auto& matrix) {
                return Eigen::MatrixXd(ElasticBox<kBoxDim>::dense(matrix)
                                       + ElasticBox<kBoxDim>::dense(*matrix.coupling()));
            },
            system.matrix());
    }

    [[nodiscard]] std::unique_ptr<LinearSolver<kBoxDim>> iterative(PreconditionerKind kind) const {
        return make_iterative_solver<kBoxDim>(
            workers, kernels<kBoxDim>(best_isa()).blocks, kind,
            {.column_start = box.dofs.column_start(),
             .rest = at_dofs<kBoxDim>(box.dofs, box.mesh.positions)});
    }
    [[nodiscard]] std::unique_ptr<LinearSolver<kBoxDim>> direct() const {
        return make_direct_solver<kBoxDim>(kernels<kBoxDim>(best_isa()).blocks,
                                           at_dofs<kBoxDim>(box.dofs, box.mesh.positions));
    }
    [[nodiscard]] LinearSolution<kBoxDim> solve(LinearSolver<kBoxDim>& solver,
                                                double tolerance) const {
        return solver.solve(system, at_dofs<kBoxDim>(box.dofs, box.positions),
                            {.tolerance = tolerance},
                            BlockVector<kBoxDim>::Zero(kBoxDim, box.pattern.rows()));
    }
};

}  // namespace pent::simulator::test
