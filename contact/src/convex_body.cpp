#include "convex_body.h"

#include "chunks.h"
#include "convex_reference.h"
#include "pair_at.h"
#include "self_proximity.h"

#include <pent/dimensions.h>

#include <Eigen/LU>
#include <Eigen/SVD>

#include <algorithm>
#include <atomic>
#include <utility>
#include <vector>

namespace pent::contact {

namespace {

// Room for rounding, and for dents too small to be bent out.
constexpr double kMargin = 1.05;

// A gap in the reference is of use from this multiple of the distance on: below there is no room
// for the body to be bent.
constexpr double kLeastGap = 1.2;

// The bound on the gap by cells is good enough from this multiple on. Else the gap is searched for,
// up to the next one, and no farther than this part of the mean edge, where pairs are few.
constexpr double kEnoughGap = 1.8;
constexpr double kMostGap = 4;
constexpr double kMostOfEdge = 0.45;

// Cells that a thread looks at in one go.
constexpr std::size_t kChunk = 512;

// A lower bound, m, of the distance of two simplices that share no vertex, one of them a vertex or
// an edge of the surface: on the way from there to the other the sum of its barycentric coordinates
// falls from 1 to 0, no faster than the steepest of all their gradients. Far too low where cells
// are flat.
template <int Dim>
double gap_by_cells(const Simplices<1>& surface,
                    const Simplices<Dim + 1>& cells,
                    const Positions<Dim>& positions) {
    std::vector<bool> is_outside(static_cast<std::size_t>(positions.cols()), false);
    for (const std::uint32_t vertex : surface.reshaped()) {
        is_outside[vertex] = true;
    }
    double steepest = 0;
    for (Eigen::Index cell = 0; cell < cells.cols(); ++cell) {
        const Corners<Dim, Dim + 1> corners = gather<Dim, Dim + 1>(cells, cell, positions);
        const Block<Dim> edges =
            corners.template rightCols<Dim>().colwise() - corners.col(0).eval();
        Corners<Dim, Dim + 1> slopes;
        slopes.template rightCols<Dim>() = edges.inverse().transpose();
        slopes.col(0) = -slopes.template rightCols<Dim>().rowwise().sum();
        for (int i = 0; i <= Dim; ++i) {
            if (!is_outside[cells(i, cell)]) {
                continue;
            }
            steepest = std::max(steepest, slopes.col(i).norm());
            for (int j = 0; j < i; ++j) {
                if (is_outside[cells(j, cell)]) {
                    steepest = std::max(steepest, (slopes.col(i) + slopes.col(j)).norm());
                }
            }
        }
    }
    return 1 / steepest;
}

// The least distance of some pairs, but no more than a limit.
template <int Dim, int K, int L>
double least_distance(const Surface<Dim>& surface,
                      const CandidateList& pairs,
                      const PositionsView<Dim>& positions,
                      double limit) {
    double least = limit;
    for (const Candidate& pair : pairs.pairs) {
        if (static_cast<double>(pair.distance) >= least) {
            continue;  // rounded down
        }
        const PairAt<Dim, K, L> at(surface.template simplices<K>(), surface.template simplices<L>(),
                                   pair, positions);
        least = at.distance_below(least);
    }
    return least;
}

// The least distance of two simplices that share no vertex, but no more than a limit, m.
template <int Dim>
double gap_by_search(const Surface<Dim>& surface, const Positions<Dim>& positions, double limit) {
    const PositionsView<Dim> view(positions);
    const CandidatePairs near =
        SelfProximity<Dim>(surface, positions, 0, false).find(Paths<Dim>{view, view}, limit, limit);
    return least_distance<Dim, 2, Dim - 1>(
        surface, near.mixed_first, view,
        least_distance<Dim, 1, Dim>(surface, near.points_first, view, limit));
}

// Whether elimination leaves all pivots above 0.
template <int Dim>
bool is_positive_definite(Block<Dim> matrix) {
    for (int k = 0; k < Dim; ++k) {
        if (!(matrix(k, k) > 0)) {
            return false;
        }
        for (int i = k + 1; i < Dim; ++i) {
            const double factor = matrix(i, k) / matrix(k, k);
            for (int j = k + 1; j <= i; ++j) {
                matrix(i, j) -= factor * matrix(j, k);
            }
        }
    }
    return true;
}

}  // namespace

template <int Dim>
ConvexBody<Dim>::ConvexBody(std::span<const std::uint32_t> cells,
                            Positions<Dim> reference,
                            double gap)
    : cells_(cells),
      first_vertex_(*std::min_element(cells.begin(), cells.end())),
      reference_(std::move(reference)),
      gap_(gap) {}

template <int Dim>
std::optional<ConvexBody<Dim>> ConvexBody<Dim>::make(std::span<const std::uint32_t> cells,
                                                     const PositionsView<Dim>& rest,
                                                     double distance) {
    if (cells.empty()) {
        return std::nullopt;
    }
    const auto [least, greatest] = std::minmax_element(cells.begin(), cells.end());
    const std::uint32_t first = *least;
    const Eigen::Index count = *greatest - first + 1;
    const Eigen::Map<const Simplices<Dim + 1>> all(
        cells.data(), Dim + 1, static_cast<Eigen::Index>(cells.size()) / (Dim + 1));
    const Simplices<Dim + 1> own = all.array() - first;
    const Surface<Dim> surface = make_surface<Dim>(own, count);
    std::optional<Positions<Dim>> reference =
        convex_reference<Dim>(surface, own, rest.middleCols(first, count));
    if (!reference) {
        return std::nullopt;
    }
    double gap = gap_by_cells<Dim>(surface.vertices, own, *reference);
    const double most =
        std::min(kMostGap * distance, kMostOfEdge * mean_edge_length<Dim>(surface, *reference));
    if (gap < kEnoughGap * distance && most >= kLeastGap * distance) {
        gap = std::max(gap, gap_by_search<Dim>(surface, *reference, most));
    }
    if (gap < kLeastGap * distance) {
        return std::nullopt;
    }
    return ConvexBody(cells, *std::move(reference), gap);
}

// The rotation of the affine map that fits the middle of the paths best: any rotation gives a valid
// bound, this one a good one.
template <int Dim>
Block<Dim> ConvexBody<Dim>::rotation(const Paths<Dim>& paths) const {
    const Eigen::Index count = reference_.cols();
    const Positions<Dim> middle =
        0.5
        * (paths.from.middleCols(first_vertex_, count) + paths.to.middleCols(first_vertex_, count));
    const Positions<Dim> centered = middle.colwise() - middle.rowwise().mean();
    const Eigen::JacobiSVD<Block<Dim>> svd(centered * reference_.transpose(),
                                           Eigen::ComputeFullU | Eigen::ComputeFullV);
    Block<Dim> u = svd.matrixU();
    if (u.determinant() * svd.matrixV().determinant() < 0) {
        u.col(Dim - 1) *= -1;
    }
    return u * svd.matrixV().transpose();
}

// Whether the symmetric part of R^T F less `least` is positive definite. With E of the edges of the
// cell as they are, and T = R E0 of those turned from the reference, F = E E0^-1: that is so if and
// only if the symmetric part of T^T E less `least` T^T T is.
template <int Dim>
bool ConvexBody<Dim>::is_monotone(std::size_t cell,
                                  const Positions<Dim>& turned,
                                  const PositionsView<Dim>& positions,
                                  double least) const {
    Block<Dim> edges;
    Block<Dim> of_turned;
    const auto corners = cells_.subspan(cell * (Dim + 1), Dim + 1);
    const std::uint32_t start = corners[0];
    for (int k = 0; k < Dim; ++k) {
        const std::uint32_t end = corners[k + 1];
        edges.col(k) = positions.col(end) - positions.col(start);
        of_turned.col(k) = turned.col(end - first_vertex_) - turned.col(start - first_vertex_);
    }
    const Block<Dim> map = of_turned.transpose() * (edges - least * of_turned);
    return is_positive_definite<Dim>(map + map.transpose());
}

template <int Dim>
bool ConvexBody<Dim>::stays_apart(const Paths<Dim>& paths, double distance) const {
    const double least = kMargin * distance / gap_;
    const Positions<Dim> turned = rotation(paths) * reference_;
    std::atomic<bool> is_apart = true;
    const auto look = [&](std::size_t, std::size_t begin, std::size_t end) {
        for (std::size_t cell = begin; cell < end && is_apart; ++cell) {
            if (!is_monotone(cell, turned, paths.from, least)
                || !(paths.is_still() || is_monotone(cell, turned, paths.to, least))) {
                is_apart = false;
            }
        }
    };
    for_each_chunk(cells_.size() / (Dim + 1), kChunk, look);
    return is_apart;
}

template <int Dim>
std::int64_t ConvexBody<Dim>::bytes() const {
    return static_cast<std::int64_t>(sizeof(double)) * reference_.size();
}

#define PENT_INSTANTIATE(Dim) template class ConvexBody<Dim>;
PENT_FOR_EACH_DIMENSION(PENT_INSTANTIATE)
#undef PENT_INSTANTIATE

}  // namespace pent::contact
