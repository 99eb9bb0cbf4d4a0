#pragma once

#include <pent/simulator/scene.h>

namespace pent::simulator {

/// Parts of check(Scene) that several blocks of a scene decide together, so that a reader of scene
/// files can say where. Each throws an Error.

/// A barrier needs an integrator that iterates.
void check_model(ContactModel model, Integrator integrator);

/// Where there is no motion nothing can come to rest.
void check_sleeping(Integrator integrator);

/// Every body of a quasistatic scene is held.
void check_held(const Body& body, const Scene& scene);

}  // namespace pent::simulator
