#include "pent/facets.h"

#include <algorithm>
#include <array>
#include <bit>
#include <utility>

namespace pent {

namespace {

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

// The two lowest corners of a cell.
template <int Dim>
std::pair<std::uint32_t, std::uint32_t> lowest_two(const Simplices<Dim + 1>& cells,
                                                   Eigen::Index cell) {
    std::uint32_t lowest = std::min(cells(0, cell), cells(1, cell));
    std::uint32_t second = std::max(cells(0, cell), cells(1, cell));
    for (int i = 2; i <= Dim; ++i) {
        const std::uint32_t corner = cells(i, cell);
        second = std::min(second, std::max(corner, lowest));
        lowest = std::min(lowest, corner);
    }
    return {lowest, second};
}

// For every vertex the cells with a facet whose lowest corner it is: those where it is the lowest
// corner, or the second lowest. Both kinds in one list, in the order of the cells.
template <int Dim>
struct CellsByLowestCorner {
    std::vector<std::size_t> begin;    // vertices + 1 offsets into cells
    std::vector<std::uint32_t> cells;  // two entries a cell

    CellsByLowestCorner(const Simplices<Dim + 1>& all, Eigen::Index vertices)
        : begin(static_cast<std::size_t>(vertices) + 1, 0),
          cells(2 * static_cast<std::size_t>(all.cols())) {
        for (Eigen::Index cell = 0; cell < all.cols(); ++cell) {
            const auto [lowest, second] = lowest_two<Dim>(all, cell);
            ++begin[lowest];
            ++begin[second];
        }
        std::size_t sum = 0;
        for (std::size_t& offset : begin) {
            sum += std::exchange(offset, sum);
        }
        std::vector<std::size_t> next(begin.begin(), begin.end() - 1);
        for (Eigen::Index cell = 0; cell < all.cols(); ++cell) {
            const auto [lowest, second] = lowest_two<Dim>(all, cell);
            cells[next[lowest]++] = static_cast<std::uint32_t>(cell);
            cells[next[second]++] = static_cast<std::uint32_t>(cell);
        }
    }
};

// The facets with one lowest corner, found by their other corners: a small hash table with open
// addressing, emptied for each lowest corner. Its order decides nothing.
template <int Dim>
class FacetTable {
public:
    struct Entry {
        std::array<std::uint32_t, Dim - 1> rest;  // sorted corners without the lowest
        std::uint32_t cell;                       // the first cell that has it
        std::uint32_t apex;                       // the corner of that cell that it lacks
        std::uint32_t count;                      // cells that have it
        bool is_outward;                          // its sorted order is outward there
        bool is_one_sided;                        // the second cell saw it from the same side
    };

    void clear(std::size_t most_entries) {
        entries_.clear();
        slots_.assign(std::bit_ceil(2 * most_entries + 1), kEmpty);
    }

    void add(const std::array<std::uint32_t, Dim - 1>& rest,
             std::uint32_t cell,
             std::uint32_t apex,
             bool is_outward) {
        const std::size_t mask = slots_.size() - 1;
        for (std::size_t slot = hash(rest) & mask;; slot = (slot + 1) & mask) {
            if (slots_[slot] == kEmpty) {
                slots_[slot] = static_cast<std::uint32_t>(entries_.size());
                entries_.push_back({rest, cell, apex, 1, is_outward, false});
                return;
            }
            Entry& entry = entries_[slots_[slot]];
            if (entry.rest == rest) {
                ++entry.count;
                entry.is_one_sided = entry.is_outward == is_outward;
                return;
            }
        }
    }

    [[nodiscard]] const std::vector<Entry>& entries() const { return entries_; }

private:
    static constexpr std::uint32_t kEmpty = 0xFFFFFFFFU;

    static std::size_t hash(const std::array<std::uint32_t, Dim - 1>& rest) {
        std::uint64_t value = 0;
        for (const std::uint32_t corner : rest) {
            value = (value ^ corner) * 0x9E3779B97F4A7C15U;  // 2^64 / golden ratio
        }
        return value >> 32;
    }

