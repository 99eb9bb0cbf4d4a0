#include "compare.h"

#include <algorithm>
#include <cmath>

namespace pent::study {

namespace {

Eigen::VectorXd center_of(const Eigen::MatrixXd& positions, const Eigen::VectorXd& masses) {
    return positions * masses / masses.sum();
}

// Mean over the time behind `from` of a quantity of the steps.
template <typename Quantity>
double mean_behind(const std::vector<StepRecord>& steps, double from, const Quantity& quantity) {
    double sum = 0;
    double duration = 0;
    double before = 0;
    for (const StepRecord& step : steps) {
        if (step.time > from) {
            const double length = step.time - std::max(before, from);
            sum += length * quantity(step);
            duration += length;
        }
        before = step.time;
    }
    return duration > 0 ? sum / duration : 0;
}

double relative(double value, double reference) {
    return reference != 0 ? std::abs(value - reference) / std::abs(reference) : std::abs(value);
}

void compare_steps(const Trajectory& run,
                   const Trajectory& reference,
                   const Window& window,
                   Errors& errors) {
    const auto internal = [](const StepRecord& step) { return step.internal; };
    const double end = reference.steps().empty() ? 0 : reference.steps().back().time;
    const double from = window.has_contact && window.end < end ? window.end : 0;
    errors.energy = relative(mean_behind(run.steps(), from, internal),
                             mean_behind(reference.steps(), from, internal));
    errors.contact_work = relative(contact_work(run.steps()), contact_work(reference.steps()));
    if (!run.steps().empty()) {
        errors.energy_drift = run.steps().back().total - run.steps().front().total;
    }
    for (const StepRecord& step : run.steps()) {
        errors.deepest_penetration = std::max(errors.deepest_penetration, step.penetration);
        errors.iterations += step.iterations;
        errors.newton_iterations += step.newton_iterations;
        errors.refused += step.refused;
    }
}

}  // namespace

double contact_work(const std::vector<StepRecord>& steps) {
    double work = 0;
    double before = 0;
    for (const StepRecord& step : steps) {
        work += std::max(0.0, step.contact_energy - before);
        before = step.contact_energy;
    }
    return work;
}

Window window_of(const Trajectory& reference, double frames_per_second) {
    const double end = reference.frames() / frames_per_second;
    for (const StepRecord& step : reference.steps()) {
        if (step.has_contact) {
            // At least to the first frame: there has to be something to compare.
            const double least = 1 / frames_per_second;
            return {std::clamp(step.time + kAfterContact, least, std::max(least, end)), true};
        }
    }
    return {end, false};
}

double rms_distance(const Eigen::MatrixXd& a,
                    const Eigen::MatrixXd& b,
                    const Eigen::VectorXd& masses) {
    return std::sqrt((a - b).colwise().squaredNorm().dot(masses) / masses.sum());
}

Eigen::VectorXd angular_momentum(const Moment& moment, const Eigen::VectorXd& masses) {
    const Eigen::Index dim = moment.positions.rows();
    const Eigen::MatrixXd arms = moment.positions.colwise() - center_of(moment.positions, masses);
    const Eigen::MatrixXd second = arms * masses.asDiagonal() * moment.velocities.transpose();
    Eigen::VectorXd momentum(dim * (dim - 1) / 2);
    Eigen::Index plane = 0;
    for (Eigen::Index i = 0; i < dim; ++i) {
        for (Eigen::Index j = i + 1; j < dim; ++j) {
            momentum[plane++] = second(i, j) - second(j, i);
        }
    }
    return momentum;
}

Errors compare(const Trajectory& run,
               const Trajectory& reference,
               const Interpolation& where,
               const Window& window,
               double frames_per_second) {
    Errors errors;
    const int dim = run.dimension();
    Eigen::VectorXd twist = Eigen::VectorXd::Zero(dim * (dim - 1) / 2);
    double motion = 0;
    double center = 0;
    errors.smallest_J = std::numeric_limits<double>::infinity();
    const Eigen::MatrixXd start = where(reference.moment(0).positions);
    for (int frame = 0; frame <= run.frames(); ++frame) {
        const Moment ours = run.moment(frame);
        const Moment theirs = reference.moment(frame);
        const Eigen::MatrixXd expected = where(theirs.positions);
        motion = std::max(motion, rms_distance(expected, start, run.masses()));
        errors.smallest_J = std::min(errors.smallest_J, run.smallest_J(ours.positions));
        center =
            (center_of(ours.positions, run.masses()) - center_of(expected, run.masses())).norm();
        // Half a frame more for rounding.
        if (frame > (window.end + 0.5 / frames_per_second) * frames_per_second) {
            continue;
        }
        errors.position_m =
            std::max(errors.position_m, rms_distance(ours.positions, expected, run.masses()));
        const Eigen::VectorXd spin = angular_momentum(theirs, reference.masses());
        twist = twist.cwiseMax((angular_momentum(ours, run.masses()) - spin).cwiseAbs());
        errors.angular_momentum_scale = std::max(errors.angular_momentum_scale, spin.norm());
    }
    errors.position = motion > 0 ? errors.position_m / motion : errors.position_m;
    errors.center = motion > 0 ? center / motion : center;
    errors.angular_momentum.assign(twist.begin(), twist.end());
    compare_steps(run, reference, window, errors);
    return errors;
}

Convergence convergence_of(double coarse, double fine) {
    // Differences this small are rounding of the frames and the solver's tolerance, not time steps.
    constexpr double kRounding = 1e-12;
    if (fine <= kRounding) {
        return {.order = 0, .error_bar = fine, .is_converged = coarse <= 1};
    }
    Convergence result;
    result.order = std::log2(coarse / fine);
    result.is_converged = result.order >= 0.5;
    result.error_bar = result.is_converged ? fine / (std::exp2(result.order) - 1) : fine;
    return result;
}

}  // namespace pent::study
