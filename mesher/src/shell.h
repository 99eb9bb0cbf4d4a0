#pragma once

#include <pent/mesher/surface.h>

#include <Eigen/Geometry>

#include <memory>

namespace pent::mesher {

/// A component of a surface, which is asked what is inside of it.
class Shell {
public:
    /// @param surface  Closed and manifold, without self-intersections; either way around.
    explicit Shell(Surface surface);
    ~Shell();
    Shell(Shell&& other) noexcept;
    Shell(const Shell&) = delete;
    Shell& operator=(Shell&&) = delete;
    Shell& operator=(const Shell&) = delete;

    [[nodiscard]] double volume() const { return volume_; }  ///< Negative if it is inside out.
    [[nodiscard]] const Eigen::AlignedBox3d& box() const { return box_; }

    /// Whether a point that is not on it is inside. Exact; the first one costs as much as some
    /// dozens of the others.
    [[nodiscard]] bool is_around(const Eigen::Vector3d& point);

private:
    struct Tree;

    Surface surface_;
    double volume_;
    Eigen::AlignedBox3d box_;
    std::unique_ptr<Tree> tree_;  // of its triangles; none before the first question
};

}  // namespace pent::mesher
