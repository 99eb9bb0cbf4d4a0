#pragma once

#include "potentials/potential.h"

#include <pent/parallel.h>

namespace pent::simulator {

/// Gravity: -sum of m g . x. Without any, g = 0, it does no work and is in no report.
template <int Dim>
class Gravity final : public Potential<Dim> {
public:
    using Vector = Eigen::Matrix<double, Dim, 1>;

    /// @param masses        One a vertex, kg; must outlive this, as must the workers.
    /// @param acceleration  g, m/s^2.
    Gravity(const Workers& workers, const Eigen::VectorXd& masses, const Vector& acceleration)
        : workers_(&workers), masses_(&masses), acceleration_(acceleration) {}

    void set_acceleration(const Vector& acceleration) { acceleration_ = acceleration; }

    [[nodiscard]] double evaluate(const Positions<Dim>& x, Positions<Dim>& gradient) override;
    void add_hessian(const Positions<Dim>& /*x*/,
                     double /*weight*/,
                     Filter /*filter*/,
                     NewtonSystem<Dim>& /*system*/) override {}
    [[nodiscard]] std::vector<TermEnergy> energies() const override {
        return acceleration_.isZero(0) ? std::vector<TermEnergy>()
                                       : std::vector<TermEnergy>{{"gravity", energy_}};
    }

private:
    const Workers* workers_;
    const Eigen::VectorXd* masses_;
    Vector acceleration_;
    double energy_ = 0;
};

}  // namespace pent::simulator
