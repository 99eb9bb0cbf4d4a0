#pragma once

#include "simulator_names.h"

#include <pent/simulator/field.h>
#include <pent/simulator/words.h>

#include <array>

namespace pent::runs {

enum class Preset { Fast, Balanced, Accurate };

/// The first key of [solver]: no member of its options has it.
inline constexpr simulator::Field kPreset = simulator::key(
    "preset",
    "",
    "defaults for the keys below, `elements` of `accurate` being quadratic where every mesh says"
    " which cells belong together; [accuracy.md](accuracy.md) has what each costs");

/// Of [output]: the one quantity of version 0.1.0, now a name in the list `vertex`.
inline constexpr simulator::Field kContactForces = simulator::key("contact_forces");

/// The settings a preset stands for, but for its elements, which depend on the meshes.
/// docs/accuracy.md has the measurements behind them.
[[nodiscard]] inline SolverOptions preset(Preset choice) {
    SolverOptions solver;
    switch (choice) {
        case Preset::Fast:
            solver.tolerance = 1e-2;
            break;
        case Preset::Balanced:
            break;
        case Preset::Accurate:
            solver.integrator = Integrator::Bdf2;
            break;
    }
    return solver;
}

}  // namespace pent::runs

namespace pent::simulator {

template <>
inline constexpr std::array kWords<runs::Preset> = {
    Word<runs::Preset>{runs::Preset::Fast, "fast"},
    Word<runs::Preset>{runs::Preset::Balanced, "balanced"},
    Word<runs::Preset>{runs::Preset::Accurate, "accurate"},
};

}  // namespace pent::simulator
