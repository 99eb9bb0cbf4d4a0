#include "winding_number.h"

#include "orientation.h"

#include <pent/dimensions.h>

#include <algorithm>
#include <array>
#include <limits>

namespace pent::contact {

namespace {

// One ray from a point along an axis, and what it crosses.
template <int Dim>
class Ray {
public:
    Ray(const Vector<Dim>& start, int axis, bool is_forward)
        : start_(start), axis_(axis), is_forward_(is_forward) {}

    // The ray as a box without width.
    [[nodiscard]] Box box() const {
        Box box = box_around<Dim, 1>(start_, 0);
        (is_forward_ ? box.high : box.low)[axis_] = is_forward_
                                                        ? std::numeric_limits<float>::infinity()
                                                        : -std::numeric_limits<float>::infinity();
        return box;
    }

    // 1 where the ray leaves the body through the facet, -1 where it enters, else 0.
    [[nodiscard]] int crossing(const std::array<std::uint32_t, Dim>& facet,
                               const PositionsView<Dim>& positions) const {
        int shadow = 0;  // sign of the projected facet, if the point is within it
        for (int i = 0; i < Dim; ++i) {
            const int sign = side_of_ridge(facet, i, positions);
            if (sign == 0 || (i > 0 && sign != shadow)) {
                return 0;
            }
            shadow = sign;
        }
        Eigen::Matrix<double, Dim, Dim + 1> points;
        for (int i = 0; i < Dim; ++i) {
            points.col(i) = positions.col(facet[i]);
        }
        points.col(Dim) = start_;
        // The signs of the outward normal along the axis, and of its product with the way from the
        // facet to the point.
        const bool is_along_axis = (shadow > 0) == (axis_ % 2 == 0);
        const int height = (Dim % 2 == 0 ? -1 : 1) * orientation<Dim>(points);
        const bool is_outward = is_along_axis == is_forward_;
        // Leaving, the point has the facet in front of it if it is on its inner side.
        const bool is_ahead = is_outward ? height < 0 : height >= 0;
        return !is_ahead ? 0 : is_outward ? 1 : -1;
    }

private:
    using Shadow = Vector<Dim - 1>;

    [[nodiscard]] Shadow project(const Vector<Dim>& point) const {
        Shadow shadow;
        for (int i = 0, at = 0; i < Dim; ++i) {
            if (i != axis_) {
                shadow[at++] = point[i];
            }
        }
        return shadow;
    }

    // Orientation of the projected facet with corner i replaced by the start of the ray, exact;
    // where it is zero, with one that is shifted by (t, t^2, ..) for a t next to 0. Zero where the
    // ridge is seen edge-on: then the projected facet has no inside.
    [[nodiscard]] int side_of_ridge(const std::array<std::uint32_t, Dim>& facet,
                                    int i,
                                    const PositionsView<Dim>& positions) const {
        Eigen::Matrix<double, Dim - 1, Dim> points;
        for (int j = 0, at = 0; j < Dim; ++j) {
            if (j != i) {
                points.col(at++) = project(positions.col(facet[j]));
            }
        }
        points.col(Dim - 1) = project(start_);
        int side = orientation<Dim - 1>(points);
        for (int axis = 0; side == 0 && axis < Dim - 1; ++axis) {
            Eigen::Matrix<double, Dim - 2, Dim - 1> ridge;
            for (int row = 0; row < Dim - 2; ++row) {
                ridge.row(row) = points.row(row < axis ? row : row + 1).template head<Dim - 1>();
            }
            side = ((Dim - 2 + axis) % 2 == 0 ? 1 : -1) * orientation<Dim - 2>(ridge);
        }
        return ((Dim - 1 - i) % 2 == 0 ? 1 : -1) * side;
    }

    Vector<Dim> start_;
    int axis_;
    bool is_forward_;
};

// The ray that leaves the box soonest.
template <int Dim>
Ray<Dim> shortest_ray(const Vector<Dim>& point, const Box& box) {
    int best_axis = 0;
    bool best_is_forward = true;
    double best = std::numeric_limits<double>::infinity();
    for (int axis = 0; axis < Dim; ++axis) {
        const double ahead = static_cast<double>(box.high[axis]) - point[axis];
        const double behind = point[axis] - static_cast<double>(box.low[axis]);
        if (std::min(ahead, behind) < best) {
            best = std::min(ahead, behind);
            best_axis = axis;
            best_is_forward = ahead <= behind;
        }
    }
    return Ray<Dim>(point, best_axis, best_is_forward);
}

}  // namespace

template <int Dim>
int winding_number(const Surface<Dim>& surface,
                   const BoxTree& facets,
                   const PositionsView<Dim>& positions,
                   const Vector<Dim>& point) {
    if (facets.is_empty() || distance_squared<Dim>(point, facets.root_box()) > 0) {
        return 0;
    }
    const Ray<Dim> ray = shortest_ray<Dim>(point, facets.root_box());
    int sum = 0;
    facets.for_each_overlap(ray.box(), [&](std::uint32_t f) {
        std::array<std::uint32_t, Dim> corners{};
        std::copy_n(surface.facets.col(f).data(), Dim, corners.begin());
        sum += ray.crossing(corners, positions);
    });
    return sum;
}

#define PENT_INSTANTIATE(Dim)                                             \
    template int winding_number<Dim>(const Surface<Dim>&, const BoxTree&, \
                                     const PositionsView<Dim>&, const Vector<Dim>&);
PENT_FOR_EACH_DIMENSION(PENT_INSTANTIATE)
#undef PENT_INSTANTIATE

}  // namespace pent::contact
