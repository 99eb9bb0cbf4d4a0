#pragma once

#include <pent/simulator/words.h>

#include <array>
#include <vector>

namespace pent::simulator {

/// What frames may have of every vertex beside its position and velocity.
enum class VertexQuantity {
    ContactForce,   ///< Of contact and obstacles, N.
    Reaction,       ///< What a constraint holds its vertices with against all forces, N; else 0.
    EnergyDensity,  ///< Elastic, J/m^Dim: of the cells around, by their volume at rest.
};
template <>
inline constexpr std::array kWords<VertexQuantity> = {
    Word<VertexQuantity>{VertexQuantity::ContactForce, "contact_force"},
    Word<VertexQuantity>{VertexQuantity::Reaction, "reaction"},
    Word<VertexQuantity>{VertexQuantity::EnergyDensity, "energy_density"},
};

/// What a run writes beside positions and velocities.
struct Output {
    std::vector<VertexQuantity> vertex = {};  ///< In the frame files.
    bool contact_pairs = false;               ///< Every pair in contact, in a table for each frame.
    bool balance = false;                     ///< Energies and momenta of each step, in a table.
};

}  // namespace pent::simulator
