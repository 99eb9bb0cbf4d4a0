#pragma once

#include "barrier_scenes.h"

#include <cmath>

// Scenes that are hard on a barrier, in R^3 and R^4, with cells as fine as asked: edges are cut
// into `fine` times as many pieces as the least that shows what the scene is about.

namespace pent::simulator::test {

/// A bullet at 100 of its lengths a second. Each step is two bodies long: after the first, it would
/// be behind the target.
template <int Dim>
[[nodiscard]] BarrierScene<Dim> fast_impact(int fine) {
    BarrierScene<Dim> scene;
    const Eigen::VectorXd unit = Eigen::VectorXd::Constant(Dim, 0.2);
    scene.scene.frames_per_second = 50;
    scene.add(box<Dim>(fine, fine, fine, unit), vector<Dim>(0, 0));
    scene.add(box<Dim>(fine, fine, fine, unit), vector<Dim>(-0.3, 0.03, 0.02)).velocity =
        vector<Dim>(20, 0);
    return scene;
}

/// Three bars that fall crosswise upon one another.
template <int Dim>
[[nodiscard]] BarrierScene<Dim> stacked_noodles(int fine) {
    BarrierScene<Dim> scene;
    scene.scene.gravity = vector<Dim>(0, -9.8);
    scene.scene.obstacles.push_back(
        {.shape = HalfSpaceObstacle{.normal = vector<Dim>(0, 1), .offset = 0}});
    const SimplexMesh<Dim> bar = box<Dim>(4 * fine, fine, fine, vector<Dim>(0.9, 0.1, 0.1));
    SimplexMesh<Dim> crosswise = bar;
    crosswise.positions.row(0).swap(crosswise.positions.row(2));  // a mirror image: turn it back
    crosswise.positions.row(0) *= -1;
    scene.add(bar, vector<Dim>(0, 0.08));
    scene.add(crosswise, vector<Dim>(0.02, 0.2, 0.01));
    scene.add(bar, vector<Dim>(0.01, 0.32, 0.03));
    return scene;
}

/// A needle, body 2, pushed at a gap narrower than itself: 0.1 wide, the soft needle 0.16, its tip
/// 0.05.
template <int Dim>
[[nodiscard]] BarrierScene<Dim> needle_at_gap(int fine) {
    BarrierScene<Dim> scene;
    const Eigen::VectorXd block = vector<Dim>(0.3, 0.3, 0.4);
    const Eigen::VectorXd everywhere = vector<Dim>(9, 9, 9);
    for (const double x : {-0.2, 0.2}) {
        scene.add(box<Dim>(fine, fine, fine, block), vector<Dim>(x, 0), 1e7);
        scene.hold(-everywhere, everywhere, vector<Dim>(0, 0));
    }
    SimplexMesh<Dim> needle = box<Dim>(fine, 4 * fine, fine, vector<Dim>(0.16, 0.6, 0.16));
    for (Eigen::Index v = 0; v < needle.vertex_count(); ++v) {
        needle.positions(0, v) *= needle.positions(1, v) < -0.2 ? 0.3 : 1;
    }
    scene.add(needle, vector<Dim>(0, 0.48), 2e4);
    scene.hold(vector<Dim>(-9, 0.77, -9), everywhere, vector<Dim>(0, -1.5));
    return scene;
}

/// Two hooks, one in the other, pulled apart.
template <int Dim>
[[nodiscard]] BarrierScene<Dim> interlocked_hooks(int fine) {
    BarrierScene<Dim> scene;
    SimplexMesh<Dim> hook = box<Dim>(3 * fine, 3 * fine, fine, vector<Dim>(0.3, 0.3, 0.1));
    for (Eigen::Index v = 0; v < hook.vertex_count(); ++v) {
        hook.positions(1, v) *= std::abs(hook.positions(1, v)) < 0.1 ? 1.4 : 1;  // a wider mouth
    }
    hook = without<Dim>(hook, {-0.05, -0.07}, {0.16, 0.07});
    SimplexMesh<Dim> other = hook;
    other.positions.row(0) *= -1;  // opens to the other side: turned over, not mirrored
    other.positions.row(1) *= -1;
    const Eigen::VectorXd everywhere = vector<Dim>(9, 9, 9);
    scene.add(hook, vector<Dim>(0, 0));
    scene.hold(-everywhere, vector<Dim>(-0.09, 9, 9), vector<Dim>(0, 0));
    scene.add(other, vector<Dim>(0.11, 0.11, 0.005));
    scene.hold(vector<Dim>(0.2, -9, -9), everywhere, vector<Dim>(0, 1), 0.15);
    return scene;
}

/// A body that falls on another a million times as soft.
template <int Dim>
[[nodiscard]] BarrierScene<Dim> million_to_one(int fine) {
    BarrierScene<Dim> scene;
    scene.scene.gravity = vector<Dim>(0, -9.8);
    scene.scene.solver.precision = Precision::Double;
    scene.scene.obstacles.push_back(
        {.shape = HalfSpaceObstacle{.normal = vector<Dim>(0, 1), .offset = 0}});
    const Eigen::VectorXd unit = Eigen::VectorXd::Constant(Dim, 0.2);
    scene.add(box<Dim>(fine, fine, fine, unit), vector<Dim>(0, 0.115), 1e4);
    scene.add(box<Dim>(fine, fine, fine, unit), vector<Dim>(0.03, 0.34, 0.02), 1e10);
    return scene;
}

/// Two sheets of one layer, one thrown at the other, on a ball.
template <int Dim>
[[nodiscard]] BarrierScene<Dim> thin_sheets(int fine) {
    BarrierScene<Dim> scene;
    scene.scene.gravity = vector<Dim>(0, -9.8);
    scene.scene.obstacles.push_back(
        {.shape = BallObstacle{.center = vector<Dim>(0, -0.3), .radius = 0.25}});
    const Eigen::VectorXd size = vector<Dim>(0.6, 0.01, 0.6);
    const int cells = (Dim == 3 ? 4 : 2) * fine;
    scene.add(box<Dim>(cells, 1, cells, size), vector<Dim>(0, 0));
    scene.add(box<Dim>(cells, 1, cells, size), vector<Dim>(0.02, 0.05, 0.01)).velocity =
        vector<Dim>(0, -3);
    return scene;
}

}  // namespace pent::simulator::test
