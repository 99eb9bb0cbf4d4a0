#pragma once

#include "linear/block_matrix.h"
#include "linear/dof_map.h"
#include "linear/hessian_stencil.h"
#include "linear/stencil_assembly.h"

#include <pent/simulator/solver_options.h>

#include <memory>
#include <variant>
#include <vector>

namespace pent::simulator {

/// The linear equation H dx = right of Newton's method while potentials put it together.
///
/// Columns of H for vertices that have no dof, but are moved by a known `displacement`, go to the
/// right side. Elements have their blocks on a fixed pattern. Stencils may couple any vertices;
/// what the pattern has no place for becomes a second part of the matrix, made anew by each
/// finish().
template <int Dim>
class NewtonSystem {
public:
    using Matrix = std::variant<BlockMatrix<Dim, float>, BlockMatrix<Dim, double>>;

    /// @param workers, dofs, pattern  Must outlive this.
    NewtonSystem(const Workers& workers,
                 const DofMap& dofs,
                 const BlockPattern& pattern,
                 Precision precision);

    /// Starts anew: H = 0.
    ///
    /// @param right         Dim x dofs.
    /// @param displacement  Dim x vertices: how far vertices without a dof move, m; 0 for others.
    void begin(BlockVector<Dim> right, Positions<Dim> displacement);

    /// Adds weight * masses to the diagonal.
    ///
    /// @param masses  One a vertex, kg.
    void add_masses(double weight, const Eigen::VectorXd& masses);

    /// H += weight * matrix, on the same pattern.
    void add_matrix(double weight, const BlockMatrix<Dim, double>& matrix);

    void add_stencil(const HessianStencil& stencil) { stencils_.push_back(stencil); }
    void reserve_stencils(std::size_t more) { stencils_.reserve(stencils_.size() + more); }

    /// Compares masses with the rounding of the stiffness, once everything has been added. Where
    /// that would hide them has_lost_inertia() and needs_double() say so; where it would merely
    /// show, finish() compensates for what float has rounded of elements, see
    /// BlockMatrix::compensate().
    void weigh_masses();

    /// Sums up the stencils, each row by one thread in the order in which they were added. Comes
    /// after weigh_masses(). Releases `displacement`.
    void finish();

    /// Whether masses are lost in the rounding of this matrix.
    [[nodiscard]] bool has_lost_inertia() const;
    /// Whether masses are lost in float, or would be, if this matrix is in double.
    [[nodiscard]] bool needs_double() const { return needs_double_; }
    [[nodiscard]] bool has_stencils() const { return !stencils_.empty(); }

    [[nodiscard]] Matrix& matrix() { return matrix_; }
    [[nodiscard]] const Matrix& matrix() const { return matrix_; }
    [[nodiscard]] BlockVector<Dim>& right() { return right_; }
    [[nodiscard]] const BlockVector<Dim>& right() const { return right_; }
    [[nodiscard]] const Positions<Dim>& prescribed_displacement() const {
        return prescribed_displacement_;
    }

private:
    [[nodiscard]] bool do_stencils_drown(double max_ratio) const;

    const Workers* workers_;
    const DofMap* dofs_;
    Matrix matrix_;
    // What stencils couple beyond the pattern, or null.
    std::variant<std::unique_ptr<CouplingMatrix<Dim, float>>,
                 std::unique_ptr<CouplingMatrix<Dim, double>>>
        coupling_;
    BlockVector<Dim> right_;
    Eigen::VectorXd masses_;  // of dofs: what add_masses() has added, kg
    Positions<Dim> prescribed_displacement_;
    std::vector<HessianStencil> stencils_;
    // What weigh_masses() has found.
    bool is_rounded_ = false;  // rigid motions would show rounding to float
    bool needs_double_ = false;
    bool is_lost_in_double_ = false;
};

}  // namespace pent::simulator
