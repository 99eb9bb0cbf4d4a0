#pragma once

#include <pent/simulator/scene.h>

#include <filesystem>
#include <string>
#include <vector>

namespace pent::test {

/// A scene as a file of its own, with coarse meshes and few steps, solved to eight digits.
struct QuickScene {
    std::string name;
    std::filesystem::path file;
    std::filesystem::path nudged;  ///< The same scene, its last body away by about what rounds.
    simulator::Scene scene;
};

/// Where programs and scenes are, and where meshes and runs go.
struct Places {
    std::filesystem::path programs;
    std::filesystem::path data;
    std::filesystem::path work;
};

/// The scenes of data/scenes and of data/study whose models are there; meshes by their recipes, a
/// few times as coarse.
[[nodiscard]] std::vector<QuickScene> data_scenes(const Places& places);

/// Activations along fibers that are found by distances, in R^3 and R^4.
[[nodiscard]] std::vector<QuickScene> muscle_scenes(const Places& places);

/// The scenes that are hard on a barrier, in R^3 and R^4, as coarse as the tests have them, but not
/// the same when z and w are exchanged, and solved until what is left moves nothing.
[[nodiscard]] std::vector<QuickScene> stress_scenes(const Places& places);

}  // namespace pent::test
