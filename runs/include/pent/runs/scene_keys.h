#pragma once

#include <pent/simulator/scene.h>

#include <string>
#include <vector>

namespace pent::runs {

/// A key of a scene by its path, and a value for it.
struct KeyValue {
    std::string path;   ///< "solver.tolerance", "body.material.young", "load.keyframes.factor".
    std::string value;  ///< As scene files have it; texts with or without their quotes.
};

/// The paths of all keys that scenes may have, in the order in which files are read.
[[nodiscard]] std::vector<std::string> scene_keys();

/// The scene with other values for some of its keys, in every block and every list that is on the
/// way to a key. A list or a table is replaced, and solver.preset stands in place of all of
/// [solver]. In whatever order they come, keys are set in that of scene_keys(), so that each finds
/// those that decide about it; those that do not apply any more go. Young's modulus is set with
/// Poisson's ratio kept, and the other way round.
///
/// Throws an Error as the reader of scene files does, without a place, for a path that is not
/// known, a block that the scene does not have, a wrong type, a number out of range, a key that
/// others make one that does not apply, one that is missing now that others make it apply, and for
/// what check(Scene) refuses.
[[nodiscard]] simulator::Scene with_keys(simulator::Scene scene, const std::vector<KeyValue>& keys);

}  // namespace pent::runs
