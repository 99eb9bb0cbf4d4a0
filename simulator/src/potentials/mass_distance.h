#pragma once

#include "potentials/potential.h"

#include <pent/parallel.h>

#include <memory>
#include <utility>

namespace pent::simulator {

/// Half the squared distance from an anchor, weighed by masses: 1/2 |x - anchor|_M^2, kg m^2.
///
/// With the place to which inertia alone would lead as the anchor it is the inertia of a time step;
/// with the place from which the velocity counts, the part of Rayleigh damping that is proportional
/// to mass.
template <int Dim>
class MassDistance final : public Potential<Dim> {
public:
    /// @param dofs    Of the vertices that count.
    /// @param masses  One a vertex, kg. These and `workers` must outlive this.
    MassDistance(const Workers& workers,
                 std::shared_ptr<const DofMap> dofs,
                 const Eigen::VectorXd& masses)
        : workers_(&workers), dofs_(std::move(dofs)), masses_(&masses) {}

    void set_dofs(std::shared_ptr<const DofMap> dofs) { dofs_ = std::move(dofs); }

    /// @param anchor  Dim x vertices, m.
    void set_anchor(std::shared_ptr<const Positions<Dim>> anchor) { anchor_ = std::move(anchor); }

    [[nodiscard]] double evaluate(const Positions<Dim>& x, Positions<Dim>& gradient) override;
    void add_hessian(const Positions<Dim>& /*x*/,
                     double weight,
                     Filter /*filter*/,
                     NewtonSystem<Dim>& system) override {
        system.add_masses(weight, *masses_);
    }

private:
    const Workers* workers_;
    std::shared_ptr<const DofMap> dofs_;
    const Eigen::VectorXd* masses_;
    std::shared_ptr<const Positions<Dim>> anchor_;
};

}  // namespace pent::simulator
