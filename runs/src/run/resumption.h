#pragma once

#include "record/journal.h"
#include "record/state_blocks.h"
#include "simulator_names.h"

#include <pent/error.h>

#include <cstdint>
#include <filesystem>
#include <string>
#include <vector>

namespace pent::runs {

/// The step at which a frame is written.
[[nodiscard]] inline std::uint64_t step_of(const Scene& scene, int frame) {
    return static_cast<std::uint64_t>(frame) * static_cast<std::uint64_t>(scene.steps_per_frame);
}

/// A run in its folder, which is to be resumed.
struct RunInFolder {
    const Scene& scene;
    const std::filesystem::path& folder;
    bool has_list = true;  ///< Of its files; a run of version 0.1.0 has none.
    const std::vector<std::uint32_t>& mesh_crcs;  ///< Of its meshes, one a body.
};

/// Where a run goes on, and with what.
template <int Dim>
struct Resumption {
    int frame = 0;             ///< The last that is whole.
    Snapshot<Dim> snapshot;    ///< Of that moment.
    StateBlocks carried = {};  ///< What of it is in no frame file.
    Journal history = {};      ///< Up to there; frames that the journal lacked are measured.
};

/// Of a run that was killed before its start was written.
[[nodiscard]] Error nothing_to_resume(const std::filesystem::path& folder);

/// Reads nothing but the folder and changes nothing in it.
///
/// Throws an Error that names the file if a file is damaged or of another
/// run, or no frame is whole.
///
/// @param simulation  Of the same scene, at its start.
/// @param history     Of the run so far.
template <int Dim>
[[nodiscard]] Resumption<Dim> find_resumption(const RunInFolder& run,
                                              const Simulation<Dim>& simulation,
                                              Journal history);

/// Names that files of a run of version 0.1.0 may have within its folder.
[[nodiscard]] std::vector<std::string> files_of_old_run(const std::vector<std::string>& bodies,
                                                        int last_frame);

}  // namespace pent::runs
