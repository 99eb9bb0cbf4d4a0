#include "surface_search.h"

#include <Eigen/Eigenvalues>

#include <algorithm>
#include <cmath>

namespace pent::mesher {

namespace {

// Where slopes are differences, over this part of the cells' scale: exact to about 1e-6 on surfaces
// that the cells resolve; Newton's method corrects the rest.
constexpr double kDifference = 1e-3;

constexpr int kMaxSteps = 12;

// Newton's method ends with steps shorter than this, in parts of the scale.
constexpr double kZero = 1e-10;

// The minimum-norm solution of least squares, from the normal equations.
Eigen::Vector4d shortest_solution(const Eigen::Matrix4d& squares, const Eigen::Vector4d& sums) {
    // Eigenvalues below this part of the largest one are taken for 0: pieces whose normals nearly
    // agree count as one.
    constexpr double kAgree = 1e-8;
    const Eigen::SelfAdjointEigenSolver<Eigen::Matrix4d> axes(squares);
    const double largest = axes.eigenvalues()[3];
    Eigen::Vector4d step = Eigen::Vector4d::Zero();
    for (int i = 0; i < 4; ++i) {
        const double square = axes.eigenvalues()[i];
        if (square > kAgree * largest) {
            const Eigen::Vector4d axis = axes.eigenvectors().col(i);
            step += axis.dot(sums) / square * axis;
        }
    }
    return step;
}

}  // namespace

// Regula falsi with the Illinois rule: the value at an end that stays is halved.
double zero_between(const Solid& solid, const Sample& from, const Sample& to) {
    if (from.value == 0 || to.value == 0) {
        return from.value == 0 ? 0 : 1;
    }
    const bool is_from_outside = from.value > 0;
    if (const auto part = is_from_outside ? solid.first_crossing(from.place, to.place)
                                          : solid.first_crossing(to.place, from.place)) {
        return is_from_outside ? *part : 1 - *part;
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
    if (const auto foot = solid.foot(start)) {
        return (*foot - start).norm() <= scale ? foot : std::nullopt;
    }
    Eigen::Vector4d p = start;
    for (int i = 0; i < kMaxSteps; ++i) {
        const auto [value, slope] = solid.value_slope(p, kDifference * scale);
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

Eigen::Vector4d piece_normal(const Solid& solid,
                             int piece,
                             const Eigen::Vector4d& p,
                             double scale) {
    return solid.piece_slope(piece, p, kDifference * scale).slope.normalized();
}

std::optional<Eigen::Vector4d> nearest_common_zero(const Solid& solid,
                                                   std::span<const int> pieces,
                                                   const Eigen::Vector4d& start,
                                                   double scale) {
    if (pieces.size() == 1) {
        if (const auto foot = solid.piece_foot(pieces[0], start)) {
            return (*foot - start).norm() <= 2 * scale ? foot : std::nullopt;
        }
    }
    Eigen::Vector4d p = start;
    for (int i = 0; i < kMaxSteps; ++i) {
        // The normal equations: four by four, however many pieces there are.
        Eigen::Matrix4d squares = Eigen::Matrix4d::Zero();
        Eigen::Vector4d sums = Eigen::Vector4d::Zero();
        double largest = 0;
        for (const int piece : pieces) {
            const auto [value, slope] = solid.piece_slope(piece, p, kDifference * scale);
            const double length = slope.norm();
            const Eigen::Vector4d normal = slope / length;
            const double distance = value / length;
            squares += normal * normal.transpose();
            sums += distance * normal;
            largest = std::max(largest, std::abs(distance));
        }
        if (!squares.allFinite() || !sums.allFinite()) {
            return std::nullopt;
        }
        const Eigen::Vector4d step = pieces.size() == 1 ? sums : shortest_solution(squares, sums);
        p -= step;
        if ((p - start).norm() > 2 * scale) {
            return std::nullopt;
        }
        if (step.norm() <= kZero * scale) {
            return largest <= 1e-6 * scale ? std::optional(p) : std::nullopt;
        }
    }
    return std::nullopt;
}

}  // namespace pent::mesher
