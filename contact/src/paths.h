#pragma once

#include <pent/contact/surface.h>

namespace pent::contact {

/// Straight paths of all vertices of a scene from one position to another: `from` and `to` are the
/// same array where nothing moves.
template <int Dim>
struct Paths {
    const PositionsView<Dim>& from;
    const PositionsView<Dim>& to;
    Vector<Dim> drift = Vector<Dim>::Zero();  ///< What all have in common, m.

    [[nodiscard]] bool is_still() const { return from.data() == to.data(); }
};

}  // namespace pent::contact
