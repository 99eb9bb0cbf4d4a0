#pragma once

#include "model/bodies.h"
#include "potentials/contact_potential.h"

#include <pent/simulator/crossing_error.h>

#include <vector>

namespace pent::simulator {

/// The error to throw for crossings, of which there is at least one.
template <int Dim>
[[nodiscard]] CrossingError<Dim> crossing_error(const Bodies<Dim>& bodies,
                                                const ContactPotential<Dim>& contacts,
                                                const std::vector<contact::Crossing>& crossings,
                                                const Positions<Dim>& positions);

}  // namespace pent::simulator
