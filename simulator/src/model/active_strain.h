#pragma once

#include "model/bodies.h"
#include "model/rotation.h"

#include <pent/parallel.h>
#include <pent/simulator/scene.h>

#include <cstdint>
#include <optional>
#include <vector>

namespace pent::simulator {

/// The active strain of the elements of a scene at a time, by its activations: Fa of each, see
/// Activation.
///
/// An element is a cell of Bodies, or a quadratic cell where the bodies have been made for these.
/// Where several activations select it their Fa are multiplied, the first one acting first.
template <int Dim>
class ActiveStrain {
public:
    /// What becomes of the rest shape of an element: F = Fe Fa.
    struct Shape {
        Matrix<Dim> inverse = Matrix<Dim>::Identity();  ///< Fa^-1.
        double growth = 1;                              ///< det Fa.

        bool operator==(const Shape&) const = default;
    };

    /// Sets shapes to those of time 0. Throws an Error if an activation selects nothing, or its
    /// fibers cannot be found.
    ///
    /// @param bodies  Must outlive this.
    ActiveStrain(const Workers& workers, const Scene& scene, const Bodies<Dim>& bodies);

    [[nodiscard]] bool is_empty() const { return muscles_.empty(); }

    /// Makes shapes those of a time, s. Returns whether any has changed, on any rank.
    [[nodiscard]] bool set_time(const Workers& workers, double time);

    /// Null for an element that no activation selects.
    [[nodiscard]] const Shape* of_element(Eigen::Index element) const;
    [[nodiscard]] const Shape* of_cell(Eigen::Index cell) const;  ///< Of Bodies.

    /// Bodies of which a shape differs between two times.
    [[nodiscard]] std::vector<std::size_t> changing_bodies(double from, double to) const;

private:
    struct Muscle {
        Activation activation;
        std::size_t body = 0;
    };
    // One element of a muscle.
    struct Fiber {
        std::uint32_t element = 0;
        std::uint32_t muscle = 0;
        Vector<Dim> direction = Vector<Dim>::Zero();  // unit length; zero without
        double delay = 0;                             // periods
    };

    void append_fibers(std::size_t muscle, const Bodies<Dim>& bodies);
    [[nodiscard]] double signal(const Fiber& fiber, double time) const;
    [[nodiscard]] Shape shape_at(std::size_t shape, double time) const;

    const Sharing* sharing_;
    std::vector<Muscle> muscles_;
    std::vector<Fiber> fibers_;             // by element; of one in the order of the scene
    std::vector<std::size_t> first_fiber_;  // of each shape, and the number of all
    std::vector<std::int32_t> shape_of_;    // one an element; below 0: none
    std::vector<std::uint32_t> parent_of_;  // of cells, where elements are quadratic
    std::vector<Shape> shapes_;
    std::optional<double> time_;  // at which shapes are as they are, s
};

/// The signal of an activation, for an element that is so many periods late: 0 to 1, times the
/// factor of keyframes.
[[nodiscard]] double signal_at(const Activation& activation, double time, double delay);

/// Fa of an activation by its signal and the direction of a fiber, zero where there is none.
template <int Dim>
[[nodiscard]] Matrix<Dim> active_deformation(const Activation& activation,
                                             double signal,
                                             const Vector<Dim>& direction);

}  // namespace pent::simulator
