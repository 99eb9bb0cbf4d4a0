#pragma once

#include "keys.h"
#include "plan.h"

/// What bodies are and what acts on each: parts of draw.cpp, which puts scenes together.
namespace pent::scene_fuzz {

extern const Keys kScene;
extern const Keys kBody;

/// Newtons a meter that go with the bodies' stiffness.
[[nodiscard]] Json contact_stiffness(Random& random, const Plan& plan);

[[nodiscard]] Json draw_load(Random& random, const Plan& plan);
[[nodiscard]] Json draw_activation(Random& random, const Plan& plan);
[[nodiscard]] Json draw_attachment(Random& random, const Plan& plan);

}  // namespace pent::scene_fuzz
