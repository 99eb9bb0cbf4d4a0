#pragma once

#include "scene_contacts.h"
#include "world.h"

#include <pent/simulator/crossing_error.h>

#include <vector>

namespace pent::simulator {

/// What to throw about crossings, of which there is at least one.
template <int Dim>
[[nodiscard]] CrossingError<Dim> crossing_error(const World<Dim>& world,
                                                const SceneContacts<Dim>& contacts,
                                                const std::vector<contact::Crossing>& crossings,
                                                const Positions<Dim>& positions);

}  // namespace pent::simulator
