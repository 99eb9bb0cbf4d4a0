#include "convex_reference.h"

#include "gather.h"

#include <pent/dimensions.h>

#include <Eigen/LU>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <tuple>
#include <vector>

namespace pent::contact {

namespace {

// Sweeps over all dents before the body counts as not nearly convex.
constexpr int kSweeps = 60;

// Over-relaxation: bending out one dent makes others, and going a little too far takes fewer
// sweeps.
constexpr double kRelaxation = 1.5;

// Vertices go no farther than this part of the mean edge; beyond it, it was more than a dent.
constexpr double kFarthest = 0.25;

// Dents that rise by less than this part of the mean edge count as flat, as the sides of a box
// whose coordinates have been rounded.
constexpr double kFlat = 1e-6;

// The corners of a facet, outward, and of its neighbor across a ridge the one that is not of both.
template <int Dim>
using Hinge = std::array<std::uint32_t, Dim + 1>;

// All hinges of a surface; none unless two facets meet at every ridge.
template <int Dim>
std::vector<Hinge<Dim>> hinges_of(const Simplices<Dim>& facets) {
    struct Side {
        std::array<std::uint32_t, Dim - 1> ridge;
        Eigen::Index facet;
        std::uint32_t opposite;
    };
    std::vector<Side> sides;
    for (Eigen::Index f = 0; f < facets.cols(); ++f) {
        for (int k = 0; k < Dim; ++k) {
            Side side{{}, f, facets(k, f)};
            std::remove_copy(facets.col(f).begin(), facets.col(f).end(), side.ridge.begin(),
                             side.opposite);
            std::sort(side.ridge.begin(), side.ridge.end());
            sides.push_back(side);
        }
    }
    std::sort(sides.begin(), sides.end(), [](const Side& a, const Side& b) {
        return std::tie(a.ridge, a.facet) < std::tie(b.ridge, b.facet);
    });
    std::vector<Hinge<Dim>> hinges;
    for (std::size_t i = 0; i < sides.size(); i += 2) {
        const bool is_pair = i + 1 < sides.size() && sides[i].ridge == sides[i + 1].ridge
                             && (i + 2 == sides.size() || sides[i].ridge != sides[i + 2].ridge);
        if (!is_pair) {
            return {};
        }
        Hinge<Dim>& hinge = hinges.emplace_back();
        const auto corners = facets.col(sides[i].facet);
        std::copy(corners.begin(), corners.end(), hinge.begin());
        hinge.back() = sides[i + 1].opposite;
    }
    return hinges;
}

// Edges from the first corner of an outward facet: of a point, and of its other corners.
template <int Dim>
Block<Dim> edges_of(const Corners<Dim, Dim>& facet, const Vector<Dim>& point) {
    Block<Dim> edges;
    edges << point - facet.col(0), facet.template rightCols<Dim - 1>().colwise() - facet.col(0);
    return edges;
}

// Dim! times the volume that a facet and a point span: above 0 where the point is before it.
template <int Dim>
double height(const Corners<Dim, Dim>& facet, const Vector<Dim>& point) {
    return edges_of<Dim>(facet, point).determinant();
}

// The derivatives of the determinant by its entries.
template <int Dim>
Block<Dim> cofactors(const Block<Dim>& matrix) {
    Block<Dim> result;
    for (int j = 0; j < Dim; ++j) {
        for (int i = 0; i < Dim; ++i) {
            Block<Dim> replaced = matrix;
            replaced.col(j) = Vector<Dim>::Unit(i);
            result(i, j) = replaced.determinant();
        }
    }
    return result;
}

template <int Dim>
class Bending {
public:
    Bending(const Surface<Dim>& surface, const PositionsView<Dim>& rest)
        : rest_(rest),
          positions_(rest),
          edge_(mean_edge_length<Dim>(surface, rest)),
          hinges_(hinges_of<Dim>(surface.facets)) {}

