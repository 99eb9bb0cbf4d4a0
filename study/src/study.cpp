#include "collect.h"
#include "meshes.h"
#include "prepare.h"
#include "run_units.h"
#include "study_folder.h"

#include <pent/error.h>
#include <pent/output_folder.h>
#include <pent/runs/scene_file.h>
#include <pent/study/study.h>
#include <pent/study/units.h>

#include <algorithm>
#include <numeric>

namespace pent::study {

namespace {

namespace fs = std::filesystem;

StudyState state_of(const StudyFolder& study) {
    StudyState state{.scene = study.plan().scene, .threads = study.plan().threads};
    for (const Unit& unit : study.plan().units) {
        state.units.push_back(
            {.kind = unit.kind, .name = unit.name, .is_done = study.is_done(unit)});
    }
    return state;
}

StudyReport stopped() {
    StudyReport report;
    report.is_stopped = true;
    return report;
}

}  // namespace

std::optional<StudyState> prepare_study(const StudyOptions& options,
                                        const StudyCallbacks& callbacks) {
    OutputFolder folder(options.folder, kStudyFolder);
    try {
        const Plan plan = prepare(options, folder, callbacks);
        return state_of(StudyFolder(plan, folder));
    } catch (const Stopped&) {
        return std::nullopt;
    }
}

StudyState state_of_study(const fs::path& path) {
    OutputFolder folder(path, kStudyFolder);
    const Plan plan = read_plan(path);
    return state_of(StudyFolder(plan, folder));
}

void require_scene(const fs::path& folder, const fs::path& scene) {
    const Plan plan = read_plan(folder);
    const simulator::Scene given = shortened(runs::read_scene(scene), plan.frames);
    if (identity_of(given) != read_text(folder / kSceneFile)) {
        throw Error(scene.string() + ": is not the scene that the study in " + folder.string()
                    + " was prepared for (" + plan.scene
                    + " as it was then); leave it out to go on with that one, or prepare another"
                      " folder");
    }
}

UnitOutcome run_unit(const fs::path& path,
                     int number,
                     const fs::path& programs,
                     const StudyCallbacks& callbacks) {
    OutputFolder folder(path, kStudyFolder);
    const Plan plan = read_plan(path);
    const int count = static_cast<int>(plan.units.size());
    if (number < 1 || number > count) {
        throw Error("--run " + std::to_string(number) + ": the study in " + path.string()
                    + " has units 1 to " + std::to_string(count)
                    + "; --list-runs says what they are");
    }
    folder.share();
    StudyFolder study(plan, folder);
    try {
        return UnitRunner(study, programs, callbacks).run({static_cast<std::size_t>(number) - 1});
    } catch (const Stopped&) {
        return {.verdict = UnitVerdict::Stopped};
    }
}

StudyReport collect_study(const fs::path& path, const std::string& created_by) {
    OutputFolder folder(path, kStudyFolder);
    const Plan plan = read_plan(path);
    StudyFolder study(plan, folder);
    return collect(study, created_by);
}

// One after the other, with the folder for itself from the beginning to the end.
StudyReport run_study(const StudyOptions& options, const StudyCallbacks& callbacks) {
    OutputFolder folder(options.folder, kStudyFolder);
    try {
        const Plan plan = prepare(options, folder, callbacks);
        StudyFolder study(plan, folder);
        std::vector<std::size_t> units(plan.units.size());
        std::iota(units.begin(), units.end(), std::size_t{0});
        UnitRunner(study, options.programs, callbacks).run(units);
        return collect(study, options.created_by);
    } catch (const Stopped&) {
        return stopped();
    }
}

std::string scene_with(const fs::path& folder, const Result& result, const fs::path& where) {
    const Plan plan = read_plan(folder);
    const auto unit = std::ranges::find_if(plan.units, [&](const Unit& candidate) {
        return candidate.kind == UnitKind::Combination && candidate.settings == result.settings;
    });
    if (unit == plan.units.end()) {
        throw Error(folder.string() + ": has no unit of these settings; prepare it again");
    }
    simulator::Scene scene = runs::read_scene(folder / (unit->name + ".toml"));
    scene.frames = plan.scene_frames;
    for (simulator::Body& body : scene.bodies) {
        body.mesh = fs::proximate(body.mesh, fs::absolute(where)).string();
    }
    return runs::scene_text(scene);
}

}  // namespace pent::study
