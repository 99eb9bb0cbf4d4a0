#pragma once

#include "model/bodies.h"

namespace pent::simulator {

/// Whether a term of a scene couples vertices that share no element.
[[nodiscard]] bool do_terms_couple_anything(const Scene& scene);

/// Drops all cells but the NeededCells of this rank, and all quadratic cells but those that these
/// are children of. What stays, stays in its order: it is all that the rows of this rank and the
/// elements that count here are made of.
template <int Dim>
void keep_near_cells(ElementKind kind, Bodies<Dim>& bodies);

}  // namespace pent::simulator
