#include "model/obstacle_motions.h"

#include "model/rotation.h"

#include <pent/dimensions.h>

#include <utility>
#include <variant>

namespace pent::simulator {

namespace {

template <int Dim>
using Placed = typename ObstacleMotions<Dim>::RigidMap;

// Keeps the point among the fields of a shape.
template <int Dim>
struct MiddleFinder {
    Vector<Dim>& middle;
    void operator()(const char* /*name*/, const Vector<Dim>& value, ShapeField kind) const {
        if (kind == ShapeField::Point) {
            middle = value;
        }
    }
    void operator()(const char* /*name*/, const auto& /*value*/, ShapeField /*kind*/) const {}
};

// Moves the fields of a shape.
template <int Dim>
struct FieldMover {
    const Placed<Dim>& map;
    void operator()(const char* /*name*/, Vector<Dim>& value, ShapeField kind) const {
        if (kind == ShapeField::Point) {
            value = (map.rotation * value + map.shift).eval();
        } else if (kind != ShapeField::Length) {  // a direction
            value = (map.rotation * value).normalized().eval();
        }
    }
    void operator()(const char* /*name*/, Matrix<Dim>& axes, ShapeField /*kind*/) const {
        axes = (map.rotation * axes).eval();
        for (int axis = 0; axis < Dim; ++axis) {  // right angles, to the last bit
            for (int before = 0; before < axis; ++before) {
                axes.col(axis) -= axes.col(before).dot(axes.col(axis)) * axes.col(before);
            }
            axes.col(axis).normalize();
        }
    }
    void operator()(const char* /*name*/, double& /*value*/, ShapeField /*kind*/) const {}
};

// What a motion that does not say it turns an obstacle about: its center, or of a half-space the
// point of its boundary that is nearest to the origin.
template <int Dim>
Vector<Dim> middle_of(const pent::ObstacleShape<Dim>& obstacle) {
    if (const auto* half_space = std::get_if<HalfSpace<Dim>>(&obstacle)) {
        return half_space->offset * half_space->normal;
    }
    Vector<Dim> middle = Vector<Dim>::Zero();
    std::visit([&](const auto& shape) { shape.fields(shape, MiddleFinder<Dim>{middle}); },
               obstacle);
    return middle;
}

// The same obstacle elsewhere.
template <int Dim>
pent::ObstacleShape<Dim> moved_to(pent::ObstacleShape<Dim> obstacle, const Placed<Dim>& map) {
    std::visit([&](auto& shape) { shape.fields(shape, FieldMover<Dim>{map}); }, obstacle);
    if (auto* half_space = std::get_if<HalfSpace<Dim>>(&obstacle)) {
        half_space->offset += half_space->normal.dot(map.shift);
    }
    return obstacle;
}

}  // namespace

template <int Dim>
ObstacleMotions<Dim>::ObstacleMotions(const Scene& scene) {
    for (const auto& obstacle : scene.obstacles) {
        pent::ObstacleShape<Dim> start = fixed_size<Dim>(obstacle.shape);
        if (!obstacle.rotate.empty()) {
            const Vector<Dim> middle = middle_of<Dim>(start);
            const Matrix<Dim> turn = rotation_of<Dim>(obstacle.rotate);
            start = moved_to<Dim>(start, {turn, middle - turn * middle});
        }
        std::vector<CenteredMotion<Dim>> motions =
            center<Dim>(obstacle.motion, middle_of<Dim>(start));
        obstacles_.push_back({std::move(start), std::move(motions)});
        is_any_ = is_any_ || !obstacle.motion.empty();
    }
}

template <int Dim>
typename ObstacleMotions<Dim>::RigidMap ObstacleMotions<Dim>::map_at(std::size_t obstacle,
                                                                     double time) const {
    const MotionChain<Dim> chain(obstacles_[obstacle].motions, time);
    RigidMap map{chain.rotation(), Vector<Dim>::Zero()};
    chain.move(map.shift, nullptr);
    return map;
}

template <int Dim>
std::vector<pent::ObstacleShape<Dim>> ObstacleMotions<Dim>::at(double time) const {
    std::vector<pent::ObstacleShape<Dim>> all;
    for (std::size_t i = 0; i < obstacles_.size(); ++i) {
        const Moved& moving = obstacles_[i];
        all.push_back(moving.motions.empty() ? moving.start
                                             : moved_to<Dim>(moving.start, map_at(i, time)));
    }
    return all;
}

template <int Dim>
typename ObstacleMotions<Dim>::RigidMap ObstacleMotions<Dim>::carried(std::size_t obstacle,
                                                                      double from,
                                                                      double to) const {
    const RigidMap before = map_at(obstacle, from);
    const RigidMap now = map_at(obstacle, to);
    const Matrix<Dim> rotation = now.rotation * before.rotation.transpose();
    return {rotation, now.shift - rotation * before.shift};
}

template <int Dim>
Vector<Dim> ObstacleMotions<Dim>::displacement(std::size_t obstacle,
                                               const Vector<Dim>& point,
                                               double from,
                                               double to) const {
    const RigidMap after = carried(obstacle, from, to);
    return after.rotation * point + after.shift - point;
}

template <int Dim>
bool ObstacleMotions<Dim>::is_moving(std::size_t obstacle, double from, double to) const {
    const RigidMap before = map_at(obstacle, from);
    const RigidMap now = map_at(obstacle, to);
    return before.rotation != now.rotation || before.shift != now.shift;
}

#define PENT_INSTANTIATE(Dim) template class ObstacleMotions<Dim>;
PENT_FOR_EACH_DIMENSION(PENT_INSTANTIATE)
#undef PENT_INSTANTIATE

}  // namespace pent::simulator
