#pragma once

#include "model/bodies.h"
#include "potentials/potential.h"
#include "potentials/spring.h"

#include <pent/simulator/host.h>

#include <cstdint>
#include <vector>

namespace pent::simulator {

/// The springs by which a host holds points of bodies; see Grab. Between steps the energy of one
/// that is stretched beyond its largest force F is F |d| - F^2 / (2 k), of which that force is the
/// gradient; in a step it is the quadratic that pulls as hard where the step starts. Without grabs
/// it does no work and is in no report.
template <int Dim>
class Grabs final : public Potential<Dim> {
public:
    using Holding = typename HostState<Dim>::Holding;

    /// @param bodies  Must outlive this.
    Grabs(const Scene& scene, const Bodies<Dim>& bodies) : bodies_(&bodies), dt_(scene.dt()) {}

    /// Takes these in place of all others; each has its max_force.
    ///
    /// @param time  Of the start of the next step, s: until its end anchors are under way.
    void set(const std::vector<Holding>& holdings, double time);
    [[nodiscard]] const std::vector<Holding>& holdings() const { return holdings_; }

    /// A step has ended: anchors are where they were to be.
    void arrive();

    [[nodiscard]] double evaluate(const Positions<Dim>& x, Positions<Dim>& gradient) override;
    void add_hessian(const Positions<Dim>& x,
                     double weight,
                     Filter filter,
                     NewtonSystem<Dim>& system) override;
    [[nodiscard]] std::vector<TermEnergy> energies() const override;
    [[nodiscard]] bool begin_step(const StepStart<Dim>& start) override;
    [[nodiscard]] bool set_time(const TimeSpan& step) override;
    void add_couplings(Couplings& couplings) const override;

private:
    struct Pull : Spring<Dim> {
        SpringLaw law;  // as it is now
        Matrix<Dim> hessian = Matrix<Dim>::Zero();
    };

    const Bodies<Dim>* bodies_;
    double dt_;
    std::vector<Holding> holdings_;
    std::vector<Pull> pulls_;  // one a holding
    double start_ = 0;         // of the step in which anchors are under way, s
    double rate_ = 0;          // 1/s; 0 between steps
    double energy_ = 0;
    double damping_energy_ = 0;
};

/// The largest force of a grab that names none; see Grab::max_force.
template <int Dim>
[[nodiscard]] double bearable_force(const Bodies<Dim>& bodies, const BodyPoint<Dim>& point);

}  // namespace pent::simulator
