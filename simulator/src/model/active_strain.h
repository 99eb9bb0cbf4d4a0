#pragma once

#include "model/bodies.h"
#include "model/rotation.h"

#include <pent/simulator/scene.h>

#include <cstdint>
#include <vector>

namespace pent::simulator {

/// What the activations of a scene make of its elements at a time: Fa of each, see Activation.
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

    /// Throws an Error if an activation selects nothing, or its fibers cannot be found.
    ActiveStrain(const Scene& scene, const Bodies<Dim>& bodies);

    [[nodiscard]] bool is_empty() const { return muscles_.empty(); }

    /// Shapes are those of a time, s, from now on. Returns whether any has changed.
    [[nodiscard]] bool set_time(double time);

    /// Null for an element that no activation selects.
    [[nodiscard]] const Shape* of_element(Eigen::Index element) const;
    [[nodiscard]] const Shape* of_cell(Eigen::Index cell) const;  ///< Of Bodies.

    /// Bodies of which a shape is another at one time than at another.
    [[nodiscard]] std::vector<std::size_t> changing_bodies(double from, double to) const;

private:
    // What an activation does to one element.
    struct Fiber {
        std::uint32_t element = 0;
        Vector<Dim> direction = Vector<Dim>::Zero();  // unit length; zero without
        double delay = 0;                             // periods
    };
    struct Muscle {
        Activation activation;
        std::size_t body = 0;
        std::vector<Fiber> fibers;
    };

    void find_cells_of_elements(const Scene& scene, const Bodies<Dim>& bodies);
    [[nodiscard]] static Muscle make_muscle(const Activation& activation,
                                            std::size_t body,
                                            const SimplexMesh<Dim>& elements,
                                            Eigen::Index first);

    std::vector<Muscle> muscles_;
    std::vector<std::int32_t> shape_of_;    // one an element; below 0: none
    std::vector<std::uint32_t> parent_of_;  // of cells, where elements are quadratic
    std::vector<Shape> shapes_;
};

/// How much of an activation is there, for an element that is so many periods late: 0 to 1, or what
/// keyframes say.
[[nodiscard]] double signal_at(const Activation& activation, double time, double delay);

/// Fa of an activation by its signal and the direction of a fiber, zero where there is none.
template <int Dim>
[[nodiscard]] Matrix<Dim> active_deformation(const Activation& activation,
                                             double signal,
                                             const Vector<Dim>& direction);

}  // namespace pent::simulator
