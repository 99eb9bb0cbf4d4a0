#pragma once

#include "compare.h"
#include "locate.h"
#include "trajectory.h"

#include <pent/simulator/scene.h>
#include <pent/study/study.h>

#include <cstdint>
#include <filesystem>
#include <map>
#include <vector>

namespace pent::study {

/// The finest level of the reference, which runs are compared with.
class Reference {
public:
    /// @param meshes  mesh_checksum() of the scene.
    ///
    /// Throws an Error if the folder does not hold the run.
    Reference(const simulator::Scene& scene,
              const std::filesystem::path& folder,
              std::uint32_t meshes);

    [[nodiscard]] const Trajectory& trajectory() const { return trajectory_; }

    /// How a finished run differs. Throws an Error if its frames cannot be read, or if its meshes
    /// are of another shape.
    [[nodiscard]] Errors errors_of(const Trajectory& run, std::uint32_t meshes);

    /// What the levels say of each other, from coarse to fine, the last one being this; without the
    /// cost.
    [[nodiscard]] ReferenceReport convergence(const std::vector<const Trajectory*>& levels) const;

private:
    [[nodiscard]] const Interpolation& where(const Trajectory& run, std::uint32_t meshes);

    double frames_per_second_;
    std::uint32_t meshes_;
    Trajectory trajectory_;
    Window window_;
    std::map<std::uint32_t, Interpolation> where_;  // by mesh_checksum()
};

}  // namespace pent::study
