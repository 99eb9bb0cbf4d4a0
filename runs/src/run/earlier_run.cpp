#include "run/earlier_run.h"

#include "record/run_report.h"
#include "run/resume.h"

#include <pent/error.h>
#include <pent/output_folder.h>
#include <pent/pent_file.h>
#include <pent/read_text.h>
#include <pent/run_files.h>

#include <optional>
#include <utility>

namespace pent::runs {

namespace fs = std::filesystem;

std::vector<std::string> names_of_bodies(const Scene& scene) {
    std::vector<std::string> names;
    for (const Body& body : scene.bodies) {
        names.push_back(body.name);
    }
    return names;
}

namespace {

// The report.json of a run without a journal, as version 0.1.0 left it.
RunReport read_old_report(const fs::path& path) {
    try {
        RunReport report = read_report(path);
        if (report.verdict == RunVerdict::Running) {
            report.parts.back().verdict = RunVerdict::Died;
        }
        return report;
    } catch (const Error& error) {
        throw Error(std::string(error.what()) + "; remove it or start again with --force");
    }
}

}  // namespace

Journal read_earlier_parts(const Scene& scene, const fs::path& folder) {
    if (!fs::exists(folder / kSceneFile)) {
        throw Error(folder.string() + ": holds no run to resume (no " + kSceneFile + ")");
    }
    check_same_scene(folder / kSceneFile, scene);
    if (std::optional<Journal> journal = read_journal(folder / kJournalFile)) {
        return *std::move(journal);
    }
    if (OutputFolder(folder, kRunFolder).has_list()) {
        throw Error((folder / kJournalFile).string()
                    + ": is missing; put it back, or use --force to start again");
    }
    const fs::path report = folder / kReportFile;
    if (!fs::exists(report)) {
        return {};
    }
    RunReport known = read_old_report(report);
    const std::size_t frames = known.frames.size();
    return {.parts = std::move(known.parts),
            .frames = std::move(known.frames),
            .has_checkpoint = std::vector<bool>(frames),
            .steps = std::move(known.steps)};
}

fs::path crossings_path(const fs::path& folder, const std::string& created_by) {
    fs::path base = fs::absolute(folder).lexically_normal();
    base = base.filename().empty() ? base.parent_path() : base;
    for (int number = 1;; ++number) {
        fs::path path = base;
        path += "-crossings" + (number > 1 ? "-" + std::to_string(number) : "") + ".pent";
        std::error_code ignored;
        if (!fs::exists(fs::symlink_status(path, ignored))) {
            return path;
        }
        try {
            if (read_info(path).created_by == created_by) {
                return path;
            }
        } catch (const Error&) {
            continue;  // no .pent file at all
        }
    }
}

}  // namespace pent::runs
