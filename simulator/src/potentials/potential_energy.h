#pragma once

#include "potentials/potential.h"

#include <memory>
#include <utility>
#include <vector>

namespace pent::simulator {

/// The potential energy of a scene: the sum of elasticity, gravity, contact and whatever else has
/// an energy. Its gradient is minus the force on every vertex.
template <int Dim>
class PotentialEnergy {
public:
    /// Adds a term; terms are summed in the order in which they were added.
    template <typename Term>
    Term& add(std::unique_ptr<Term> term) {
        Term& added = *term;
        terms_.push_back(std::move(term));
        return added;
    }

    /// Removes a term, and all that were added after it.
    void remove_from(const Potential<Dim>& term);

    /// Evaluates all terms, unless that is what was done last.
    void update(const Positions<Dim>& x);

    /// Makes the next update() evaluate in any case: to be called where something that a term holds
    /// has changed.
    void invalidate() { is_valid_ = false; }

    /// The gradient of one of the terms at the positions last evaluated, Dim x vertices, N.
    [[nodiscard]] Positions<Dim> gradient_of(Potential<Dim>& term) const;

    /// The positions last evaluated, Dim x vertices, m.
    [[nodiscard]] const Positions<Dim>& positions() const { return x_; }

    [[nodiscard]] double value() const { return value_; }  ///< J.
    /// Dim x vertices, N.
    [[nodiscard]] const Positions<Dim>& gradient() const { return gradient_; }

    [[nodiscard]] std::vector<TermEnergy> energies() const;
    void set_time(const TimeSpan& step);
    [[nodiscard]] Couplings couplings() const;
    void begin_step(const StepStart<Dim>& start);
    [[nodiscard]] double max_step(const Positions<Dim>& from, const Positions<Dim>& to);
    [[nodiscard]] bool is_bounded() const;
    [[nodiscard]] bool adapt();
    [[nodiscard]] double rounding() const;
    [[nodiscard]] bool has_kink() const;

    [[nodiscard]] const std::vector<std::unique_ptr<Potential<Dim>>>& terms() const {
        return terms_;
    }

private:
    std::vector<std::unique_ptr<Potential<Dim>>> terms_;
    bool is_valid_ = false;
    Positions<Dim> x_;  // where terms were last evaluated: they look at it again
    double value_ = 0;
    Positions<Dim> gradient_;
};

}  // namespace pent::simulator
