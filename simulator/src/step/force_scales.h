#pragma once

#include "model/bodies.h"
#include "step/objective.h"

#include <vector>

namespace pent::simulator {

/// Norms in which residual forces are measured. Beside the forces on steel those on rubber are no
/// more than a rounding, and so are those on a small body beside a large one, and yet all of them
/// have to be balanced. So the residual is measured in further norms, too, in which the force on
/// each vertex counts relative to what equal strains, or equal accelerations, would cause there.
template <int Dim>
class ForceScales {
public:
    /// @param bodies  A vertex of several materials counts as of the stiffest, or of the densest.
    explicit ForceScales(const Bodies<Dim>& bodies);

    /// Whether densities count: in a step with inertia.
    void set_inertia(bool has_inertia) { has_inertia_ = has_inertia; }

    /// The norm of a gradient; its norm with the force on each vertex divided by the shear modulus
    /// there times V^((Dim - 1) / Dim), V being the mean volume of a vertex of the same piece; and,
    /// with inertia, with each divided by the density times V. The largest divisor is scaled to 1;
    /// a norm whose divisors are about the same everywhere is left out. A piece is a connected
    /// component of a mesh.
    ///
    /// @param gradient  Dim x vertices.
    [[nodiscard]] GradientNorms norms(const Positions<Dim>& gradient) const;

    /// For all norms but the first: weights of the squared forces on the vertices of these rows.
    [[nodiscard]] std::vector<Eigen::VectorXd> weights(const DofMap& rows) const;

private:
    [[nodiscard]] std::vector<const Eigen::VectorXd*> scales() const;

    // Factors of the force on each vertex: the largest divisor over that there; empty if all are
    // alike.
    Eigen::VectorXd by_stiffness_;
    Eigen::VectorXd by_density_;
    bool has_inertia_ = true;
};

}  // namespace pent::simulator
