#pragma once

#include <pent/obstacle.h>
#include <pent/simulator/scene.h>

namespace pent::simulator {

/// An obstacle of a scene as an obstacle of fixed dimension. Its vectors have Dim numbers; not
/// checked.
template <int Dim>
[[nodiscard]] pent::Obstacle<Dim> to_obstacle(const ObstacleShape& shape) {
    struct Convert {
        pent::Obstacle<Dim> operator()(const HalfSpaceObstacle& plane) const {
            return HalfSpace<Dim>{plane.normal, plane.offset};
        }
        pent::Obstacle<Dim> operator()(const BallObstacle& ball) const {
            return Ball<Dim>{ball.center, ball.radius};
        }
        pent::Obstacle<Dim> operator()(const CavityObstacle& cavity) const {
            return Cavity<Dim>{cavity.center, cavity.radius};
        }
        pent::Obstacle<Dim> operator()(const BowlObstacle& bowl) const {
            return Bowl<Dim>{bowl.center, bowl.radius, bowl.up};
        }
    };
    return std::visit(Convert{}, shape);
}

}  // namespace pent::simulator
