#pragma once

#include <cstdint>
#include <vector>

namespace pent::mesher {

/// What enumeration proves about cutting the prism over a simplex into simplices without adding
/// points, when each rectangle above an edge is cut by the diagonal that the edge's direction
/// names.
struct DecompositionProof {
    int base_vertices = 0;  ///< n; the prism has dimension n, 2 n corners and n simplices.

    std::int64_t orientations = 0;  ///< All 2^(n (n-1) / 2) ways to direct the edges.
    std::int64_t acyclic = 0;       ///< Those without a cycle: n!, one for each order.
    std::int64_t filled =
        0;  ///< Acyclic ones whose path decomposition fills the prism, every facet
            ///< shared or on the boundary, with exactly the cuts asked for.

    bool is_searched = false;        ///< All subsets of simplices were tried (n up to 4).
    std::int64_t unique = 0;         ///< If searched: acyclic ones with exactly one decomposition.
    std::int64_t impossible = 0;     ///< If searched: cyclic ones without any.
    std::int64_t with_triangle = 0;  ///< Cyclic ones with a directed 3-cycle; the prism over that
                                     ///< triangle is a face, and impossible for n = 3.

    std::int64_t neighbors = 0;  ///< Orders of two base simplices with a common facet: (n + 1)!.
    std::int64_t agreeing = 0;   ///< Those for which both cut the prism between them alike.

    /// Acyclic directions work, cyclic ones cannot, and neighbors agree.
    [[nodiscard]] bool holds() const;
};

/// Proves it for one size of base simplex, in exact integer arithmetic.
///
/// That n simplices fill the prism follows from three things that are checked: each has volume
/// 1 / n!, which makes the volume of the prism; every facet inside is shared by two of them from
/// opposite sides; no facet on the boundary is there twice. So each point is covered equally often,
/// and the volume says once.
///
/// @param base_vertices  2 to 6.
[[nodiscard]] DecompositionProof prove_decompositions(int base_vertices);

/// A set of the prism's corners: bit i for the bottom of vertex i, bit n + i for its top.
using Corners = std::uint32_t;

/// The n simplices {b0..bk, tk..t(n-1)} over the base vertices in the given order.
[[nodiscard]] std::vector<Corners> path_decomposition(const std::vector<int>& order);

}  // namespace pent::mesher
