#include "step/newton.h"

#include <pent/dimensions.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <optional>
#include <utility>

namespace pent::simulator {

namespace {

// Forcing term of the inexact Newton method, the relative residual of its linear solves: each
// iteration then gains two digits, which is what its quadratic model is good for.
constexpr double kForcing = 1e-2;

// Armijo's rule: a step is taken if the value falls by at least this part of what the slope at its
// start promises [nocedal2006, 3.1].
constexpr double kArmijo = 1e-4;
constexpr double kRounding = 1e-13;  // of the value
constexpr int kMaxBacktracks = 40;

// Newton's method stops at a kink when the gradient left is below this part of that at the start,
// and either a step that had to be cut gains less than this part of what all steps have gained, or
// the gradient has not decreased in so many iterations.
constexpr double kKinkGradient = 0.1;
constexpr double kKinkGain = 1e-4;
constexpr int kKinkIterations = 8;

// Near kinks, where the gradient is not quite the derivative of the value, a step is also taken if
// it reduces the gradient by this part of what it would if the gradient were linear. With a smaller
// part, steps would be taken that hop to and fro over a kink.
constexpr double kKinkFall = 0.25;

// Filtered Hessians are too stiff where bodies slide along each other, so that the value often
// keeps falling beyond a full step. A step at whose end the slope is still above this part of that
// at its start is extended to where a linear slope would vanish, at most so many times as far at
// once, and so many times.
constexpr double kSteep = 0.35;
constexpr double kMaxStretch = 4;
constexpr int kMaxStretches = 4;
constexpr double kMinStretch = 1.3;  // anything less is not worth an evaluation

// Prescribed points that get no further than this part of their way, in so many steps in a row, are
// blocked.
constexpr double kBlocked = 1e-3;
constexpr int kMaxBlockedSteps = 10;

// @param part  The least part, that is enough, of what a linear gradient would lose in the step.
template <int Dim>
bool has_less_gradient(const Evaluation<Dim>& at,
                       const Evaluation<Dim>& next,
                       double factor,
                       double part) {
    return next.gradient.norm() <= (1 - part * factor) * at.gradient.norm();
}

template <int Dim>
class Minimizer {
public:
    Minimizer(Objective<Dim>& function, const NewtonOptions& options, Positions<Dim>& x)
        : function_(function), options_(options), x_(x) {}

    NewtonReport run() {
        at_ = function_.evaluate(x_);
        start_ = x_;
        first_ = options_.start ? *options_.start
                                : NewtonStart{at_.value, function_.norms(at_.gradient)};
        displacement_ = function_.prescribed_displacement(x_);
        is_pending_ = !displacement_.isZero(0);
        while (report_.iterations < options_.max_iterations) {
            if (!iterate()) {
                return report_;
            }
        }
        if (options_.may_stop_short || has_converged()) {
            static_cast<void>(finish(residual()));
        } else if (!is_at_kink()) {
            fail("Newton's method did not reach its tolerance");
        }
        return report_;
    }

private:
    // Returns whether to go on.
    bool iterate() {
        if (!std::isfinite(at_.value)) {
            return fail("the energy grew beyond all bounds");
        }
        if (has_converged()) {
            return finish(residual());
        }
        ++report_.iterations;
        const NewtonDirection<Dim> direction =
            function_.solve(at_.gradient, displacement_, kForcing);
        if (!direction.failure_reason.empty()) {
            return fail(direction.failure_reason);
        }
        const double correction = direction.step.template lpNorm<Eigen::Infinity>();
        if (!is_pending_ && correction < options_.min_correction) {
            return finish(0);
        }
        // As the solve has them, however short collisions then cut them.
        astray_ = correction < options_.bound ? 0 : astray_ + 1;
        if (options_.max_astray > 0 && astray_ == options_.max_astray) {
            return fail("the motion grew beyond all bounds");
        }
        const double limit = function_.max_step(x_, x_ + direction.step);
        const double value_before = at_.value;
        const std::optional<double> factor = search(direction.step, limit);
        if (factor && at_.has_kink) {
            remember();
        }
        const bool is_cut = !factor || *factor < 1;
        const bool has_stalled =
            is_cut && value_before - at_.value <= kKinkGain * (first_.value - at_.value);
        if ((has_stalled || best_age_ >= kKinkIterations) && is_at_kink()) {
            return false;
        }
        if (factor && !((x_ - start_).cwiseAbs().maxCoeff() < options_.bound)) {
            return fail("the motion grew beyond all bounds");
        }
        const bool has_changed = factor && function_.accept(x_);
        // From a point that this step could not leave the next one fails likewise, unless the
        // function changed.
        const bool is_stuck = !factor || (*factor == 0 && !is_pending_ && !has_changed);
        if (is_stuck && options_.may_stop_short && report_.iterations > 1) {
            return finish(residual());
        }
        if (is_stuck) {
            return fail("the line search found no decrease");
        }
        if (!is_pending_ && *factor >= 1
            && *factor * correction < options_.settled * options_.min_correction
            && residual() <= options_.settled * options_.tolerance) {
            return finish(residual());
        }
        if (is_pending_ && !carry_on(limit)) {
            return false;
        }
        if (has_changed) {
            at_ = function_.evaluate(x_);
        }
        return true;
    }

