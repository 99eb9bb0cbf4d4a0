#include "model/obstacle_motions.h"

#include <type_traits>
#include <variant>

namespace pent::simulator {

namespace {

// What a motion turns an obstacle about that does not say it: its center, or of a half-space the
// point next to the origin.
template <int Dim>
Vector<Dim> middle_of(const pent::Obstacle<Dim>& obstacle) {
    if (const auto* half_space = std::get_if<HalfSpace<Dim>>(&obstacle)) {
        return half_space->offset * half_space->normal;
    }
    Vector<Dim> middle = Vector<Dim>::Zero();
    std::visit(
        [&](const auto& shape) {
            shape.fields(shape, [&](const char* /*name*/, const auto& value, ShapeField kind) {
                if constexpr (!std::is_arithmetic_v<std::remove_cvref_t<decltype(value)>>) {
                    if (kind == ShapeField::Point) {
                        middle = value;
                    }
                }
            });
        },
        obstacle);
    return middle;
}

}  // namespace

template <int Dim>
ObstacleMotions<Dim>::ObstacleMotions(const Scene& scene) {
    for (const auto& obstacle : scene.obstacles) {
        const pent::Obstacle<Dim> start = fixed_size<Dim>(obstacle.shape);
        obstacles_.push_back({start, center<Dim>(obstacle.motion, middle_of<Dim>(start))});
        is_any_ = is_any_ || !obstacle.motion.empty();
    }
}

template <int Dim>
typename ObstacleMotions<Dim>::Placement ObstacleMotions<Dim>::placement(std::size_t obstacle,
                                                                         double time) const {
    const MotionChain<Dim> chain(obstacles_[obstacle].motions, time);
    Placement placement{Matrix<Dim>::Identity(), Vector<Dim>::Zero()};
    chain.move(placement.shift, nullptr);
    for (int axis = 0; axis < Dim; ++axis) {
        Vector<Dim> end = Vector<Dim>::Unit(axis);
        chain.move(end, nullptr);
        placement.rotation.col(axis) = end - placement.shift;
    }
    return placement;
}

template <int Dim>
std::vector<pent::Obstacle<Dim>> ObstacleMotions<Dim>::at(double time) const {
    std::vector<pent::Obstacle<Dim>> all;
    for (std::size_t i = 0; i < obstacles_.size(); ++i) {
        pent::Obstacle<Dim>& now = all.emplace_back(obstacles_[i].start);
        if (obstacles_[i].motions.empty()) {
            continue;
        }
        const Placement placed = placement(i, time);
        std::visit(
            [&](auto& shape) {
                shape.fields(shape, [&](const char* /*name*/, auto& value, ShapeField kind) {
                    if constexpr (!std::is_arithmetic_v<std::remove_cvref_t<decltype(value)>>) {
                        if (kind == ShapeField::Point) {
                            value = (placed.rotation * value + placed.shift).eval();
                        } else if (kind != ShapeField::Length) {  // a direction
                            value = (placed.rotation * value).normalized().eval();
                        }
                    }
                });
            },
            now);
        if (auto* half_space = std::get_if<HalfSpace<Dim>>(&now)) {
            half_space->offset += half_space->normal.dot(placed.shift);
        }
    }
    return all;
}

template <int Dim>
typename ObstacleMotions<Dim>::Placement ObstacleMotions<Dim>::carried(std::size_t obstacle,
                                                                       double from,
                                                                       double to) const {
    const Placement before = placement(obstacle, from);
    const Placement now = placement(obstacle, to);
    const Matrix<Dim> rotation = now.rotation * before.rotation.transpose();
    return {rotation, now.shift - rotation * before.shift};
}

template <int Dim>
Vector<Dim> ObstacleMotions<Dim>::travel(std::size_t obstacle,
                                         const Vector<Dim>& point,
                                         double from,
                                         double to) const {
    const Placement before = carried(obstacle, to, from);
    return point - (before.rotation * point + before.shift);
}

template <int Dim>
bool ObstacleMotions<Dim>::is_moving(std::size_t obstacle, double from, double to) const {
    const Placement before = placement(obstacle, from);
    const Placement now = placement(obstacle, to);
    return before.rotation != now.rotation || before.shift != now.shift;
}

template class ObstacleMotions<3>;
template class ObstacleMotions<4>;

}  // namespace pent::simulator
