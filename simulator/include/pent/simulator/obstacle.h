#pragma once

#include <pent/obstacle.h>
#include <pent/simulator/motion.h>

#include <Eigen/Core>

#include <limits>
#include <vector>

namespace pent::simulator {

/// Shapes of obstacles, with vectors of the scene's dimension: <pent/obstacle.h>.
using HalfSpaceObstacle = pent::HalfSpace<Eigen::Dynamic>;
using BallObstacle = pent::Ball<Eigen::Dynamic>;
using CavityObstacle = pent::Cavity<Eigen::Dynamic>;
using BowlObstacle = pent::Bowl<Eigen::Dynamic>;
using BoxObstacle = pent::Cuboid<Eigen::Dynamic>;
using ObstacleShape = pent::ObstacleShape<Eigen::Dynamic>;

/// Something no body may enter; it moves as it is told, or not at all.
///
/// Every free vertex nearer than `distance` to it, or inside it, has the energy
/// stiffness (distance - d)^2, d being the signed distance: a force that grows linearly with depth.
struct Obstacle {
    ObstacleShape shape;
    double distance = 0.02;   ///< m, > 0.
    double stiffness = 1000;  ///< N/m for each vertex, > 0.
    /// How it stands at the start, in the order given: about its center, a half-space about its
    /// point next to the origin.
    std::vector<Turn> rotate = {};
    /// One after the other, as of a Constraint; each turns it about the same point unless it says
    /// otherwise.
    std::vector<Motion> motion = {};
    /// Coulomb's coefficient, >= 0, as of a Body; infinite: that of ContactSettings.
    double friction = std::numeric_limits<double>::infinity();
};

}  // namespace pent::simulator