    // Backtracking line search: tries `factor` times the step, half of that and so on; goes farther
    // where `factor` is 1 and the value keeps falling. Returns the factor that was taken; nothing
    // if the value does not fall.
    std::optional<double> search(const Positions<Dim>& step, double factor) {
        const double slope = at_.gradient.cwiseProduct(step).sum();
        if (!is_pending_ && !(slope < 0)) {
            return std::nullopt;  // no direction of descent
        }
        Positions<Dim> trial;
        for (int k = 0; k < kMaxBacktracks; ++k, factor /= 2) {
            trial = x_ + factor * step;
            Evaluation<Dim> next = function_.evaluate(trial);
            if (is_pending_ ? std::isfinite(next.value) : has_improved(next, step, factor, slope)) {
                take(trial, std::move(next));
                if (factor == 1 && !is_pending_ && options_.extends_steps) {
                    factor = extend(trial, step, slope);
                }
                return factor;
            }
        }
        return std::nullopt;
    }

    // Goes on beyond a full step while the value falls; returns how far in all.
    //
    // @param from  Where the step began.
    double extend(const Positions<Dim>& from, const Positions<Dim>& step, double first_slope) {
        double factor = 1;
        for (int k = 0; k < kMaxStretches; ++k) {
            const double slope = at_.gradient.cwiseProduct(step).sum();
            if (!(slope < kSteep * first_slope)) {
                break;
            }
            const double most = kMaxStretch * factor;
            const double bend = (slope - first_slope) / factor;
            const double wanted = bend > 0 ? std::min(most, -first_slope / bend) : most;
            const double limit = function_.max_step(from, from + wanted * step);
            if (limit * wanted < kMinStretch * factor) {
                break;
            }
            Positions<Dim> trial = from + limit * wanted * step;
            Evaluation<Dim> next = function_.evaluate(trial);
            if (!(next.value < at_.value)) {
                at_ = function_.evaluate(x_);  // where accept() and solve() are to look
                break;
            }
            take(trial, std::move(next));
            factor = limit * wanted;
        }
        return factor;
    }

    // Makes a trial the current point, and leaves the point before in the trial's place.
    void take(Positions<Dim>& trial, Evaluation<Dim>&& next) {
        std::swap(x_, trial);
        at_ = std::move(next);
    }

    // Sufficient decrease of the value; of the gradient where the value changes by no more than its
    // rounding, and near kinks where the slopes at both ends of the step tell that it leads down.
    [[nodiscard]] bool has_improved(const Evaluation<Dim>& next,
                                    const Positions<Dim>& step,
                                    double factor,
                                    double slope) const {
        const double change = next.value - at_.value;
        const bool is_lost = change <= at_.rounding;
        return change <= kArmijo * factor * slope + kRounding * std::abs(at_.value)
               || ((is_lost
                    || (next.has_kink && slope + next.gradient.cwiseProduct(step).sum() <= 0))
                   && has_less_gradient(at_, next, factor, is_lost ? kArmijo : kKinkFall));
    }

