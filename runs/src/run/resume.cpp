#include "run/resume.h"

#include <pent/error.h>
#include <pent/formatted.h>
#include <pent/mesh_part.h>
#include <pent/run_files.h>
#include <pent/runs/scene_file.h>

#include <algorithm>
#include <fstream>
#include <nlohmann/json.hpp>
#include <optional>
#include <span>
#include <sstream>
#include <utility>

namespace pent::runs {

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

std::vector<SleepState> read_rest(const fs::path& path, const std::vector<std::string>& bodies) {
    std::ifstream file(path);
    try {
        const auto json = nlohmann::json::parse(file);
        std::vector<SleepState> rest(bodies.size());
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

namespace {

// The mesh of a run as its folder has it, without what is beside it: the rows of a slab.
template <int Dim>
SimplexMesh<Dim> slab_in_folder(const fs::path& mesh_file,
                                const MeshSlab& rows,
                                const RunRanks& ranks) {
    const MeshSource<Dim> source(mesh_file, std::max(1, ranks.count()));
    SimplexMesh<Dim> slab = source.cells(rows.first_cell, rows.last_cell);
    SimplexMesh<Dim> vertices = rows_of<Dim>(
        source.vertices(), {.first_vertex = rows.first_vertex, .last_vertex = rows.last_vertex});
    slab.positions = std::move(vertices.positions);
    slab.columns = std::move(vertices.columns);
    slab.layers = std::move(vertices.layers);
    return slab;
}

}  // namespace

template <int Dim>
std::uint32_t check_same_mesh(const fs::path& mesh_file,
                              const SimplexMesh<Dim>& slab,
                              const RunRanks& ranks) {
    FileInfo before;
    ranks.agree([&] { before = read_info(mesh_file); });
    check_checksum(mesh_file, ranks.writers());
    const std::uint32_t now = checksum_of_mesh(slab, ranks.writers());
    const SlabPlace vertices =
        place_slab(ranks.writers(), static_cast<std::uint64_t>(slab.vertex_count()));
    const SlabPlace cells =
        place_slab(ranks.writers(), static_cast<std::uint64_t>(slab.cell_count()));
    bool is_same = before.dimension == Dim && !before.is_frame && !before.is_extrusion
                   && before.vertices == vertices.all && before.cells == cells.all;
    // Quantities, labels and tags beside the mesh are in its checksum, and change nothing of a run.
    if (is_same && before.crc32c != now) {
        const auto first_vertex = static_cast<Eigen::Index>(vertices.before);
        const auto first_cell = static_cast<Eigen::Index>(cells.before);
        const MeshSlab rows = {.first_vertex = first_vertex,
                               .last_vertex = first_vertex + slab.vertex_count(),
                               .first_cell = first_cell,
                               .last_cell = first_cell + slab.cell_count()};
        SimplexMesh<Dim> stored;
        ranks.agree([&] { stored = slab_in_folder<Dim>(mesh_file, rows, ranks); });
        is_same = checksum_of_mesh(stored, ranks.writers()) == now;
    }
    if (!is_same) {
        throw Error(mesh_file.string()
                    + ": is another mesh than that of the scene now; put the old one back, or use"
                      " --force to start again");
    }
    return before.crc32c;
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
Positions<Dim> positions_of(const StateBlocks& blocks,
                            const std::string& name,
                            Eigen::Index count) {
    const std::vector<double> values =
        blocks.get<double>(name, Dim * static_cast<std::size_t>(count));
    return Eigen::Map<const Positions<Dim>>(values.data(), Dim, count);
}

// Of vertices [first, first + count).
template <int Dim>
void put_positions(StateBlocks& blocks,
                   const std::string& name,
                   const Positions<Dim>& all,
                   Eigen::Index first,
                   Eigen::Index count) {
    blocks.put(name, std::span<const double>(all.data() + Dim * first,
                                             Dim * static_cast<std::size_t>(count)));
}

constexpr const char* kStiffnessBlock = "contact stiffness";
constexpr const char* kSpringsBlock = "broken springs";
constexpr const char* kPlacesBlock = "hold places";

std::string sleep_block(const std::string& body) {
    return "sleep/" + body;
}
std::string sleep_stiffness_block(const std::string& body) {
    return "sleep stiffness/" + body;
}
std::string positions_block(const std::string& body) {
    return "previous positions/" + body;
}
std::string velocities_block(const std::string& body) {
    return "previous velocities/" + body;
}

void put_sleep(StateBlocks& blocks, const std::string& body, const SleepState& sleep) {
    const std::uint64_t counts[] = {sleep.is_asleep ? 1U : 0U, sleep.quiet_steps};
    const double stiffness[] = {sleep.contact_stiffness};
    blocks.put<std::uint64_t>(sleep_block(body), counts);
    blocks.put<double>(sleep_stiffness_block(body), stiffness);
}

SleepState sleep_of(const StateBlocks& blocks, const std::string& body) {
    const auto counts = blocks.get<std::uint64_t>(sleep_block(body), 2);
    return {.is_asleep = counts[0] != 0,
            .quiet_steps = counts[1],
            .contact_stiffness = blocks.get<double>(sleep_stiffness_block(body), 1)[0]};
}

}  // namespace

template <int Dim>
StateBlocks carried_state(const Simulation<Dim>& simulation,
                          const std::vector<std::string>& bodies) {
    const Snapshot<Dim> snapshot = simulation.save();
    StateBlocks blocks;
    if (snapshot.contact_stiffness > 0) {
        const double stiffness[] = {snapshot.contact_stiffness};
        blocks.put<double>(kStiffnessBlock, stiffness);
    }
    if (std::count(snapshot.broken_springs.begin(), snapshot.broken_springs.end(), 1) > 0) {
        blocks.put<std::uint8_t>(kSpringsBlock, snapshot.broken_springs);
    }
    if (!snapshot.hold_places.isZero(0)) {
        put_positions<Dim>(blocks, kPlacesBlock, snapshot.hold_places, 0,
                           snapshot.hold_places.cols());
    }
    for (std::size_t i = 0; i < bodies.size(); ++i) {
        const int body = static_cast<int>(i);
        if (snapshot.sleep[i] != SleepState()) {
            put_sleep(blocks, bodies[i], snapshot.sleep[i]);
        }
        if (snapshot.previous_positions.cols() > 0) {
            const Eigen::Index first = simulation.first_vertex(body);
            const Eigen::Index count = simulation.mesh(body).vertex_count();
            put_positions<Dim>(blocks, positions_block(bodies[i]), snapshot.previous_positions,
                               first, count);
            put_positions<Dim>(blocks, velocities_block(bodies[i]), snapshot.previous_velocities,
                               first, count);
        }
    }
    return blocks;
}

template <int Dim>
void read_carried_state(const StateBlocks& blocks,
                        const std::vector<std::string>& bodies,
                        const Simulation<Dim>& simulation,
                        Snapshot<Dim>& snapshot) {
    const Snapshot<Dim> now = simulation.save();
    const bool has_barrier = now.contact_stiffness > 0;
    const std::size_t springs = now.broken_springs.size();
    snapshot.broken_springs = blocks.has(kSpringsBlock)
                                  ? blocks.get<std::uint8_t>(kSpringsBlock, springs)
                                  : std::vector<std::uint8_t>(springs, 0);
    snapshot.contact_stiffness = has_barrier ? blocks.get<double>(kStiffnessBlock, 1)[0] : 0;
    snapshot.hold_places = Positions<Dim>::Zero(Dim, now.hold_places.cols());
    if (blocks.has(kPlacesBlock)) {
        snapshot.hold_places = positions_of<Dim>(blocks, kPlacesBlock, snapshot.hold_places.cols());
    }
    snapshot.sleep.assign(bodies.size(), {});
    const bool has_history = blocks.has(positions_block(bodies.front()));
    const Eigen::Index total = has_history ? snapshot.positions.cols() : 0;
    snapshot.previous_positions.resize(Dim, total);
    snapshot.previous_velocities.resize(Dim, total);
    for (std::size_t i = 0; i < bodies.size(); ++i) {
        if (blocks.has(sleep_block(bodies[i]))) {
            snapshot.sleep[i] = sleep_of(blocks, bodies[i]);
        }
        if (has_history) {
            const Eigen::Index first = simulation.first_vertex(static_cast<int>(i));
            const Eigen::Index count = simulation.mesh(static_cast<int>(i)).vertex_count();
            snapshot.previous_positions.middleCols(first, count) =
                positions_of<Dim>(blocks, positions_block(bodies[i]), count);
            snapshot.previous_velocities.middleCols(first, count) =
                positions_of<Dim>(blocks, velocities_block(bodies[i]), count);
        }
    }
}

template <int Dim>
StateBlocks carried_state_of_old_run(const fs::path& folder,
                                     const std::vector<std::string>& bodies,
                                     const std::vector<std::uint32_t>& mesh_crcs,
                                     const Scene& scene,
                                     int frame) {
    if (scene.contact && scene.contact->model == ContactModel::Barrier) {
        throw Error(folder.string()
                    + ": was begun by version 0.1.0, which did not keep the stiffness of its"
                      " barrier: going on would lead elsewhere; use --force to start again");
    }
    StateBlocks blocks;
    if (scene.sleep) {
        const std::vector<SleepState> sleep = read_rest(folder / old_sleep_file(frame), bodies);
        for (std::size_t i = 0; i < bodies.size(); ++i) {
            put_sleep(blocks, bodies[i], sleep[i]);
        }
    }
    for (std::size_t i = 0; i < bodies.size(); ++i) {
        const fs::path path = folder / old_checkpoint_file(bodies[i], frame);
        if (!fs::exists(path)) {
            if (fs::exists(folder / old_checkpoint_file(bodies[i], frame + 2))) {
                throw Error(path.string() + ": is not kept so far back; put the later frames back,"
                                            " or use --force to start again");
            }
            break;  // there was none: the step before was the first, or cut in two
        }
        const Frame<Dim> before = read_own_frame<Dim>(
            path, mesh_crcs[i], static_cast<std::uint64_t>(frame),
            static_cast<std::uint64_t>(frame) * static_cast<std::uint64_t>(scene.steps_per_frame));
        const Eigen::Index count = before.positions.cols();
        put_positions<Dim>(blocks, positions_block(bodies[i]), before.positions, 0, count);
        put_positions<Dim>(blocks, velocities_block(bodies[i]), before.velocities, 0, count);
    }
    return blocks;
}

std::string old_checkpoint_file(const std::string& body, int frame) {
    return std::string(kCheckpointFolder) + "/" + frame_file_name(body, frame);
}

std::string old_sleep_file(int frame) {
    return std::string(kCheckpointFolder) + formatted("/rest_%06d.json", frame);
}

#define PENT_INSTANTIATE(Dim)                                                                  \
    template std::uint32_t check_same_mesh<Dim>(const fs::path&, const SimplexMesh<Dim>&,      \
                                                const RunRanks&);                              \
    template Frame<Dim> read_own_frame<Dim>(const fs::path&, std::uint32_t, std::uint64_t,     \
                                            std::uint64_t);                                    \
    template StateBlocks carried_state<Dim>(const Simulation<Dim>&,                            \
                                            const std::vector<std::string>&);                  \
    template void read_carried_state<Dim>(const StateBlocks&, const std::vector<std::string>&, \
                                          const Simulation<Dim>&, Snapshot<Dim>&);             \
    template StateBlocks carried_state_of_old_run<Dim>(                                        \
        const fs::path&, const std::vector<std::string>&, const std::vector<std::uint32_t>&,   \
        const Scene&, int);
PENT_INSTANTIATE(3)
PENT_INSTANTIATE(4)
#undef PENT_INSTANTIATE

}  // namespace pent::runs
