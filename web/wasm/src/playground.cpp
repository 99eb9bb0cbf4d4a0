#include "playground.h"

#include "handles.h"
#include "scene/scene_meshes.h"

#include <pent/machine_memory.h>
#include <pent/obstacles_file.h>
#include <pent/output_file.h>
#include <pent/pent_file.h>
#include <pent/run_files.h>
#include <pent/runs/scene_file.h>
#include <pent/with_dimension.h>

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <filesystem>
#include <string>
#include <utility>

using namespace pent;
using namespace pent::plugin;

// Where web/src/play/library.ts reads and writes.
static_assert(sizeof(void*) == 4);
static_assert(offsetof(pent_step_report, seconds) == 16 && offsetof(pent_step_report, refused) == 28
              && offsetof(pent_step_report, iterations) == 36
              && offsetof(pent_step_report, inverted) == 56
              && offsetof(pent_step_report, point_facet) == 72
              && offsetof(pent_step_report, obstacle) == 88 && sizeof(pent_step_report) == 112);
static_assert(offsetof(pent_energy, energy) == 8 && offsetof(pent_energy, is_stored) == 16
              && sizeof(pent_energy) == 24);
static_assert(offsetof(pent_point, cell) == 8 && offsetof(pent_point, weights) == 16);
static_assert(offsetof(pent_hit, place) == 56 && offsetof(pent_hit, distance) == 88);
static_assert(offsetof(pent_grab, anchor) == 56 && offsetof(pent_grab, stiffness) == 88
              && sizeof(pent_grab) == 112);
static_assert(offsetof(play_facts, gravity) == 16 && sizeof(play_facts) == 48);

namespace {

constexpr const char* kCreatedBy = "Pentimento playground";

namespace fs = std::filesystem;
using simulator::Material;

void stiffen(Material& material, double factor) {
    material.lame.lambda *= factor;
    material.lame.mu *= factor;
}

Scene with_settings(Scene scene, const play_settings& settings) {
    for (simulator::Body& body : scene.bodies) {
        stiffen(body.material, settings.stiffness);
        for (simulator::Region& region : body.regions) {
            stiffen(region.material, settings.stiffness);
        }
    }
    if (settings.damping >= 0) {
        const double mass = scene.damping ? scene.damping->mass : 0;
        scene.damping.reset();
        if (mass > 0 || settings.damping > 0) {
            scene.damping = simulator::Damping{.mass = mass, .stiffness = settings.damping};
        }
    }
    if (settings.steps_per_second > 0) {
        scene.frames_per_second = settings.steps_per_second;
        scene.steps_per_frame = 1;
    }
    simulator::check(scene);
    return scene;
}

// The state of another simulation at the step of this one that is nearest in time.
template <int Dim>
void take_over(const Simulation<Dim>& before, Simulation<Dim>& simulation) {
    simulator::Snapshot<Dim> state = before.save();
    const double dt = simulation.scene().dt();
    if (dt != before.scene().dt()) {
        state.steps = static_cast<std::uint64_t>(std::llround(before.time() / dt));
        state.time_step = dt;
        state.previous_positions.resize(Dim, 0);
        state.previous_velocities.resize(Dim, 0);
    }
    simulation.restore(state);
}

template <int Dim>
std::unique_ptr<Simulation<Dim>> open(const Scene& scene, const pent_simulation* before) {
    auto simulation =
        std::make_unique<Simulation<Dim>>(scene, runs::read_meshes<Dim>(scene).meshes,
                                          simulator::SimulationOptions{.memory = machine_memory()});
    if (before != nullptr) {
        const std::shared_ptr<Opened> opened = simulations().find(before, "simulation");
        const auto* held = std::get_if<std::unique_ptr<Simulation<Dim>>>(&opened->simulation);
        if (held == nullptr) {
            throw Error("the state is of a simulation of another dimension");
        }
        take_over(**held, *simulation);
    }
    return simulation;
}

// The scene with the meshes that are beside it, as placed.
Scene as_written(Scene scene) {
    for (simulator::Body& body : scene.bodies) {
        body.mesh = mesh_file(body.name);
        body.place = simulator::Placement();
        body.place.translate.setZero(scene.dimension);
    }
    return scene;
}

}  // namespace

