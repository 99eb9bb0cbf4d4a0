#include "step/matrix_range.h"

#include <algorithm>
#include <cmath>
#include <numbers>

namespace pent::simulator {

namespace {

// Floats are normal from 2^-126 on and end at 2^128. The rest is room: cells are smaller than what
// belongs to a vertex, and entries of blocks may be small beside others.
constexpr double kHeld = 113;
// Entries within this of 1 are left as they are.
constexpr double kNear = 66;
// What is so many powers of two below something that it is added to is lost in floats.
constexpr double kUnseen = 30;

// Logarithm to the base 2. std::log2() would bring a table of two kilobytes along, which pages
// load.
double exponent_of(double number) {
    return std::log(number) / std::numbers::ln2;
}

}  // namespace

MatrixRange::MatrixRange(int dimension,
                         const Eigen::VectorXd& masses,
                         const std::vector<CellRange>& ranges)
    : dimension_(dimension),
      mass_{exponent_of(masses.minCoeff()), exponent_of(masses.maxCoeff())},
      modulus_{INFINITY, -INFINITY} {
    Span density = modulus_;
    const auto extend = [](Span& span, double number) {
        span = {std::min(span.low, exponent_of(number)), std::max(span.high, exponent_of(number))};
    };
    for (const CellRange& range : ranges) {
        extend(density, range.material.density);
        extend(modulus_, range.material.lame.mu + std::abs(range.material.lame.lambda));
    }
    length_ = {(mass_.low - density.high) / dimension_, (mass_.high - density.low) / dimension_};
}

MatrixRange::Span MatrixRange::stiffness(double scale) const {
    const Span entries = times_lengths(modulus_, dimension_ - 2);
    return {entries.low + exponent_of(scale), entries.high + exponent_of(scale)};
}

MatrixRange::Span MatrixRange::inertia(double weight) const {
    return {mass_.low + exponent_of(weight), mass_.high + exponent_of(weight)};
}

// Masses and stiffness are added on the diagonal, where the larger counts.
MatrixRange::Span MatrixRange::entries(double weight, double scale) const {
    const Span masses = inertia(weight);
    const Span others = stiffness(scale);
    return {std::max(masses.low, others.low), std::max(masses.high, others.high)};
}

double MatrixRange::unit(double weight, double scale) const {
    const Span all = entries(weight, scale);
    const bool is_near = all.low > -kNear && all.high < kNear;
    return is_near ? 1 : std::ldexp(1, static_cast<int>(std::lround((all.low + all.high) / 2)));
}

bool MatrixRange::is_in_float(double weight, double scale) const {
    const double unit = this->unit(weight, scale);
    const double factor = exponent_of(scale / unit);
    const Span all = entries(weight / unit, scale / unit);
    const Span rotations = times_lengths(all, 2);  // entries for the turns of pieces of a body
    const bool is_negligible = stiffness(scale).high + kUnseen < inertia(weight).low;
    const auto is_held = [&](const Span& span, double times) {
        return (is_negligible || span.low + times > -kHeld) && span.high + times < kHeld;
    };
    const Span volume = times_lengths({0, 0}, dimension_);
    // Kernels multiply volumes by the factor, by gradients at rest and by moduli, in more than one
    // order, and compare squares of moduli.
    return all.low > -kHeld && all.high < kHeld && rotations.low > -kHeld && rotations.high < kHeld
           && is_held(volume, 0) && is_held(volume, factor)
           && is_held(times_lengths({0, 0}, dimension_ - 1), factor)
           && is_held(times_lengths(modulus_, dimension_), factor)
           && is_held({2 * modulus_.low, 2 * modulus_.high}, 0);
}

}  // namespace pent::simulator
