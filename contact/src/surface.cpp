#include "pent/contact/surface.h"

#include "gather.h"

#include <pent/facets.h>
#include <pent/parallel.h>

#include <algorithm>
#include <array>
#include <limits>

namespace pent::contact {

namespace {

// Normals and boxes of one thread at a time.
constexpr int kChunk = 1024;

// All faces with Count corners of the facets, each once, corners and faces ascending.
template <int Dim, int Count>
Simplices<Count> faces_of(const Simplices<Dim>& facets) {
    std::vector<std::array<std::uint32_t, Count>> faces;
    for (Eigen::Index f = 0; f < facets.cols(); ++f) {
        std::array<std::uint32_t, Dim> corners{};
        std::copy_n(facets.col(f).data(), Dim, corners.begin());
        std::sort(corners.begin(), corners.end());
        std::array<bool, Dim> is_chosen{};
        std::fill_n(is_chosen.begin(), Count, true);
        do {
            std::array<std::uint32_t, Count> face{};
            for (int i = 0, at = 0; i < Dim; ++i) {
                if (is_chosen[i]) {
                    face[at++] = corners[i];
                }
            }
            faces.push_back(face);
        } while (std::prev_permutation(is_chosen.begin(), is_chosen.end()));
    }
    std::sort(faces.begin(), faces.end());
    faces.erase(std::unique(faces.begin(), faces.end()), faces.end());
    Simplices<Count> result(Count, static_cast<Eigen::Index>(faces.size()));
    for (std::size_t i = 0; i < faces.size(); ++i) {
        std::copy(faces[i].begin(), faces[i].end(),
                  result.col(static_cast<Eigen::Index>(i)).data());
    }
    return result;
}

template <int Dim>
void list_facets_at_vertices(Surface<Dim>& surface) {
    const std::uint32_t* begin = surface.vertices.data();
    const std::uint32_t* end = begin + surface.vertices.size();
    const auto place = [&](std::uint32_t vertex) {
        return std::lower_bound(begin, end, vertex) - begin;
    };
    surface.facet_begin.assign(static_cast<std::size_t>(end - begin) + 1, 0);
    for (Eigen::Index i = 0; i < surface.facets.size(); ++i) {
        ++surface.facet_begin[place(surface.facets.data()[i]) + 1];
    }
    for (std::size_t i = 1; i < surface.facet_begin.size(); ++i) {
        surface.facet_begin[i] += surface.facet_begin[i - 1];
    }
    surface.facet_of.resize(surface.facets.size());
    std::vector<std::uint32_t> next(surface.facet_begin.begin(), surface.facet_begin.end() - 1);
    for (Eigen::Index i = 0; i < surface.facets.size(); ++i) {
        surface.facet_of[next[place(surface.facets.data()[i])]++] =
            static_cast<std::uint32_t>(i / Dim);
    }
}

// The vector normal to the columns, of which there are Dim - 1: n with n . x = det[columns, x].
Vector<2> cross(const Eigen::Matrix<double, 2, 1>& edges) {
    return {-edges(1, 0), edges(0, 0)};
}

Vector<3> cross(const Eigen::Matrix<double, 3, 2>& edges) {
    return {edges(1, 0) * edges(2, 1) - edges(2, 0) * edges(1, 1),
            edges(2, 0) * edges(0, 1) - edges(0, 0) * edges(2, 1),
            edges(0, 0) * edges(1, 1) - edges(1, 0) * edges(0, 1)};
}

Vector<4> cross(const Eigen::Matrix<double, 4, 3>& edges) {
    const auto minor = [&](int a, int b, int c) {
        return edges(a, 0) * (edges(b, 1) * edges(c, 2) - edges(c, 1) * edges(b, 2))
               - edges(b, 0) * (edges(a, 1) * edges(c, 2) - edges(c, 1) * edges(a, 2))
               + edges(c, 0) * (edges(a, 1) * edges(b, 2) - edges(b, 1) * edges(a, 2));
    };
    return {-minor(1, 2, 3), minor(0, 2, 3), -minor(0, 1, 3), minor(0, 1, 2)};
}

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
        const Shadow normal = cross(edges);
        double side = normal.dot(project(start_) - origin);
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
Surface<Dim> make_surface(const Simplices<Dim + 1>& cells,
                          Eigen::Index vertices,
                          std::uint32_t first_vertex) {
    Surface<Dim> surface;
    surface.first_vertex = first_vertex;
    surface.facets = match_facets<Dim>(cells, vertices).boundary;
    surface.facets.array() += first_vertex;
    surface.vertices = faces_of<Dim, 1>(surface.facets);
    surface.edges = faces_of<Dim, 2>(surface.facets);
    surface.ridges = faces_of<Dim, Dim - 1>(surface.facets);
    list_facets_at_vertices(surface);
    return surface;
}

template <int Dim>
double mean_edge_length(const Surface<Dim>& surface, const PositionsView<Dim>& positions) {
    double sum = 0;
    for (Eigen::Index i = 0; i < surface.edges.cols(); ++i) {
        sum += (positions.col(surface.edges(1, i)) - positions.col(surface.edges(0, i))).norm();
    }
    return surface.edges.cols() == 0 ? 0 : sum / static_cast<double>(surface.edges.cols());
}

template <int Dim>
Vector<Dim> facet_normal(const Corners<Dim, Dim>& corners) {
    const Eigen::Matrix<double, Dim, Dim - 1> edges =
        corners.template rightCols<Dim - 1>().colwise() - corners.col(0);
    // cross() has its vector last in the determinant, the outward rule first.
    return Dim % 2 == 0 ? Vector<Dim>(-cross(edges)) : cross(edges);
}

template <int Dim>
Positions<Dim> vertex_normals(const Surface<Dim>& surface, const PositionsView<Dim>& positions) {
    Positions<Dim> of_facets(Dim, surface.facets.cols());
    parallel_for(of_facets.cols(), kChunk, [&](Eigen::Index f) {
        of_facets.col(f) = facet_normal<Dim>(gather<Dim, Dim>(surface.facets, f, positions));
    });
    Positions<Dim> normals(Dim, surface.vertices.cols());
    parallel_for(normals.cols(), kChunk, [&](Eigen::Index i) {
        Vector<Dim> sum = Vector<Dim>::Zero();
        for (std::uint32_t k = surface.facet_begin[i]; k < surface.facet_begin[i + 1]; ++k) {
            sum += of_facets.col(surface.facet_of[k]);
        }
        normals.col(i) = sum.stableNormalized();
    });
    return normals;
}

template <int Dim, int Count>
std::vector<Box> boxes_around(const Simplices<Count>& simplices,
                              const PositionsView<Dim>& positions,
                              double margin) {
    std::vector<Box> boxes(static_cast<std::size_t>(simplices.cols()));
    parallel_for(boxes.size(), kChunk, [&](std::size_t i) {
        boxes[i] = box_around<Dim, Count>(
            gather<Dim, Count>(simplices, static_cast<Eigen::Index>(i), positions), margin);
    });
    return boxes;
}

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

template Surface<3> make_surface<3>(const Simplices<3 + 1>&, Eigen::Index, std::uint32_t);
template double mean_edge_length<3>(const Surface<3>&, const PositionsView<3>&);
template Vector<3> facet_normal<3>(const Corners<3, 3>&);
template Positions<3> vertex_normals<3>(const Surface<3>&, const PositionsView<3>&);
template int winding_number<3>(const Surface<3>&,
                               const BoxTree&,
                               const PositionsView<3>&,
                               const Vector<3>&);
template Surface<4> make_surface<4>(const Simplices<4 + 1>&, Eigen::Index, std::uint32_t);
template double mean_edge_length<4>(const Surface<4>&, const PositionsView<4>&);
template Vector<4> facet_normal<4>(const Corners<4, 4>&);
template Positions<4> vertex_normals<4>(const Surface<4>&, const PositionsView<4>&);
template int winding_number<4>(const Surface<4>&,
                               const BoxTree&,
                               const PositionsView<4>&,
                               const Vector<4>&);
template std::vector<Box> boxes_around<3, 1>(const Simplices<1>&, const PositionsView<3>&, double);
template std::vector<Box> boxes_around<3, 2>(const Simplices<2>&, const PositionsView<3>&, double);
template std::vector<Box> boxes_around<3, 3>(const Simplices<3>&, const PositionsView<3>&, double);
template std::vector<Box> boxes_around<4, 1>(const Simplices<1>&, const PositionsView<4>&, double);
template std::vector<Box> boxes_around<4, 2>(const Simplices<2>&, const PositionsView<4>&, double);
template std::vector<Box> boxes_around<4, 3>(const Simplices<3>&, const PositionsView<4>&, double);
template std::vector<Box> boxes_around<4, 4>(const Simplices<4>&, const PositionsView<4>&, double);

}  // namespace pent::contact
