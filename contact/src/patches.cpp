#include "patches.h"

#include "lanes.h"
#include "normals.h"

#include <pent/dimensions.h>
#include <pent/parallel.h>

#include <Eigen/Eigenvalues>
#include <Eigen/LU>

#include <algorithm>
#include <cassert>
#include <cmath>
#include <span>

namespace pent::contact {

namespace {

// A patch whose mean squared offset along its thinnest axis is below this part of that along the
// next is flat: its vertices do not tell how it stretches across, which is taken as no stretch.
constexpr double kFlat = 0.05;

// With the same along the second thinnest axis below this part of that along the longest no map can
// be fit.
constexpr double kSlender = 1e-6;

// How much rounding may add to lengths, over the size of coordinates.
constexpr double kRounding = 1e-12;

// Patches that one thread fits at a time.
constexpr std::size_t kChunk = 64;

// Where the lower bound of the smallest eigenvalue of a map's metric is at least this part of the
// mean of all, it is good enough.
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

// The smallest singular value of a map, or a lower bound: the least that an eigenvalue of A^T A can
// be, by the mean and the variance of all.
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

}  // namespace

template <int Dim>
PatchMotions<Dim>::PatchMotions(const std::vector<PatchMotion<Dim>>& motions) {
    const bool are_still = std::all_of(motions.begin(), motions.end(),
                                       [](const auto& motion) { return motion.is_still; });
    places_ = are_still ? 1 : 2;
    const auto size = static_cast<std::size_t>(MotionRows::size(places_));
    numbers_.resize(motions.size() * size);
    parallel_for(motions.size(), kChunk, [&](std::size_t patch) {
        const PatchMotion<Dim>& motion = motions[patch];
        double* const row = numbers_.data() + patch * size;
        using Axes = Eigen::Map<Vector<Dim>>;
        Axes(row + MotionRows::kEarlierCenter) = motion.earlier_center;
        row[MotionRows::kSizes] = motion.least_stretch;
        row[MotionRows::kSizes + 1] = motion.radius;
        row[MotionRows::kSizes + 2] = motion.deviation;
        for (int i = 0; i < places_; ++i) {
            const PatchPlace<Dim>& place = i == 0 ? motion.end : motion.start;
            double* const to = row + MotionRows::kPlaces + i * MotionRows::kPlaceSize;
            Axes{to} = place.center - place.map * motion.earlier_center;
            for (int axis = 0; axis < Dim; ++axis) {
                Axes(to + MotionRows::kAxes * (1 + axis)) = place.map.col(axis);
            }
        }
    });
}

template <int Dim>
void PatchMotions<Dim>::bound(std::size_t patch,
                              const PatchMotions& others,
                              std::span<const std::uint32_t> which,
                              std::span<PatchBound> bounds) const {
    assert(places_ == others.places_ && bounds.size() >= which.size());
    const double* const row =
        numbers_.data() + patch * static_cast<std::size_t>(MotionRows::size(places_));
    lanes_kernels<Dim>().bound_motions(row, others.rows(), which.data(),
                                       static_cast<int>(which.size()), bounds.data());
}

template <int Dim>
Patches<Dim>::Patches(const PatchVertices& vertices, const PositionsView<Dim>& rest)
    : begin_(vertices.starts()), vertices_(vertices.of_all()) {
    rest_.resize(vertices.size());
    offsets_.resize(Dim, static_cast<Eigen::Index>(vertices_.size()));
    parallel_for(rest_.size(), kChunk, [&](std::size_t patch) {
        auto offsets = own(offsets_, patch);
        gather(patch, rest, offsets);
        offsets.colwise() -= offsets.rowwise().mean().eval();
        rest_[patch] = rest_of(offsets);
    });
}

template <int Dim>
void Patches<Dim>::gather(std::size_t patch,
                          const PositionsView<Dim>& positions,
                          Eigen::Ref<Positions<Dim>> vertices) const {
    for (Eigen::Index k = 0; k < vertices.cols(); ++k) {
        vertices.col(k) = positions.col(vertices_[begin_[patch] + static_cast<std::size_t>(k)]);
    }
}

template <int Dim>
typename Patches<Dim>::Rest Patches<Dim>::rest_of(const PositionsView<Dim>& offsets) {
    Rest rest;
    const Map<Dim> spread = offsets * offsets.transpose();
    const Eigen::SelfAdjointEigenSolver<Map<Dim>> solver(spread);
    const Vector<Dim>& along = solver.eigenvalues();  // ascending
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
PatchPlaces<Dim> Patches<Dim>::place(const PositionsView<Dim>& positions) const {
    PatchPlaces<Dim> places;
    places.of_patch.resize(rest_.size());
    places.vertices.resize(Dim, static_cast<Eigen::Index>(vertices_.size()));
    parallel_for(rest_.size(), kChunk, [&](std::size_t patch) {
        auto vertices = own(places.vertices, patch);
        gather(patch, positions, vertices);
        places.of_patch[patch] = place(patch, vertices);
    });
    return places;
}

template <int Dim>
PatchPlace<Dim> Patches<Dim>::place(std::size_t patch, const PositionsView<Dim>& vertices) const {
    const Rest& rest = rest_[patch];
    const auto offsets = own(offsets_, patch);
    PatchPlace<Dim> place;
    place.center = vertices.rowwise().sum() / static_cast<double>(vertices.cols());
    for (Eigen::Index k = 0; k < vertices.cols(); ++k) {
        place.map += (vertices.col(k) - place.center) * offsets.col(k).transpose();
    }
    place.map *= rest.inverse;
    if (rest.is_flat) {
        place.map += across<Dim>(place.map * rest.axes) * rest.axes.col(0).transpose();
    }
    return place;
}

template <int Dim>
std::vector<PatchMotion<Dim>> Patches<Dim>::motions(const PatchPlaces<Dim>& earlier,
                                                    const PatchPlaces<Dim>& now) const {
    std::vector<PatchMotion<Dim>> motions(size());
    parallel_for(size(), kChunk, [&](std::size_t patch) {
        PatchMotion<Dim>& motion = motions[patch];
        begin(patch, earlier, motion);
        motion.end = motion.start = move(patch, earlier, now, motion);
        motion.least_stretch = least_stretch<Dim>(motion.end.map);
    });
    return motions;
}

// With D the change of a map A, (A + t D)^T (A + t D) is the mean of those at both ends, weighted
// by time, less t (1 - t) D^T D.
template <int Dim>
std::vector<PatchMotion<Dim>> Patches<Dim>::motions(const PatchPlaces<Dim>& earlier,
                                                    const PatchPlaces<Dim>& start,
                                                    const PatchPlaces<Dim>& end) const {
    std::vector<PatchMotion<Dim>> motions(size());
    parallel_for(size(), kChunk, [&](std::size_t patch) {
        PatchMotion<Dim>& motion = motions[patch];
        begin(patch, earlier, motion);
        motion.is_still = false;
        motion.start = move(patch, earlier, start, motion);
        motion.end = move(patch, earlier, end, motion);
        const double least =
            std::min(least_stretch<Dim>(motion.start.map), least_stretch<Dim>(motion.end.map));
        const double change = 0.5 * (motion.end.map - motion.start.map).norm();
        motion.least_stretch = std::sqrt(std::max(0.0, least * least - change * change));
    });
    return motions;
}

// Sets where a motion begins; the rest of it is still to come.
template <int Dim>
void Patches<Dim>::begin(std::size_t patch,
                         const PatchPlaces<Dim>& earlier,
                         PatchMotion<Dim>& motion) const {
    motion.earlier_center = earlier.of_patch[patch].center;
    const auto offsets = own(earlier.vertices, patch).colwise() - motion.earlier_center;
    motion.radius = (1 + kRounding) * std::sqrt(offsets.colwise().squaredNorm().maxCoeff());
    motion.deviation = 0;
}

// Where the patch has gone to, from where it was earlier; raises the deviation to what its vertices
// deviate there. Any map would do: what both fits make of rest is close to the best.
template <int Dim>
PatchPlace<Dim> Patches<Dim>::move(std::size_t patch,
                                   const PatchPlaces<Dim>& earlier,
                                   const PatchPlaces<Dim>& now,
                                   PatchMotion<Dim>& motion) const {
    PatchPlace<Dim> place = now.of_patch[patch];
    place.map *= earlier.of_patch[patch].map.inverse();
    const auto before = own(earlier.vertices, patch);
    const auto after = own(now.vertices, patch);
    double squared = 0;
    for (Eigen::Index k = 0; k < before.cols(); ++k) {
        const Vector<Dim> offset = before.col(k) - motion.earlier_center;
        squared = larger(squared, (after.col(k) - place.center - place.map * offset).squaredNorm());
    }
    const double rounding =
        kRounding
        * (place.center.norm()
           + (1 + place.map.norm()) * (motion.earlier_center.norm() + motion.radius));
    motion.deviation = larger(motion.deviation, std::sqrt(squared) + rounding);
    return place;
}

template <int Dim>
std::int64_t Patches<Dim>::bytes() const {
    return static_cast<std::int64_t>(rest_.size() * sizeof(Rest)
                                     + begin_.size() * sizeof(std::size_t)
                                     + vertices_.size() * sizeof(std::uint32_t)
                                     + static_cast<std::size_t>(offsets_.size()) * sizeof(double));
}

#define PENT_INSTANTIATE(Dim)         \
    template class PatchMotions<Dim>; \
    template class Patches<Dim>;
PENT_FOR_EACH_DIMENSION(PENT_INSTANTIATE)
#undef PENT_INSTANTIATE

}  // namespace pent::contact
