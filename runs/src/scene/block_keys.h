#pragma once

#include "scene/part_reader.h"
#include "scene/presets.h"

#include <pent/cell_parents.h>
#include <pent/error.h>

#include <algorithm>

namespace pent::runs {

/// Whether every mesh of a scene says which cells lie in one quadratic cell. What is wrong with a
/// file is said when its mesh is read.
[[nodiscard]] inline bool do_all_have_parents(const Scene& scene) {
    return std::all_of(scene.bodies.begin(), scene.bodies.end(), [](const Body& body) {
        try {
            return has_parents(body.mesh);
        } catch (const Error&) {
            return false;
        }
    });
}

/// Reads the keys of a block that are no members of its part, which stand before those that are.
/// Whether there were any.
///
/// @param scene  Its bodies have been read.
template <typename Part>
bool read_block_keys(const Scene& /*scene*/, TableReader& /*block*/, Part& /*part*/) {
    return false;
}

inline bool read_block_keys(const Scene& scene, TableReader& block, SolverOptions& solver) {
    if (!block.has(kPreset.key)) {
        return false;
    }
    const std::size_t which = block.choice(kPreset.key, simulator::words<Preset>(), 0);
    const Preset choice = simulator::kWords<Preset>[which].value;
    solver = preset(choice);
    if (choice == Preset::Accurate && do_all_have_parents(scene)) {
        solver.elements = simulator::ElementKind::Quadratic;
    }
    return true;
}

inline bool read_block_keys(const Scene& /*scene*/, TableReader& block, Output& output) {
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
