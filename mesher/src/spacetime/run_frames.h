#pragma once

#include <pent/mesher/moving_mesh.h>

#include <filesystem>

namespace pent::mesher {

/// Reads the mesh of a body and its frames from a run folder of pent-sim, of three dimensions, with
/// velocities and whatever else the frames have. Throws an Error that names the file.
[[nodiscard]] MovingMesh read_run_frames(const std::filesystem::path& folder,
                                         const SeriesOptions& options);

}  // namespace pent::mesher
