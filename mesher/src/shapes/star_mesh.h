#pragma once

#include <pent/simplex_mesh.h>

#include <cstdint>
#include <limits>
#include <span>
#include <vector>

namespace pent::mesher {

/// Of the mean ratios of the cells around a vertex.
struct StarQuality {
    double least = std::numeric_limits<double>::infinity();
    double sum = 0;
};

/// A mesh to change in places: the cells around each vertex are at hand.
class StarMesh {
public:
    explicit StarMesh(SimplexMesh<4> mesh);

    [[nodiscard]] std::uint32_t vertex_count() const {
        return static_cast<std::uint32_t>(places_.size());
    }
    [[nodiscard]] const Eigen::Vector4d& place(std::uint32_t vertex) const {
        return places_[vertex];
    }
    [[nodiscard]] const std::array<std::uint32_t, 5>& cell(std::uint32_t cell) const {
        return cells_[cell];
    }
    [[nodiscard]] std::uint32_t cell_count() const {
        return static_cast<std::uint32_t>(cells_.size());
    }
    /// The cells that have a vertex.
    [[nodiscard]] const std::vector<std::uint32_t>& star(std::uint32_t vertex) const {
        return stars_[vertex];
    }
    /// The cells that have all of some vertices.
    [[nodiscard]] std::vector<std::uint32_t> star(std::span<const std::uint32_t> simplex) const;

    /// Mean ratio of a cell; negative if it is turned over.
    [[nodiscard]] double quality(std::uint32_t cell) const;

    /// Of the cells around a vertex if it were elsewhere.
    [[nodiscard]] StarQuality quality_if_moved(std::uint32_t vertex,
                                               const Eigen::Vector4d& place) const;

    /// Slope of the logarithm of a cell's mean ratio over the place of one of its corners, 1/m.
    [[nodiscard]] Eigen::Vector4d quality_slope(std::uint32_t cell, std::uint32_t vertex) const;

    /// The least quality of the cells that splitting a simplex at a place would make.
    [[nodiscard]] double quality_if_split(std::span<const std::uint32_t> simplex,
                                          const Eigen::Vector4d& place) const;

    void move(std::uint32_t vertex, const Eigen::Vector4d& place);

    /// Puts a new vertex into an edge, triangle or tetrahedron of the mesh: each cell that has it
    /// becomes as many as it has corners. Conforming as the mesh was. Returns the vertex, which is
    /// the last.
    std::uint32_t split(std::span<const std::uint32_t> simplex, const Eigen::Vector4d& place);

    /// A version number of the cells around a vertex: another one after each move or split that
    /// changed one of them.
    [[nodiscard]] std::uint32_t change(std::uint32_t vertex) const { return changes_[vertex]; }

    [[nodiscard]] SimplexMesh<4> mesh() const;

private:
    void note_change(std::span<const std::uint32_t> cells);

    std::vector<Eigen::Vector4d> places_;
    std::vector<std::array<std::uint32_t, 5>> cells_;
    std::vector<std::vector<std::uint32_t>> stars_;
    std::vector<std::uint32_t> changes_;
    std::uint32_t last_change_ = 0;
};

}  // namespace pent::mesher
