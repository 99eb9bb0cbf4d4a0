#pragma once

#include "scene/part_reader.h"
#include "scene/presets.h"

#include <algorithm>

namespace pent::runs {

/// Reads the keys of a block that are no members of its part, which stand before those that are.
/// Whether there were any.
template <typename Part>
bool read_block_keys(TableReader& /*block*/, Part& /*part*/) {
    return false;
}

inline bool read_block_keys(TableReader& block, SolverOptions& solver) {
    if (!block.has(kPreset.key)) {
        return false;
    }
    const std::size_t choice = block.choice(kPreset.key, simulator::words<Preset>(), 0);
    solver = preset(simulator::kWords<Preset>[choice].value);
    return true;
}

inline bool read_block_keys(TableReader& block, Output& output) {
    constexpr auto kForce = VertexQuantity::ContactForce;
    if (!block.has(kContactForces.key)) {
        return false;
    }
    const bool is_wanted = block.flag(kContactForces.key, false);
    if (is_wanted && std::count(output.vertex.begin(), output.vertex.end(), kForce) == 0) {
        output.vertex.push_back(kForce);
    }
    return true;
}

}  // namespace pent::runs
