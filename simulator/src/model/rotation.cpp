#include "model/rotation.h"

#include "model/keyframes.h"

#include <pent/dimensions.h>
#include <pent/geometry.h>
#include <pent/simulator/placed_mesh.h>

#include <algorithm>
#include <cmath>
#include <numbers>
#include <string>
#include <vector>

namespace pent::simulator {

namespace {

constexpr double kRadiansPerDegree = std::numbers::pi / 180;

std::string name_as_placed(const Body& body) {
    return body.mesh + " (as placed for body \"" + body.name + "\")";
}

}  // namespace

template <int Dim>
Matrix<Dim> plane_rotation(const Plane& plane, double angle) {
    return pent::plane_rotation<Dim>(plane.from, plane.to, angle);
}

template <int Dim>
Matrix<Dim> rotation_of(const std::vector<Turn>& turns) {
    Matrix<Dim> rotation = Matrix<Dim>::Identity();
    for (const Turn& turn : turns) {
        rotation = plane_rotation<Dim>(turn.plane, kRadiansPerDegree * turn.degrees) * rotation;
    }
    return rotation;
}

template <int Dim>
void put_in_place(SimplexMesh<Dim>& mesh, const Placement& placement) {
    if (placement.scale != 1) {
        mesh.positions *= placement.scale;
    }
    if (!placement.rotate.empty()) {
        const Matrix<Dim> rotation = rotation_of<Dim>(placement.rotate);
        mesh.positions = (rotation * mesh.positions).eval();
        mesh.fibers = (rotation * mesh.fibers).eval();
    }
    const Vector<Dim> translate = placement.translate;
    mesh.positions.colwise() += translate;
}

template <int Dim>
SimplexMesh<Dim> place(SimplexMesh<Dim> mesh, const Body& body) {
    put_in_place(mesh, body.place);
    validate(mesh, name_as_placed(body));
    return mesh;
}

template <int Dim>
MeshPart<Dim> place(MeshPart<Dim> part, const Body& body) {
    put_in_place(part.mesh, body.place);
    validate_part<Dim>(part.mesh, name_as_placed(body), part.numbers);
    return part;
}

namespace {

// How far a motion has gone: translation, and a turn in each plane.
struct Turned {
    Plane plane;
    double angle = 0;  // radians
    double rate = 0;   // radians/s
};
template <int Dim>
struct Course {
    Vector<Dim> shift = Vector<Dim>::Zero();     // m
    Vector<Dim> velocity = Vector<Dim>::Zero();  // m/s
    std::vector<Turned> turns;                   // the first is applied first
};

template <int Dim>
Course<Dim> steady_course(const Motion& motion, double time) {
    const double elapsed = std::clamp(time, motion.from, motion.to) - motion.from;
    // The velocity is that with which the time is reached, as at the end of a step: of two motions
    // one after the other it is that of the first. At 0, where no step ends, it is that of the
    // motion that begins.
    const bool has_begun = time == 0 ? motion.from == 0 : is_behind(time, motion.from);
    const bool is_moving = has_begun && !is_behind(time, motion.to);
    const Vector<Dim> translate = motion.translate;
    Course<Dim> course;
    course.shift = elapsed * translate;
    if (is_moving) {
        course.velocity = translate;
    }
    for (const Spin& spin : motion.rotate) {
        const double omega = kRadiansPerDegree * spin.degrees_per_s;
        course.turns.push_back({spin.plane, omega * elapsed, is_moving ? omega : 0});
    }
    return course;
}

// The curve of one component, from rest at the start of the motion through all later keyframes.
template <typename PointOf>
CurveState component_at(const Motion& motion, double time, const PointOf& point_of) {
    const auto first = std::find_if(motion.keyframes.begin(), motion.keyframes.end(),
                                    [&](const auto& frame) { return frame.time > motion.from; });
    const auto later = static_cast<std::size_t>(motion.keyframes.end() - first);
    return curve_at(
        1 + later,
        [&](std::size_t i) {
            return i == 0 ? CurvePoint{motion.from, 0, 0}
                          : point_of(first[static_cast<std::ptrdiff_t>(i) - 1]);
        },
        time);
}

CurvePoint angle_in(const MotionKeyframe& keyframe, const Plane& plane) {
    CurvePoint point{keyframe.time, 0};
    for (const Turn& turn : keyframe.rotate) {
        point.value += turn.plane == plane ? kRadiansPerDegree * turn.degrees : 0;
    }
    for (const Spin& spin : keyframe.spin) {
        if (spin.plane == plane) {
            point.slope = point.slope.value_or(0) + kRadiansPerDegree * spin.degrees_per_s;
        }
    }
    return point;
}

// The planes that keyframes turn in, each once, in the order in which they name them.
std::vector<Plane> planes_of(const Motion& motion) {
    std::vector<Plane> planes;
    const auto add = [&](const auto& turns) {
        for (const auto& turn : turns) {
            if (std::find(planes.begin(), planes.end(), turn.plane) == planes.end()) {
                planes.push_back(turn.plane);
            }
        }
    };
    for (const MotionKeyframe& keyframe : motion.keyframes) {
        add(keyframe.rotate);
        add(keyframe.spin);
    }
    return planes;
}

template <int Dim>
Course<Dim> course_through_keyframes(const Motion& motion, double time) {
    Course<Dim> course;
    for (int axis = 0; axis < Dim; ++axis) {
        const CurveState state = component_at(motion, time, [&](const MotionKeyframe& keyframe) {
            CurvePoint point{keyframe.time, keyframe.translate[axis]};
            if (keyframe.velocity) {
                point.slope = (*keyframe.velocity)[axis];
            }
            return point;
        });
        course.shift[axis] = state.value;
        course.velocity[axis] = state.slope;
    }
    for (const Plane& plane : planes_of(motion)) {
        const CurveState state = component_at(motion, time, [&](const MotionKeyframe& keyframe) {
            return angle_in(keyframe, plane);
        });
        course.turns.push_back({plane, state.value, state.slope});
    }
    return course;
}

}  // namespace

double largest_turn_rate(const Motion& motion) {
    double largest = 0;
    for (const Spin& spin : motion.rotate) {
        largest = std::max(largest, std::abs(spin.degrees_per_s));
    }
    for (const Plane& plane : planes_of(motion)) {
        double time = motion.from;
        double angle = 0;
        for (const MotionKeyframe& keyframe : motion.keyframes) {
            const double next = angle_in(keyframe, plane).value;
            largest = std::max(largest,
                               std::abs(next - angle) / (keyframe.time - time) / kRadiansPerDegree);
            time = keyframe.time;
            angle = next;
        }
    }
    return largest;
}

template <int Dim>
Pose<Dim> pose_at(const Motion& motion, double time) {
    const Course<Dim> course = motion.keyframes.empty()
                                   ? steady_course<Dim>(motion, time)
                                   : course_through_keyframes<Dim>(motion, time);
    Pose<Dim> pose{Matrix<Dim>::Identity(), course.shift, Matrix<Dim>::Zero(), course.velocity};
    for (const Turned& turned : course.turns) {
        const auto& [from, to] = turned.plane;
        const Matrix<Dim> turn = plane_rotation<Dim>(turned.plane, turned.angle);
        Matrix<Dim> generator = Matrix<Dim>::Zero();
        generator(to, from) = turned.rate;
        generator(from, to) = -turned.rate;
        pose.rate = (generator * turn * pose.rotation + turn * pose.rate).eval();
        pose.rotation = (turn * pose.rotation).eval();
    }
    return pose;
}

template Matrix<2> plane_rotation<2>(const Plane&, double);
#define PENT_INSTANTIATE(Dim)                                             \
    template Matrix<Dim> plane_rotation<Dim>(const Plane&, double);       \
    template Matrix<Dim> rotation_of<Dim>(const std::vector<Turn>&);      \
    template void put_in_place<Dim>(SimplexMesh<Dim>&, const Placement&); \
    template SimplexMesh<Dim> place<Dim>(SimplexMesh<Dim>, const Body&);  \
    template MeshPart<Dim> place<Dim>(MeshPart<Dim>, const Body&);        \
    template Pose<Dim> pose_at<Dim>(const Motion&, double);
PENT_FOR_EACH_DIMENSION(PENT_INSTANTIATE)
#undef PENT_INSTANTIATE

}  // namespace pent::simulator
