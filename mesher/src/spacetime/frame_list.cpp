#include "frame_list.h"

#include "../xml_file.h"

#include <pent/counted.h>
#include <pent/error.h>
#include <pent/formatted.h>
#include <pent/input_path.h>
#include <pent/read_text.h>
#include <pent/real_text.h>

#include <algorithm>
#include <charconv>
#include <cmath>
#include <nlohmann/json.hpp>
#include <system_error>

namespace pent::mesher {

namespace {

namespace fs = std::filesystem;

double time_of(std::string_view word, const std::string& place) {
    double time = 0;
    const auto [end, error] = real_from_chars(word.data(), word.data() + word.size(), time);
    if (word.empty() || error != std::errc() || end != word.data() + word.size()
        || !std::isfinite(time)) {
        throw Error(place + ": timestep " + in_quotes(word) + ", expected a finite number");
    }
    return time;
}

fs::path file_of(const std::string& name, const fs::path& list, const std::string& place) {
    const bool is_plain =
        std::none_of(name.begin(), name.end(), [](char c) { return c >= 0 && c < ' '; });
    if (name.empty() || !is_plain) {
        throw Error(place + ": the file " + in_quotes(name) + ", expected a name");
    }
    return list.parent_path() / fs::path(name);
}

std::vector<FrameFile> read_pvd(const fs::path& path) {
    const std::string text = read_text(path, "a list of frames (.pvd)");
    const XmlElement root = parse_xml(text, path.string()).root;
    const XmlElement* collection = root.child("Collection");
    if (root.name != "VTKFile" || collection == nullptr) {
        throw Error(path.string() + ": found " + in_quotes(root.name)
                    + " without a Collection; expected VTKFile of type Collection");
    }
    std::vector<FrameFile> frames;
    for (const XmlElement& entry : collection->children) {
        const std::string place = path.string() + ": line " + std::to_string(entry.line);
        if (entry.name != "DataSet" || entry.attribute("file").empty()) {
            throw Error(place + ": found " + in_quotes(entry.name)
                        + " without a file; expected DataSet with timestep and file");
        }
        frames.push_back({file_of(std::string(entry.attribute("file")), path, place),
                          time_of(entry.attribute("timestep"), place), place});
    }
    return frames;
}

std::vector<FrameFile> read_series(const fs::path& path) {
    const std::string text = read_text(path, "a list of frames (.series)");
    const auto json = nlohmann::json::parse(text, nullptr, false);
    if (!json.is_object() || !json.contains("files") || !json["files"].is_array()) {
        throw Error(path.string()
                    + ": no JSON with a list \"files\"; expected {\"files\": [{\"name\": ...,"
                      " \"time\": ...}, ...]}");
    }
    std::vector<FrameFile> frames;
    for (const nlohmann::json& entry : json["files"]) {
        const std::string place = path.string() + ": file " + std::to_string(frames.size());
        if (!entry.is_object() || !entry.contains("name") || !entry["name"].is_string()
            || !entry.contains("time") || !entry["time"].is_number()) {
            throw Error(place + ": expected {\"name\": FILE, \"time\": SECONDS}");
        }
        frames.push_back({file_of(entry["name"].get<std::string>(), path, place),
                          entry["time"].get<double>(), place});
        if (!std::isfinite(frames.back().time)) {
            throw Error(place + ": its time is not finite");
        }
    }
    return frames;
}

// "heart_0012" is "heart_" and "0012".
std::size_t start_of_number(const std::string& stem) {
    const std::size_t last = stem.find_last_not_of("0123456789");
    return last == std::string::npos ? 0 : last + 1;
}

struct NumberedFile {
    std::uint64_t number = 0;
    fs::path path;
};

std::vector<NumberedFile> numbered_files(const fs::path& path) {
    const std::string stem = path.stem().string();
    const std::string start = stem.substr(0, start_of_number(stem));
    const fs::path folder = path.has_parent_path() ? path.parent_path() : fs::path(".");
    std::vector<NumberedFile> files;
    std::error_code error;
    fs::directory_iterator entry(folder, error);
    for (; !error && entry != fs::directory_iterator(); entry.increment(error)) {
        const fs::path found = entry->path();
        const std::string name = found.stem().string();
        std::uint64_t number = 0;
        const char* const end = name.data() + name.size();
        if (found.extension() != path.extension() || name.size() <= start.size()
            || !name.starts_with(start)) {
            continue;
        }
        const auto [stop, wrong] = std::from_chars(name.data() + start.size(), end, number);
        if (wrong == std::errc() && stop == end) {
            files.push_back({number, path.parent_path() / found.filename()});
        }
    }
    if (error) {
        throw Error(folder.string() + ": " + error.message() + "; expected numbered files");
    }
    std::sort(files.begin(), files.end(), [](const NumberedFile& a, const NumberedFile& b) {
        return a.number != b.number ? a.number < b.number : a.path < b.path;
    });
    return files;
}

std::vector<FrameFile> list_numbered(const fs::path& path, std::optional<double> time_step) {
    require_file(path);
    const std::string stem = path.stem().string();
    if (start_of_number(stem) == stem.size()) {
        throw Error(path.string()
                    + ": is one frame; expected a list of frames (.pvd, .series), or the first of"
                      " files with numbers, as frame_000" + path.extension().string());
    }
    if (!time_step || !(*time_step > 0) || !std::isfinite(*time_step)) {
        throw Error(path.string() + ": numbered files do not say when they are; expected a time"
                                    " step above 0: --time-step");
    }
    const std::vector<NumberedFile> files = numbered_files(path);
    std::vector<FrameFile> frames;
    for (std::size_t i = 0; i < files.size(); ++i) {
        if (files[i].path.filename() == path.filename()) {
            frames.clear();  // from the file that was named on
        }
        frames.push_back({files[i].path, 0, files[i].path.string()});
        const std::size_t n = frames.size();
        if (n >= 3
            && files[i].number - files[i - 1].number != files[i - 1].number - files[i - 2].number) {
            throw Error(files[i].path.string() + ": follows "
                        + files[i - 1].path.filename().string()
                        + ", not as far behind it as that is behind the one before: a frame is"
                          " missing, or there is one too many");
        }
        frames.back().time = static_cast<double>(n - 1) * *time_step;
    }
    return frames;
}

void check_times(const std::vector<FrameFile>& frames, const fs::path& path) {
    for (std::size_t i = 1; i < frames.size(); ++i) {
        const double before = frames[i - 1].time;
        if (frames[i].time == before) {
            throw Error(frames[i].place
                        + formatted(": a second file at the time %g; expected one file a time:"
                                    " merge parts first",
                                    before));
        }
        if (frames[i].time < before) {
            throw Error(frames[i].place
                        + formatted(": the time %g behind %g; expected times that increase",
                                    frames[i].time, before));
        }
    }
    if (frames.size() < 2) {
        throw Error(path.string() + ": " + counted(frames.size(), "frame", "frames")
                    + "; a space-time mesh needs two or more");
    }
}

}  // namespace

std::vector<FrameFile> list_frames(const fs::path& path, std::optional<double> time_step) {
    const std::string ending = format_of(path, "");
    const bool is_list = ending == ".pvd" || ending == ".series";
    if (is_list && time_step) {
        throw Error(path.string() + ": has times itself; leave out --time-step");
    }
    std::vector<FrameFile> frames = ending == ".pvd"      ? read_pvd(path)
                                    : ending == ".series" ? read_series(path)
                                                          : list_numbered(path, time_step);
    check_times(frames, path);
    return frames;
}

}  // namespace pent::mesher