    std::vector<Entry> entries_;
    std::vector<std::uint32_t> slots_;
};

// Adds the facets of a cell whose lowest corner is `vertex`. With the corners of a positively
// oriented cell sorted, by a permutation of parity p, the facet without corner j, in sorted order,
// is outward when j + p is even.
template <int Dim>
void add_facets(const Simplices<Dim + 1>& cells,
                std::uint32_t cell,
                std::uint32_t vertex,
                FacetTable<Dim>& table) {
    std::array<std::uint32_t, Dim + 1> corners{};
    std::copy_n(cells.col(cell).data(), Dim + 1, corners.begin());
    const bool is_even = sort_with_parity(corners);
    std::array<std::uint32_t, Dim - 1> rest{};
    if (corners[0] != vertex) {  // then it is the second lowest: the facet without the lowest
        std::copy(corners.begin() + 2, corners.end(), rest.begin());
        table.add(rest, cell, corners[0], is_even);
        return;
    }
    for (int j = 1; j <= Dim; ++j) {
        std::copy(corners.begin() + 1, corners.begin() + j, rest.begin());
        std::copy(corners.begin() + j + 1, corners.end(), rest.begin() + j - 1);
        table.add(rest, cell, corners[j], (j % 2 == 0) == is_even);
    }
}

struct CellFacet {
    std::uint32_t cell;
    int corner;  // which corner of the cell it lacks
};

template <int Dim>
void copy_boundary(const Simplices<Dim + 1>& cells,
                   const std::vector<CellFacet>& boundary,
                   FacetMatch<Dim>& match) {
    match.boundary.resize(Dim, static_cast<Eigen::Index>(boundary.size()));
    match.boundary_cells.reserve(boundary.size());
    for (std::size_t i = 0; i < boundary.size(); ++i) {
        const auto facet = outward_facet<Dim>(cells, boundary[i].cell, boundary[i].corner);
        std::copy(facet.begin(), facet.end(),
                  match.boundary.col(static_cast<Eigen::Index>(i)).data());
        match.boundary_cells.push_back(boundary[i].cell);
    }
}

}  // namespace

template <int Dim>
FacetMatch<Dim> match_facets(const Simplices<Dim + 1>& cells,
                             Eigen::Index vertices,
                             const std::function<bool(std::uint32_t)>& is_counted) {
    const CellsByLowestCorner<Dim> by_corner(cells, vertices);
    FacetTable<Dim> table;
    FacetMatch<Dim> match;
    std::vector<CellFacet> boundary;
    for (std::uint32_t vertex = 0; vertex + 1 < by_corner.begin.size(); ++vertex) {
        const std::size_t begin = by_corner.begin[vertex];
        const std::size_t end = by_corner.begin[vertex + 1];
        if (is_counted && !is_counted(vertex)) {
            continue;
        }
        table.clear(Dim * (end - begin));
        for (std::size_t i = begin; i < end; ++i) {
            add_facets<Dim>(cells, by_corner.cells[i], vertex, table);
        }
        for (const auto& entry : table.entries()) {
            if (entry.count == 1) {
                const auto cell = cells.col(entry.cell);
                const auto* corner = std::find(cell.data(), cell.data() + Dim + 1, entry.apex);
                boundary.push_back({entry.cell, static_cast<int>(corner - cell.data())});
            } else if (entry.count == 2 && !entry.is_one_sided) {
                ++match.interior;
            } else {
                ++(entry.count > 2 ? match.overfull : match.one_sided);
                if (match.first_fault < 0 || entry.cell < match.first_fault) {
                    match.first_fault = entry.cell;
                }
            }
        }
    }
    std::sort(boundary.begin(), boundary.end(), [](const CellFacet& a, const CellFacet& b) {
        return a.cell != b.cell ? a.cell < b.cell : a.corner < b.corner;
    });
    copy_boundary<Dim>(cells, boundary, match);
    return match;
}

#define PENT_INSTANTIATE(Dim)                                                           \
    template FacetMatch<Dim> match_facets<Dim>(const Simplices<Dim + 1>&, Eigen::Index, \
                                               const std::function<bool(std::uint32_t)>&);
PENT_INSTANTIATE(2)
PENT_INSTANTIATE(3)
PENT_INSTANTIATE(4)
#undef PENT_INSTANTIATE

}  // namespace pent
