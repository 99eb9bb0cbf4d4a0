#include "path_cover.h"

#include <pent/dimensions.h>

#include <algorithm>
#include <cmath>
#include <utility>

namespace pent::contact {

namespace {

float rounded_up(double value) {
    return static_cast<float>(value * (1 + 1e-7));
}

}  // namespace

template <int Dim>
PathCover<Dim>::PathCover(Simplices<1> vertices, const Paths<Dim>& paths)
    : vertices_(std::move(vertices)),
      start_(Dim, vertices_.cols()),
      way_(Dim, vertices_.cols()),
      inflation_(vertices_.cols()) {
    const Vector<Dim> from = mean(paths.from);
    const Vector<Dim> to = mean(paths.to);
    double longest = 0;
    for (Eigen::Index k = 0; k < vertices_.cols(); ++k) {
        const std::uint32_t v = vertices_(0, k);
        start_.col(k) = paths.from.col(v) - from;
        way_.col(k) = paths.to.col(v) - to - start_.col(k);
        inflation_[k] = paths.inflation_of(v);
        const double squared = way_.col(k).squaredNorm();
        longest = std::max(longest, squared);
        squared_ways_ += squared;
    }
    longest_path_ = std::sqrt(longest);
}

template <int Dim>
Vector<Dim> PathCover<Dim>::mean(const PositionsView<Dim>& positions) const {
    Vector<Dim> sum = Vector<Dim>::Zero();
    for (const std::uint32_t v : vertices_.reshaped()) {
        sum += positions.col(v);
    }
    return mean_of_sum(sum);
}

template <int Dim>
Vector<Dim> PathCover<Dim>::mean_of_sum(const Vector<Dim>& sum) const {
    return sum / std::max<double>(1, static_cast<double>(vertices_.cols()));
}

// The time at which the paths are nearest to the positions in the sense of least squares, as good a
// choice as any. It is the same where all positions are shifted, since ways add up to zero.
template <int Dim>
bool PathCover<Dim>::covers(const PositionsView<Dim>& positions) const {
    Vector<Dim> sum = Vector<Dim>::Zero();
    double along = 0;
    for (Eigen::Index k = 0; k < vertices_.cols(); ++k) {
        const auto position = positions.col(vertices_(0, k));
        sum += position;
        along += way_.col(k).dot(position - start_.col(k));
    }
    const Vector<Dim> middle = mean_of_sum(sum);
    const double t = squared_ways_ > 0 ? std::clamp(along / squared_ways_, 0.0, 1.0) : 0;
    for (Eigen::Index k = 0; k < vertices_.cols(); ++k) {
        const double squared =
            (positions.col(vertices_(0, k)) - middle - start_.col(k) - t * way_.col(k))
                .squaredNorm();
        if (!(squared <= inflation_[k] * inflation_[k])) {
            return false;
        }
    }
    return true;
}

template <int Dim>
double PathCover<Dim>::squared_from_end(const PositionsView<Dim>& positions,
                                        const Vector<Dim>& mean,
                                        Eigen::Index k) const {
    return (positions.col(vertices_(0, k)) - mean - start_.col(k) - way_.col(k)).squaredNorm();
}

// The distance from the end of a path is convex along a straight way, whatever the shift on it:
// largest at one of its ends.
template <int Dim>
void PathCover<Dim>::find_displacement(const PositionsView<Dim>& from,
                                       const PositionsView<Dim>& to,
                                       Displacement& displacement) const {
    const bool is_still = from.data() == to.data();
    const Vector<Dim> mean_from = mean(from);
    const Vector<Dim> mean_to = is_still ? mean_from : mean(to);
    displacement.max = 0;
    for (Eigen::Index k = 0; k < vertices_.cols(); ++k) {
        double squared = squared_from_end(from, mean_from, k);
        if (!is_still) {
            squared = std::max(squared, squared_from_end(to, mean_to, k));
        }
        const float of_vertex = rounded_up(std::sqrt(squared));
        displacement[vertices_(0, k)] = of_vertex;
        displacement.max = std::max(displacement.max, of_vertex);
    }
}

template <int Dim>
double PathCover<Dim>::farthest_from_end(const PositionsView<Dim>& positions) const {
    const Vector<Dim> middle = mean(positions);
    double squared = 0;
    for (Eigen::Index k = 0; k < vertices_.cols(); ++k) {
        squared = std::max(squared, squared_from_end(positions, middle, k));
    }
    return std::sqrt(squared);
}

template <int Dim>
std::int64_t PathCover<Dim>::bytes() const {
    return static_cast<std::int64_t>(sizeof(double))
               * (start_.size() + way_.size() + inflation_.size())
           + static_cast<std::int64_t>(sizeof(std::uint32_t)) * vertices_.size();
}

#define PENT_INSTANTIATE(Dim) template class PathCover<Dim>;
PENT_FOR_EACH_DIMENSION(PENT_INSTANTIATE)
#undef PENT_INSTANTIATE

}  // namespace pent::contact
