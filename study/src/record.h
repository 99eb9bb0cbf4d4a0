#pragma once

#include "machine.h"

#include <pent/study/study.h>

#include <filesystem>
#include <optional>
#include <string>
#include <vector>

namespace pent::study {

/// What is kept of a unit of a study: NAME.json.
struct Record {
    std::string scene = {};      ///< Text of the scene that was run.
    std::string reference = {};  ///< What it was compared with: the text of the reference's scene
                                 ///< and the checksum of its meshes; empty before.
    std::uint32_t meshes = 0;    ///< Checksum of the checksums of the mesh files.
    int threads = 0;             ///< Of each run.
    UnitVerdict verdict = UnitVerdict::None;  ///< While no run of it has ended.
    std::string message = {};
    std::vector<double> wall_seconds = {};  ///< One a repetition.
    std::vector<double> cpu_seconds = {};
    std::vector<double> peak_bytes = {};
    std::vector<Machine> machines = {};
    Errors errors = {};
};

/// The medians of a record.
[[nodiscard]] Cost cost_of(const Record& record, int frames);

void write_record(const std::filesystem::path& path, const Record& record);

/// Nothing if there is no such file. Throws an Error if it is something else.
[[nodiscard]] std::optional<Record> read_record(const std::filesystem::path& path);

/// All bytes of a file; none if there is none. Throws an Error if it cannot be read.
[[nodiscard]] std::string read_text(const std::filesystem::path& path);

/// What tells one build of a program from another: 16 hexadecimal digits of its bytes (FNV-1a).
[[nodiscard]] std::string fingerprint(const std::filesystem::path& program);

/// Text of study.json and study.csv.
[[nodiscard]] std::string study_json(const StudyReport& report, const std::string& created_by);
[[nodiscard]] std::string study_csv(const StudyReport& report);

}  // namespace pent::study
