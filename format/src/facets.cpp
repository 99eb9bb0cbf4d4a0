#include "pent/facets.h"

#include <algorithm>
#include <array>

namespace pent {

namespace {

// A facet by its sorted corners without the lowest, which is the bucket it lies in.
template <int Dim>
struct SortedFacet {
    std::array<std::uint32_t, Dim - 1> rest;
    std::uint32_t cell;
    std::uint8_t corner;  // which corner of the cell it lacks
    bool is_even;         // whether sorting its outward corners was an even permutation
};

// Corners of facet k of a cell, in an outward order.
template <int Dim>
std::array<std::uint32_t, Dim> outward_facet(const Simplices<Dim + 1>& cells,
                                             Eigen::Index cell,
                                             int k) {
    std::array<std::uint32_t, Dim> facet{};
    for (int i = 0, at = 0; i <= Dim; ++i) {
        if (i != k) {
            facet[at++] = cells(i, cell);
        }
    }
    if (k % 2 == 1) {
        std::swap(facet[Dim - 2], facet[Dim - 1]);
    }
    return facet;
}

// Sorts a few numbers; returns whether the permutation was even.
template <std::size_t Size>
bool sort_with_parity(std::array<std::uint32_t, Size>& values) {
    bool is_even = true;
    for (std::size_t i = 1; i < Size; ++i) {
        for (std::size_t j = i; j > 0 && values[j] < values[j - 1]; --j) {
            std::swap(values[j], values[j - 1]);
            is_even = !is_even;
        }
    }
    return is_even;
}

// Calls visit(cell, k) for every facet of every cell, in order.
template <int Dim, typename Visit>
void for_each_facet(const Simplices<Dim + 1>& cells, Visit&& visit) {
    for (Eigen::Index cell = 0; cell < cells.cols(); ++cell) {
        for (int k = 0; k <= Dim; ++k) {
            visit(cell, k);
        }
    }
}

// All facets, grouped by their lowest corner (counting sort), then sorted within each group.
template <int Dim>
std::vector<SortedFacet<Dim>> sorted_facets(const Simplices<Dim + 1>& cells,
                                            Eigen::Index vertices,
                                            std::vector<std::size_t>& bucket) {
    bucket.assign(static_cast<std::size_t>(vertices) + 1, 0);
    for_each_facet<Dim>(cells, [&](Eigen::Index cell, int k) {
        const auto facet = outward_facet<Dim>(cells, cell, k);
        ++bucket[*std::min_element(facet.begin(), facet.end()) + 1];
    });
    for (std::size_t i = 1; i < bucket.size(); ++i) {
        bucket[i] += bucket[i - 1];
    }
    std::vector<SortedFacet<Dim>> sorted(bucket.back());
    std::vector<std::size_t> next(bucket.begin(), bucket.end() - 1);
    for_each_facet<Dim>(cells, [&](Eigen::Index cell, int k) {
        auto facet = outward_facet<Dim>(cells, cell, k);
        const bool is_even = sort_with_parity(facet);
        SortedFacet<Dim>& entry = sorted[next[facet[0]]++];
        std::copy(facet.begin() + 1, facet.end(), entry.rest.begin());
        entry.cell = static_cast<std::uint32_t>(cell);
        entry.corner = static_cast<std::uint8_t>(k);
        entry.is_even = is_even;
    });
    for (std::size_t i = 0; i + 1 < bucket.size(); ++i) {
        std::sort(sorted.begin() + static_cast<std::ptrdiff_t>(bucket[i]),
                  sorted.begin() + static_cast<std::ptrdiff_t>(bucket[i + 1]),
                  [](const SortedFacet<Dim>& a, const SortedFacet<Dim>& b) {
                      return a.rest != b.rest ? a.rest < b.rest : a.cell < b.cell;
                  });
    }
    return sorted;
}

}  // namespace

template <int Dim>
FacetMatch<Dim> match_facets(const Simplices<Dim + 1>& cells, Eigen::Index vertices) {
    struct CellFacet {
        std::uint32_t cell;
        std::uint8_t corner;
    };
    std::vector<std::size_t> bucket;
    const std::vector<SortedFacet<Dim>> sorted = sorted_facets<Dim>(cells, vertices, bucket);

    FacetMatch<Dim> match;
    std::vector<CellFacet> boundary;
    const auto blame = [&match](std::uint32_t cell) {
        if (match.first_fault < 0 || cell < match.first_fault) {
            match.first_fault = cell;
        }
    };
    for (std::size_t group = 0; group + 1 < bucket.size(); ++group) {
        for (std::size_t i = bucket[group]; i < bucket[group + 1];) {
            std::size_t end = i + 1;
            while (end < bucket[group + 1] && sorted[end].rest == sorted[i].rest) {
                ++end;
            }
            if (end - i == 1) {
                boundary.push_back({sorted[i].cell, sorted[i].corner});
            } else if (end - i > 2) {
                ++match.overfull;
                blame(sorted[i].cell);
            } else if (sorted[i].is_even == sorted[i + 1].is_even) {
                ++match.one_sided;
                blame(sorted[i].cell);
            } else {
                ++match.interior;
            }
            i = end;
        }
    }
    std::sort(boundary.begin(), boundary.end(), [](const CellFacet& a, const CellFacet& b) {
        return a.cell != b.cell ? a.cell < b.cell : a.corner < b.corner;
    });
    match.boundary.resize(Dim, static_cast<Eigen::Index>(boundary.size()));
    match.boundary_cells.reserve(boundary.size());
    for (std::size_t i = 0; i < boundary.size(); ++i) {
        const auto facet = outward_facet<Dim>(cells, boundary[i].cell, boundary[i].corner);
        for (int k = 0; k < Dim; ++k) {
            match.boundary(k, static_cast<Eigen::Index>(i)) = facet[k];
        }
        match.boundary_cells.push_back(boundary[i].cell);
    }
    return match;
}

template FacetMatch<2> match_facets<2>(const Simplices<3>&, Eigen::Index);
template FacetMatch<3> match_facets<3>(const Simplices<4>&, Eigen::Index);
template FacetMatch<4> match_facets<4>(const Simplices<5>&, Eigen::Index);

}  // namespace pent
