#pragma once

#include "model/bodies.h"
#include "model/held_vertices.h"

#include <pent/contact/contact_scene.h>
#include <pent/simulator/scene.h>

#include <cstddef>

namespace pent::simulator {

/// Whether any two of so many bodies, or one and itself, may touch.
[[nodiscard]] bool may_any_touch(const Scene& scene, std::size_t bodies);

/// A scene as contact sees it: surfaces, which vertices are held, which bodies ignore each other,
/// obstacles as the scene has them.
///
/// @param do_bodies_meet  Else they meet only obstacles, and have no surfaces in it.
template <int Dim>
[[nodiscard]] contact::ContactScene<Dim> contact_scene(const Scene& scene,
                                                       const Bodies<Dim>& bodies,
                                                       const HeldVertices<Dim>& held,
                                                       bool do_bodies_meet);

}  // namespace pent::simulator
