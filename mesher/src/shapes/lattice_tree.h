#pragma once

#include "lattice.h"

#include <pent/mesher/size_field.h>
#include <pent/mesher/solid.h>
#include <pent/mesher/stuff.h>

#include <array>
#include <bitset>
#include <compare>
#include <cstdint>
#include <unordered_set>
#include <utility>
#include <vector>

namespace pent::mesher {

/// The lattice in and around a solid, as cells of 24 simplices each whose sides are powers of two
/// times the smallest spacing; cells that touch differ by one power at most.
///
/// Where a cell touches smaller ones, edges of its simplices have their middles, and the pieces of
/// halved_simplices() are its simplices, so that all fit together. Points are numbered along a
/// Morton curve: along the paths of a cell numbers ascend.
class LatticeTree {
public:
    static constexpr std::uint32_t kNone = 0xffffffff;

    /// Every simplex with a corner inside is there. Throws an Error for NaN and for more cells than
    /// can be kept.
    ///
    /// @param solid     Bounded.
    /// @param smallest  The lattice where `sizes` asks for the shortest edges.
    LatticeTree(const Solid& solid, const Lattice& smallest, const SizeField& sizes);

    [[nodiscard]] const Lattice& lattice() const { return lattice_; }
    [[nodiscard]] std::uint32_t point_count() const {
        return static_cast<std::uint32_t>(keys_.size());
    }
    [[nodiscard]] std::uint32_t cell_count() const {
        return static_cast<std::uint32_t>(cells_.size());
    }

    [[nodiscard]] Eigen::Vector4d place(std::uint32_t point) const;
    [[nodiscard]] double value(std::uint32_t point) const { return values_[point]; }

    /// Where edges go through the surface twice.
    [[nodiscard]] const ThinParts& thin_parts() const { return thin_parts_; }

    /// The smallest cell that has a point is 2^size() spacings long.
    [[nodiscard]] int size(std::uint32_t point) const { return sizes_[point]; }

    /// Calls visit(corners, is_odd) for every simplex of a cell: points ascending, and whether that
    /// order turns it over.
    template <typename Visit>
    void visit_simplices(std::uint32_t cell, const Visit& visit) const;

private:
    static constexpr unsigned kCorners = 16;
    static constexpr unsigned kPlaces = 81;  // corners, and middles between them
    using Places = std::array<std::uint32_t, kPlaces>;
    using Simplex = std::array<std::uint32_t, 5>;

    struct Cell {
        std::uint64_t key = 0;  // of its first corner
        std::uint8_t size = 0;
        bool is_inside = false;  // with all of its points
    };
    struct ThinEdge {
        std::uint32_t a = 0;
        std::uint32_t b = 0;  // the larger
        double width = 0;     // of what is between
        auto operator<=>(const ThinEdge&) const = default;
    };
    struct Node;
    struct PatternTable;

    void set_range(const Solid& solid, const SizeField& sizes);
    template <typename Split, typename Leaf>
    void descend(const Solid& solid, const Node& node, const Split& split, const Leaf& leaf) const;
    template <typename Split, typename Leaf>
    void descend(const Solid& solid, const Split& split, const Leaf& leaf) const;
    void choose_cells(const Solid& solid, const SizeField& sizes);
    void balance();
    [[nodiscard]] std::bitset<kPlaces> middles_of(const Cell& cell) const;
    void number_points(const std::vector<std::bitset<kPlaces>>& middles);
    void sample(const Solid& solid);
    [[nodiscard]] double steepest() const;
    template <typename Visit>
    void visit_near_edges(std::uint32_t task,
                          const std::vector<double>& distances,
                          const Visit& visit) const;
    [[nodiscard]] ThinParts summary(const std::vector<std::vector<ThinEdge>>& found) const;
    [[nodiscard]] ThinParts find_thin_parts(const Solid& solid) const;
    void leave_out_what_is_outside();
    void visit_halved(const Places& places,
                      unsigned path,
                      std::vector<std::pair<Simplex, bool>>& simplices) const;
    [[nodiscard]] static const PatternTable& patterns();

    Lattice lattice_;
    Eigen::Vector4i low_;    // where keys begin
    Eigen::Vector4i count_;  // of the largest cells
    int top_ = 0;            // size of the largest cells to begin with
    int largest_ = 0;        // size of the largest cells that may stay
    std::vector<std::unordered_set<std::uint64_t>> split_;  // by size: cells made of smaller ones
    std::vector<Cell> cells_;
    std::vector<std::array<std::uint32_t, kCorners>> corners_;  // one a cell
    std::vector<std::uint32_t> halved_;                         // one a cell: of places_, or kNone
    std::vector<Places> places_;
    std::vector<std::uint64_t> keys_;
    std::vector<double> values_;
    std::vector<std::uint8_t> sizes_;
    ThinParts thin_parts_;
};

template <typename Visit>
void LatticeTree::visit_simplices(std::uint32_t cell, const Visit& visit) const {
    const auto& paths = lattice_paths();
    if (halved_[cell] == kNone) {
        const auto& corners = corners_[cell];
        for (const LatticePath& path : paths) {
            Simplex simplex{};
            for (int i = 0; i < 5; ++i) {
                simplex[i] = corners[path.steps[i]];
            }
            visit(simplex, path.is_odd);
        }
        return;
    }
    std::vector<std::pair<Simplex, bool>> simplices;
    for (unsigned path = 0; path < paths.size(); ++path) {
        visit_halved(places_[halved_[cell]], path, simplices);
    }
    for (const auto& [simplex, is_odd] : simplices) {
        visit(simplex, is_odd);
    }
}

}  // namespace pent::mesher
