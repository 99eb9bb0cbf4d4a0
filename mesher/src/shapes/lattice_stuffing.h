#pragma once

#include "lattice_tree.h"

#include <pent/mesher/cut_simplex.h>
#include <pent/simplex_mesh.h>

#include <cstdint>
#include <utility>
#include <vector>

namespace pent::mesher {

/// What the lattice simplices have inside a solid, as a mesh.
struct StuffedMesh {
    SimplexMesh<4> mesh;
    std::vector<bool> is_on_surface;  ///< One a vertex.
    std::vector<std::uint8_t> sizes;  ///< One a vertex: edges there are about 2^this times as long
                                      ///< as the shortest.
};

/// Stuffs a solid with the simplices of a lattice [labelle2007], in four dimensions.
///
/// A lattice point moves onto the surface if an edge from it is cut near it. Simplices that are
/// then cut by the surface get the pieces of cut_simplex(); as lattice points have one order,
/// neighbors agree.
class LatticeStuffing {
public:
    LatticeStuffing(const Solid& solid, const LatticeTree& tree);

    /// The mesh as things are. Throws an Error for more than 2^32 - 1 vertices.
    [[nodiscard]] StuffedMesh mesh();

    /// Lets lattice points stay where they are that had moved to these vertices of the last mesh.
    /// Returns how many; without any to move back, meshes are sound.
    std::int64_t move_back(const std::vector<bool>& vertices);

private:
    using Simplex = std::array<std::uint32_t, 5>;

    // An edge with one end inside and one outside, as the solid has them.
    struct Edge {
        std::uint32_t from = 0;
        std::uint32_t to = 0;  // the larger
        double cut = 0;        // part of the way
    };
    struct Move {
        std::uint32_t point = 0;
        Eigen::Vector4d place;
    };
    struct Numbering {
        std::vector<std::uint32_t> points;      // the vertex of each that is used
        std::vector<std::uint32_t> cuts;        // of each edge that is cut
        std::vector<std::uint64_t> first_cell;  // of tasks
        std::uint32_t vertices = 0;
    };

    void find_edges();
    void find_cuts();
    void move_points();
    [[nodiscard]] std::vector<std::uint32_t> nearest_edges() const;
    [[nodiscard]] Eigen::Vector4d moved(std::uint32_t point, const Edge& edge) const;
    [[nodiscard]] bool is_cut(const Edge& edge) const {
        return sides_[edge.from] != Side::On && sides_[edge.to] != Side::On;
    }
    [[nodiscard]] std::uint32_t edge_between(std::uint32_t from, std::uint32_t to) const;
    [[nodiscard]] std::vector<std::uint8_t> used_points() const;
    template <typename Visit>
    void visit_pieces(std::uint32_t task, const Visit& visit) const;
    void number_vertices();
    void write_vertices(StuffedMesh& result) const;
    void write_cells(std::uint32_t task, SimplexMesh<4>& mesh) const;

    const Solid* solid_;
    const LatticeTree* tree_;
    std::vector<Side> sides_;                // of points
    std::vector<Edge> edges_;                // by `from`, then `to`
    std::vector<std::uint32_t> first_edge_;  // of points
    std::vector<Move> moves_;                // by point
    std::vector<std::uint8_t> is_used_;      // points that are vertices of the last mesh
    Numbering numbering_;
};

}  // namespace pent::mesher
