#pragma once

#include <pent/study/study.h>
#include <pent/study/units.h>

#include <cstdint>
#include <filesystem>
#include <string>
#include <vector>

namespace pent::study {

inline constexpr const char* kPlanFile = "plan.json";
inline constexpr const char* kProgramFile = "program.txt";  ///< fingerprint() of its pent-sim.
inline constexpr const char* kSceneFile = "scene.toml";     ///< What is studied, before settings.

/// What a program runs of a study by itself. Its files are NAME.toml, which stays as --prepare
/// wrote it, NAME.json, its Record, and NAME/, a run folder.
struct Unit {
    UnitKind kind = UnitKind::Combination;
    std::string name = {};
    Settings settings = {};    ///< Of a combination.
    std::string scene = {};    ///< fingerprint() of NAME.toml.
    std::uint32_t meshes = 0;  ///< mesh_checksum() of its scene.
    std::string refusal = {};  ///< Why the settings do not go together; such a unit is not run.
};

/// What a study is made of; OUT/plan.json.
struct Plan {
    std::string scene = {};  ///< Path of the scene file, absolute.
    int frames = 0;          ///< Studied.
    int scene_frames = 0;
    int repeats = 1;
    int threads = 1;
    bool keep_runs = false;
    std::string reference_integrator = {};
    std::string reference = {};    ///< Record::reference of what is compared with its finest level.
    std::vector<Unit> units = {};  ///< The levels of the reference, from coarse to fine, then the
                                   ///< combinations in their order.

    [[nodiscard]] std::size_t level_count() const;
};

/// The number of a unit, as users count: from 1.
[[nodiscard]] inline int number_of(std::size_t unit) {
    return static_cast<int>(unit) + 1;
}

void write_plan(const std::filesystem::path& path, const Plan& plan);

/// The plan of the study in a folder. Throws an Error that says what to do if there is none.
[[nodiscard]] Plan read_plan(const std::filesystem::path& folder);

}  // namespace pent::study
