#include "resume.h"

#include <pent/error.h>

#include <fstream>
#include <nlohmann/json.hpp>
#include <sstream>
#include <vector>

namespace pent::simulator {

namespace fs = std::filesystem;

void check_same_scene(const fs::path& scene_file, const std::string& text) {
    std::ifstream before(scene_file);
    std::istringstream now(text);
    std::string old_line;
    std::string new_line;
    const auto next = [](std::istream& lines, std::string& line) {
        do {
            if (!std::getline(lines, line)) {
                line = "(its end)";
                return false;
            }
        } while (line.rfind("frames = ", 0) == 0);
        return true;
    };
    bool is_old = true;
    bool is_new = true;
    while (is_old && is_new) {
        is_old = next(before, old_line);
        is_new = next(now, new_line);
        if (old_line != new_line) {
            throw Error(scene_file.string() + ": is another scene than the one given: it has "
                        + old_line + " where that has " + new_line
                        + "; only the number of frames may change; use --force to start again");
        }
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