pent_simulation* play_open(const char* scene_path,
                           const play_settings* settings,
                           const pent_simulation* before) {
    return guarded<pent_simulation*>(nullptr, [&] {
        require(scene_path, "scene_path");
        require(settings, "settings");
        const Scene scene = with_settings(runs::read_scene(scene_path), *settings);
        if (scene.dimension != 4) {  // the code for others would double what a browser has to load
            throw Error(std::string(scene_path) + ": the scene has dimension "
                        + std::to_string(scene.dimension)
                        + "; the playground has bodies of four dimensions alone. Simulate it with "
                          "pent-sim, and drop the run here or open it with pent-view");
        }
        auto opened = std::make_shared<Opened>();
        with_dimension(scene.dimension,
                       [&](auto dim) { opened->simulation = open<dim>(scene, before); });
        return simulations().add(std::move(opened));
    });
}

int play_get_facts(const pent_simulation* simulation, play_facts* facts) {
    return with(simulation, -1, [&](auto& held, Opened& /*opened*/) {
        require(facts, "facts");
        const Scene& scene = held.scene();
        *facts = {.time_step = scene.dt(),
                  .damping = scene.damping ? scene.damping->stiffness : 0,
                  .gravity = {}};
        const auto gravity = held.host().gravity;
        for (int axis = 0; axis < scene.dimension; ++axis) {
            facts->gravity[axis] = gravity ? (*gravity)[axis] : scene.gravity[axis];
        }
        return 0;
    });
}

const char* play_mesh_path(const pent_simulation* simulation, int body) {
    return with_body<const char*>(simulation, body, nullptr, [&](auto& held, Opened& /*opened*/) {
        return held.scene().bodies[static_cast<std::size_t>(body)].mesh.c_str();
    });
}

const double* play_contact_forces(const pent_simulation* simulation, int body) {
    static std::vector<double> forces;
    return with_body<const double*>(simulation, body, nullptr, [&](auto& held, Opened& /*opened*/) {
        const auto all = held.contact_forces(body);
        forces.assign(all.data(), all.data() + all.size());
        return forces.data();
    });
}

const char* play_obstacles(const pent_simulation* simulation) {
    static std::string text;
    return with<const char*>(simulation, nullptr, [&](auto& held, Opened& /*opened*/) {
        constexpr int kDim = kDimOf<std::remove_reference_t<decltype(held)>>;
        text = obstacles_text<kDim>(held.obstacles());
        return text.c_str();
    });
}

int play_begin_run(const pent_simulation* simulation, const char* folder) {
    return with(simulation, -1, [&](auto& held, Opened& /*opened*/) {
        require(folder, "folder");
        constexpr int kDim = kDimOf<std::remove_reference_t<decltype(held)>>;
        const fs::path run = folder;
        for (const char* part : {kMeshesFolder, kFramesFolder}) {
            fs::create_directories(run / part);
        }
        const Scene& scene = held.scene();
        write_text(run / kSceneFile, runs::scene_text(as_written(scene)));
        for (int body = 0; body < held.body_count(); ++body) {
            const simulator::Body& of_scene = scene.bodies[static_cast<std::size_t>(body)];
            auto extras = read_mesh<kDim>(of_scene.mesh).extras;
            runs::turn<kDim>(extras.vertex_fields, of_scene.place);
            runs::turn<kDim>(extras.cell_fields, of_scene.place);
            write_mesh(run / mesh_file(of_scene.name), held.mesh(body), {.created_by = kCreatedBy},
                       extras);
        }
        const bool do_move = std::any_of(scene.obstacles.begin(), scene.obstacles.end(),
                                         [](const auto& one) { return !one.motion.empty(); });
        if (do_move) {
            fs::create_directories(run / kObstaclesFolder);
        } else if (!scene.obstacles.empty()) {
            write_obstacles(run / kObstaclesFile, held.obstacles());
        }
        return 0;
    });
}

int play_add_frame(const pent_simulation* simulation, const char* folder, int frame) {
    return with(simulation, -1, [&](auto& held, Opened& /*opened*/) {
        require(folder, "folder");
        constexpr int kDim = kDimOf<std::remove_reference_t<decltype(held)>>;
        const fs::path run = folder;
        for (int body = 0; body < held.body_count(); ++body) {
            const std::string& name = held.scene().bodies[static_cast<std::size_t>(body)].name;
            Frame<kDim> file;
            file.positions = held.positions(body);
            file.velocities = held.velocities(body);
            file.contact_forces = held.contact_forces(body);
            file.mesh_name = name + ".pent";
            file.mesh_crc = read_info(run / mesh_file(name)).crc32c;
            file.frame = static_cast<std::uint64_t>(frame);
            file.step = held.step_count();
            file.time = held.time();
            write_frame(run / frame_file(name, frame), file, {.created_by = kCreatedBy});
        }
        if (fs::exists(run / kObstaclesFolder)) {
            write_obstacles(run / obstacles_file(frame), held.obstacles());
        }
        return 0;
    });
}
