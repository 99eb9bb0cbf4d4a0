#pragma once

#include "scene/scene_meshes.h"
#include "simulator_names.h"

#include <Eigen/Geometry>

#include <memory>
#include <string>
#include <vector>

namespace pent::runs {

/// A scene after one step in memory, which tells what it costs and much of what is wrong with it.
template <int Dim>
struct Trial {
    using Box = Eigen::AlignedBox<double, Dim>;

    /// @param threads  At least 1.
    /// @param ranks    Null for none.
    Trial(const Scene& of, int threads, std::shared_ptr<const simulator::Ranks> ranks);

    const Scene& scene;
    SceneMeshes<Dim> meshes;  ///< Its warnings; the simulation has the meshes.
    Simulation<Dim> simulation;
    std::vector<std::string> overlaps;        ///< What overlaps at the start, a line each.
    std::vector<std::int64_t> free_vertices;  ///< One a body: those that are not held.
    std::vector<Box> start;                   ///< One a body, around it at the start.
    StepReport step;
    simulator::RankTraffic traffic;  ///< Of the step.
    SimulationSize size;

    /// Held everywhere: nothing of it is solved for.
    [[nodiscard]] bool is_kinematic(std::size_t body) const { return free_vertices[body] == 0; }
};

/// What could be left out of a scene or is missing, a line each.
template <int Dim>
[[nodiscard]] std::vector<std::string> advice(const Trial<Dim>& trial);

}  // namespace pent::runs
