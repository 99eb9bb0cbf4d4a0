#pragma once

#include "model/cell_range.h"

#include <Eigen/Core>

#include <vector>

namespace pent::simulator {

/// How small and how large numbers get in the matrix inertia M + scale K of a scene, contact and
/// springs aside. With bodies of nanometers, or of millions of kilometers, they are beyond the
/// range of floats, in which parts of the matrix and of preconditioners are kept. Estimates, to a
/// few powers of two, by the masses and the materials that there are.
class MatrixRange {
public:
    /// @param dimension  Of the bodies.
    /// @param masses     One a vertex, kg.
    /// @param ranges     Of all cells.
    MatrixRange(int dimension, const Eigen::VectorXd& masses, const std::vector<CellRange>& ranges);

    /// The unit, a power of two, by which entries of the matrix are to be divided: 1 unless they
    /// are far from that.
    ///
    /// @param weight  Of the masses: inertia, 0 in statics.
    [[nodiscard]] double unit(double weight, double scale) const;

    /// Whether the matrix, in units of that, can be put together in floats.
    [[nodiscard]] bool is_in_float(double weight, double scale) const;

private:
    // Logarithms to the base 2 of the smallest and of the largest of something.
    struct Span {
        double low;
        double high;
    };

    [[nodiscard]] Span stiffness(double scale) const;
    [[nodiscard]] Span inertia(double weight) const;
    [[nodiscard]] Span entries(double weight, double scale) const;
    // The range of numbers times a power of lengths, which is not negative.
    [[nodiscard]] Span times_lengths(const Span& span, double power) const {
        return {span.low + power * length_.low, span.high + power * length_.high};
    }

    double dimension_;
    Span mass_;     // of a vertex
    Span modulus_;  // of a material
    Span length_;   // of an edge
};

}  // namespace pent::simulator
