#include "potentials/potential_energy.h"

#include <pent/dimensions.h>

#include <algorithm>

namespace pent::simulator {

template <int Dim>
void PotentialEnergy<Dim>::remove_from(const Potential<Dim>& term) {
    terms_.erase(std::find_if(terms_.begin(), terms_.end(),
                              [&](const auto& other) { return other.get() == &term; }),
                 terms_.end());
    invalidate();
}

template <int Dim>
void PotentialEnergy<Dim>::update(const Positions<Dim>& x) {
    if (is_valid_ && x_.cols() == x.cols() && x_ == x) {
        return;
    }
    x_ = x;
    gradient_.setZero(Dim, x.cols());
    value_ = 0;
    for (const auto& term : terms_) {
        value_ += term->evaluate(x_, gradient_);
    }
    is_valid_ = true;
}

template <int Dim>
Positions<Dim> PotentialEnergy<Dim>::gradient_of(Potential<Dim>& term) const {
    Positions<Dim> own = Positions<Dim>::Zero(Dim, x_.cols());
    static_cast<void>(term.evaluate(x_, own));
    return own;
}

template <int Dim>
std::vector<TermEnergy> PotentialEnergy<Dim>::energies() const {
    std::vector<TermEnergy> all;
    for (const auto& term : terms_) {
        const std::vector<TermEnergy> own = term->energies();
        all.insert(all.end(), own.begin(), own.end());
    }
    return all;
}

template <int Dim>
void PotentialEnergy<Dim>::set_time(const TimeSpan& step) {
    for (const auto& term : terms_) {
        is_valid_ = !term->set_time(step) && is_valid_;
    }
}

template <int Dim>
Couplings PotentialEnergy<Dim>::couplings() const {
    Couplings all;
    for (const auto& term : terms_) {
        term->add_couplings(all);
    }
    return all;
}

template <int Dim>
void PotentialEnergy<Dim>::begin_step(const StepStart<Dim>& start) {
    for (const auto& term : terms_) {
        is_valid_ = !term->begin_step(start) && is_valid_;
    }
}

template <int Dim>
double PotentialEnergy<Dim>::max_step(const Positions<Dim>& from, const Positions<Dim>& to) {
    double least = 1;
    for (const auto& term : terms_) {
        least = std::min(least, term->max_step(from, to));
    }
    return least;
}

template <int Dim>
bool PotentialEnergy<Dim>::is_bounded() const {
    return std::any_of(terms_.begin(), terms_.end(),
                       [](const auto& term) { return term->is_bounded(); });
}

template <int Dim>
bool PotentialEnergy<Dim>::adapt() {
    for (const auto& term : terms_) {
        is_valid_ = !term->adapt() && is_valid_;
    }
    return !is_valid_;
}

template <int Dim>
double PotentialEnergy<Dim>::rounding() const {
    double sum = 0;
    for (const auto& term : terms_) {
        sum += term->rounding();
    }
    return sum;
}

template <int Dim>
bool PotentialEnergy<Dim>::has_kink() const {
    return std::any_of(terms_.begin(), terms_.end(),
                       [](const auto& term) { return term->has_kink(); });
}

#define PENT_INSTANTIATE(Dim) template class PotentialEnergy<Dim>;
PENT_FOR_EACH_DIMENSION(PENT_INSTANTIATE)
#undef PENT_INSTANTIATE

}  // namespace pent::simulator
