#pragma once

#include <pent/simplex_mesh.h>

#include <cassert>
#include <cstdint>
#include <span>
#include <vector>

namespace pent::simulator {

/// Which vertices are solved for, and in which order: the only place that knows.
///
/// A dof is a vertex with Dim unknowns. Vertices of one extrusion column come one after the other,
/// from layer to layer; columns (single vertices, where a mesh knows no columns) in reverse
/// Cuthill-McKee order, which keeps neighbors close in memory [cuthill1969].
///
/// With ranks the dofs of this rank come first; only they have rows in its matrix. Ghosts follow,
/// as columns alone: dofs of other ranks to which those rows may be coupled.
class DofMap {
public:
    DofMap() = default;

    /// @param vertex_of_dof  Distinct vertices, in the order of their dofs.
    /// @param column_start   Dofs of extrusion column c: [start[c], start[c + 1]). Columns cover
    ///                       the dofs that have rows, and no ghosts.
    /// @param is_own         One entry a vertex, with a dof or not: whether it is of this rank;
    ///                       empty if all are.
    DofMap(std::size_t vertices,
           std::vector<std::uint32_t> vertex_of_dof,
           std::vector<std::uint32_t> column_start,
           std::vector<bool> is_own = {});

    [[nodiscard]] std::uint32_t count() const {
        return static_cast<std::uint32_t>(vertex_of_dof_.size());
    }

    /// How many have rows here: all but the ghosts.
    [[nodiscard]] std::uint32_t row_count() const { return column_start_.back(); }

    [[nodiscard]] bool has_dof(std::uint32_t vertex) const { return index_[vertex] < count(); }

    /// Only for a vertex that has one.
    [[nodiscard]] std::uint32_t dof_of(std::uint32_t vertex) const {
        assert(has_dof(vertex));
        return index_[vertex];
    }
    [[nodiscard]] std::uint32_t vertex_of(std::uint32_t dof) const { return vertex_of_dof_[dof]; }

    /// One a dof.
    [[nodiscard]] const std::vector<std::uint32_t>& vertices() const { return vertex_of_dof_; }

    /// The dof of a vertex, or count() + vertex for one that has none: an order of all vertices in
    /// which those come last.
    [[nodiscard]] std::uint32_t index_of(std::uint32_t vertex) const { return index_[vertex]; }

    /// The same, one a vertex.
    [[nodiscard]] const std::vector<std::uint32_t>& indices() const { return index_; }

    /// Dofs of column c: [start[c], start[c + 1]); those that have rows.
    [[nodiscard]] const std::vector<std::uint32_t>& column_start() const { return column_start_; }

    [[nodiscard]] std::size_t vertex_count() const { return index_.size(); }

    /// Whether a vertex is of this rank.
    [[nodiscard]] bool is_own(std::uint32_t vertex) const {
        return is_own_.empty() || is_own_[vertex];
    }

private:
    std::vector<std::uint32_t> index_;
    std::vector<std::uint32_t> vertex_of_dof_;
    std::vector<std::uint32_t> column_start_ = {0};
    std::vector<bool> is_own_;
};

/// Extrusion columns of all bodies, numbered through, and places within them. One entry a vertex.
struct Columns {
    std::vector<std::uint32_t> columns;  ///< Vertices with the same number form a column; no gaps.
    std::vector<std::uint32_t> layers;   ///< Place within the column.
};

/// @param cells     Of all bodies, vertices counted through.
/// @param is_fixed  One entry a vertex: those that get no dof.
template <int Dim>
[[nodiscard]] DofMap number_dofs(const Simplices<Dim + 1>& cells,
                                 const std::vector<bool>& is_fixed,
                                 const Columns& columns);

/// The columns of the vertices that have dofs, in their order: Dim x dofs.
template <int Dim>
[[nodiscard]] Positions<Dim> at_dofs(const DofMap& dofs, const Positions<Dim>& vertices) {
    Positions<Dim> values(Dim, dofs.count());
    for (std::uint32_t dof = 0; dof < dofs.count(); ++dof) {
        values.col(dof) = vertices.col(dofs.vertex_of(dof));
    }
    return values;
}

}  // namespace pent::simulator