    // After a step of prescribed points: whether they can go on, or have arrived.
    bool carry_on(double limit) {
        displacement_ = function_.prescribed_displacement(x_);
        is_pending_ = displacement_.cwiseAbs().maxCoeff() > options_.arrival;
        if (!is_pending_) {
            displacement_.setZero();
        }
        const GradientNorms now = function_.norms(at_.gradient);
        for (std::size_t norm = 0; norm < now.size(); ++norm) {
            first_.norms[norm] = std::max(first_.norms[norm], now[norm]);
        }
        blocked_steps_ = limit < kBlocked ? blocked_steps_ + 1 : 0;
        if (is_pending_ && blocked_steps_ == kMaxBlockedSteps) {
            report_.has_blocked_points = true;
            return fail("prescribed points cannot go on");
        }
        return true;
    }

    // Keeps the point with the least gradient that was come by near kinks.
    void remember() {
        ++best_age_;
        const GradientNorms now = function_.norms(at_.gradient);
        if (best_norms_.empty() || residual(now) < residual(best_norms_)) {
            best_ = x_;
            best_norms_ = now;
            best_age_ = 0;
        }
    }

    bool is_at_kink() {
        if (best_norms_.empty() || residual(best_norms_) > kKinkGradient) {
            return false;
        }
        x_ = best_;
        static_cast<void>(finish(residual(best_norms_)));
        return true;
    }

    [[nodiscard]] bool has_converged() const {
        return !is_pending_ && residual() <= options_.tolerance;
    }

    // How much of the gradient at the start is left, in the norm in which that is most.
    [[nodiscard]] double residual() const { return residual(function_.norms(at_.gradient)); }
    [[nodiscard]] double residual(const GradientNorms& now) const {
        double most = 0;
        for (std::size_t norm = 0; norm < now.size(); ++norm) {
            const double left = now[norm] == 0 ? 0 : now[norm] / first_.norms[norm];
            most = left <= most ? most : left;  // NaN if one is
        }
        return most;
    }

    bool finish(double residual) {
        report_.has_converged = true;
        report_.residual = residual;
        return false;
    }

    bool fail(const std::string& reason) {
        report_.failure_reason = reason;
        return false;
    }

    Objective<Dim>& function_;
    const NewtonOptions& options_;
    Positions<Dim>& x_;
    Positions<Dim> start_;
    Evaluation<Dim> at_;           // at x
    Positions<Dim> displacement_;  // of prescribed points, to their places
    bool is_pending_ = false;      // whether they are still on their way
    int blocked_steps_ = 0;        // steps in a row that hardly moved them
    int astray_ = 0;               // corrections in a row that go beyond the bound
    NewtonStart first_;
    Positions<Dim> best_;       // see remember()
    GradientNorms best_norms_;  // there; empty until there is one
    int best_age_ = 0;          // iterations since
    NewtonReport report_;
};

}  // namespace

template <int Dim>
NewtonReport newton(Objective<Dim>& function, const NewtonOptions& options, Positions<Dim>& x) {
    return Minimizer<Dim>(function, options, x).run();
}

template <int Dim>
NewtonReport newton_step(Objective<Dim>& function, Positions<Dim>& x) {
    NewtonReport report;
    const Evaluation<Dim> at = function.evaluate(x);
    const NewtonDirection<Dim> direction =
        function.solve(at.gradient, function.prescribed_displacement(x), 0);
    report.failure_reason = direction.failure_reason;
    report.has_converged = direction.failure_reason.empty();
    if (report.has_converged) {
        report.iterations = 1;
        x += direction.step;
    }
    return report;
}

#define PENT_INSTANTIATE(Dim)                                                             \
    template NewtonReport newton(Objective<Dim>&, const NewtonOptions&, Positions<Dim>&); \
    template NewtonReport newton_step(Objective<Dim>&, Positions<Dim>&);
PENT_FOR_EACH_DIMENSION(PENT_INSTANTIATE)
#undef PENT_INSTANTIATE

}  // namespace pent::simulator
