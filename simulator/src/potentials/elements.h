#pragma once

#include "kernels/kernels.h"
#include "linear/block_matrix.h"
#include "model/cell_range.h"
#include "model/quadratic_cells.h"
#include "potentials/own_elements.h"
#include "potentials/smoothing.h"

#include <pent/parallel.h>
#include <pent/simplex_mesh.h>
#include <pent/simulator/scene.h>

#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

namespace pent::simulator {

template <int Dim>
class ActiveStrain;

/// Makes the Hessian times `scale` go into a matrix, without the part of held vertices.
template <int Dim, typename Scalar>
[[nodiscard]] HessianTarget<Scalar> target_in(BlockMatrix<Dim, Scalar>& matrix,
                                              double scale,
                                              Filter filter) {
    return {.values = matrix.values(), .scale = scale, .filter = filter};
}

/// The sums over elastic elements.
struct ElasticEnergy : RunEnergy {
    std::vector<double> of_ranges;  ///< J: of every range of cells.

    void add(const ElasticEnergy& other);
};

/// The elastic elements of all bodies, those with at least one vertex that has a dof, laid out for
/// kernels: cells, the domains of smoothed cells, or quadratic cells. Where vertices are shared by
/// ranks, those with a vertex of this rank. What is added up or counted of them over all ranks has
/// each once; gradients and rows of the matrix are whole for the vertices of this rank.
template <int Dim>
class Elements {
public:
    /// @param rest     Rest positions of all vertices, Dim x n.
    /// @param cells    All cells, positively oriented.
    /// @param ranges   They cover all cells.
    /// @param pattern  Of the matrix that add_hessian() fills.
    /// @param strain   Of what activate() will be called with; null if it will not be.
    /// @param grips    If not null: those that are held and strained in place of those with a dof,
    ///                 see is_held_and_strained().
    Elements(const Positions<Dim>& rest,
             const Simplices<Dim + 1>& cells,
             const std::vector<CellRange>& ranges,
             const DofMap& dofs,
             const BlockPattern& pattern,
             const ActiveStrain<Dim>* strain = nullptr,
             const Grips* grips = nullptr);

    /// @param domains  Of each range.
    Elements(const std::vector<SmoothingDomains<Dim>>& domains,
             const std::vector<CellRange>& ranges,
             const DofMap& dofs,
             const BlockPattern& pattern,
             const Grips* grips = nullptr);

    /// @param quadratic  With mean dilatation.
    Elements(const Positions<Dim>& rest,
             const QuadraticCells<Dim>& quadratic,
             const DofMap& dofs,
             const BlockPattern& pattern,
             const ActiveStrain<Dim>* strain = nullptr,
             const Grips* grips = nullptr);

    /// Gives elements the rest shapes that activations make of them now.
    void activate(const Workers& workers, const ActiveStrain<Dim>& strain);

    /// Adds the gradient of the elastic energy to `gradient` (Dim x vertices); returns the energy.
    ElasticEnergy add_gradient(const Workers& workers,
                               const Kernels<Dim>& kernels,
                               const Positions<Dim>& positions,
                               Positions<Dim>& gradient) const;

    /// Adds the filtered Hessian; returns how many elements the filter changed.
    template <typename Scalar>
    std::int64_t add_hessian(const Workers& workers,
                             const Kernels<Dim>& kernels,
                             const Positions<Dim>& positions,
                             const HessianTarget<Scalar>& target) const;

    [[nodiscard]] std::int64_t count() const { return count_; }  ///< Of those that count here.
    [[nodiscard]] std::int64_t bytes() const;

private:
    // One element as in ElementRun.
    struct Element {
        std::vector<std::uint32_t> corners;
        std::vector<double> rest;  // without the volume, and what is missing to more corners
        double volume = 0;
    };

    // Elements of one range of cells that, but for padding, have the same number of corners.
    struct Chunk {
        ElementKind kind = ElementKind::Linear;
        int elements = 0;
        int corners = 0;
        Material material;
        std::size_t range = 0;  // of cells, that it is of
        bool counts = true;     // here; if not, on another rank
        double collapse_norm = 0;
        std::size_t first_rest = 0;  // where its rows begin in the arrays
        std::size_t first_corner = 0;
        std::size_t first_block = 0;
    };

    // A chunk of which an element is activated, with its rest shape as it is without that.
    struct Passive {
        std::size_t chunk = 0;
        std::vector<Eigen::Index> elements;
        std::vector<double> rest;  // its rows
    };

    Elements(std::size_t ranges, const DofMap& dofs, const BlockPattern& pattern);

    // A chunk to be made, and its elements.
    struct Plan {
        Chunk like;
        std::span<const Eigen::Index> elements;
    };

    // Plans chunks of so many elements, or of what is left at the end of a range.
    //
    // @param like_of  Gives what a chunk is like by its range and its elements.
    template <typename LikeOf>
    [[nodiscard]] static std::vector<Plan> plan(const std::vector<OwnAndShared>& chosen,
                                                std::size_t size,
                                                const LikeOf& like_of);

    // Reserves arrays at the size that they need: while an array grows its memory is there twice.
    //
    // @param make  Fills in an element by its range and number.
    template <typename Make>
    void append(const std::vector<Plan>& plans,
                const Make& make,
                const DofMap& dofs,
                const BlockPattern& pattern,
                const ActiveStrain<Dim>* strain);
    template <typename Make>
    void append(const Plan& plan,
                const Make& make,
                const DofMap& dofs,
                const BlockPattern& pattern);
    void reserve(const std::vector<Plan>& plans);
    [[nodiscard]] static std::size_t lanes_of(const Plan& plan) {
        return (plan.elements.size() + kGroup - 1) / kGroup * kGroup;
    }
    void set_lane(const Element& element,
                  const Chunk& chunk,
                  std::size_t lane,
                  const DofMap& dofs,
                  const BlockPattern& pattern);
    [[nodiscard]] static std::size_t rest_rows(const Chunk& chunk);
    void keep_passive(std::span<const Eigen::Index> chosen, const ActiveStrain<Dim>* strain);
    void activate(const Passive& passive, const ActiveStrain<Dim>& strain);
    void color(std::size_t vertices);
    [[nodiscard]] ElementRun run(int chunk) const;

    std::vector<std::uint32_t> indices_;  // DofMap::index_of of every vertex
    std::vector<double> rest_;
    std::vector<std::uint32_t> vertices_;
    std::vector<std::int32_t> blocks_;
    std::vector<Chunk> chunks_;
    std::vector<Passive> passive_;
    Coloring coloring_;
    std::size_t ranges_ = 0;
    std::uint32_t dof_count_ = 0;
    std::int64_t count_ = 0;
};

}  // namespace pent::simulator
