#include "winding_number.h"

#include "normals.h"

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
            if (i > 0 && sign != shadow) {
                return 0;
            }
            shadow = sign;
        }
        Corners<Dim, Dim> corners;
        for (int i = 0; i < Dim; ++i) {
            corners.col(i) = positions.col(facet[i]);
        }
        const Vector<Dim> normal = facet_normal<Dim>(corners);
        const double height = normal.dot(start_ - corners.col(0));
        const bool is_outward = (normal[axis_] > 0) == is_forward_;
        // Leaving, the point has the facet in front of it if it is on its inner side.
        const bool is_ahead = is_outward ? height < 0 : height >= 0;
        return normal[axis_] == 0 || !is_ahead ? 0 : (is_outward ? 1 : -1);
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

    // Orientation of the projected facet with corner i replaced by the start of the ray. Computed
    // from the ridge's corners in ascending order, so that both facets at a ridge agree to the bit;
    // where it is zero, from a start that is shifted by (t, t^2, ..) for a t next to 0.
    [[nodiscard]] int side_of_ridge(const std::array<std::uint32_t, Dim>& facet,
                                    int i,
                                    const PositionsView<Dim>& positions) const {
        std::array<std::uint32_t, Dim - 1> ridge{};
        for (int j = 0, at = 0; j < Dim; ++j) {
            if (j != i) {
                ridge[at++] = facet[j];
            }
        }
        bool is_even = (Dim - 1 - i) % 2 == 0;
        for (int a = 1; a < Dim - 1; ++a) {
            for (int b = a; b > 0 && ridge[b] < ridge[b - 1]; --b) {
                std::swap(ridge[b], ridge[b - 1]);
                is_even = !is_even;
            }
        }
        const Shadow origin = project(positions.col(ridge[0]));
        Eigen::Matrix<double, Dim - 1, Dim - 2> edges;
        for (int j = 1; j < Dim - 1; ++j) {
            edges.col(j - 1) = project(positions.col(ridge[j])) - origin;
        }
        const Shadow normal = normal_to(edges);
        const Shadow start = project(start_);
        // A point may lie exactly in line with corners, as with two copies of a mesh, one behind
        // the other. There more than two ridges meet and all have to agree, which they do where the
        // side is exactly 0.
        const bool is_at_corner = std::any_of(
            ridge.begin(), ridge.end(),
            [&](std::uint32_t corner) { return project(positions.col(corner)) == start; });
        double side = is_at_corner ? 0 : normal.dot(start - origin);
        for (int j = 0; side == 0 && j < Dim - 1; ++j) {
            side = normal[j];
        }
        return (side > 0) == is_even ? 1 : -1;
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
