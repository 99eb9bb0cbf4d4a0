#include "pent/run_files.h"

#include "pent/error.h"
#include "pent/formatted.h"
#include "pent/pent_file.h"

#include <algorithm>
#include <charconv>
#include <optional>
#include <system_error>
#include <utility>

namespace pent {

namespace fs = std::filesystem;

namespace {

constexpr const char* kEnding = ".pent";

std::string in_folder(const char* folder, const std::string& file) {
    return std::string(folder) + "/" + file;
}

// Names without their ending of the .pent files in a folder; hidden ones are temporary.
std::vector<std::string> stems_in(const fs::path& folder, const std::string& expected) {
    std::vector<std::string> stems;
    std::error_code error;
    fs::directory_iterator entry(folder, error);
    for (; !error && entry != fs::directory_iterator(); entry.increment(error)) {
        const fs::path name = entry->path().filename();
        if (name.extension() == kEnding && name.string().front() != '.') {
            stems.push_back(name.stem().string());
        }
    }
    if (error) {
        throw Error(folder.string() + ": " + error.message() + "; expected " + expected);
    }
    std::sort(stems.begin(), stems.end());
    return stems;
}

// Body and number that the name of a frame is made of; a body's name may have digits and _ itself.
std::optional<std::pair<std::string, int>> parts_of_frame(const std::string& stem) {
    const std::size_t bar = stem.rfind('_');
    if (bar == std::string::npos) {
        return std::nullopt;
    }
    int frame = 0;
    std::from_chars(stem.data() + bar + 1, stem.data() + stem.size(), frame);
    std::string body = stem.substr(0, bar);
    if (frame < 0 || frame_file_name(body, frame) != stem + kEnding) {
        return std::nullopt;
    }
    return std::pair(std::move(body), frame);
}

}  // namespace

std::string mesh_file(const std::string& body) {
    return in_folder(kMeshesFolder, body + kEnding);
}

std::string frame_file(const std::string& body, int frame) {
    return in_folder(kFramesFolder, frame_file_name(body, frame));
}

std::string obstacles_file(int frame) {
    return in_folder(kObstaclesFolder, formatted("%06d.json", frame));
}

std::string contacts_file(int frame) {
    return in_folder(kContactsFolder, formatted("%06d.csv", frame));
}

std::string checkpoint_file(int frame) {
    return in_folder(kCheckpointFolder, formatted("%06d.state", frame));
}

std::vector<std::string> bodies_of_run(const fs::path& run, const std::string& expected) {
    return stems_in(run / kMeshesFolder, expected);
}

std::map<std::string, std::set<int>> frames_of_run(const fs::path& run,
                                                   const std::string& expected) {
    std::map<std::string, std::set<int>> frames;
    for (const std::string& stem : stems_in(run / kFramesFolder, expected)) {
        if (const auto parts = parts_of_frame(stem)) {
            frames[parts->first].insert(parts->second);
        }
    }
    return frames;
}

}  // namespace pent
