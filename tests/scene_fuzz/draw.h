#pragma once

#include "document.h"

#include <cstdint>

namespace pent::scene_fuzz {

/// A scene drawn at random, the same for a seed everywhere: one to four bodies of few cells placed
/// so that they meet, any energies, elements, integrators, models of contact, obstacles,
/// constraints and outputs, five to fifteen steps. Its meshes are named as meshes.h says.
[[nodiscard]] Json draw_scene(std::uint64_t seed);

}  // namespace pent::scene_fuzz
