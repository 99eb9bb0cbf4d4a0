#include "scenes.h"

#include <pent/simulator/simulation.h>

#include <Eigen/Eigenvalues>
#include <gtest/gtest.h>

#include <cmath>
#include <complex>
#include <numbers>

// The rule of docs/trust.md, "Choosing dt": how much of the amplitude of a swing a time step
// leaves.

namespace pent::simulator {
namespace {

// A cube of which one corner alone is free: three oscillators, of which one is set going.
class Oscillator {
public:
    Oscillator() {
        scene_ = test::box_scene<3>();
        scene_.bodies[0].material.model = Model::Linear;
        scene_.bodies[0].material.lame = lame_from_young(3, 1e3, 0.28);
        scene_.solver.newton_tolerance = 1e-10;
        scene_.solver.tolerance = 1e-12;
        scene_.solver.precision = Precision::Double;
        // All but the corner (1, 1, 1).
        scene_.constraints = {test::hold(
            HalfSpaceSelection{.normal = Eigen::Vector3d::Ones().normalized(), .offset = 1.4},
            test::still(3))};
        Simulation<3> simulation(scene_, {mesh_});
        Eigen::Matrix3d stiffness;
        for (int axis = 0; axis < 3; ++axis) {  // exact, since forces are linear
            set(simulation, Eigen::Vector3d::Unit(axis), Eigen::Vector3d::Zero());
            stiffness.col(axis) = -simulation.forces(0).col(corner_);
        }
        const Eigen::SelfAdjointEigenSolver<Eigen::Matrix3d> modes(stiffness);
        mode_ = modes.eigenvectors().col(0);
        omega_ = std::sqrt(modes.eigenvalues()[0] / simulation.masses(0)[corner_]);
    }

    // The amplitude after the second of two periods over that after the first, in steps of T /
    // count.
    [[nodiscard]] double left_of_a_period(Integrator integrator, int count) {
        scene_.solver.integrator = integrator;
        scene_.frames_per_second = count * omega_ / (2 * std::numbers::pi);
        Simulation<3> simulation(scene_, {mesh_});
        set(simulation, 0.01 * mode_, Eigen::Vector3d::Zero());
        double amplitude[2] = {};
        for (double& now : amplitude) {
            for (int step = 0; step < count; ++step) {
                EXPECT_TRUE(simulation.step().is_accepted);
            }
            const Eigen::Vector3d x =
                simulation.positions(0).col(corner_) - mesh_.positions.col(corner_);
            now = std::hypot(x.norm(), simulation.velocities(0).col(corner_).norm() / omega_);
        }
        return amplitude[1] / amplitude[0];
    }

private:
    void set(Simulation<3>& simulation, const Eigen::Vector3d& x, const Eigen::Vector3d& v) const {
        Positions<3> positions = mesh_.positions;
        Positions<3> velocities = Positions<3>::Zero(3, positions.cols());
        positions.col(corner_) += x;
        velocities.col(corner_) = v;
        simulation.set_state(0, positions, velocities);
    }

    SimplexMesh<3> mesh_ = pent::test::kuhn_box<3>({1, 1, 1}, {1, 1, 1});
    Eigen::Index corner_ = 7;
    Scene scene_;
    Eigen::Vector3d mode_;
    double omega_ = 0;
};

// By the roots of each method for x'' = -omega^2 x, written as y' = i omega y [hairer1996].
double of_theory(Integrator integrator, int count) {
    using Complex = std::complex<double>;
    const double z = 2 * std::numbers::pi / count;
    if (integrator == Integrator::NewtonEuler || integrator == Integrator::LinearEuler) {
        return std::pow(1 + z * z, -0.5 * count);
    }
    const Complex a(3, -2 * z);
    const Complex root = std::sqrt(16.0 - 4.0 * a);
    return std::pow(std::abs((4.0 + root) / (2.0 * a)), count);
}

TEST(TimeStep, LeavesAsMuchOfASwingAsTheRuleSays) {
    Oscillator oscillator;
    for (const Integrator integrator :
         {Integrator::LinearEuler, Integrator::NewtonEuler, Integrator::Bdf2}) {
        for (const int count : {20, 50, 100, 400}) {
            // What BDF2 began with, a step of Euler, has faded after a period but for a thousandth.
            EXPECT_NEAR(oscillator.left_of_a_period(integrator, count),
                        of_theory(integrator, count), 1e-3)
                << static_cast<int>(integrator) << " " << count;
        }
    }
    // The table.
    EXPECT_NEAR(of_theory(Integrator::NewtonEuler, 400), 0.95, 0.005);
    EXPECT_NEAR(of_theory(Integrator::NewtonEuler, 100), 0.82, 0.005);
    EXPECT_NEAR(of_theory(Integrator::NewtonEuler, 20), 0.39, 0.005);
    EXPECT_NEAR(of_theory(Integrator::Bdf2, 50), 0.997, 0.0005);
    EXPECT_NEAR(of_theory(Integrator::Bdf2, 20), 0.96, 0.005);
}

}  // namespace
}  // namespace pent::simulator
