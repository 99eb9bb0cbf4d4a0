#include "linear/newton_system.h"

#include <pent/dimensions.h>

#include <limits>
#include <type_traits>
#include <utility>

namespace pent::simulator {

namespace {

template <int Dim>
typename NewtonSystem<Dim>::Matrix make_matrix(const BlockPattern& pattern, Precision precision) {
    using Matrix = typename NewtonSystem<Dim>::Matrix;
    return precision == Precision::Float
               ? Matrix(std::in_place_type<BlockMatrix<Dim, float>>, pattern)
               : Matrix(std::in_place_type<BlockMatrix<Dim, double>>, pattern);
}

}  // namespace

template <int Dim>
NewtonSystem<Dim>::NewtonSystem(const Workers& workers,
                                const DofMap& dofs,
                                const BlockPattern& pattern,
                                Precision precision)
    : workers_(&workers), dofs_(&dofs), matrix_(make_matrix<Dim>(pattern, precision)) {}

template <int Dim>
void NewtonSystem<Dim>::begin(BlockVector<Dim> right, Positions<Dim> displacement) {
    right_ = std::move(right);
    prescribed_displacement_ = std::move(displacement);
    stencils_.clear();
    has_lost_inertia_ = false;
    std::visit(
        [&](auto& matrix) {
            matrix.set_coupling(nullptr);
            matrix.set_zero(*workers_);
        },
        matrix_);
}

// In a free body the stiffness cancels for rigid motions, and the rounding that is left takes the
// place of inertia: at most 2e-3 of it in floats, to which doubles are the remedy, and 1e-2, as
// rounding is not all of one sign, in doubles, to which there is none.
template <int Dim>
void NewtonSystem<Dim>::add_masses(double weight, const Eigen::VectorXd& masses) {
    const auto add = [&](auto& matrix) {
        using Scalar = typename std::decay_t<decltype(matrix)>::Block::Scalar;
        constexpr double kMaxRatio = (std::is_same_v<Scalar, float> ? 2e-3 : 1e-2)
                                     / static_cast<double>(std::numeric_limits<Scalar>::epsilon());
        return matrix.sum_row_chunks(*workers_, [&](std::int64_t begin, std::int64_t end) {
            int lost = 0;
            for (std::int64_t row = begin; row < end; ++row) {
                const double mass =
                    weight * masses[dofs_->vertex_of(static_cast<std::uint32_t>(row))];
                auto diagonal = matrix.diagonal(row);
                lost += static_cast<double>(diagonal.trace()) / Dim > kMaxRatio * mass ? 1 : 0;
                diagonal.diagonal().array() += static_cast<Scalar>(mass);
            }
            return lost;
        }) > 0 || do_stencils_drown(kMaxRatio, weight, masses);
    };
    has_lost_inertia_ = std::visit(add, matrix_) || has_lost_inertia_;
}

// Of single stencils that are to be checked, by their largest diagonal entries.
template <int Dim>
bool NewtonSystem<Dim>::do_stencils_drown(double max_ratio,
                                          double weight,
                                          const Eigen::VectorXd& masses) const {
    for (const HessianStencil& stencil : stencils_) {
        for (std::int32_t i = 0; stencil.is_checked && i < stencil.count; ++i) {
            const std::uint32_t vertex = stencil.vertices[i];
            const double stiffness =
                stencil.scale * stencil.weights[i] * stencil.weights[i] * stencil.matrix[0];
            if (dofs_->has_dof(vertex) && stiffness > max_ratio * weight * masses[vertex]) {
                return true;
            }
        }
    }
    return false;
}

template <int Dim>
void NewtonSystem<Dim>::add_matrix(double weight, const BlockMatrix<Dim, double>& matrix) {
    std::visit([&](auto& sum) { sum.add_scaled(*workers_, weight, matrix); }, matrix_);
}

template <int Dim>
void NewtonSystem<Dim>::finish() {
    const auto add = [&](auto& matrix) {
        using Scalar = typename std::decay_t<decltype(matrix)>::Block::Scalar;
        auto coupling = assemble_stencils<Dim, Scalar>(*workers_, *dofs_, stencils_,
                                                       prescribed_displacement_, matrix, right_);
        matrix.set_coupling(coupling ? &coupling->matrix : nullptr);
        coupling_ = std::move(coupling);
    };
    std::visit(add, matrix_);
    prescribed_displacement_.resize(Dim, 0);
}

#define PENT_INSTANTIATE(Dim) template class NewtonSystem<Dim>;
PENT_FOR_EACH_DIMENSION(PENT_INSTANTIATE)
#undef PENT_INSTANTIATE

}  // namespace pent::simulator
