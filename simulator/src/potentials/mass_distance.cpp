#include "potentials/mass_distance.h"

#include "potentials/vertex_chunks.h"

#include <pent/dimensions.h>

namespace pent::simulator {

template <int Dim>
double MassDistance<Dim>::evaluate(const Positions<Dim>& x, Positions<Dim>& gradient) {
    return sum_vertices(*workers_, dofs_->count(), [&](Eigen::Index dof) {
        const std::uint32_t v = dofs_->vertex_of(static_cast<std::uint32_t>(dof));
        const Eigen::Matrix<double, Dim, 1> pull = (*masses_)[v] * (x.col(v) - anchor_->col(v));
        gradient.col(v) += pull;
        return 0.5 * pull.dot(x.col(v) - anchor_->col(v));
    });
}

#define PENT_INSTANTIATE(Dim) template class MassDistance<Dim>;
PENT_FOR_EACH_DIMENSION(PENT_INSTANTIATE)
#undef PENT_INSTANTIATE

}  // namespace pent::simulator
