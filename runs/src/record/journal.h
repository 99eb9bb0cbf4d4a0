#pragma once

#include "simulator_names.h"

#include <pent/runs/run.h>

#include <filesystem>
#include <optional>
#include <string>
#include <vector>

namespace pent::runs {

/// RUN/journal.txt: what a run did, written as it goes, so that a kill loses nothing of the
/// statistics and a damaged byte is noticed. A line is 8 hexadecimal digits, the crc32c of what
/// follows the space behind them, and an object with one key:
///
///     {"part": ...}    a call of run() begins
///     {"step": ...}    a step, as in report.json
///     {"frame": ...}   a frame whose steps are above; written before the files of the frame
///     {"end": ...}     the part, as it ended; a part without has died
struct Journal {
    std::vector<RunPart> parts;
    std::vector<FrameReport> frames;
    std::vector<bool> has_checkpoint;  ///< One a frame: whether there is state beside its files.
    std::vector<StepReport> steps;

    /// Forgets what is behind a frame.
    void cut(int last_frame);
};

/// A line of each kind, with its newline.
[[nodiscard]] std::string part_line(const RunPart& part);
[[nodiscard]] std::string step_line(const StepReport& step);
/// @param seconds  Of the part, so far.
[[nodiscard]] std::string frame_line(const FrameReport& frame, bool has_checkpoint, double seconds);
[[nodiscard]] std::string end_line(const RunPart& part);

/// All lines of a journal whose last part has ended or died.
[[nodiscard]] std::string journal_text(const Journal& journal);

/// Nothing if there is no such file. A last line that is not whole is left out; parts without an
/// end have the verdict "died". Throws an Error that names the line for anything else.
[[nodiscard]] std::optional<Journal> read_journal(const std::filesystem::path& path);

}  // namespace pent::runs
