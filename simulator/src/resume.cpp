#include "resume.h"

#include <pent/error.h>
#include <pent/simulator/scene_file.h>

#include <fstream>
#include <nlohmann/json.hpp>
#include <optional>
#include <span>
#include <sstream>
#include <utility>

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

std::vector<BodyRest> read_rest(const fs::path& path, const std::vector<std::string>& bodies) {
    std::ifstream file(path);
    try {
        const auto json = nlohmann::json::parse(file);
        std::vector<BodyRest> rest(bodies.size());
        for (std::size_t body = 0; body < bodies.size(); ++body) {
            const auto& entry = json.at(bodies[body]);
            entry.at("is_asleep").get_to(rest[body].is_asleep);
            rest[body].quiet_steps =
                entry.at("quiet_steps").get_ref<const nlohmann::json::number_unsigned_t&>();
        }
        return rest;
    } catch (const nlohmann::json::exception&) {
        throw Error(path.string()
                    + ": does not say which bodies sleep; remove the last frame to go on from the"
                      " one before, or use --force to start again");
    }
}

// What has to be the same in both parts of a run, as a file has it: meshes are compared themselves,
// wherever they are.
std::string comparable_text(Scene scene) {
    for (Body& body : scene.bodies) {
        body.mesh = "";
        body.recipe = "";
    }
    return scene_text(parse_scene(scene_text(scene), "the scene", ""));
}

// The scene of a run as this program reads it: another may have begun the run that did not know
// every key yet.
Scene read_own_scene(const fs::path& path) {
    try {
        return read_scene(path);
    } catch (const Error& error) {
        throw Error(error.what() + std::string("; use --force to start again"));
    }
}

}  // namespace

void check_same_scene(const fs::path& scene_file, const Scene& scene) {
    const auto lines =
        difference(comparable_text(read_own_scene(scene_file)), comparable_text(scene));
    if (lines) {
        throw Error(scene_file.string() + ": is another scene than the one given: it has "
                    + lines->first + " where that has " + lines->second
                    + "; only the number of frames may change; use --force to start again");
    }
}

