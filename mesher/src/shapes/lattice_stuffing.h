#pragma once

#include "lattice_grid.h"

#include <pent/simplex_mesh.h>

#include <cstdint>
#include <optional>
#include <vector>

namespace pent::mesher {

/// What the lattice simplices have inside a solid, as a mesh.
struct StuffedMesh {
    SimplexMesh<4> mesh;
    std::vector<bool> is_on_surface;  ///< One a vertex.
};

/// Stuffs a solid with the simplices of a lattice [labelle2007], in four dimensions.
///
/// A lattice point moves onto the surface if an edge from it is cut near it. Simplices that are
/// then cut by the surface get the pieces of cut_simplex(); as lattice points have one order,
/// neighbors agree.
class LatticeStuffing {
public:
    LatticeStuffing(const Solid& solid, const LatticeGrid& grid);

    /// The mesh as things are. Throws an Error for more than 2^32 - 1 vertices.
    [[nodiscard]] StuffedMesh mesh();

    /// Lets lattice points stay where they are that had moved to these vertices of the last mesh.
    /// Returns how many; without any to move back, meshes are sound.
    std::int64_t move_back(const std::vector<bool>& vertices);

private:
    struct Numbering {
        std::vector<std::uint32_t> vertices;  // of points; of the first cut of those that have none
        std::vector<std::uint32_t> first_vertex;  // of blocks
        std::vector<std::uint64_t> first_cell;
    };

    void find_cuts();
    void find_cuts_of(std::uint32_t point);
    void move_points();
    [[nodiscard]] Eigen::Vector4d moved(std::uint32_t point,
                                        const Eigen::Vector4d& nearest_cut) const;
    [[nodiscard]] Side side_of(std::uint32_t point) const {
        return point == LatticeGrid::kNone ? Side::Outside : sides_[point];
    }
    [[nodiscard]] bool is_used(std::uint32_t point) const;
    [[nodiscard]] unsigned cuts_from(std::uint32_t point) const;
    [[nodiscard]] bool is_cut(std::uint32_t point, unsigned step) const {
        return (steps_cut_[point] >> step & 1U) != 0;
    }
    [[nodiscard]] double cut_part(std::uint32_t point, unsigned step) const;
    [[nodiscard]] Eigen::Vector4d cut_place(std::uint32_t point,
                                            unsigned step,
                                            double least_part = 0) const;
    [[nodiscard]] std::optional<Eigen::Vector4d> cut_near(std::uint32_t point) const;
    template <typename Visit>
    void visit_pieces(std::uint32_t point, const Visit& visit) const;
    void number_vertices();
    void write_vertices(std::uint32_t block, StuffedMesh& result) const;
    void write_cells(std::uint32_t block, SimplexMesh<4>& mesh) const;

    const Solid* solid_;
    const LatticeGrid* grid_;
    std::vector<Side> sides_;                // of points
    std::vector<std::uint16_t> steps_cut_;   // of points: bit s if the edge along step s is cut
    std::vector<std::uint32_t> first_cut_;   // of points, in their block's list
    std::vector<std::vector<double>> cuts_;  // of blocks: parts of edges from their lower ends
    std::vector<std::vector<std::pair<std::uint32_t, Eigen::Vector4d>>>
        moved_;  // of blocks, by point
    Numbering numbering_;
};

}  // namespace pent::mesher
