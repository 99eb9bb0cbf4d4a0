#pragma once

#include <Eigen/Core>

#include <array>
#include <cstdint>
#include <span>
#include <string>
#include <vector>

namespace pent::mesher {

/// What a cell of a file is. Cells of higher order have their corners first and more nodes behind.
enum class CellKind : std::uint8_t {
    Tetrahedron,
    Pyramid,     ///< Corners around its base, then the tip.
    Prism,       ///< Over a triangle: corners of one end, then those of the other.
    Hexahedron,  ///< Corners around one side, then those of the opposite one.
    PentagonalPrism,
    HexagonalPrism,
    Polyhedron,  ///< Any other cell of three dimensions.
    Triangle,
    Quadrilateral,
    Polygon,
    Line,
    Point,
};
inline constexpr std::size_t kCellKinds = 12;

[[nodiscard]] int dimension_of(CellKind kind);

/// How many corners a cell of this kind has; 0 where that differs or does not matter.
[[nodiscard]] std::size_t corners_of(CellKind kind);

/// Faces as positions of corners, counterclockwise from outside if the last corners lie above the
/// first ones; the fourth of a triangle is -1. Empty for kinds that are not cut.
using CellFace = std::array<int, 4>;
[[nodiscard]] std::span<const CellFace> faces_of(CellKind kind);

/// How many cells of each kind there are.
using CellCounts = std::array<std::int64_t, kCellKinds>;

/// As in "2 hexahedra, 1 prism", of the kinds from `first` to `last`; empty if there are none.
[[nodiscard]] std::string list_counts(const CellCounts& counts, CellKind first, CellKind last);

/// Points and cells as a file lists them. Of cells with fewer than three dimensions only the number
/// is kept.
struct CellSoup {
    std::vector<Eigen::Vector3d> points;
    std::vector<CellKind> kinds;         ///< Of each cell of three dimensions.
    std::vector<std::uint32_t> corners;  ///< Theirs, one cell after the other; indices of points.
    std::vector<std::int64_t> labels;    ///< Theirs.
    bool has_labels = false;
    CellCounts counts{};
    std::int64_t curved_cells = 0;  ///< Of three dimensions with more nodes than corners.

    /// @param nodes  At least as many as the kind has corners; of those only the corners are kept.
    void add(CellKind kind, std::span<const std::uint32_t> nodes, std::int64_t label = 0);
};

}  // namespace pent::mesher
