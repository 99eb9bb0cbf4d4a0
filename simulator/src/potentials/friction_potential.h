#pragma once

#include "potentials/contact_potential.h"
#include "potentials/potential.h"

#include <pent/contact/friction.h>

#include <vector>

namespace pent::simulator {

/// Friction of all contacts of a scene, with the normal forces, normals and weights that they have
/// at the start of a step: held, so that it has an energy. Nothing before the first step.
template <int Dim>
class FrictionPotential final : public Potential<Dim> {
public:
    /// @param contacts  What touches; must outlive this, and be evaluated where a step starts.
    FrictionPotential(const ContactPotential<Dim>& contacts, const contact::Friction& friction)
        : contacts_(&contacts), friction_(friction) {}

    /// Where a step begins that ends at another time, drops what is held of the last one, which
    /// does not belong to it: until begin_step() there is no friction. That is so, too, where a
    /// simulation was put to another time.
    [[nodiscard]] bool set_time(const TimeSpan& step) override;
    [[nodiscard]] bool begin_step(const StepStart<Dim>& start) override;
    [[nodiscard]] double evaluate(const Positions<Dim>& x, Positions<Dim>& gradient) override;
    void add_hessian(const Positions<Dim>& x,
                     double weight,
                     Filter filter,
                     NewtonSystem<Dim>& system) override;
    [[nodiscard]] std::vector<TermEnergy> energies() const override {
        return {{.name = "friction", .energy = energy_, .is_stored = false}};
    }

    /// Its gradient at the positions last evaluated, Dim x vertices, N; no columns before the first
    /// step.
    [[nodiscard]] const Positions<Dim>& gradient() const { return gradient_; }

    /// Contacts whose friction was computed, since this was last asked.
    [[nodiscard]] std::int64_t take_count();

private:
    const ContactPotential<Dim>* contacts_;
    contact::LaggedFriction<Dim> friction_;
    double end_of_step_ = 0;  // of that which is held, s
    Positions<Dim> gradient_;
    double energy_ = 0;
    std::int64_t count_ = 0;
    contact::StencilHessians<Dim> hessians_;  // while a system is assembled
};

}  // namespace pent::simulator