    // Moves the corners of each dent, along the gradient of its volume, to where it is none.
    bool run() {
        bool is_convex = false;
        for (int sweep = 0; sweep < kSweeps && !hinges_.empty() && !is_convex; ++sweep) {
            is_convex = true;
            for (const Hinge<Dim>& hinge : hinges_) {
                is_convex &= !bend(hinge);
            }
            if (is_far()) {
                return false;
            }
        }
        return is_convex;
    }

    [[nodiscard]] const Positions<Dim>& positions() const { return positions_; }

private:
    // Bends out a hinge; returns whether it was a dent.
    bool bend(const Hinge<Dim>& hinge) {
        Corners<Dim, Dim> facet;
        for (int i = 0; i < Dim; ++i) {
            facet.col(i) = positions_.col(hinge[i]);
        }
        const Block<Dim> edges = edges_of<Dim>(facet, positions_.col(hinge[Dim]));
        const double volume = edges.determinant();
        Corners<Dim, Dim + 1> slope;  // by the corners of the hinge
        const Block<Dim> of_edges = cofactors<Dim>(edges);
        slope << -of_edges.rowwise().sum(), of_edges.template rightCols<Dim - 1>(), of_edges.col(0);
        const double squared = slope.squaredNorm();
        if (!(volume > kFlat * edge_ * std::sqrt(squared))) {
            return false;
        }
        for (int i = 0; i <= Dim; ++i) {
            positions_.col(hinge[i]) -= kRelaxation * volume / squared * slope.col(i);
        }
        return true;
    }

    [[nodiscard]] bool is_far() const {
        const double squared = (positions_ - rest_).colwise().squaredNorm().maxCoeff();
        return !(squared <= kFarthest * kFarthest * edge_ * edge_);
    }

    const PositionsView<Dim>& rest_;
    Positions<Dim> positions_;
    double edge_;  // m
    std::vector<Hinge<Dim>> hinges_;
};

// Whether all cells are positively oriented, and the middle of the first is behind every facet and
// in no other cell. A surface without dents then goes round that point once: it is convex, and the
// cells fill it once.
template <int Dim>
bool is_filled_once(const Surface<Dim>& surface,
                    const Simplices<Dim + 1>& cells,
                    const PositionsView<Dim>& positions) {
    const auto corners_of = [&](Eigen::Index cell) {
        return gather<Dim, Dim + 1>(cells, cell, positions);
    };
    const Vector<Dim> middle = corners_of(0).rowwise().mean();
    for (Eigen::Index f = 0; f < surface.facets.cols(); ++f) {
        if (!(height<Dim>(gather<Dim, Dim>(surface.facets, f, positions), middle) < 0)) {
            return false;
        }
    }
    Eigen::Index around = 0;
    for (Eigen::Index cell = 0; cell < cells.cols(); ++cell) {
        const Corners<Dim, Dim + 1> corners = corners_of(cell);
        const Block<Dim> edges =
            corners.template rightCols<Dim>().colwise() - corners.col(0).eval();
        if (!(edges.determinant() > 0)) {
            return false;
        }
        const Vector<Dim> weights = edges.inverse() * (middle - corners.col(0));
        around += weights.minCoeff() >= 0 && weights.sum() <= 1 ? 1 : 0;
    }
    return around == 1;
}

}  // namespace

template <int Dim>
std::optional<Positions<Dim>> convex_reference(const Surface<Dim>& surface,
                                               const Simplices<Dim + 1>& cells,
                                               const PositionsView<Dim>& rest) {
    Bending<Dim> bending(surface, rest);
    if (!bending.run() || !is_filled_once<Dim>(surface, cells, bending.positions())) {
        return std::nullopt;
    }
    return bending.positions();
}

#define PENT_INSTANTIATE(Dim)                                     \
    template std::optional<Positions<Dim>> convex_reference<Dim>( \
        const Surface<Dim>&, const Simplices<Dim + 1>&, const PositionsView<Dim>&);
PENT_FOR_EACH_DIMENSION(PENT_INSTANTIATE)
#undef PENT_INSTANTIATE

}  // namespace pent::contact
