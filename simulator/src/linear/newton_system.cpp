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

template <typename Scalar>
constexpr double kRounding = static_cast<double>(std::numeric_limits<Scalar>::epsilon());

// How many rows have masses so small beside their stiffness that its rounding matters.
struct RowCounts {
    std::int64_t rounded = 0;         // to float: to be compensated for
    std::int64_t lost_in_float = 0;   // to float: too much for that
    std::int64_t lost_in_double = 0;  // to double

    RowCounts& operator+=(const RowCounts& other) {
        rounded += other.rounded;
        lost_in_float += other.lost_in_float;
        lost_in_double += other.lost_in_double;
        return *this;
    }
};

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
    masses_.setZero(dofs_->count());
    is_rounded_ = false;
    needs_double_ = false;
    is_lost_in_double_ = false;
    std::visit(
        [&](auto& matrix) {
            matrix.set_coupling(nullptr);
            matrix.set_zero(*workers_);
        },
        matrix_);
}

template <int Dim>
void NewtonSystem<Dim>::add_masses(double weight, const Eigen::VectorXd& masses) {
    for (std::uint32_t dof = 0; dof < dofs_->count(); ++dof) {
        masses_[dof] += weight * masses[dofs_->vertex_of(dof)];
    }
    std::visit(
        [&](auto& matrix) {
            using Scalar = typename std::decay_t<decltype(matrix)>::Block::Scalar;
            matrix.for_each_row_chunk(*workers_, [&](std::int64_t begin, std::int64_t end) {
                for (std::int64_t row = begin; row < end; ++row) {
                    const double mass =
                        weight * masses[dofs_->vertex_of(static_cast<std::uint32_t>(row))];
                    matrix.add_to_diagonal(row, static_cast<Scalar>(mass));
                }
            });
        },
        matrix_);
}

// The stiffness of a free body cancels for rigid motions, so that what rounding leaves of it acts
// as a spurious stiffness beside the inertia. In float up to 2e-3 of the inertia are tolerated. Up
// to 4e-3 translations are compensated for; beyond, what is not compensated would show: rotations,
// and soft parts beside stiff ones. In double, where there is no higher precision to fall back on,
// 1e-2 are tolerated, as roundings partly cancel. Statics has no inertia to lose.
template <int Dim>
void NewtonSystem<Dim>::weigh_masses() {
    constexpr double kUnseen = 2e-3 / kRounding<float>;
    constexpr double kMaxInFloat = 4e-3 / kRounding<float>;
    constexpr double kMaxInDouble = 1e-2 / kRounding<double>;
    const RowCounts counts = std::visit(
        [&](const auto& matrix) {
            return matrix.sum_row_chunks(*workers_, [&](std::int64_t begin, std::int64_t end) {
                RowCounts found;
                for (std::int64_t row = begin; row < end; ++row) {
                    const double all = static_cast<double>(matrix.diagonal(row).trace()) / Dim;
                    const double mass = masses_[row];
                    found.rounded += mass > 0 && all > kUnseen * mass ? 1 : 0;
                    found.lost_in_float += mass > 0 && all > kMaxInFloat * mass ? 1 : 0;
                    found.lost_in_double += mass > 0 && all > kMaxInDouble * mass ? 1 : 0;
                }
                return found;
            });
        },
        matrix_);
    is_rounded_ = counts.rounded > 0;
    // What is rounded of stencils is not compensated for.
    needs_double_ = counts.lost_in_float > 0 || do_stencils_drown(kUnseen);
    is_lost_in_double_ = counts.lost_in_double > 0 || do_stencils_drown(kMaxInDouble);
}

template <int Dim>
bool NewtonSystem<Dim>::has_lost_inertia() const {
    return std::holds_alternative<BlockMatrix<Dim, float>>(matrix_) ? needs_double_
                                                                    : is_lost_in_double_;
}

// Looks at single stencils that ask for it. Those are springs: numbers[0] is their stiffness.
template <int Dim>
bool NewtonSystem<Dim>::do_stencils_drown(double max_ratio) const {
    for (const HessianStencil& stencil : stencils_) {
        for (std::int32_t i = 0; stencil.is_checked && i < stencil.count; ++i) {
            const std::uint32_t vertex = stencil.vertices[i];
            const double stiffness =
                stencil.scale * stencil.weights[i] * stencil.weights[i] * stencil.numbers[0];
            const double mass = dofs_->has_dof(vertex) ? masses_[dofs_->dof_of(vertex)] : 0;
            if (mass > 0 && stiffness > max_ratio * mass) {
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
        if (is_rounded_ && std::is_same_v<Scalar, float>) {
            matrix.compensate(*workers_, masses_);
        }
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
