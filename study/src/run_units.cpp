#include "run_units.h"

#include "child_process.h"
#include "frontier.h"
#include "meshes.h"
#include "prepare.h"

#include <pent/error.h>
#include <pent/file_lock.h>
#include <pent/run_files.h>

#include <algorithm>
#include <utility>

namespace pent::study {

namespace {

namespace fs = std::filesystem;

void require_meshes(const UnitFiles& files) {
    if (mesh_checksum(files.scene) == files.unit.meshes) {
        return;
    }
    std::string names;
    for (const simulator::Body& body : files.scene.bodies) {
        names += (names.empty() ? "" : ", ") + body.mesh;
    }
    throw Error(
        names + (files.scene.bodies.size() == 1 ? ": is not the mesh" : ": are not the meshes")
        + " that the study was prepared with; put back what it was, or run --prepare again");
}

// The record of a run that is to be taken again.
Record fresh(const Record& record) {
    return {.scene = record.scene, .meshes = record.meshes, .threads = record.threads};
}

// Where a level of the reference was stopped it goes on, and all of its parts count.
void add_times(Record& record, const ChildOutcome& outcome, double earlier_seconds = 0) {
    record.wall_seconds.push_back(earlier_seconds + outcome.wall_seconds);
    record.cpu_seconds.push_back(outcome.cpu_seconds);
    record.peak_bytes.push_back(outcome.peak_bytes);
    record.machines.push_back(this_machine());
}

}  // namespace

UnitRunner::UnitRunner(StudyFolder& study, fs::path programs, const StudyCallbacks& callbacks)
    : study_(study), programs_(std::move(programs)), callbacks_(callbacks) {
    const fs::path program = programs_ / "pent-sim";
    if (fingerprint(program) + "\n" != read_text(study.folder().path() / kProgramFile)) {
        throw Error(program.string() + ": is another build than the study in "
                    + study.folder().path().string()
                    + " was prepared with, and times and bits would mix; use that one, or prepare"
                      " another folder");
    }
}

bool UnitRunner::is_stopping() const {
    return callbacks_.should_stop && callbacks_.should_stop();
}

int UnitRunner::runs_of(const Unit& unit) const {
    return unit.kind == UnitKind::Reference ? 1 : study_.plan().repeats;
}

void UnitRunner::tell(int run, const std::string& next) const {
    if (is_stopping()) {
        throw Stopped{};
    }
    if (callbacks_.on_run) {
        callbacks_.on_run(runs_done_ + run, runs_, next);
    }
}

UnitOutcome UnitRunner::run(const std::vector<std::size_t>& units) {
    const std::vector<Unit>& all = study_.plan().units;
    for (const std::size_t unit : units) {
        runs_ += runs_of(all[unit]);
    }
    UnitOutcome outcome;
    for (const std::size_t i : units) {
        const Unit& unit = all[i];
        if (!unit.refusal.empty()) {
            outcome = {.verdict = UnitVerdict::Refused, .message = unit.refusal};
        } else {
            // A simulation that outlives us, as when we are killed, keeps the lock.
            const FileLock lock(study_.path_of(unit, ".toml"),
                                "is being run by another program; wait until that ends, or run"
                                " another unit",
                                {.is_inherited = true});
            UnitFiles files = study_.open(unit);
            unit.kind == UnitKind::Reference ? run_level(files) : run_combination(files);
            outcome = {.verdict = files.record.verdict,
                       .message = files.record.message,
                       .has_failed = files.record.verdict == UnitVerdict::Refused};
        }
        runs_done_ += runs_of(unit);
    }
    return outcome;
}

ChildOutcome UnitRunner::simulate(const UnitFiles& files, bool resume) const {
    const fs::path scene = study_.path_of(files.unit, ".toml");
    const fs::path folder = study_.folder().claim(files.unit.name + "/").parent_path();
    ChildOutcome outcome =
        run_child(programs_ / "pent-sim",
                  {scene.string(), "-o", folder.string(), "--quiet", "--threads",
                   std::to_string(study_.plan().threads), resume ? "--resume" : "--force"},
                  {}, callbacks_.should_stop);
    // It may have been told to stop before we were.
    const bool is_stopped =
        outcome.exit_code == 3 && verdict_of(folder) == runs::RunVerdict::Stopped;
    if (is_stopped || is_stopping()) {
        throw Stopped{};
    }
    return outcome;
}

// Runs a level of the reference unless it is there; goes on where an earlier run was interrupted.
void UnitRunner::run_level(UnitFiles& files) {
    const std::string step = "dt = " + short_number(files.scene.dt()) + " s";
    if (study_.is_done(files)) {
        return;
    }
    tell(0, "reference, " + step);
    require_meshes(files);
    const fs::path report = study_.path_of(files.unit) / kReportFile;
    const bool goes_on = files.is_begun && fs::exists(report);
    const double earlier = goes_on ? runs::read_report(report).seconds : 0;
    if (!goes_on) {
        // From its record on the folder of the run holds nothing of another scene or mesh.
        study_.folder().remove(files.unit.name + "/");
        files.record = fresh(files.record);
        study_.write(files);
    }
    const ChildOutcome outcome = simulate(files, goes_on);
    if (outcome.exit_code != 0) {
        throw Error("the reference (" + study_.plan().reference_integrator + ", " + step
                    + ") does not run to its end: " + outcome.error);
    }
    files.record.verdict = UnitVerdict::Finished;
    add_times(files.record, outcome, earlier);
    study_.write(files);
}

void UnitRunner::run_combination(UnitFiles& files) {
    Record& record = files.record;
    if (record.verdict == UnitVerdict::Refused) {
        record = fresh(record);  // what refused it may have been mended since, as a full disk
    }
    while (!study_.is_done(files)) {
        run_once(files);
    }
    if (record.verdict == UnitVerdict::Finished && !study_.is_measured(record)
        && study_.reference() != nullptr) {
        study_.measure(files);
    }
}

void UnitRunner::run_once(UnitFiles& files) {
    Record& record = files.record;
    tell(std::min(static_cast<int>(record.wall_seconds.size()), runs_of(files.unit) - 1),
         settings_text(files.unit.settings));
    require_meshes(files);
    const ChildOutcome outcome = simulate(files, false);
    add_times(record, outcome);
    record.verdict = outcome.exit_code == 0   ? UnitVerdict::Finished
                     : outcome.exit_code == 3 ? UnitVerdict::Diverged
                                              : UnitVerdict::Refused;
    record.message = outcome.exit_code < 0 ? "ended by a signal" : outcome.error;
    study_.write(files);
    // Frames that nothing is to be compared with are in the way of the next run.
    const bool is_compared = study_.is_measured(record) && !study_.plan().keep_runs;
    if (outcome.exit_code != 0 || is_compared) {
        study_.folder().remove(files.unit.name + "/");
    }
}

}  // namespace pent::study
