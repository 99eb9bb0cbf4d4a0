#pragma once

#include "simulator/scenes.h"
#include "support/temp_folder.h"

#include <pent/pent_file.h>
#include <pent/simulator/scene.h>

#include <filesystem>
#include <fstream>
#include <iterator>
#include <string>

namespace pent::runs::test {

inline std::string bytes_of(const std::filesystem::path& path) {
    std::ifstream file(path, std::ios::binary);
    return {std::istreambuf_iterator<char>(file), std::istreambuf_iterator<char>()};
}

/// A bar held at its left end that falls under gravity for some frames.
inline simulator::Scene falling_bar(const pent::test::TempFolder& folder, int frames) {
    namespace scenes = simulator::test;
    write_mesh(folder / "bar.pent", scenes::bar(3));
    simulator::Scene scene = scenes::box_scene<4>();
    scene.gravity[1] = -9.8;
    scene.frames = frames;
    scene.steps_per_frame = 2;
    scene.bodies[0].mesh = (folder / "bar.pent").string();
    scene.bodies[0].place.translate[3] = 1;
    scene.constraints = {scenes::hold(
        simulator::HalfSpaceSelection{.normal = Eigen::Vector4d(1, 0, 0, 0), .offset = 1e-6},
        scenes::still(4))};
    return scene;
}

}  // namespace pent::runs::test
