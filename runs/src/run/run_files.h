#pragma once

#include <pent/formatted.h>
#include <pent/pent_file.h>

#include <string>

namespace pent::runs {

/// Names of the files of a run within its folder.
inline constexpr const char* kRunFolder = "run";  // what its list calls it
inline constexpr const char* kSceneFile = "scene.toml";
inline constexpr const char* kObstaclesFile = "obstacles.json";
inline constexpr const char* kReportFile = "report.json";
inline constexpr const char* kBalanceFile = "balance.csv";
inline constexpr const char* kJournalFile = "journal.txt";

[[nodiscard]] inline std::string mesh_file(const std::string& body) {
    return "meshes/" + body + ".pent";
}
[[nodiscard]] inline std::string frame_file(const std::string& body, int frame) {
    return "frames/" + frame_file_name(body, frame);
}
[[nodiscard]] inline std::string moved_obstacles_file(int frame) {
    return formatted("obstacles/%06d.json", frame);
}
[[nodiscard]] inline std::string contacts_file(int frame) {
    return formatted("contacts/%06d.csv", frame);
}
[[nodiscard]] inline std::string checkpoint_file(int frame) {
    return formatted("checkpoint/%06d.state", frame);
}

}  // namespace pent::runs
