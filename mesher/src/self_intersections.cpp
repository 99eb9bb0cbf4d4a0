#include "self_intersections.h"

#include <pent/mesher/surface_check.h>

#include <CGAL/Exact_predicates_inexact_constructions_kernel.h>
#include <CGAL/box_intersection_d.h>
#include <algorithm>

namespace pent::mesher {

namespace {

using Kernel = CGAL::Exact_predicates_inexact_constructions_kernel;
using Point = Kernel::Point_3;
using Box = CGAL::Box_intersection_d::Box_with_info_d<double, 3, std::uint32_t>;

Point point(const Surface& surface, std::uint32_t index) {
    return {surface.points(0, index), surface.points(1, index), surface.points(2, index)};
}

// A triangle with the corners it shares with another one in front.
struct Corners {
    std::array<std::uint32_t, 3> index{};
    std::array<Point, 3> point;
};

Corners corners_shared_first(const Surface& surface, std::uint32_t triangle, std::uint32_t other) {
    Corners corners;
    for (int i = 0; i < 3; ++i) {
        corners.index[i] = surface.triangles(i, triangle);
    }
    const auto is_shared = [&](std::uint32_t corner) {
        return (surface.triangles.col(other).array() == corner).any();
    };
    std::stable_partition(corners.index.begin(), corners.index.end(), is_shared);
    for (int i = 0; i < 3; ++i) {
        corners.point[i] = point(surface, corners.index[i]);
    }
    return corners;
}

int shared_corners(const Surface& surface, std::uint32_t a, std::uint32_t b) {
    int shared = 0;
    for (int i = 0; i < 3; ++i) {
        for (int j = 0; j < 3; ++j) {
            shared += surface.triangles(i, a) == surface.triangles(j, b) ? 1 : 0;
        }
    }
    return shared;
}

bool do_meet(const Surface& surface, std::uint32_t a, std::uint32_t b) {
    const int shared = shared_corners(surface, a, b);
    const auto [a_index, p] = corners_shared_first(surface, a, b);
    const auto [b_index, q] = corners_shared_first(surface, b, a);
    const Kernel::Triangle_3 first(p[0], p[1], p[2]);
    const Kernel::Triangle_3 second(q[0], q[1], q[2]);
    switch (shared) {
        case 0:
            return CGAL::do_intersect(first, second);
        case 1:  // beyond the shared corner, an intersection ends on the side opposite to it
            return CGAL::do_intersect(Kernel::Segment_3(p[1], p[2]), second)
                   || CGAL::do_intersect(Kernel::Segment_3(q[1], q[2]), first);
        case 2:  // folded flat onto each other
            return CGAL::coplanar(p[0], p[1], p[2], q[2])
                   && CGAL::coplanar_orientation(p[0], p[1], p[2], q[2]) == CGAL::POSITIVE;
        default:
            return false;
    }
}

std::vector<Box> boxes(const Surface& surface) {
    std::vector<Box> result;
    for (std::uint32_t t = 0; t < surface.triangle_count(); ++t) {
        if (is_degenerate(surface, t)) {
            continue;
        }
        CGAL::Bbox_3 box;
        for (int i = 0; i < 3; ++i) {
            box += point(surface, surface.triangles(i, t)).bbox();
        }
        result.emplace_back(box, t);
    }
    return result;
}

}  // namespace

bool is_degenerate(const Surface& surface, Eigen::Index triangle) {
    return CGAL::collinear(point(surface, surface.triangles(0, triangle)),
                           point(surface, surface.triangles(1, triangle)),
                           point(surface, surface.triangles(2, triangle)));
}

std::vector<std::array<std::uint32_t, 2>> self_intersections(const Surface& surface) {
    std::vector<Box> all = boxes(surface);
    std::vector<std::array<std::uint32_t, 2>> pairs;
    CGAL::box_self_intersection_d(all.begin(), all.end(), [&](const Box& a, const Box& b) {
        if (do_meet(surface, a.info(), b.info())) {
            pairs.push_back({std::min(a.info(), b.info()), std::max(a.info(), b.info())});
        }
    });
    std::sort(pairs.begin(), pairs.end());
    return pairs;
}

}  // namespace pent::mesher
