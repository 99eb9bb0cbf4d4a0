#pragma once

#include "plan.h"

#include <pent/output_folder.h>
#include <pent/simulator/scene.h>
#include <pent/study/study.h>

#include <string>

namespace pent::study {

/// Thrown to leave a study that was asked to stop.
struct Stopped {};

/// Checks the options, claims the folder, makes the meshes and writes the scenes of all units and
/// the plan. All names that a unit will write to are listed then. Throws an Error as run_study()
/// does, of mistakes in the options before anything is written, and Stopped.
[[nodiscard]] Plan prepare(const StudyOptions& options,
                           OutputFolder& folder,
                           const StudyCallbacks& callbacks);

/// The scene with only so many frames; 0 for all it has.
[[nodiscard]] simulator::Scene shortened(simulator::Scene scene, int frames);

/// What tells one scene from another, wherever its file was named from: a scene text with the paths
/// of its meshes absolute.
[[nodiscard]] std::string identity_of(simulator::Scene scene);

}  // namespace pent::study
