#include "patches.h"

#include "normals.h"

#include <pent/parallel.h>

#include <Eigen/Eigenvalues>

#include <algorithm>
#include <cmath>

namespace pent::contact {

namespace {

// Simplices of a patch, at most. Small ones are nearer to an affine map, large ones fewer.
constexpr std::size_t kMaxInPatch = 16;

// Mean squared offset along the thinnest axis of a patch, over that along the next: below, it is
// flat. Then, and only then, what lies across it is taken to move without stretch.
constexpr double kFlat = 0.05;

// The same along the second thinnest axis, over the longest: below, no map can be told.
constexpr double kSlender = 1e-6;

// What rounding may add to lengths, over the size of coordinates.
constexpr double kRounding = 1e-12;

template <int Dim>
using Map = Eigen::Matrix<double, Dim, Dim>;

// The unit vector across `axes` but the first, on the side that makes them right-handed.
template <int Dim>
Vector<Dim> across(const Map<Dim>& axes) {
    Corners<Dim, Dim> corners;
    corners << Vector<Dim>::Zero(), axes.template rightCols<Dim - 1>();
    return facet_normal<Dim>(corners).stableNormalized();
}

// Vertices of the simplices in a range, ascending, once each.
template <int Count>
std::vector<std::uint32_t> vertices_of(const Simplices<Count>& simplices,
                                       const BoxTree& tree,
                                       const BoxTree::Range& range) {
    std::vector<std::uint32_t> vertices;
    for (std::uint32_t place = range.begin; place < range.begin + range.count; ++place) {
        const auto corners = simplices.col(tree.leaf(place));
        vertices.insert(vertices.end(), corners.begin(), corners.end());
    }
    std::sort(vertices.begin(), vertices.end());
    vertices.erase(std::unique(vertices.begin(), vertices.end()), vertices.end());
    return vertices;
}

}  // namespace

int patch_depth(std::size_t simplices) {
    int depth = 0;
    for (; simplices > kMaxInPatch; simplices = (simplices + 1) / 2) {
        ++depth;
    }
    return depth;
}

std::vector<BoxTree::Range> patch_ranges(const BoxTree& tree) {
    std::vector<BoxTree::Range> ranges{tree.root()};
    for (int depth = patch_depth(tree.size()); depth > 0; --depth) {
        std::vector<BoxTree::Range> halves;
        for (const BoxTree::Range& range : ranges) {
            halves.push_back(range.left());
            halves.push_back(range.right());
        }
        ranges.swap(halves);
    }
    return ranges;
}

template <int Dim>
bool stay_apart(const PatchMotion<Dim>& first,
                const PatchMotion<Dim>& second,
                double rest_distance,
                double distance) {
    const Map<Dim> mean = 0.5 * (first.map + second.map);
    const double turn = 0.5 * (first.map - second.map).norm();
    const Vector<Dim> shift =
        first.center - second.center - mean * (first.rest_center - second.rest_center);
    const double stretch = std::max(first.least_stretch, second.least_stretch) - turn;
    const double lack =
        shift.norm() + turn * (first.radius + second.radius) + first.deviation + second.deviation;
    return stretch > 0 && stretch * rest_distance - lack > distance;
}

template <int Dim>
template <int Count>
Patches<Dim>::Patches(const Simplices<Count>& simplices,
                      const BoxTree& tree,
                      const PositionsView<Dim>& rest) {
    for (const BoxTree::Range& range : patch_ranges(tree)) {
        add(vertices_of<Count>(simplices, tree, range), rest);
    }
    patches_.emplace_back().begin = vertices_.size();
}

template <int Dim>
void Patches<Dim>::add(const std::vector<std::uint32_t>& vertices, const PositionsView<Dim>& rest) {
    Rest& patch = patches_.emplace_back();
    patch.begin = vertices_.size();
    PatchMotion<Dim>& motion = motions_.emplace_back();
    for (const std::uint32_t vertex : vertices) {
        motion.rest_center += rest.col(vertex) / static_cast<double>(vertices.size());
    }
    Map<Dim> spread = Map<Dim>::Zero();
    for (const std::uint32_t vertex : vertices) {
        vertices_.push_back(vertex);
        offsets_.emplace_back(rest.col(vertex) - motion.rest_center);
        spread += offsets_.back() * offsets_.back().transpose();
        motion.radius = std::max(motion.radius, offsets_.back().norm());
    }
    const Eigen::SelfAdjointEigenSolver<Map<Dim>> solver(spread);
    const Vector<Dim>& along = solver.eigenvalues();  // ascending
    patch.axes = solver.eigenvectors();
    patch.is_flat = !(along[0] > kFlat * along[1]);
    if (patch.is_flat) {
        patch.axes.col(0) = across<Dim>(patch.axes);
    }
    Map<Dim> inverse = Map<Dim>::Zero();  // zero where no map can be told
    if (along[1] > kSlender * along[Dim - 1]) {
        for (int axis = patch.is_flat ? 1 : 0; axis < Dim; ++axis) {
            inverse += patch.axes.col(axis) * patch.axes.col(axis).transpose() / along[axis];
        }
    }
    for (std::size_t i = patch.begin; i < vertices_.size(); ++i) {
        weights_.emplace_back(inverse * offsets_[i]);
    }
}

template <int Dim>
void Patches<Dim>::fit(const PositionsView<Dim>& positions) {
    constexpr int kChunk = 64;
    parallel_for(motions_.size(), kChunk,
                 [&](std::size_t patch) { motions_[patch] = fit(patch, positions); });
}

template <int Dim>
PatchMotion<Dim> Patches<Dim>::fit(std::size_t patch, const PositionsView<Dim>& positions) const {
    const Rest& rest = patches_[patch];
    const std::size_t end = patches_[patch + 1].begin;
    PatchMotion<Dim> motion;
    motion.rest_center = motions_[patch].rest_center;
    motion.radius = motions_[patch].radius;
    for (std::size_t i = rest.begin; i < end; ++i) {
        motion.center += positions.col(vertices_[i]);
    }
    motion.center /= static_cast<double>(end - rest.begin);
    for (std::size_t i = rest.begin; i < end; ++i) {
        motion.map += (positions.col(vertices_[i]) - motion.center) * weights_[i].transpose();
    }
    if (rest.is_flat) {
        motion.map += across<Dim>(motion.map * rest.axes) * rest.axes.col(0).transpose();
    }
    double deviation_squared = 0;
    for (std::size_t i = rest.begin; i < end; ++i) {
        deviation_squared = std::max(
            deviation_squared,
            (positions.col(vertices_[i]) - motion.center - motion.map * offsets_[i]).squaredNorm());
    }
    const Map<Dim> metric = motion.map.transpose() * motion.map;
    const Eigen::SelfAdjointEigenSolver<Map<Dim>> solver(metric, Eigen::EigenvaluesOnly);
    motion.least_stretch = std::sqrt(std::max(0.0, solver.eigenvalues()[0]));
    motion.deviation =
        std::sqrt(deviation_squared)
        + kRounding * (motion.center.norm() + motion.rest_center.norm() + motion.radius);
    return motion;
}

template <int Dim>
std::int64_t Patches<Dim>::bytes() const {
    return static_cast<std::int64_t>(
        patches_.size() * sizeof(Rest) + motions_.size() * sizeof(PatchMotion<Dim>)
        + vertices_.size() * sizeof(std::uint32_t) + 2 * offsets_.size() * sizeof(Vector<Dim>));
}

template bool stay_apart(const PatchMotion<3>&, const PatchMotion<3>&, double, double);
template bool stay_apart(const PatchMotion<4>&, const PatchMotion<4>&, double, double);
template class Patches<3>;
template class Patches<4>;
template Patches<3>::Patches(const Simplices<1>&, const BoxTree&, const PositionsView<3>&);
template Patches<3>::Patches(const Simplices<2>&, const BoxTree&, const PositionsView<3>&);
template Patches<3>::Patches(const Simplices<3>&, const BoxTree&, const PositionsView<3>&);
template Patches<4>::Patches(const Simplices<1>&, const BoxTree&, const PositionsView<4>&);
template Patches<4>::Patches(const Simplices<2>&, const BoxTree&, const PositionsView<4>&);
template Patches<4>::Patches(const Simplices<3>&, const BoxTree&, const PositionsView<4>&);
template Patches<4>::Patches(const Simplices<4>&, const BoxTree&, const PositionsView<4>&);

}  // namespace pent::contact
