#include "lattice_stuffing.h"
#include "surface_mesh.h"

#include <pent/error.h>
#include <pent/formatted.h>
#include <pent/mesher/links.h>
#include <pent/mesher/quality.h>
#include <pent/mesher/stuff.h>

#include <algorithm>
#include <cassert>
#include <cmath>

namespace pent::mesher {

namespace {

// Cells of this mean ratio are not worked on; the lattice's own have 0.89.
constexpr double kGood = 0.3;

// Below this a cell is given up, and lattice points around it move back.
constexpr double kTooFlat = 0.01;

constexpr int kMaxRounds = 8;

void check(const Solid& solid, double edge_length) {
    if (!(edge_length > 0) || !std::isfinite(edge_length)) {
        throw Error(formatted("edges of %g m; expected a length above 0", edge_length));
    }
    const Box4& box = solid.bounds();
    if ((box.high - box.low).minCoeff() <= 0) {
        throw Error("the shape is empty: what is intersected lies apart");
    }
    if (!solid.is_bounded()) {
        throw Error(
            "the shape has no bounds; expected half-spaces to be intersected with a box, ball "
            "or other shape that has");
    }
    if (solid.smallest_width() < edge_length) {
        throw Error(
            formatted("a part of the shape is only %g m thick, less than edges of %g m; expected "
                      "an edge length of at most %g m, better half of that",
                      solid.smallest_width(), edge_length, solid.smallest_width()));
    }
}

Error nothing_inside(const ThinParts& thin, double edge_length) {
    if (thin.edges > 0) {
        return Error(
            formatted("the shape is thinner than edges of %g m everywhere, as thin as %.3g m near "
                      "(%.4g, %.4g, %.4g, %.4g); expected an edge length of at most %.3g m",
                      edge_length, thin.width, thin.place[0], thin.place[1], thin.place[2],
                      thin.place[3], thin.width));
    }
    return Error(
        formatted("the shape is empty, or smaller than edges of %g m; expected something "
                  "inside it, or shorter edges",
                  edge_length));
}

// A size field that leaves two edges across the thinnest primitive.
SizeField limited(SizeField sizes, const Solid& solid, double edge_length) {
    constexpr double kEdgesAcross = 2;
    if (!(sizes.growth >= 0 && std::isfinite(sizes.growth))) {
        throw Error(
            formatted("edges that grow by %g m for each m; expected 0 or more", sizes.growth));
    }
    if (!(sizes.longest >= edge_length)) {
        throw Error(
            formatted("longest edges of %g m, shorter than the shortest of %g m; expected "
                      "longer ones",
                      sizes.longest, edge_length));
    }
    sizes.longest =
        std::max(edge_length, std::min(sizes.longest, solid.smallest_width() / kEdgesAcross));
    return sizes;
}

// Stuffs until the boundary is a manifold: in every round at least one point moves back.
StuffedMesh manifold_mesh(LatticeStuffing& stuffing, std::int64_t& moved_back) {
    for (;;) {
        StuffedMesh stuffed = stuffing.mesh();
        const LinkReport links = check_links(stuffed.mesh);
        if (links.faulty == 0) {
            return stuffed;
        }
        const std::int64_t count = stuffing.move_back(links.is_faulty);
        assert(count > 0);
        moved_back += count;
    }
}

double least_mean_ratio(const SimplexMesh<4>& mesh) {
    return measure_quality(mesh).mean_ratio.min;
}

// Follows the ridges where that leaves good cells first, then where it leaves poor ones; between,
// vertices move, after which more is possible.
std::int64_t follow_ridges(SurfaceMesh& surface) {
    std::int64_t left = 0;
    for (const double least_quality : {0.3, 0.2, 0.12, 0.11, 0.1}) {
        left = sharpen(surface, least_quality);
        if (left == 0) {
            break;
        }
        if (least_quality < 0.15) {
            relax(surface, 0.2);
            smooth(surface, kGood);
        }
    }
    return left;
}

// The corners of cells too flat to keep.
std::vector<bool> corners_of_flat_cells(const StarMesh& mesh, std::size_t lattice_vertices) {
    std::vector<bool> found;
    for (std::uint32_t cell = 0; cell < mesh.cell_count(); ++cell) {
        if (mesh.quality(cell) < kTooFlat) {
            found.resize(lattice_vertices, false);
            for (const std::uint32_t vertex : mesh.cell(cell)) {
                if (vertex < lattice_vertices) {
                    found[vertex] = true;
                }
            }
        }
    }
    return found;
}

}  // namespace

StuffedSolid stuff(const Solid& solid, double edge_length, const SizeField& sizes) {
    check(solid, edge_length);
    const LatticeTree tree(solid, Lattice::with_mean_edge(edge_length),
                           limited(sizes, solid, edge_length));
    LatticeStuffing stuffing(solid, tree);
    StuffedSolid result;
    result.thin_parts = tree.thin_parts();
    for (int round = 0; round < kMaxRounds; ++round) {
        StuffedMesh stuffed = manifold_mesh(stuffing, result.moved_back);
        if (stuffed.mesh.cell_count() == 0) {
            throw nothing_inside(result.thin_parts, edge_length);
        }
        if (solid.piece_count() == 1 && least_mean_ratio(stuffed.mesh) >= kGood) {
            result.mesh = std::move(stuffed.mesh);
            return result;
        }
        const std::size_t lattice_vertices = stuffed.is_on_surface.size();
        SurfaceMesh surface = on_surface(solid, edge_length, std::move(stuffed));
        result.beveled = follow_ridges(surface);
        relax(surface, kGood);
        smooth(surface, kGood);
        relax(surface, kGood);
        const std::vector<bool> flat = corners_of_flat_cells(surface.mesh, lattice_vertices);
        const std::int64_t count = flat.empty() ? 0 : stuffing.move_back(flat);
        result.moved_back += count;
        if (count == 0) {
            result.mesh = surface.mesh.mesh();
            return result;
        }
    }
    throw Error(
        formatted("edges of %g m leave flat cells; expected shorter ones, at which the shape's "
                  "parts are a few edges thick",
                  edge_length));
}

double estimate_cells(const Solid& solid, double edge_length, const SizeField& sizes) {
    check(solid, edge_length);
    const SizeField own = limited(sizes, solid, edge_length);
    constexpr double kReach = 1.2;  // of a cell of the lattice around its center, in edges
    constexpr int kPerSide = 16;
    constexpr int kPoints = kPerSide * kPerSide * kPerSide * kPerSide;
    const Box4& box = solid.bounds();
    const Eigen::Vector4d step = (box.high - box.low) / kPerSide;
    double cells = 0;
    for (int i = 0; i < kPoints; ++i) {
        const Eigen::Array4d place(i % kPerSide, i / kPerSide % kPerSide,
                                   i / (kPerSide * kPerSide) % kPerSide,
                                   i / (kPerSide * kPerSide * kPerSide));
        const Eigen::Vector4d p = box.low.array() + (place + 0.5) * step.array();
        if (solid.is_inside(p)) {
            // Cells of the lattice have the largest power of two that all of them may have.
            double edge = edge_length;
            while (own.edge_within(edge_length, p, kReach * 2 * edge) >= 2 * edge) {
                edge *= 2;
            }
            cells += step.prod() / Lattice::with_mean_edge(edge).cell_volume();
        }
    }
    return cells;
}

}  // namespace pent::mesher
