#include "surface_search.h"

#include <Eigen/QR>

#include <algorithm>
#include <cmath>

namespace pent::mesher {

namespace {

// Central differences over this part of the cells' scale are exact to about 1e-6 on surfaces that
// the cells resolve; Newton's method corrects the rest.
constexpr double kDifference = 1e-3;

constexpr int kMaxSteps = 12;

// How near to zero values are taken to, in parts of the scale.
constexpr double kZero = 1e-10;

template <typename Function>
Eigen::Vector4d gradient(const Function& function, const Eigen::Vector4d& p, double scale) {
    const double step = kDifference * scale;
    Eigen::Vector4d result;
    for (int axis = 0; axis < 4; ++axis) {
        Eigen::Vector4d there = p;
        there[axis] = p[axis] + step;
        const double after = function(there);
        there[axis] = p[axis] - step;
        result[axis] = (after - function(there)) / (2 * step);
    }
    return result;
}

}  // namespace

// Regula falsi with the Illinois rule: the value at an end that stays is halved.
double zero_between(const Solid& solid, const Sample& from, const Sample& to) {
    if (from.value == 0 || to.value == 0) {
        return from.value == 0 ? 0 : 1;
    }
    constexpr int kMaxEvaluations = 60;
    constexpr double kClose = 1e-12;
    double a = 0;
    double b = 1;
    double at_a = from.value;
    double at_b = to.value;
    const double small = kClose * std::max(std::abs(at_a), std::abs(at_b));
    double t = 0.5;
    int last_side = 0;
    for (int i = 0; i < kMaxEvaluations && b - a > kClose; ++i) {
        t = (a * at_b - b * at_a) / (at_b - at_a);
        if (!(t > a && t < b)) {
            t = (a + b) / 2;
        }
        const double value = solid.value(from.place + t * (to.place - from.place));
        if (std::abs(value) <= small) {
            break;
        }
        const bool is_like_a = (value < 0) == (at_a < 0);
        (is_like_a ? a : b) = t;
        (is_like_a ? at_a : at_b) = value;
        const int side = is_like_a ? -1 : 1;
        if (side == last_side) {
            (is_like_a ? at_b : at_a) /= 2;
        }
        last_side = side;
    }
    return t;
}

std::optional<Eigen::Vector4d> nearest_zero(const Solid& solid,
                                            const Eigen::Vector4d& start,
                                            double scale) {
    const auto function = [&](const Eigen::Vector4d& p) { return solid.value(p); };
    Eigen::Vector4d p = start;
    for (int i = 0; i < kMaxSteps; ++i) {
        const double value = function(p);
        const Eigen::Vector4d slope = gradient(function, p, scale);
        const Eigen::Vector4d step = slope * (value / slope.squaredNorm());
        if (!step.allFinite() || (p - step - start).norm() > scale) {
            return std::nullopt;
        }
        p -= step;
        if (step.norm() <= kZero * scale) {
            return p;
        }
    }
    return std::nullopt;
}

Eigen::Vector4d piece_gradient(const Solid& solid,
                               int piece,
                               const Eigen::Vector4d& p,
                               double scale) {
    return gradient([&](const Eigen::Vector4d& q) { return solid.piece_value(piece, q); }, p,
                    scale);
}

std::optional<Eigen::Vector4d> nearest_common_zero(const Solid& solid,
                                                   std::span<const int> pieces,
                                                   const Eigen::Vector4d& start,
                                                   double scale) {
    Eigen::Vector4d p = start;
    for (int i = 0; i < kMaxSteps; ++i) {
        Eigen::Matrix<double, Eigen::Dynamic, 4> slopes(pieces.size(), 4);
        Eigen::VectorXd values(pieces.size());
        for (std::size_t k = 0; k < pieces.size(); ++k) {
            const auto row = static_cast<Eigen::Index>(k);
            const Eigen::Vector4d slope = piece_gradient(solid, pieces[k], p, scale);
            const double length = slope.norm();
            values[row] = solid.piece_value(pieces[k], p) / length;
            slopes.row(row) = slope / length;
        }
        if (!slopes.allFinite() || !values.allFinite()) {
            return std::nullopt;
        }
        Eigen::CompleteOrthogonalDecomposition<Eigen::MatrixXd> factors;
        factors.setThreshold(1e-4);  // pieces that nearly agree count as one
        factors.compute(slopes);
        const Eigen::Vector4d step = factors.solve(values);
        p -= step;
        if ((p - start).norm() > 2 * scale) {
            return std::nullopt;
        }
        if (step.norm() <= kZero * scale) {
            return values.cwiseAbs().maxCoeff() <= 1e-6 * scale ? std::optional(p) : std::nullopt;
        }
    }
    return std::nullopt;
}

}  // namespace pent::mesher
