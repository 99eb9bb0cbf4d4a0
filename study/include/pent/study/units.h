#pragma once

#include <pent/study/study.h>

#include <filesystem>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

namespace pent::study {

/// A study in parts, which run_study() is made of, too: it is prepared, its units are run, anywhere
/// that sees the folder, in any order and many at a time, and it is collected. Everything that the
/// later parts need stands in the folder. A unit that is done is not run again. One that was killed
/// goes on: a level of the reference after its last frame, a combination with the repetition that
/// it was in.

/// A level of the reference, or a combination of settings with all its repetitions.
enum class UnitKind { Reference, Combination };

/// "reference" or "combination".
[[nodiscard]] std::string_view kind_name(UnitKind kind);

struct UnitState {
    UnitKind kind = UnitKind::Combination;
    std::string name = {};  ///< Of its files in the folder, as "runs/dt-1_60".
    bool is_done = false;   ///< Nothing of it is missing in a collection.
};

/// What a folder says of the study in it.
struct StudyState {
    std::filesystem::path scene = {};   ///< The scene file that was prepared.
    int threads = 1;                    ///< Of each run.
    std::vector<UnitState> units = {};  ///< Number 1 first: the levels of the reference.
};

/// How the run of a unit ended.
struct UnitOutcome {
    UnitVerdict verdict = UnitVerdict::None;
    std::string message = {};  ///< Why it did not finish.
    bool has_failed = false;   ///< It was run and refused: no result, try again.
};

/// Makes the meshes, and writes the scenes and numbers of all units. What has been run before and
/// still holds stays. Nothing if it was asked to stop. Throws an Error as run_study() does for its
/// options and its folder.
[[nodiscard]] std::optional<StudyState> prepare_study(const StudyOptions& options,
                                                      const StudyCallbacks& callbacks = {});

/// Looks at a folder and writes nothing. Throws an Error if no study has been prepared in it.
[[nodiscard]] StudyState state_of_study(const std::filesystem::path& folder);

/// Throws an Error unless the scene is the one that the study was prepared for.
void require_scene(const std::filesystem::path& folder, const std::filesystem::path& scene);

/// Runs a unit, unless it is done, and compares a combination with the reference if that is there.
///
/// Throws an Error if there is no unit of this number, if it is being run by another program, if
/// its scene, a mesh of it or pent-sim is not what the study was prepared with, and for a level of
/// the reference that does not run to its end.
///
/// @param number    From 1.
/// @param programs  Folder with pent-sim.
[[nodiscard]] UnitOutcome run_unit(const std::filesystem::path& folder,
                                   int number,
                                   const std::filesystem::path& programs,
                                   const StudyCallbacks& callbacks = {});

/// Compares what has not been compared, and writes the files of the study. Throws an Error that
/// names the units that are missing, and how to run them.
[[nodiscard]] StudyReport collect_study(const std::filesystem::path& folder,
                                        const std::string& created_by);

}  // namespace pent::study
