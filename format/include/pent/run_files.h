#pragma once

#include <array>
#include <filesystem>
#include <map>
#include <set>
#include <string>
#include <vector>

namespace pent {

/// Where the files of a run are within its folder, for all that write runs and read them: a program
/// that spells such a name itself would miss what others write. web/src/run/listing.ts and
/// python/pentimento/run.py have the same for the page and for Python.

inline constexpr const char* kRunFolder = "run";  ///< What the list of such a folder calls it.

inline constexpr const char* kSceneFile = "scene.toml";
inline constexpr const char* kReportFile = "report.json";
inline constexpr const char* kJournalFile = "journal.txt";
inline constexpr const char* kBalanceFile = "balance.csv";
inline constexpr const char* kObstaclesFile = "obstacles.json";  ///< Where none of them moves.

inline constexpr const char* kMeshesFolder = "meshes";
inline constexpr const char* kFramesFolder = "frames";
inline constexpr const char* kObstaclesFolder = "obstacles";  ///< Where one of them moves.
inline constexpr const char* kContactsFolder = "contacts";
inline constexpr const char* kCheckpointFolder = "checkpoint";

/// All of these, none of which another program may write to.
inline constexpr std::array kPartsOfRun = {
    kSceneFile,    kReportFile,   kJournalFile,     kBalanceFile,    kObstaclesFile,
    kMeshesFolder, kFramesFolder, kObstaclesFolder, kContactsFolder, kCheckpointFolder};

/// Paths relative to the folder: "meshes/octopus.pent", "frames/octopus_000042.pent",
/// "obstacles/000042.json", "contacts/000042.csv", "checkpoint/000042.state".
[[nodiscard]] std::string mesh_file(const std::string& body);
[[nodiscard]] std::string frame_file(const std::string& body, int frame);
[[nodiscard]] std::string obstacles_file(int frame);
[[nodiscard]] std::string contacts_file(int frame);
[[nodiscard]] std::string checkpoint_file(int frame);

/// The bodies of a run, by the names of their meshes, ascending.
///
/// Throws an Error if there is no folder of meshes.
///
/// @param expected  What errors say the path should have been, as in "a run folder of pent-sim".
[[nodiscard]] std::vector<std::string> bodies_of_run(const std::filesystem::path& run,
                                                     const std::string& expected);

/// The numbers of the frames of each body that has any. Files whose names are none of frame_file(),
/// as those that are being written, are passed over. Throws as bodies_of_run().
[[nodiscard]] std::map<std::string, std::set<int>> frames_of_run(const std::filesystem::path& run,
                                                                 const std::string& expected);

}  // namespace pent
