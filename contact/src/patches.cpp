#include "patches.h"

#include "normals.h"

#include <pent/dimensions.h>
#include <pent/parallel.h>

#include <Eigen/Eigenvalues>

#include <algorithm>
#include <cmath>

namespace pent::contact {

namespace {

// Mean squared offset along the thinnest axis of a patch, over that along the next: below, it is
// flat. Then, and only then, what lies across it is taken to move without stretch.
constexpr double kFlat = 0.05;

// The same along the second thinnest axis, over the longest: below, no map can be told.
constexpr double kSlender = 1e-6;

// What rounding may add to lengths, over the size of coordinates.
constexpr double kRounding = 1e-12;

// Patches that one thread fits at a time.
constexpr std::size_t kChunk = 64;

// Where the bound on the smallest eigenvalue of a map's metric is at least this part of their mean,
// it is good enough.
constexpr double kTight = 0.7;

template <int Dim>
using Map = Eigen::Matrix<double, Dim, Dim>;

// The unit vector across `axes` but the first, on the side that makes them right-handed.
template <int Dim>
Vector<Dim> across(const Map<Dim>& axes) {
    Corners<Dim, Dim> corners;
    corners << Vector<Dim>::Zero(), axes.template rightCols<Dim - 1>();
    return facet_normal<Dim>(corners).stableNormalized();
}

// The smallest singular value of a map, or a bound from below: no eigenvalue of A^T A is farther
// below their mean than all others can make up for.
template <int Dim>
double least_stretch(const Map<Dim>& map) {
    const Map<Dim> metric = map.transpose() * map;
    const double mean = metric.trace() / Dim;
    const double spread =
        (metric - mean * Map<Dim>::Identity()).norm() / std::sqrt(static_cast<double>(Dim));
    const double least = mean - std::sqrt(Dim - 1.0) * spread;
    if (least > kTight * mean) {
        return std::sqrt(least);
    }
    const Eigen::SelfAdjointEigenSolver<Map<Dim>> solver(metric, Eigen::EigenvaluesOnly);
    return std::sqrt(std::max(0.0, solver.eigenvalues()[0]));
}

// NaN if one is.
double larger(double a, double b) {
    return a > b || std::isnan(a) ? a : b;
}

// Vertices of some simplices, ascending, once each.
template <int Count>
std::vector<std::uint32_t> vertices_of(const Simplices<Count>& simplices,
                                       std::span<const std::uint32_t> patch) {
    std::vector<std::uint32_t> vertices;
    for (const std::uint32_t i : patch) {
        const auto corners = simplices.col(i);
        vertices.insert(vertices.end(), corners.begin(), corners.end());
    }
    std::sort(vertices.begin(), vertices.end());
    vertices.erase(std::unique(vertices.begin(), vertices.end()), vertices.end());
    return vertices;
}

}  // namespace

template <int Dim>
PatchBound bound_of(const PatchMotion<Dim>& first, const PatchMotion<Dim>& second) {
    double turn = 0;
    double shift = 0;
    const auto add = [&](const PatchPlace<Dim>& a, const PatchPlace<Dim>& b) {
        const Map<Dim> mean = 0.5 * (a.map + b.map);
        turn = std::max(turn, 0.5 * (a.map - b.map).norm());
        shift = std::max(
            shift, (a.center - b.center - mean * (first.rest_center - second.rest_center)).norm());
    };
    add(first.end, second.end);
    if (!first.is_still || !second.is_still) {
        add(first.start, second.start);
    }
    return {std::max(first.least_stretch, second.least_stretch) - turn,
            shift + turn * (first.radius + second.radius) + first.deviation + second.deviation};
}

template <int Dim>
template <int Count>
Patches<Dim>::Patches(const Simplices<Count>& simplices,
                      const PatchPartition& partition,
                      const PositionsView<Dim>& rest) {
    Vertices all;
    for (std::size_t patch = 0; patch < partition.size(); ++patch) {
        const std::vector<std::uint32_t> vertices = vertices_of<Count>(simplices, partition[patch]);
        all.begin.push_back(all.of_patch.size());
        all.of_patch.insert(all.of_patch.end(), vertices.begin(), vertices.end());
    }
    all.begin.push_back(all.of_patch.size());
    vertices_ = std::make_shared<const Vertices>(std::move(all));
    set_rest(rest);
}

template <int Dim>
Patches<Dim>::Patches(const Patches& others, const PositionsView<Dim>& rest)
    : vertices_(others.vertices_) {
    set_rest(rest);
}

template <int Dim>
void Patches<Dim>::set_rest(const PositionsView<Dim>& rest) {
    rest_positions_ = rest;
    patches_.resize(vertices_->begin.size() - 1);
    motions_.resize(patches_.size());
    parallel_for(motions_.size(), kChunk,
                 [&](std::size_t patch) { patches_[patch] = rest_of(patch, motions_[patch]); });
}

template <int Dim>
typename Patches<Dim>::Rest Patches<Dim>::rest_of(std::size_t patch,
                                                  PatchMotion<Dim>& motion) const {
    const std::span<const std::uint32_t> vertices = vertices_->of(patch);
    for (const std::uint32_t vertex : vertices) {
        motion.rest_center += rest_positions_.col(vertex) / static_cast<double>(vertices.size());
    }
    Map<Dim> spread = Map<Dim>::Zero();
    for (const std::uint32_t vertex : vertices) {
        const Vector<Dim> offset = rest_positions_.col(vertex) - motion.rest_center;
        spread += offset * offset.transpose();
        motion.radius = std::max(motion.radius, offset.norm());
    }
    const Eigen::SelfAdjointEigenSolver<Map<Dim>> solver(spread);
    const Vector<Dim>& along = solver.eigenvalues();  // ascending
    Rest rest;
    rest.axes = solver.eigenvectors();
    rest.is_flat = !(along[0] > kFlat * along[1]);
    if (rest.is_flat) {
        rest.axes.col(0) = across<Dim>(rest.axes);
    }
    if (along[1] > kSlender * along[Dim - 1]) {  // else no map can be told
        for (int axis = rest.is_flat ? 1 : 0; axis < Dim; ++axis) {
            rest.inverse += rest.axes.col(axis) * rest.axes.col(axis).transpose() / along[axis];
        }
    }
    return rest;
}

template <int Dim>
void Patches<Dim>::fit(const Paths<Dim>& paths) {
    parallel_for(motions_.size(), kChunk,
                 [&](std::size_t patch) { motions_[patch] = fit(patch, paths); });
}

// With D what a map A changes by, (A + t D)^T (A + t D) is the mean of those at both ends, weighted
// by time, less t (1 - t) D^T D.
template <int Dim>
PatchMotion<Dim> Patches<Dim>::fit(std::size_t patch, const Paths<Dim>& paths) const {
    PatchMotion<Dim> motion;
    motion.rest_center = motions_[patch].rest_center;
    motion.radius = motions_[patch].radius;
    motion.is_still = paths.is_still();
    motion.deviation = 0;
    motion.end = place(patch, paths.to, motion.deviation);
    motion.least_stretch = least_stretch<Dim>(motion.end.map);
    if (motion.is_still) {
        motion.start = motion.end;
    } else {
        motion.start = place(patch, paths.from, motion.deviation);
        const double least = std::min(motion.least_stretch, least_stretch<Dim>(motion.start.map));
        const double change = 0.5 * (motion.end.map - motion.start.map).norm();
        motion.least_stretch = std::sqrt(std::max(0.0, least * least - change * change));
    }
    return motion;
}

// Where the patch is; raises the deviation to what its vertices deviate there.
template <int Dim>
PatchPlace<Dim> Patches<Dim>::place(std::size_t patch,
                                    const PositionsView<Dim>& positions,
                                    double& deviation) const {
    const Rest& rest = patches_[patch];
    const Vector<Dim>& rest_center = motions_[patch].rest_center;
    const std::span<const std::uint32_t> vertices = vertices_->of(patch);
    PatchPlace<Dim> place;
    for (const std::uint32_t vertex : vertices) {
        place.center += positions.col(vertex);
    }
    place.center /= static_cast<double>(vertices.size());
    for (const std::uint32_t vertex : vertices) {
        place.map += (positions.col(vertex) - place.center)
                     * (rest_positions_.col(vertex) - rest_center).transpose();
    }
    place.map *= rest.inverse;
    if (rest.is_flat) {
        place.map += across<Dim>(place.map * rest.axes) * rest.axes.col(0).transpose();
    }
    double squared = 0;
    for (const std::uint32_t vertex : vertices) {
        const Vector<Dim> offset = rest_positions_.col(vertex) - rest_center;
        squared = std::max(
            squared, (positions.col(vertex) - place.center - place.map * offset).squaredNorm());
    }
    const double rounding =
        kRounding * (place.center.norm() + rest_center.norm() + motions_[patch].radius);
    deviation = larger(deviation, std::sqrt(squared) + rounding);
    return place;
}

template <int Dim>
std::int64_t Patches<Dim>::bytes() const {
    return static_cast<std::int64_t>(
        patches_.size() * sizeof(Rest) + motions_.size() * sizeof(PatchMotion<Dim>)
        + static_cast<std::size_t>(rest_positions_.size()) * sizeof(double)
        + (vertices_ ? vertices_->of_patch.size() * sizeof(std::uint32_t) : 0));
}

#define PENT_INSTANTIATE_OF(Dim, Count)                                            \
    template Patches<Dim>::Patches(const Simplices<Count>&, const PatchPartition&, \
                                   const PositionsView<Dim>&);
#define PENT_INSTANTIATE(Dim)                                                       \
    template PatchBound bound_of(const PatchMotion<Dim>&, const PatchMotion<Dim>&); \
    template class Patches<Dim>;
PENT_FOR_EACH_DIMENSION(PENT_INSTANTIATE)
PENT_FOR_EACH_DIMENSION(PENT_INSTANTIATE_OF, 1)
PENT_FOR_EACH_DIMENSION(PENT_INSTANTIATE_OF, 2)
PENT_FOR_EACH_DIMENSION(PENT_INSTANTIATE_OF, 3)
PENT_INSTANTIATE_OF(4, 4)
#undef PENT_INSTANTIATE
#undef PENT_INSTANTIATE_OF

}  // namespace pent::contact
