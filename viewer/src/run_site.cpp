#include "run_site.h"

#include "web_page.h"

#include <pent/error.h>
#include <pent/input_path.h>
#include <pent/read_text.h>
#include <pent/run_files.h>
#include <pent/viewer/run_folder.h>

#include <algorithm>
#include <fstream>
#include <nlohmann/json.hpp>
#include <optional>
#include <sstream>
#include <system_error>
#include <vector>

namespace pent::viewer {

namespace {

namespace fs = std::filesystem;

constexpr const char* kPlayground = "playground.js";  // beside the page, where it was built

// What the page needs: its own scripts and style, workers that it makes itself, the simulator in
// one of them, files of the run.
constexpr const char* kPolicy =
    "Content-Security-Policy: default-src 'none'; "
    "script-src 'self' 'unsafe-inline' 'wasm-unsafe-eval' blob:; "
    "worker-src blob:; style-src 'unsafe-inline'; img-src data: blob:; media-src blob:; "
    "connect-src 'self'; base-uri 'none'; form-action 'none'; frame-ancestors 'none'\r\n";

std::optional<std::string> read_file(const fs::path& path) {
    std::error_code error;
    if (!fs::is_regular_file(path, error)) {
        return std::nullopt;
    }
    try {
        return read_text(path, "a file of a run");
    } catch (const Error&) {
        return std::nullopt;
    }
}

// Frames as ranges: [[0,89],[95,95]].
std::string ranges(const std::vector<int>& frames) {
    std::string text = "[";
    for (std::size_t i = 0; i < frames.size();) {
        std::size_t last = i;
        while (last + 1 < frames.size() && frames[last + 1] == frames[last] + 1) {
            ++last;
        }
        text += (i == 0 ? "[" : ",[") + std::to_string(frames[i]) + ","
                + std::to_string(frames[last]) + "]";
        i = last + 1;
    }
    return text + "]";
}

// Whether pent-sim may still be at work: report.json says so near its start. Without a report it
// has just begun.
bool is_growing(const fs::path& run) {
    std::ifstream file(run / kReportFile, std::ios::binary);
    std::string head(1024, '\0');
    file.read(head.data(), static_cast<std::streamsize>(head.size()));
    head.resize(static_cast<std::size_t>(file.gcount()));
    return head.empty() || head.find("\"verdict\": \"running\"") != std::string::npos;
}

// A file name of a run, with no way out of its folder: "meshes/a.pent", "report.json".
bool is_served(const std::string& name) {
    if (name == kSceneFile || name == kReportFile || name == kObstaclesFile) {
        return true;
    }
    const std::size_t slash = name.find('/');
    const std::string folder = name.substr(0, slash);
    const bool has_ending =
        folder == kObstaclesFolder
            ? name.ends_with(".json")
            : (folder == kMeshesFolder || folder == kFramesFolder) && name.ends_with(".pent");
    return has_ending && slash != std::string::npos && name[slash + 1] != '.'
           && name.find('/', slash + 1) == std::string::npos;
}

// Frames whose obstacles are there, too: pent-sim writes them last.
std::vector<int> whole_frames(const RunFolder& run) {
    std::vector<int> frames;
    for (const int frame : run.frames) {
        if (fs::exists(run.path / obstacles_file(frame))) {
            frames.push_back(frame);
        }
    }
    return frames;
}

// A model of other programs, G4MF, which the page reads and this library does not know.
bool is_model(const fs::path& path) {
    std::error_code error;
    const std::string ending = format_of(path, "");
    return (ending == ".g4b" || ending == ".g4tf") && fs::is_regular_file(path, error);
}

// The files that a model says its buffers are in; none where it cannot be read, as the page tells.
std::vector<std::string> buffer_files(const fs::path& model) {
    // Of the text, behind the headers of the file and of its first chunk.
    constexpr std::size_t kChunkBegin = 32;
    std::string text = read_file(model).value_or("");
    const bool is_chunked = text.starts_with("G4MF");
    std::istringstream stream(is_chunked ? text.substr(std::min(kChunkBegin, text.size())) : text);
    std::vector<std::string> files;
    try {
        nlohmann::json json;
        stream >> json;  // and nothing behind it
        for (const nlohmann::json& buffer : json.at("buffers")) {
            if (buffer.contains("uri")) {
                files.push_back(buffer.at("uri").get<std::string>());
            }
        }
    } catch (const nlohmann::json::exception&) {
        files.clear();
    }
    return files;
}

HttpResponse binary(std::optional<std::string> bytes, const std::string& type) {
    if (!bytes) {
        return refusal(404, "no such file");
    }
    HttpResponse response;
    response.type = type;
    response.body = std::move(*bytes);
    return response;
}

}  // namespace

RunSite::RunSite(const fs::path& page, const fs::path& run)
    : page_(read_web_page(page)), playground_(page.parent_path() / kPlayground) {
    is_single_file_ = is_model(run) || open_run(run).is_mesh;
    run_ = fs::canonical(run);
    name_ = run_.filename().string();
}

// The page takes what is behind run= for an address, in which a name is encoded; as a part of this
// address that is encoded once more.
std::string RunSite::start() const {
    return "/?run=" + percent_encoded(percent_encoded(name_)) + "/";
}

HttpResponse RunSite::answer(const HttpRequest& request, int port) const {
    const std::string at = ":" + std::to_string(port);
    if (request.host != "127.0.0.1" + at && request.host != "localhost" + at) {
        return refusal(403, "the address must be http://127.0.0.1" + at + " or localhost");
    }
    if (request.method != "GET") {
        HttpResponse response = refusal(405, "nothing can be changed here; use GET");
        response.headers = "Allow: GET\r\n";
        return response;
    }
    if (request.path == "/" || request.path == "/index.html") {
        HttpResponse response = binary(page_, "text/html; charset=utf-8");
        response.headers = kPolicy;
        return response;
    }
    if (request.path == std::string("/") + kPlayground) {
        return binary(read_file(playground_), "text/javascript; charset=utf-8");
    }
    const std::string folder = "/" + name_ + "/";
    if (!request.path.starts_with(folder)) {
        return refusal(404, "there is " + folder + " and the page / alone");
    }
    const std::string name = request.path.substr(folder.size());
    if (is_single_file_ && name == name_) {
        return binary(read_file(run_), "application/octet-stream");
    }
    if (is_single_file_ && name != "run.json") {
        return buffer_of_model(name);
    }
    return name == "run.json" ? listing() : file_of_run(name);
}

HttpResponse RunSite::file_of_run(const std::string& name) const {
    if (!is_served(name)) {
        return refusal(404, "no such file");
    }
    // A link within the run may not lead out of it.
    std::error_code error;
    const fs::path path = fs::canonical(run_ / name, error);
    if (error || path.parent_path() != (run_ / name).parent_path()) {
        return refusal(404, "no such file");
    }
    const bool is_text = name == kSceneFile;
    return binary(read_file(path), name.ends_with(".json") ? "application/json"
                                   : is_text               ? "text/plain; charset=utf-8"
                                                           : "application/octet-stream");
}

HttpResponse RunSite::buffer_of_model(const std::string& name) const {
    // A name as browsers ask for it: without the "./" that a model may have in front of it.
    const fs::path asked = fs::path(name).lexically_normal();
    const auto is_asked = [&](const std::string& file) {
        return fs::path(file).lexically_normal() == asked;
    };
    const std::vector<std::string> files =
        is_model(run_) ? buffer_files(run_) : std::vector<std::string>();
    // Neither a model that names other files of this machine nor a link may lead out of its folder.
    const fs::path folder = run_.parent_path();
    std::error_code error;
    const fs::path path = fs::canonical(folder / asked, error);
    if (error || path.lexically_relative(folder) != asked || *asked.begin() == ".."
        || std::none_of(files.begin(), files.end(), is_asked)) {
        return refusal(404, "no such file");
    }
    return binary(read_file(path), "application/octet-stream");
}

HttpResponse RunSite::listing() const {
    if (is_single_file_) {  // whatever its name, the page need not tell from it what it is
        return binary("{\"mesh\":" + json_string(name_) + "}", "application/json");
    }
    try {
        const bool may_grow = is_growing(run_);  // before the frames, or the last might be missed
        RunFolder run = open_run(run_);
        const bool do_move = fs::is_directory(run_ / kObstaclesFolder);
        if (do_move && may_grow) {
            run.frames = whole_frames(run);
        }
        const std::string obstacles = do_move                             ? "moving"
                                      : fs::exists(run_ / kObstaclesFile) ? "still"
                                                                          : "none";
        std::string meshes;
        std::string frames;
        for (const std::string& body : run.bodies) {
            const std::string comma = meshes.empty() ? "" : ",";
            meshes += comma + json_string(body);
            frames += comma + json_string(body) + ":" + ranges(run.frames);
        }
        return binary("{\"meshes\":[" + meshes + "],\"frames\":{" + frames + "},\"obstacles\":\""
                          + obstacles + "\",\"follow\":" + (may_grow ? "true" : "false") + "}",
                      "application/json");
    } catch (const Error& error) {  // the run was removed meanwhile
        return refusal(404, error.what());
    }
}

}  // namespace pent::viewer