template <int Dim>
std::uint32_t check_same_mesh(const fs::path& mesh_file, const SimplexMesh<Dim>& mesh) {
    const MeshFile<Dim> before = read_mesh<Dim>(mesh_file);
    const bool is_same =
        before.mesh.positions.cols() == mesh.positions.cols()
        && before.mesh.positions == mesh.positions && before.mesh.cells.cols() == mesh.cells.cols()
        && before.mesh.cells == mesh.cells && before.mesh.regions == mesh.regions
        && before.mesh.columns == mesh.columns && before.mesh.layers == mesh.layers;
    if (!is_same) {
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

namespace {

template <int Dim>
std::span<const double> numbers(const Eigen::Map<const Positions<Dim>>& positions) {
    return {positions.data(), static_cast<std::size_t>(positions.size())};
}

template <int Dim>
Positions<Dim> positions_of(const StateBlocks& blocks,
                            const std::string& name,
                            Eigen::Index count) {
    const std::vector<double> values =
        blocks.get<double>(name, Dim * static_cast<std::size_t>(count));
    return Eigen::Map<const Positions<Dim>>(values.data(), Dim, count);
}

std::string rest_block(const std::string& body) {
    return "rest/" + body;
}
std::string positions_block(const std::string& body) {
    return "previous positions/" + body;
}
std::string velocities_block(const std::string& body) {
    return "previous velocities/" + body;
}

void put_rest(StateBlocks& blocks, const std::string& body, const BodyRest& rest) {
    const std::uint64_t values[] = {rest.is_asleep ? 1U : 0U, rest.quiet_steps};
    blocks.put<std::uint64_t>(rest_block(body), values);
}

}  // namespace

template <int Dim>
StateBlocks carried_state(const Simulation<Dim>& simulation,
                          const std::vector<std::string>& bodies) {
    StateBlocks blocks;
    for (std::size_t i = 0; i < bodies.size(); ++i) {
        const int body = static_cast<int>(i);
        if (simulation.rest()[i] != BodyRest()) {
            put_rest(blocks, bodies[i], simulation.rest()[i]);
        }
        if (simulation.has_history()) {
            blocks.put(positions_block(bodies[i]),
                       numbers<Dim>(simulation.previous_positions(body)));
            blocks.put(velocities_block(bodies[i]),
                       numbers<Dim>(simulation.previous_velocities(body)));
        }
    }
    return blocks;
}

template <int Dim>
void restore_carried_state(const StateBlocks& blocks,
                           const std::vector<std::string>& bodies,
                           Simulation<Dim>& simulation) {
    std::vector<BodyRest> rest(bodies.size());
    for (std::size_t i = 0; i < bodies.size(); ++i) {
        const int body = static_cast<int>(i);
        const Eigen::Index count = simulation.mesh(body).vertex_count();
        if (blocks.has(positions_block(bodies[i]))) {
            simulation.set_history(body,
                                   positions_of<Dim>(blocks, positions_block(bodies[i]), count),
                                   positions_of<Dim>(blocks, velocities_block(bodies[i]), count));
        }
        if (blocks.has(rest_block(bodies[i]))) {
            const auto values = blocks.get<std::uint64_t>(rest_block(bodies[i]), 2);
            rest[i] = {.is_asleep = values[0] != 0, .quiet_steps = values[1]};
        }
    }
    simulation.set_rest(rest);
}

template <int Dim>
StateBlocks carried_state_of_old_run(const fs::path& folder,
                                     const std::vector<std::string>& bodies,
                                     const std::vector<std::uint32_t>& mesh_crcs,
                                     const Scene& scene,
                                     int frame) {
    StateBlocks blocks;
    const auto checkpoint = [&](const std::string& name, int number) {
        return folder / "checkpoint" / frame_file_name(name, number);
    };
    if (scene.sleep) {
        const fs::path path = checkpoint("rest", frame).replace_extension(".json");
        const std::vector<BodyRest> rest = read_rest(path, bodies);
        for (std::size_t i = 0; i < bodies.size(); ++i) {
            put_rest(blocks, bodies[i], rest[i]);
        }
    }
    for (std::size_t i = 0; i < bodies.size(); ++i) {
        const fs::path path = checkpoint(bodies[i], frame);
        if (!fs::exists(path)) {
            if (fs::exists(checkpoint(bodies[i], frame + 2))) {
                throw Error(path.string() + ": is not kept so far back; put the later frames back,"
                                            " or use --force to start again");
            }
            break;  // there was none: the step before was the first, or cut in two
        }
        const Frame<Dim> before = read_own_frame<Dim>(
            path, mesh_crcs[i], static_cast<std::uint64_t>(frame),
            static_cast<std::uint64_t>(frame) * static_cast<std::uint64_t>(scene.steps_per_frame));
        const auto count = static_cast<std::size_t>(before.positions.size());
        blocks.put(positions_block(bodies[i]),
                   std::span<const double>(before.positions.data(), count));
        blocks.put(velocities_block(bodies[i]),
                   std::span<const double>(before.velocities.data(), count));
    }
    return blocks;
}

#define PENT_INSTANTIATE(Dim)                                                                     \
    template std::uint32_t check_same_mesh<Dim>(const fs::path&, const SimplexMesh<Dim>&);        \
    template Frame<Dim> read_own_frame<Dim>(const fs::path&, std::uint32_t, std::uint64_t,        \
                                            std::uint64_t);                                       \
    template StateBlocks carried_state<Dim>(const Simulation<Dim>&,                               \
                                            const std::vector<std::string>&);                     \
    template void restore_carried_state<Dim>(const StateBlocks&, const std::vector<std::string>&, \
                                             Simulation<Dim>&);                                   \
    template StateBlocks carried_state_of_old_run<Dim>(                                           \
        const fs::path&, const std::vector<std::string>&, const std::vector<std::uint32_t>&,      \
        const Scene&, int);
PENT_INSTANTIATE(3)
PENT_INSTANTIATE(4)
#undef PENT_INSTANTIATE

}  // namespace pent::simulator
