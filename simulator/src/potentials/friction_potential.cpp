#include "potentials/friction_potential.h"

#include "model/same_time.h"

#include <pent/dimensions.h>

#include <cmath>
#include <utility>

namespace pent::simulator {

template <int Dim>
bool FrictionPotential<Dim>::set_time(const TimeSpan& step) {
    if (std::abs(step.end - end_of_step_) > kSameTime * (step.end - step.begin)) {
        friction_.end_step();
        end_of_step_ = step.end;
    }
    return false;
}

template <int Dim>
bool FrictionPotential<Dim>::begin_step(const StepStart<Dim>& start) {
    if (start.h == 0) {
        friction_.end_step();
        return true;
    }
    const Positions<Dim>* velocities = start.is_linear ? &start.velocities : nullptr;
    if (contacts_->has_moving_obstacles()) {
        // With obstacles at the end of the step, one that comes nearer would press on a body that
        // has not moved yet as if it had been run into.
        friction_.begin_step(contacts_->contacts_at_begin(start.positions).list, start.positions,
                             velocities, start.h, [&](const contact::Contact<Dim>& contact) {
                                 return contacts_->obstacle_displacement(contact, start.positions);
                             });
    } else {
        friction_.begin_step(contacts_->contacts().list, start.positions, velocities, start.h);
    }
    return true;
}

template <int Dim>
double FrictionPotential<Dim>::evaluate(const Positions<Dim>& x, Positions<Dim>& gradient) {
    gradient_.setZero(Dim, x.cols());
    energy_ = friction_.add_gradient(x, gradient_);
    gradient += gradient_;
    count_ += static_cast<std::int64_t>(friction_.size());
    return energy_;
}

template <int Dim>
void FrictionPotential<Dim>::add_hessian(const Positions<Dim>& x,
                                         double weight,
                                         Filter /*filter*/,
                                         NewtonSystem<Dim>& system) {
    hessians_ = friction_.hessians(x);
    add_stencils<Dim>(weight, hessians_, 0, system);
}

template <int Dim>
std::int64_t FrictionPotential<Dim>::take_count() {
    return std::exchange(count_, 0);
}

#define PENT_INSTANTIATE(Dim) template class FrictionPotential<Dim>;
PENT_FOR_EACH_DIMENSION(PENT_INSTANTIATE)
#undef PENT_INSTANTIATE

}  // namespace pent::simulator
