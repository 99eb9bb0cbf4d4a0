#include "record/journal.h"

#include "record/json_record.h"

#include <pent/crc32c.h>
#include <pent/error.h>
#include <pent/formatted.h>
#include <pent/read_text.h>

#include <algorithm>
#include <utility>

namespace pent::runs {

namespace {

constexpr std::size_t kDigits = 8;

std::string line(const char* key, Json json) {
    Json entry;
    entry[key] = std::move(json);
    const std::string text = entry.dump(-1, ' ', false, Json::error_handler_t::replace);
    return formatted("%08x ", crc32c(text.data(), text.size())) + text + "\n";
}

// Adds what a line says to the journal; the checksum of its text is right.
void take(const std::string& text, Journal& journal) {
    const Json entry = Json::parse(text);
    if (!entry.is_object() || entry.size() != 1) {
        throw Error("found " + text + "; expected one key and its value");
    }
    const Json& value = entry.front();
    const std::string key = entry.begin().key();
    if (key == "part") {
        journal.parts.push_back(read_record<RunPart>(value));
        journal.parts.back().verdict = RunVerdict::Died;  // unless its end follows
    } else if (key == "step") {
        journal.steps.push_back(read_record<StepReport>(value));
    } else if (key == "frame") {
        journal.frames.push_back(read_record<FrameReport>(value));
        journal.has_checkpoint.push_back(value.at("has_checkpoint").get<bool>());
        RunPart& part = journal.parts.at(journal.parts.size() - 1);
        part.last_frame = journal.frames.back().frame;
        value.at("seconds").get_to(part.seconds);
    } else if (key == "end") {
        journal.parts.at(journal.parts.size() - 1) = read_record<RunPart>(value);
    } else {
        throw Error("found \"" + key + "\"; expected part, step, frame or end");
    }
}

}  // namespace

std::string part_line(const RunPart& part) {
    return line("part", write_record(part));
}

std::string step_line(const StepReport& step) {
    return line("step", write_record(step));
}

std::string frame_line(const FrameReport& frame, bool has_checkpoint, double seconds) {
    Json json = write_record(frame);
    json["has_checkpoint"] = has_checkpoint;
    json["seconds"] = seconds;
    return line("frame", std::move(json));
}

std::string end_line(const RunPart& part) {
    return line("end", write_record(part));
}

void Journal::cut(int last_frame) {
    const auto is_behind = [&](const FrameReport& frame) { return frame.frame > last_frame; };
    frames.erase(std::find_if(frames.begin(), frames.end(), is_behind), frames.end());
    has_checkpoint.resize(frames.size());
    const std::uint64_t last_step = frames.empty() ? 0 : frames.back().step;
    std::erase_if(steps, [&](const StepReport& step) { return step.step > last_step; });
    for (RunPart& part : parts) {
        part.last_frame = std::min(part.last_frame, last_frame);
    }
}

std::string journal_text(const Journal& journal) {
    std::string text;
    auto step = journal.steps.begin();
    std::size_t frame = 0;
    for (const RunPart& part : journal.parts) {
        text += part_line(part);
        for (; frame < journal.frames.size() && journal.frames[frame].frame <= part.last_frame;
             ++frame) {
            const FrameReport& now = journal.frames[frame];
            for (; step != journal.steps.end() && step->step <= now.step; ++step) {
                text += step_line(*step);
            }
            text += frame_line(now, journal.has_checkpoint[frame], part.seconds);
        }
        text += end_line(part);
    }
    return text;
}

std::optional<Journal> read_journal(const std::filesystem::path& path) {
    std::error_code ignored;
    if (!std::filesystem::exists(path, ignored)) {
        return std::nullopt;
    }
    const std::string text = read_text(path, "the journal of a run");
    Journal journal;
    int number = 1;
    for (std::size_t at = 0; at < text.size(); ++number) {
        const std::size_t end = text.find('\n', at);
        if (end == std::string::npos) {
            break;  // the run died while it wrote this
        }
        const std::string_view line = std::string_view(text).substr(at, end - at);
        const std::string content(line.substr(std::min(line.size(), kDigits + 1)));
        try {
            if (line.substr(0, kDigits + 1)
                != formatted("%08x ", crc32c(content.data(), content.size()))) {
                throw Error("its checksum does not fit");
            }
            take(content, journal);
        } catch (const std::exception& error) {
            throw Error(path.string() + ":" + std::to_string(number)
                        + ": is damaged, or the journal of another run (" + error.what()
                        + "); put it back, or use --force to start again");
        }
        at = end + 1;
    }
    return journal;
}

}  // namespace pent::runs
