#pragma once

#include "model/bodies.h"

namespace pent::simulator {

/// Places the meshes of `bodies` and puts their vertices, cells and quadratic cells one after the
/// other, those of a body by their materials.
template <int Dim>
void append_bodies(const Scene& scene, Bodies<Dim>& bodies);

}  // namespace pent::simulator
