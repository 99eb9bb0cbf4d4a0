#pragma once

#include "model/bodies.h"
#include "step/objective.h"

#include <vector>

namespace pent::simulator {

/// How large forces are on some vertices beside those on others that are strained as much or
/// accelerated alike, by what they are made of and how much of it belongs to each. Beside steel the
/// forces on rubber are no more than a rounding, and beside a large body those on a small one, and
/// yet they have to be balanced: so what is left of them is told in several norms.
template <int Dim>
class ForceScales {
public:
    /// @param bodies  A vertex of several materials counts as of the stiffest, or densest.
    explicit ForceScales(const Bodies<Dim>& bodies);

    /// Whether densities count: in a step with inertia.
    void set_inertia(bool has_inertia) { has_inertia_ = has_inertia; }

    /// The norm of a gradient; that with every part over the stiffness there times the surface of
    /// what belongs to a vertex of the piece, if that is not about the same everywhere; and that
    /// over the mass of such a vertex, likewise. What is largest counts as it is. A piece is what
    /// hangs together of a body.
    ///
    /// @param gradient  Dim x vertices.
    [[nodiscard]] GradientNorms norms(const Positions<Dim>& gradient) const;

    /// Of the squares of forces on the vertices of these rows in all norms but the first.
    [[nodiscard]] std::vector<Eigen::VectorXd> weights(const DofMap& rows) const;

private:
    [[nodiscard]] std::vector<const Eigen::VectorXd*> scales() const;

    // What is largest over what is there, one a vertex; empty if the same everywhere.
    Eigen::VectorXd by_stiffness_;
    Eigen::VectorXd by_density_;
    bool has_inertia_ = true;
};

}  // namespace pent::simulator
