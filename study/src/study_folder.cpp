#include "study_folder.h"

#include <pent/error.h>
#include <pent/runs/scene_file.h>

#include <algorithm>

namespace pent::study {

namespace fs = std::filesystem;

fs::path StudyFolder::path_of(const Unit& unit, const char* ending) const {
    return folder_.path() / (unit.name + ending);
}

UnitFiles StudyFolder::open(const Unit& unit) const {
    const fs::path path = path_of(unit, ".toml");
    if (fingerprint(path) != unit.scene) {
        throw Error(path.string()
                    + ": is not the scene that was prepared; run --prepare again, and what has"
                      " been run of others stays");
    }
    const std::string text = read_text(path);
    UnitFiles files{.unit = unit,
                    .scene = runs::parse_scene(text, path.string(), path.parent_path()),
                    .record = {.scene = text, .meshes = unit.meshes, .threads = plan_.threads}};
    const std::optional<Record> before = read_record(path_of(unit, ".json"));
    files.is_begun = before && before->scene == text && before->meshes == unit.meshes
                     && before->threads == plan_.threads;
    if (files.is_begun) {
        files.record = *before;
    }
    return files;
}

void StudyFolder::write(const UnitFiles& files) {
    write_record(folder_.claim(files.unit.name + ".json"), files.record);
}

bool StudyFolder::is_done(const Unit& unit) const {
    return !unit.refusal.empty() || is_done(open(unit));
}

bool StudyFolder::is_done(const UnitFiles& files) const {
    const Record& record = files.record;
    if (record.verdict != UnitVerdict::Finished) {
        return record.verdict != UnitVerdict::None;
    }
    const auto has_frames = [&] {
        return verdict_of(path_of(files.unit)) == runs::RunVerdict::Finished;
    };
    if (files.unit.kind == UnitKind::Reference) {
        return has_frames();
    }
    const bool is_repeated = static_cast<int>(record.wall_seconds.size()) >= plan_.repeats;
    return is_repeated && ((is_measured(record) && !plan_.keep_runs) || has_frames());
}

bool StudyFolder::is_measured(const Record& record) const {
    return record.reference == plan_.reference;
}

Reference* StudyFolder::reference() {
    if (reference_ == nullptr) {
        for (std::size_t level = 0; level < plan_.level_count(); ++level) {
            if (!is_done(plan_.units[level])) {
                return nullptr;
            }
        }
        const Unit& finest = plan_.units[plan_.level_count() - 1];
        reference_ =
            std::make_unique<Reference>(open(finest).scene, path_of(finest), finest.meshes);
    }
    return reference_.get();
}

void StudyFolder::measure(UnitFiles& files) {
    const Trajectory run(files.scene, path_of(files.unit));
    files.record.errors = reference()->errors_of(run, files.unit.meshes);
    files.record.reference = plan_.reference;
    write(files);
    if (!plan_.keep_runs) {
        folder_.remove(files.unit.name + "/");
    }
}

}  // namespace pent::study
