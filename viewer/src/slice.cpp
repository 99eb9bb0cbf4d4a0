#include "pent/viewer/slice.h"

#include <pent/parallel.h>

#include <array>
#include <cstdint>
#include <vector>

namespace pent::viewer {

namespace {

// How a tetrahedron is cut, by which of its corners are above: bit k of the mask for corner k.
// Each triangle is three edges of the tetrahedron, numbered 01 02 03 12 13 23.
struct TetCut {
    int triangles = 0;
    std::array<std::array<std::uint8_t, 3>, 2> edges{};
};

// For an outward tetrahedron with corner 0 alone above, e_k the edge points seen from corner 0:
//     0 < det[n, e1, e2, e3] = -(height of 0) det3[n, e2 - e1, e3 - e1],
// so 01, 03, 02 turns outward. With corner 1 raised too, 01 gives way to 12 and 13, and the
// quadrilateral is 03, 02, 12, 13. The others are even permutations of the corners of these two;
// changing above for below reverses.
constexpr std::array<TetCut, 16> kTetCuts = {{
    {},
    {1, {{{0, 2, 1}}}},             // 0 above
    {1, {{{0, 3, 4}}}},             // 1
    {2, {{{2, 1, 3}, {2, 3, 4}}}},  // 0 1
    {1, {{{1, 5, 3}}}},             // 2
    {2, {{{0, 2, 5}, {0, 5, 3}}}},  // 0 2
    {2, {{{4, 0, 1}, {4, 1, 5}}}},  // 1 2
    {1, {{{2, 5, 4}}}},             // 0 1 2
    {1, {{{2, 4, 5}}}},             // 3
    {2, {{{4, 1, 0}, {4, 5, 1}}}},  // 0 3
    {2, {{{0, 5, 2}, {0, 3, 5}}}},  // 1 3
    {1, {{{1, 3, 5}}}},             // 0 1 3
    {2, {{{1, 2, 4}, {1, 4, 3}}}},  // 2 3
    {1, {{{0, 4, 3}}}},             // 0 2 3
    {1, {{{0, 1, 2}}}},             // 1 2 3
    {},
}};

// Replaces counts by the sums of those before, and gives the total.
std::uint32_t exclusive_sum(std::vector<std::uint32_t>& counts) {
    std::uint32_t sum = 0;
    for (std::uint32_t& count : counts) {
        const std::uint32_t here = count;
        count = sum;
        sum += here;
    }
    return sum;
}

int mask_above(const Eigen::Vector4<std::uint32_t>& tet, const Eigen::VectorXd& heights) {
    int mask = 0;
    for (int k = 0; k < 4; ++k) {
        mask |= heights[tet[k]] < 0 ? 0 : 1 << k;
    }
    return mask;
}

// One surface vertex per cut edge; gives the number of each.
std::vector<std::uint32_t> cut_edges(const Boundary<4>& boundary,
                                     const Positions<4>& positions,
                                     const FramedHyperplane& hyperplane,
                                     const Eigen::VectorXd& heights,
                                     Surface& surface) {
    const Simplices<2>& edges = boundary.edges;
    const auto is_cut = [&](Eigen::Index e) {
        return (heights[edges(0, e)] < 0) != (heights[edges(1, e)] < 0);
    };
    std::vector<std::uint32_t> numbers(static_cast<std::size_t>(edges.cols()));
    parallel_for(edges.cols(), kLightChunk,
                 [&](Eigen::Index e) { numbers[e] = is_cut(e) ? 1 : 0; });
    const std::uint32_t vertices = exclusive_sum(numbers);
    surface.positions.resize(3, vertices);
    surface.ends.resize(2, vertices);
    surface.weights.resize(vertices);
    const Eigen::Matrix<double, 3, 4> axes = hyperplane.frame.topRows<3>();
    parallel_for(edges.cols(), kLightChunk, [&](Eigen::Index e) {
        if (!is_cut(e)) {
            return;
        }
        const std::uint32_t a = edges(0, e);
        const std::uint32_t b = edges(1, e);
        const double t = heights[a] / (heights[a] - heights[b]);
        const std::uint32_t v = numbers[e];
        // Exactly an end where t is 0 or 1, unlike a + t (b - a).
        const Eigen::Vector4d point = (1.0 - t) * positions.col(a) + t * positions.col(b);
        surface.positions.col(v) = axes * point;
        surface.ends.col(v) << a, b;
        surface.weights[v] = t;
    });
    return numbers;
}

}  // namespace

Eigen::VectorXd distances(const Positions<4>& positions, const FramedHyperplane& hyperplane) {
    const Eigen::RowVector4d normal = hyperplane.frame.row(3);
    Eigen::VectorXd heights(positions.cols());
    parallel_for(positions.cols(), kLightChunk, [&](Eigen::Index v) {
        heights[v] = normal.dot(positions.col(v)) - hyperplane.offset;
    });
    return heights;
}

Surface slice(const Boundary<4>& boundary,
              const Positions<4>& positions,
              const FramedHyperplane& hyperplane) {
    const Eigen::VectorXd heights = distances(positions, hyperplane);
    Surface surface;
    const std::vector<std::uint32_t> numbers =
        cut_edges(boundary, positions, hyperplane, heights, surface);

    std::vector<std::uint32_t> first(static_cast<std::size_t>(boundary.facets.cols()));
    parallel_for(boundary.facets.cols(), kLightChunk, [&](Eigen::Index f) {
        const TetCut& cut = kTetCuts[mask_above(boundary.facets.col(f), heights)];
        first[f] = static_cast<std::uint32_t>(cut.triangles);
    });
    const std::uint32_t triangles = exclusive_sum(first);
    surface.triangles.resize(3, triangles);
    surface.facets.resize(triangles);
    parallel_for(boundary.facets.cols(), kLightChunk, [&](Eigen::Index f) {
        const TetCut& cut = kTetCuts[mask_above(boundary.facets.col(f), heights)];
        for (int t = 0; t < cut.triangles; ++t) {
            const std::uint32_t triangle = first[f] + static_cast<std::uint32_t>(t);
            for (int k = 0; k < 3; ++k) {
                surface.triangles(k, triangle) = numbers[boundary.facet_edges(cut.edges[t][k], f)];
            }
            surface.facets[triangle] = static_cast<std::uint32_t>(f);
        }
    });
    return surface;
}

Surface skin(const Boundary<3>& boundary, const Positions<3>& positions) {
    Surface surface;
    std::vector<std::uint32_t> numbers(static_cast<std::size_t>(positions.cols()));
    for (Eigen::Index v = 0; v < positions.cols(); ++v) {
        numbers[v] = boundary.vertex_begin[v] < boundary.vertex_begin[v + 1] ? 1 : 0;
    }
    const std::uint32_t vertices = exclusive_sum(numbers);
    surface.positions.resize(3, vertices);
    surface.ends.resize(2, vertices);
    surface.weights.setZero(vertices);
    for (Eigen::Index v = 0; v < positions.cols(); ++v) {
        if (boundary.vertex_begin[v] < boundary.vertex_begin[v + 1]) {
            surface.positions.col(numbers[v]) = positions.col(v);
            surface.ends.col(numbers[v]).setConstant(static_cast<std::uint32_t>(v));
        }
    }
    surface.triangles = boundary.facets.unaryExpr([&](std::uint32_t v) { return numbers[v]; });
    surface.facets.resize(static_cast<std::size_t>(boundary.facets.cols()));
    for (std::size_t f = 0; f < surface.facets.size(); ++f) {
        surface.facets[f] = static_cast<std::uint32_t>(f);
    }
    return surface;
}

}  // namespace pent::viewer
