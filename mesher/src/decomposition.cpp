#include <pent/mesher/decomposition.h>

#include <algorithm>
#include <array>
#include <bit>
#include <cassert>
#include <cstdlib>
#include <map>
#include <numeric>

namespace pent::mesher {

namespace {

constexpr int kMaxVertices = 6;
constexpr int kMaxSearched = 4;

// How the edges of a base simplex are directed: bit j of row i for an edge from i to j.
struct Orientation {
    int n = 0;
    std::array<std::uint32_t, kMaxVertices + 1> to{};

    [[nodiscard]] bool has(int i, int j) const { return (to[i] >> j & 1U) != 0; }
    void direct(int i, int j) { to[i] |= 1U << j; }
};

Orientation orientation(int n, std::uint32_t code) {
    Orientation result{n, {}};
    for (int i = 0; i < n; ++i) {
        for (int j = i + 1; j < n; ++j, code >>= 1U) {
            (code & 1U) == 0 ? result.direct(i, j) : result.direct(j, i);
        }
    }
    return result;
}

// A tournament without a cycle is an order: the vertex with k outgoing edges comes k-th from last.
std::vector<int> order_of(const Orientation& edges) {
    std::vector<int> order(edges.n, -1);
    for (int i = 0; i < edges.n; ++i) {
        order[edges.n - 1 - std::popcount(edges.to[i])] = i;
    }
    return std::find(order.begin(), order.end(), -1) == order.end() ? order : std::vector<int>();
}

bool has_directed_triangle(const Orientation& edges) {
    for (int i = 0; i < edges.n; ++i) {
        for (int j = 0; j < edges.n; ++j) {
            for (int k = 0; k < edges.n; ++k) {
                if (edges.has(i, j) && edges.has(j, k) && edges.has(k, i)) {
                    return true;
                }
            }
        }
    }
    return false;
}

// Determinant in integers, fraction-free (Bareiss). Entries are 0, 1 and -1 and stay small.
std::int64_t determinant(std::vector<std::vector<std::int64_t>> m) {
    const std::size_t n = m.size();
    std::int64_t sign = 1;
    std::int64_t divisor = 1;
    for (std::size_t k = 0; k + 1 < n; ++k) {
        std::size_t pivot = k;
        while (pivot < n && m[pivot][k] == 0) {
            ++pivot;
        }
        if (pivot == n) {
            return 0;
        }
        if (pivot != k) {
            std::swap(m[pivot], m[k]);
            sign = -sign;
        }
        for (std::size_t i = k + 1; i < n; ++i) {
            for (std::size_t j = k + 1; j < n; ++j) {
                m[i][j] = (m[i][j] * m[k][k] - m[i][k] * m[k][j]) / divisor;
            }
        }
        divisor = m[k][k];
    }
    return sign * m[n - 1][n - 1];
}

// Corner `bit` of the prism: base vertex 0 at the origin, the others at unit points, height 0 or 1.
std::vector<std::int64_t> place(int n, int bit) {
    std::vector<std::int64_t> point(n, 0);
    if (bit % n > 0) {
        point[bit % n - 1] = 1;
    }
    point[n - 1] = bit / n;
    return point;
}

std::vector<int> bits_of(Corners corners) {
    std::vector<int> bits;
    for (; corners != 0; corners &= corners - 1) {
        bits.push_back(std::countr_zero(corners));
    }
    return bits;
}

// n! times the signed volume of the simplex of some corners, in the order given.
std::int64_t volume(int n, const std::vector<int>& corners) {
    const std::vector<std::int64_t> origin = place(n, corners[0]);
    std::vector<std::vector<std::int64_t>> edges;
    for (std::size_t i = 1; i < corners.size(); ++i) {
        edges.push_back(place(n, corners[i]));
        for (int axis = 0; axis < n; ++axis) {
            edges.back()[axis] -= origin[axis];
        }
    }
    return determinant(edges);
}

// On which side of a facet a corner lies: the sign of a volume.
std::int64_t side(int n, Corners facet, int corner) {
    std::vector<int> corners = bits_of(facet);
    corners.push_back(corner);
    return volume(n, corners);
}

// A facet lies on the boundary if all its corners are at the bottom or at the top, or if it lacks
// both corners over some base vertex.
bool is_on_boundary(int n, Corners facet) {
    const Corners bottom = (1U << n) - 1;
    return (facet & ~bottom) == 0 || (facet & bottom) == 0
           || ((facet | facet >> n) & bottom) != bottom;
}

bool has_cuts(int n, Corners simplex, const Orientation& edges) {
    for (int i = 0; i < n; ++i) {
        for (int j = 0; j < n; ++j) {
            // The diagonal from the bottom of i to the top of j belongs to the edge from i to j.
            const Corners diagonal = (1U << i) | (1U << (n + j));
            if (i != j && (simplex & diagonal) == diagonal && !edges.has(i, j)) {
                return false;
            }
        }
    }
    return true;
}

// Whether simplices of the prism fill it: see prove_decompositions().
bool do_fill(int n, const std::vector<Corners>& simplices) {
    std::map<Corners, std::vector<std::int64_t>> sides_of_facets;
    std::int64_t total = 0;
    for (const Corners simplex : simplices) {
        const std::vector<int> corners = bits_of(simplex);
        if (static_cast<int>(corners.size()) != n + 1) {
            return false;
        }
        const std::int64_t size = std::abs(volume(n, corners));
        if (size == 0) {
            return false;
        }
        total += size;
        for (const int corner : corners) {
            const Corners facet = simplex & ~(1U << corner);
            sides_of_facets[facet].push_back(side(n, facet, corner));
        }
    }
    for (const auto& [facet, sides] : sides_of_facets) {
        const bool is_matched = is_on_boundary(n, facet)
                                    ? sides.size() == 1
                                    : sides.size() == 2 && (sides[0] > 0) != (sides[1] > 0);
        if (!is_matched) {
            return false;
        }
    }
    return total == n;  // the prism's volume is 1 / (n - 1)! = n / n!
}

// All simplices of the prism that are not flat.
std::vector<Corners> all_simplices(int n) {
    std::vector<Corners> simplices;
    for (Corners corners = 0; corners < 1U << (2 * n); ++corners) {
        if (std::popcount(corners) == n + 1 && volume(n, bits_of(corners)) != 0) {
            simplices.push_back(corners);
        }
    }
    return simplices;
}

// Number of ways to fill the prism with simplices that have the cuts: every subset is tried. Since
// no simplex is smaller than 1 / n!, none has more than n.
std::int64_t count_fillings(int n,
                            const std::vector<Corners>& allowed,
                            std::size_t next,
                            std::vector<Corners>& chosen) {
    std::int64_t found = do_fill(n, chosen) ? 1 : 0;
    if (static_cast<int>(chosen.size()) == n) {
        return found;
    }
    for (; next < allowed.size(); ++next) {
        chosen.push_back(allowed[next]);
        found += count_fillings(n, allowed, next + 1, chosen);
        chosen.pop_back();
    }
    return found;
}

std::int64_t count_fillings(int n, const std::vector<Corners>& all, const Orientation& edges) {
    std::vector<Corners> allowed;
    std::copy_if(all.begin(), all.end(), std::back_inserter(allowed),
                 [&](Corners simplex) { return has_cuts(n, simplex, edges); });
    std::vector<Corners> chosen;
    return count_fillings(n, allowed, 0, chosen);
}

// The facets with which simplices cut the side of the prism opposite to a base vertex; base
// vertices by the names given.
std::vector<std::uint64_t> cuts_of_side(const std::vector<Corners>& simplices,
                                        const std::vector<int>& names,
                                        int opposite) {
    const int n = static_cast<int>(names.size());
    std::vector<std::uint64_t> cuts;
    for (const Corners simplex : simplices) {
        const Corners facet = simplex & ~((1U << opposite) | (1U << (n + opposite)));
        if (std::popcount(facet) != n) {
            continue;  // both corners over that vertex are in it: it touches the side in less
        }
        std::uint64_t cut = 0;
        for (const int corner : bits_of(facet)) {
            cut |= std::uint64_t{1} << (corner / n * 32 + names[corner % n]);
        }
        cuts.push_back(cut);
    }
    std::sort(cuts.begin(), cuts.end());
    return cuts;
}

// Cuts between two base simplices, without vertex n and without vertex 0, from one side: the
// simplex lacks vertex `lacking`, its neighbor lacks `opposite`.
std::vector<std::uint64_t> cuts_from(const std::vector<int>& order, int lacking, int opposite) {
    std::vector<int> names;  // of this simplex's vertices
    for (int i = 0; i < static_cast<int>(order.size()); ++i) {
        if (i != lacking) {
            names.push_back(i);
        }
    }
    std::vector<int> own_order;
    for (const int name : order) {
        if (name != lacking) {
            own_order.push_back(
                static_cast<int>(std::find(names.begin(), names.end(), name) - names.begin()));
        }
    }
    const auto place_of_opposite = std::find(names.begin(), names.end(), opposite) - names.begin();
    return cuts_of_side(path_decomposition(own_order), names, static_cast<int>(place_of_opposite));
}

void count_neighbors(DecompositionProof& proof) {
    std::vector<int> order(proof.base_vertices + 1);
    std::iota(order.begin(), order.end(), 0);
    const int last = proof.base_vertices;
    do {
        ++proof.neighbors;
        const std::vector<std::uint64_t> cuts = cuts_from(order, last, 0);
        const bool is_complete = static_cast<int>(cuts.size()) == proof.base_vertices - 1;
        proof.agreeing += is_complete && cuts == cuts_from(order, 0, last) ? 1 : 0;
    } while (std::next_permutation(order.begin(), order.end()));
}

void count_orientation(const Orientation& edges,
                       const std::vector<Corners>& all,
                       DecompositionProof& proof) {
    const int n = edges.n;
    ++proof.orientations;
    const std::vector<int> order = order_of(edges);
    const bool is_acyclic = !order.empty();
    if (is_acyclic) {
        ++proof.acyclic;
        const std::vector<Corners> simplices = path_decomposition(order);
        const bool is_cut = std::all_of(simplices.begin(), simplices.end(), [&](Corners simplex) {
            return has_cuts(n, simplex, edges);
        });
        proof.filled += is_cut && do_fill(n, simplices) ? 1 : 0;
    } else {
        proof.with_triangle += has_directed_triangle(edges) ? 1 : 0;
    }
    if (proof.is_searched) {
        const std::int64_t found = count_fillings(n, all, edges);
        proof.unique += is_acyclic && found == 1 ? 1 : 0;
        proof.impossible += !is_acyclic && found == 0 ? 1 : 0;
    }
}

}  // namespace

bool DecompositionProof::holds() const {
    const std::int64_t cyclic = orientations - acyclic;
    return orientations > 0 && filled == acyclic && with_triangle == cyclic
           && (!is_searched || (unique == acyclic && impossible == cyclic))
           && agreeing == neighbors;
}

std::vector<Corners> path_decomposition(const std::vector<int>& order) {
    const auto n = static_cast<int>(order.size());
    std::vector<Corners> simplices(n, 0);
    for (int k = 0; k < n; ++k) {
        for (int i = 0; i <= k; ++i) {
            simplices[k] |= 1U << order[i];
        }
        for (int i = k; i < n; ++i) {
            simplices[k] |= 1U << (n + order[i]);
        }
    }
    return simplices;
}

DecompositionProof prove_decompositions(int base_vertices) {
    assert(base_vertices >= 2 && base_vertices <= kMaxVertices);
    DecompositionProof proof;
    proof.base_vertices = base_vertices;
    proof.is_searched = base_vertices <= kMaxSearched;
    const std::vector<Corners> all =
        proof.is_searched ? all_simplices(base_vertices) : std::vector<Corners>();
    const std::uint32_t codes = 1U << (base_vertices * (base_vertices - 1) / 2);
    for (std::uint32_t code = 0; code < codes; ++code) {
        count_orientation(orientation(base_vertices, code), all, proof);
    }
    count_neighbors(proof);
    return proof;
}

}  // namespace pent::mesher
