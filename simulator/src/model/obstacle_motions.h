#pragma once

#include "model/motion_chain.h"

#include <pent/obstacle.h>
#include <pent/simulator/scene.h>

#include <vector>

namespace pent::simulator {

/// Where the obstacles of a scene are, at any time.
template <int Dim>
class ObstacleMotions {
public:
    /// X goes to rotation X + shift.
    struct RigidMap {
        Matrix<Dim> rotation;
        Vector<Dim> shift;
    };

    explicit ObstacleMotions(const Scene& scene);

    /// Whether any has a motion.
    [[nodiscard]] bool is_any() const { return is_any_; }

    /// All of them at a time, s; those without a motion as the scene has them, to the bit.
    [[nodiscard]] std::vector<pent::ObstacleShape<Dim>> at(double time) const;

    /// The rigid map of an obstacle from one time to another: takes where a point that goes with it
    /// is at `from` to where that is at `to`.
    [[nodiscard]] RigidMap carried(std::size_t obstacle, double from, double to) const;

    /// How far a point of an obstacle, which is at `point` at one time, has come at another, m.
    [[nodiscard]] Vector<Dim> displacement(std::size_t obstacle,
                                           const Vector<Dim>& point,
                                           double from,
                                           double to) const;

    /// Whether one is moving from one time to another, turning about itself included.
    [[nodiscard]] bool is_moving(std::size_t obstacle, double from, double to) const;

private:
    struct Moved {
        pent::ObstacleShape<Dim> start;
        std::vector<CenteredMotion<Dim>> motions;
    };
    [[nodiscard]] RigidMap map_at(std::size_t obstacle, double time) const;

    std::vector<Moved> obstacles_;
    bool is_any_ = false;
};

}  // namespace pent::simulator
