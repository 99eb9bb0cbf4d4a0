#pragma once

#include "contact_scenes.h"
#include "elastic_box.h"
#include "model/body_dofs.h"
#include "model/rotation.h"
#include "potentials/potential.h"

#include <gtest/gtest.h>

#include <cmath>

namespace pent::simulator::test {

using Dimensions = testing::Types<std::integral_constant<int, 3>, std::integral_constant<int, 4>>;

// A cube of so many quadratic cubes an edge.
template <int Dim>
SimplexMesh<Dim> quadratic_cube(int count = 1, double size = 1) {
    std::array<int, Dim> counts{};
    std::array<double, Dim> sizes{};
    counts.fill(count);
    sizes.fill(size);
    return pent::test::quadratic_kuhn_box<Dim>(counts, sizes);
}

// A cube of so many cells an edge, for quadratic elements if the scene wants that.
template <int Dim>
SimplexMesh<Dim> cube_for(const Scene& scene, int cells) {
    if (scene.solver.elements != ElementKind::Quadratic) {
        return cube<Dim>(cells);
    }
    return quadratic_cube<Dim>((cells + 1) / 2, 0.5);
}

// What terms stand on.
template <int Dim>
struct Setting {
    Scene scene;
    Workers workers{2};
    const Kernels<Dim>& isa = kernels<Dim>(best_isa());
    Bodies<Dim> bodies;
    HeldVertices<Dim> held;
    DofMap dofs;

    Setting(const Scene& of, int cells)
        : scene(of),
          bodies(make_bodies<Dim>(
              scene,
              std::vector<SimplexMesh<Dim>>(scene.bodies.size(), cube_for<Dim>(scene, cells)))),
          held(scene, bodies),
          dofs(number_dofs(bodies, held, std::vector<bool>(bodies.count(), true))) {}
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
                           const Positions<Dim>& x,
                           Filter filter = Filter::None) {
    constexpr double kWeight = 3;
    NewtonSystem<Dim> system(setting.workers, setting.dofs, pattern, Precision::Double);
    system.begin(BlockVector<Dim>::Zero(Dim, setting.dofs.count()),
                 Positions<Dim>::Zero(Dim, x.cols()));
    static_cast<void>(value_of<Dim>(term, x));
    term.add_hessian(x, kWeight, filter, system);
    system.finish();
    const auto& matrix = std::get<BlockMatrix<Dim, double>>(system.matrix());
    Eigen::MatrixXd sum = ElasticBox<Dim>::dense(matrix);
    if (matrix.coupling() != nullptr) {
        sum += ElasticBox<Dim>::dense(*matrix.coupling());
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
    expect_derivatives<Dim>(setting, make_pattern<Dim>(setting.bodies.cells(), setting.dofs), term,
                            x, step);
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

}  // namespace pent::simulator::test
