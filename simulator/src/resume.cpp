#include "resume.h"

#include <pent/error.h>
#include <pent/simulator/scene_file.h>

#include <fstream>
#include <iterator>
#include <nlohmann/json.hpp>
#include <optional>
#include <sstream>
#include <utility>
#include <vector>

namespace pent::simulator {

namespace fs = std::filesystem;

namespace {

// The first line in which two scenes differ but for the number of frames, of each; none: no line.
std::optional<std::pair<std::string, std::string>> difference(const std::string& a,
                                                              const std::string& b) {
    std::istringstream lines_of_a(a);
    std::istringstream lines_of_b(b);
    std::pair<std::string, std::string> lines;
    const auto next = [](std::istream& text, std::string& line) {
        do {
            if (!std::getline(text, line)) {
                line = "(its end)";
                return false;
            }
        } while (line.rfind("frames = ", 0) == 0);
        return true;
    };
    bool is_in_a = true;
    bool is_in_b = true;
    while (is_in_a && is_in_b) {
        is_in_a = next(lines_of_a, lines.first);
        is_in_b = next(lines_of_b, lines.second);
        if (lines.first != lines.second) {
            return lines;
        }
    }
    return std::nullopt;
}

// As this program writes it: another may have begun the run that did not know every key yet.
std::string written_again(const std::string& scene, const std::string& name) {
    try {
        return scene_text(parse_scene(scene, name, ""));
    } catch (const Error& error) {
        throw Error(error.what() + std::string("; use --force to start again"));
    }
}

}  // namespace

void check_same_scene(const fs::path& scene_file, const std::string& text) {
    std::ifstream file(scene_file, std::ios::binary);
    const std::string before{std::istreambuf_iterator<char>(file), {}};
    if (!difference(before, text)) {
        return;
    }
    if (const auto lines = difference(written_again(before, scene_file.string()), text)) {
        throw Error(scene_file.string() + ": is another scene than the one given: it has "
                    + lines->first + " where that has " + lines->second
                    + "; only the number of frames may change; use --force to start again");
    }
}

template <int Dim>
std::uint32_t check_same_mesh(const fs::path& mesh_file, const SimplexMesh<Dim>& mesh) {
    const MeshFile<Dim> before = read_mesh<Dim>(mesh_file);
    if (before.mesh.positions.cols() != mesh.positions.cols()
        || before.mesh.positions != mesh.positions || before.mesh.cells.cols() != mesh.cells.cols()
        || before.mesh.cells != mesh.cells) {
        throw Error(mesh_file.string()
                    + ": is another mesh than that of the scene now; put the old one back, or use"
                      " --force to start again");
    }
    return before.info.crc32c;
}

template <int Dim>
Frame<Dim> read_own_frame(const fs::path& path,
                          std::uint32_t mesh_crc,
                          std::uint64_t frame,
                          std::uint64_t step) {
    constexpr const char* kAdvice = "; remove it to go on from the frame before";
    Frame<Dim> file;
    try {
        file = read_frame<Dim>(path);
    } catch (const Error& error) {
        throw Error(error.what() + std::string(kAdvice));
    }
    if (file.mesh_crc != mesh_crc) {
        throw Error(path.string() + ": belongs to another mesh than that in the folder" + kAdvice);
    }
    if (file.frame != frame || file.step != step) {
        throw Error(path.string() + ": holds frame " + std::to_string(file.frame) + ", step "
                    + std::to_string(file.step) + "; expected frame " + std::to_string(frame)
                    + ", step " + std::to_string(step) + kAdvice);
    }
    return file;
}

template std::uint32_t check_same_mesh<3>(const fs::path&, const SimplexMesh<3>&);
template std::uint32_t check_same_mesh<4>(const fs::path&, const SimplexMesh<4>&);
template Frame<3> read_own_frame<3>(const fs::path&, std::uint32_t, std::uint64_t, std::uint64_t);
template Frame<4> read_own_frame<4>(const fs::path&, std::uint32_t, std::uint64_t, std::uint64_t);

void remove_temporaries(const fs::path& folder) {
    std::vector<fs::path> left;
    for (const auto& entry : fs::recursive_directory_iterator(folder)) {
        const std::string name = entry.path().filename().string();
        if (name.front() == '.' && entry.path().extension() == ".tmp") {
            left.push_back(entry.path());
        }
    }
    for (const fs::path& path : left) {
        std::error_code ignored;
        fs::remove(path, ignored);
    }
}

std::string isa_of_run(const fs::path& folder) {
    std::ifstream file(folder / "report.json");
    const auto report = nlohmann::json::parse(file, nullptr, false);
    const auto isa = report.find("isa");
    return isa != report.end() && isa->is_string() ? isa->get<std::string>() : "";
}

}  // namespace pent::simulator
