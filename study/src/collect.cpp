#include "collect.h"

#include "drawing.h"
#include "frontier.h"
#include "plot.h"

#include <pent/error.h>
#include <pent/output_file.h>

#include <memory>
#include <vector>

namespace pent::study {

namespace {

namespace fs = std::filesystem;

void require_all(const StudyFolder& study, const fs::path& folder) {
    std::vector<int> missing;
    const std::vector<Unit>& units = study.plan().units;
    for (std::size_t i = 0; i < units.size(); ++i) {
        if (!study.is_done(units[i])) {
            missing.push_back(number_of(i));
        }
    }
    if (missing.empty()) {
        return;
    }
    throw Error(folder.string() + ": of " + std::to_string(units.size())
                + " units these have not been run to their end: " + ranges_text(missing)
                + "; run each by pent-study -o " + folder.string()
                + " --run NUMBER, then collect again");
}

void collect_reference(StudyFolder& study, StudyReport& report, std::vector<Machine>& machines) {
    const Plan& plan = study.plan();
    const Reference& reference = *study.reference();
    std::vector<std::unique_ptr<Trajectory>> coarser;
    std::vector<const Trajectory*> levels;
    std::vector<double> dt;
    Cost cost;
    for (std::size_t level = 0; level < plan.level_count(); ++level) {
        const UnitFiles files = study.open(plan.units[level]);
        dt.push_back(files.scene.dt());
        if (level + 1 < plan.level_count()) {
            coarser.push_back(std::make_unique<Trajectory>(files.scene, study.path_of(files.unit)));
            levels.push_back(coarser.back().get());
        } else {
            levels.push_back(&reference.trajectory());
            cost = cost_of(files.record, plan.frames);
            machines.insert(machines.end(), files.record.machines.begin(),
                            files.record.machines.end());
        }
    }
    report.reference = reference.convergence(levels);
    report.reference.dt = dt;
    report.reference.cost = cost;
    report.vertices = reference.trajectory().rest().cols();
    report.cells = reference.trajectory().cell_count();
}

Result collect_unit(StudyFolder& study, const Unit& unit, std::vector<Machine>& machines) {
    Result result{
        .settings = unit.settings, .verdict = UnitVerdict::Refused, .message = unit.refusal};
    if (!unit.refusal.empty()) {
        return result;
    }
    UnitFiles files = study.open(unit);
    const Record& record = files.record;
    if (record.verdict == UnitVerdict::Finished && !study.is_measured(record)) {
        study.measure(files);
    }
    machines.insert(machines.end(), record.machines.begin(), record.machines.end());
    result.verdict = record.verdict;
    result.message = record.message;
    result.cost = cost_of(record, study.plan().frames);
    result.errors = record.errors;
    return result;
}

void write_files(const StudyReport& report, OutputFolder& folder, const std::string& created_by) {
    write_text(folder.claim("study.json"), study_json(report, created_by));
    write_text(folder.claim("study.csv"), study_csv(report));
    const Drawing plot = frontier_plot(report);
    write_text(folder.claim("frontier.svg"), svg(plot));
    viewer::write_png(folder.claim("frontier.png"), raster(plot));
}

}  // namespace

StudyReport collect(StudyFolder& study, const std::string& created_by) {
    const Plan& plan = study.plan();
    require_all(study, study.folder().path());
    StudyReport report;
    report.scene = fs::path(plan.scene).filename().string();
    report.frames = plan.frames;
    report.scene_frames = plan.scene_frames;
    report.threads = plan.threads;
    std::vector<Machine> machines;
    collect_reference(study, report, machines);
    for (std::size_t i = plan.level_count(); i < plan.units.size(); ++i) {
        report.results.push_back(collect_unit(study, plan.units[i], machines));
    }
    report.frontier = frontier_of(report.results, report.reference.error_bar);
    report.sentences = sentences_of(report);
    if (const std::string warning = mixture_warning(machines); !warning.empty()) {
        report.warnings.push_back(warning);
    }
    write_files(report, study.folder(), created_by);
    return report;
}

std::string ranges_text(const std::vector<int>& numbers) {
    std::string text;
    for (std::size_t first = 0; first < numbers.size();) {
        std::size_t last = first;
        while (last + 1 < numbers.size() && numbers[last + 1] == numbers[last] + 1) {
            ++last;
        }
        text += (text.empty() ? "" : ", ") + std::to_string(numbers[first])
                + (last > first ? "-" + std::to_string(numbers[last]) : "");
        first = last + 1;
    }
    return text;
}

}  // namespace pent::study
