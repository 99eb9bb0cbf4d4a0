#pragma once

#include "potentials/potential.h"

#include <pent/parallel.h>

namespace pent::simulator {

/// Half the squared distance from an anchor, weighed by masses: 1/2 |x - anchor|_M^2, kg m^2.
///
/// With the place that inertia alone would lead to for an anchor it is the inertia of a time step;
/// with the place from which its velocity counts it is the part of Rayleigh damping that masses
/// make.
template <int Dim>
class MassDistance final : public Potential<Dim> {
public:
    /// @param dofs    Of the vertices that count.
    /// @param masses  One a vertex, kg. All must outlive this.
    MassDistance(const Workers& workers, const DofMap& dofs, const Eigen::VectorXd& masses)
        : workers_(&workers), dofs_(&dofs), masses_(&masses) {}

    /// @param anchor  Dim x vertices, m; must outlive its use.
    void set_anchor(const Positions<Dim>& anchor) { anchor_ = &anchor; }

    [[nodiscard]] double evaluate(const Positions<Dim>& x, Positions<Dim>& gradient) override;
    void add_hessian(double weight, Filter /*filter*/, NewtonSystem<Dim>& system) override {
        system.add_masses(weight, *masses_);
    }

private:
    const Workers* workers_;
    const DofMap* dofs_;
    const Eigen::VectorXd* masses_;
    const Positions<Dim>* anchor_ = nullptr;
};

}  // namespace pent::simulator
