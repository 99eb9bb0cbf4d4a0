#include "model/falling_values.h"
#include "model/selection_marks.h"

#include <pent/dimensions.h>
#include <pent/facets.h>
#include <pent/simulator/mesh_share.h>

#include <algorithm>
#include <limits>
#include <numeric>

namespace pent::simulator {

namespace {

constexpr double kUnseen = std::numeric_limits<double>::infinity();

// One number of each rank.
std::vector<double> list(const Ranks* ranks, double own) {
    if (ranks == nullptr) {
        return {own};
    }
    const std::vector<std::int64_t> ones(static_cast<std::size_t>(ranks->count()), 1);
    return ranks->gather({&own, 1}, ones);
}

std::int64_t sum(const Ranks* ranks, std::int64_t own) {
    const std::vector<double> all = list(ranks, static_cast<double>(own));
    return static_cast<std::int64_t>(std::accumulate(all.begin(), all.end(), 0.0));
}

// One pass over the cells takes the depth at least one edge further in. Returns whether any of a
// vertex of this rank has changed.
template <int Dim>
bool take_further(const MeshShare<Dim>& share, Eigen::VectorXd& depth) {
    bool has_changed = false;
    for (const auto cell : share.mesh.cells.colwise()) {
        double least = kUnseen;
        for (const std::uint32_t vertex : cell) {
            least = std::min(least, depth[vertex]);
        }
        for (const std::uint32_t vertex : cell) {
            if (depth[vertex] > least + 1 && share.owns(vertex)) {
                depth[vertex] = least + 1;
                has_changed = true;
            }
        }
    }
    return has_changed;
}

}  // namespace

// A rank has both cells of a facet with a corner of its own: of such a corner it knows whether it
// is on the boundary, of others their ranks do.
template <int Dim>
MeshDepth depth_of(const MeshShare<Dim>& share) {
    const SimplexMesh<Dim>& mesh = share.mesh;
    Eigen::VectorXd depth = Eigen::VectorXd::Constant(mesh.vertex_count(), kUnseen);
    const FacetMatch<Dim> facets = match_facets<Dim>(mesh.cells, mesh.vertex_count());
    std::int64_t on_boundary = 0;
    for (const std::uint32_t vertex : facets.boundary.reshaped()) {
        if (share.owns(vertex) && depth[vertex] > 0) {
            depth[vertex] = 0;
            ++on_boundary;
        }
    }
    FallingValues others(share);
    for (bool has_changed = true; has_changed;) {
        has_changed = !others.take_over(depth).empty();
        has_changed = others.any(take_further(share, depth) || has_changed);
    }
    double deepest = 0;
    for (const double edges : depth) {
        deepest = edges < kUnseen ? std::max(deepest, edges) : deepest;
    }
    const std::vector<double> all = list(share.ranks, deepest);
    deepest = *std::max_element(all.begin(), all.end());
    return {.boundary_vertices = sum(share.ranks, on_boundary),
            .cells_across = std::max(1, 2 * static_cast<int>(deepest))};
}

template <int Dim>
std::int64_t count_selected(const MeshShare<Dim>& share,
                            const std::vector<Selection>& select,
                            const std::string& where) {
    const std::vector<bool> marks = mark_vertices(share.mesh, select, where);
    std::int64_t own = 0;
    for (std::uint32_t vertex = 0; vertex < marks.size(); ++vertex) {
        own += marks[vertex] && share.owns(vertex) ? 1 : 0;
    }
    return sum(share.ranks, own);
}

#define PENT_INSTANTIATE(Dim)                                        \
    template MeshDepth depth_of<Dim>(const MeshShare<Dim>&);         \
    template std::int64_t count_selected<Dim>(const MeshShare<Dim>&, \
                                              const std::vector<Selection>&, const std::string&);
PENT_FOR_EACH_DIMENSION(PENT_INSTANTIATE)
#undef PENT_INSTANTIATE

}  // namespace pent::simulator
