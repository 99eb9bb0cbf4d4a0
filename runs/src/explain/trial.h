#pragma once

#include "simulator_names.h"

#include <Eigen/Geometry>

#include <cstdint>
#include <memory>
#include <string>
#include <vector>

namespace pent::runs {

struct TrialBody {
    std::int64_t cells = 0;
    int cells_across = 1;
    std::int64_t boundary_vertices = 0;
    bool has_parents = false;        ///< Its mesh is one for quadratic elements.
    std::int64_t free_vertices = 0;  ///< Those that are not held.
    Eigen::AlignedBox<double, Eigen::Dynamic> box = {};  ///< Around it at the start.

    /// Held everywhere: nothing of it is solved for.
    [[nodiscard]] bool is_kinematic() const { return free_vertices == 0; }
};

/// A scene after one step in memory, which tells what it costs and much of what is wrong with it.
struct Trial {
    const Scene& scene;
    const simulator::Ranks* ranks = nullptr;  ///< Null for none.
    std::vector<TrialBody> bodies = {};
    std::vector<std::int64_t> springs = {};  ///< One an attachment: how many it has.
    std::vector<std::string> warnings = {};  ///< Of meshes, units, overlap and the like.
    StepReport step = {};
    simulator::RankTraffic traffic = {};  ///< Of the step.
    SimulationSize size = {};
};

/// Reads the meshes of a scene and takes a step. Throws an Error as Simulation does.
///
/// @param threads  At least 1.
/// @param ranks    Null for none.
template <int Dim>
[[nodiscard]] Trial make_trial(const Scene& scene,
                               int threads,
                               const std::shared_ptr<const simulator::Ranks>& ranks);

}  // namespace pent::runs
