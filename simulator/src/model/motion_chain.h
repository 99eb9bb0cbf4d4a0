#pragma once

#include "model/rotation.h"

#include <pent/simulator/scene.h>

#include <vector>

namespace pent::simulator {

/// A motion and what it turns about, m.
template <int Dim>
struct CenteredMotion {
    Motion motion;
    Vector<Dim> about;
};

/// Finds what each motion turns about: what it says, or the point to which those before it have
/// taken `middle`.
template <int Dim>
[[nodiscard]] std::vector<CenteredMotion<Dim>> center(const std::vector<Motion>& motions,
                                                      const Vector<Dim>& middle);

/// Where motions, applied one after the other, have taken points by one moment.
template <int Dim>
class MotionChain {
public:
    /// @param time  s.
    MotionChain(const std::vector<CenteredMotion<Dim>>& motions, double time);

    /// Moves a point from where it is at t = 0, m; sets its velocity, too, unless that is null,
    /// m/s. A motion at rest keeps the point to the bit.
    void move(Vector<Dim>& point, Vector<Dim>* velocity) const;

    /// The rotation by all of them together.
    [[nodiscard]] Matrix<Dim> rotation() const;

private:
    struct Link {
        Pose<Dim> pose;
        Vector<Dim> about;
    };
    std::vector<Link> links_;
};

}  // namespace pent::simulator
