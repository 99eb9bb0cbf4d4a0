#include "potentials/rayleigh_damping.h"

#include <pent/dimensions.h>

#include <utility>

namespace pent::simulator {

template <int Dim>
bool RayleighDamping<Dim>::begin_step(const StepStart<Dim>& start) {
    is_on_ = !start.is_linear;
    if (!is_on_) {
        return true;
    }
    origin_ = start.origin;
    if (!tangent_) {
        pattern_ = elasticity_->pattern();
        tangent_ = std::make_unique<BlockMatrix<Dim, double>>(*pattern_);
    }
    tangent_->set_zero(*workers_);
    dirichlet_part_.setZero(Dim, dofs_->count());
    elasticity_->add_tangent(start.positions, filter_, start.prescribed_displacement, *tangent_,
                             dirichlet_part_);
    dirichlet_part_ = -dirichlet_part_;
    hessians_ += elasticity_->element_count();
    return true;
}

template <int Dim>
double RayleighDamping<Dim>::evaluate(const Positions<Dim>& x, Positions<Dim>& gradient) {
    if (!is_on_) {
        return 0;
    }
    const BlockVector<Dim> displacement = at_dofs<Dim>(*dofs_, x - origin_);
    BlockVector<Dim> resistance(Dim, displacement.cols());
    tangent_->multiply(*workers_, *kernels_, displacement, resistance);
    const auto rows = static_cast<Eigen::Index>(dofs_->row_count());
    Positions<Dim> forces = Positions<Dim>::Zero(Dim, gradient.cols());
    for (Eigen::Index dof = 0; dof < rows; ++dof) {
        forces.col(dofs_->vertex_of(static_cast<std::uint32_t>(dof))) =
            resistance.col(dof) + dirichlet_part_.col(dof);
    }
    sharing_->gather(forces);
    gradient += forces;
    const auto along = [&](const BlockVector<Dim>& force) {
        return force.leftCols(rows).cwiseProduct(displacement.leftCols(rows)).sum();
    };
    return sharing_->sum(0.5 * along(resistance) + along(dirichlet_part_));
}

template <int Dim>
void RayleighDamping<Dim>::add_hessian(const Positions<Dim>& /*x*/,
                                       double weight,
                                       Filter /*filter*/,
                                       NewtonSystem<Dim>& system) {
    if (is_on_) {
        system.add_matrix(weight, *tangent_);
    }
}

template <int Dim>
std::int64_t RayleighDamping<Dim>::take_hessians() {
    return std::exchange(hessians_, 0);
}

#define PENT_INSTANTIATE(Dim) template class RayleighDamping<Dim>;
PENT_FOR_EACH_DIMENSION(PENT_INSTANTIATE)
#undef PENT_INSTANTIATE

}  // namespace pent::simulator
