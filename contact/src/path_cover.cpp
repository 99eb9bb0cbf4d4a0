#include "path_cover.h"

#include <pent/dimensions.h>

#include <algorithm>
#include <cmath>

namespace pent::contact {

namespace {

float rounded_up(double value) {
    return static_cast<float>(value * (1 + 1e-7));
}

}  // namespace

template <int Dim>
Vector<Dim> mean_shift(const Simplices<1>& vertices,
                       const PositionsView<Dim>& a,
                       const PositionsView<Dim>& b) {
    Vector<Dim> sum = Vector<Dim>::Zero();
    for (const std::uint32_t v : vertices.reshaped()) {
        sum += b.col(v) - a.col(v);
    }
    return sum / std::max<double>(1, static_cast<double>(vertices.cols()));
}

template <int Dim>
double longest_path(const Simplices<1>& vertices,
                    const PositionsView<Dim>& from,
                    const PositionsView<Dim>& to) {
    const Vector<Dim> drift = mean_shift<Dim>(vertices, from, to);
    double squared = 0;
    for (const std::uint32_t v : vertices.reshaped()) {
        squared = std::max(squared, (to.col(v) - from.col(v) - drift).squaredNorm());
    }
    return std::sqrt(squared);
}

template <int Dim>
void PathCover<Dim>::clear() {
    *this = {};
}

template <int Dim>
void PathCover<Dim>::set(const Vertices& vertices,
                         const PositionsView<Dim>& from,
                         const PositionsView<Dim>& to,
                         double inflation,
                         double of_path) {
    start_.conservativeResize(Dim, from.cols());
    end_.conservativeResize(Dim, from.cols());
    inflation_.conservativeResize(from.cols());
    const Vector<Dim> drift = mean_shift<Dim>(vertices, from, to);
    for (const std::uint32_t v : vertices.reshaped()) {
        start_.col(v) = from.col(v);
        end_.col(v) = to.col(v);
        inflation_[v] = std::max(inflation, of_path * (to.col(v) - from.col(v) - drift).norm());
    }
}

// The time at which the paths are next to the positions in the sense of least squares is as good as
// any.
template <int Dim>
bool PathCover<Dim>::covers(const Vertices& vertices, const PositionsView<Dim>& positions) const {
    if (positions.cols() != start_.cols()) {
        return false;
    }
    const PositionsView<Dim> start = start_;
    const Vector<Dim> drift = mean_shift<Dim>(vertices, start, end_);
    const Vector<Dim> shift = mean_shift<Dim>(vertices, start, positions);
    double squared = 0;
    double along = 0;
    for (const std::uint32_t v : vertices.reshaped()) {
        const Vector<Dim> path = end_.col(v) - start_.col(v) - drift;
        squared += path.squaredNorm();
        along += path.dot(positions.col(v) - start_.col(v) - shift);
    }
    const double t = squared > 0 ? std::clamp(along / squared, 0.0, 1.0) : 0;
    const auto is_near = [&](std::uint32_t v) {
        const Vector<Dim> path = end_.col(v) - start_.col(v) - drift;
        const Vector<Dim> aside = positions.col(v) - start_.col(v) - shift - t * path;
        return aside.squaredNorm() <= inflation_[v] * inflation_[v];
    };
    const auto all = vertices.reshaped();
    return std::all_of(all.begin(), all.end(), is_near);
}

// How far it is along a straight way is convex, whatever the shift on it: most at one of its ends.
template <int Dim>
float PathCover<Dim>::displacement(const Vertices& vertices,
                                   const PositionsView<Dim>& from,
                                   const PositionsView<Dim>& to,
                                   Eigen::VectorXf& of_vertex) const {
    const PositionsView<Dim> end = end_;
    const Vector<Dim> at_start = mean_shift<Dim>(vertices, end, from);
    const Vector<Dim> at_end = mean_shift<Dim>(vertices, end, to);
    float max = 0;
    for (const std::uint32_t v : vertices.reshaped()) {
        const double squared = std::max((from.col(v) - end_.col(v) - at_start).squaredNorm(),
                                        (to.col(v) - end_.col(v) - at_end).squaredNorm());
        of_vertex[v] = rounded_up(std::sqrt(squared));
        max = std::max(max, of_vertex[v]);
    }
    return max;
}

#define PENT_INSTANTIATE(Dim)                                                       \
    template Vector<Dim> mean_shift(const Simplices<1>&, const PositionsView<Dim>&, \
                                    const PositionsView<Dim>&);                     \
    template double longest_path(const Simplices<1>&, const PositionsView<Dim>&,    \
                                 const PositionsView<Dim>&);                        \
    template class PathCover<Dim>;
PENT_FOR_EACH_DIMENSION(PENT_INSTANTIATE)
#undef PENT_INSTANTIATE

}  // namespace pent::contact
