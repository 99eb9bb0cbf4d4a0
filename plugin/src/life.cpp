// Simulations that are opened and closed, stepped, saved and restored.

#include "handles.h"

#include <pent/counted.h>
#include <pent/machine_memory.h>
#include <pent/runs/scene_file.h>
#include <pent/runs/scene_meshes.h>
#include <pent/with_dimension.h>

#include <algorithm>
#include <utility>

using namespace pent;
using namespace pent::plugin;

namespace {

template <int Dim>
std::vector<SimplexMesh<Dim>> meshes_of(const Scene& scene, const pent_mesh* meshes) {
    std::vector<SimplexMesh<Dim>> all;
    for (const simulator::Body& body : scene.bodies) {
        all.push_back(mesh_of_body<Dim>(scene, body, meshes[all.size()]));
    }
    return all;
}

template <int Dim>
std::unique_ptr<Simulation<Dim>> make_simulation(const Scene& scene,
                                                 const pent_mesh* meshes,
                                                 int threads) {
    return std::make_unique<Simulation<Dim>>(
        scene,
        meshes != nullptr ? meshes_of<Dim>(scene, meshes) : runs::read_meshes<Dim>(scene).meshes,
        simulator::SimulationOptions{.threads = threads, .memory = machine_memory()});
}

pent_simulation* open(const Scene& scene, const pent_mesh* meshes, int threads) {
    auto opened = std::make_shared<Opened>();
    with_dimension(scene.dimension, [&](auto dim) {
        opened->simulation = make_simulation<dim>(scene, meshes, threads);
    });
    return simulations().add(std::move(opened));
}

pent_step_report c_report(const simulator::StepReport& step) {
    return {.step = step.step,
            .time = step.time,
            .seconds = step.seconds,
            .substeps = step.substeps,
            .refused = step.refused,
            .newton_iterations = step.newton_iterations,
            .iterations = step.iterations,
            .residual = step.residual,
            .unknowns = step.unknowns,
            .inverted = step.inverted,
            .asleep = step.asleep,
            .point_facet = step.contact.point_facet,
            .mixed = step.contact.mixed,
            .obstacle = step.contact.obstacle,
            .deepest = step.contact.deepest,
            .smallest_distance = step.contact.smallest_distance};
}

}  // namespace

int pent_plugin_version(void) {
    return PENT_PLUGIN_VERSION;
}

const char* pent_last_error(void) {
    return last_error().c_str();
}

// What hosts of version 1 call first; no header has it any more.
extern "C" PENT_PLUGIN_API void* pent_open(const char* scene_path, int threads);
void* pent_open(const char* /*scene_path*/, int /*threads*/) {
    return guarded<void*>(nullptr, []() -> void* {
        throw Error("this host was built for version 1 of pent_plugin.h, the library has version "
                    + std::to_string(PENT_PLUGIN_VERSION)
                    + ": build it with the new header, where pent_open_file() takes the place of"
                      " pent_open()");
    });
}

pent_simulation* pent_open_file(const char* scene_path, int threads) {
    return guarded<pent_simulation*>(nullptr, [&] {
        require(scene_path, "scene_path");
        return open(runs::read_scene(scene_path), nullptr, threads);
    });
}

pent_simulation* pent_open_text(const char* scene,
                                const pent_mesh* meshes,
                                int64_t mesh_count,
                                int threads) {
    return pent_open_scene(scene, "scene", "", meshes, mesh_count, threads);
}

pent_simulation* pent_open_scene(const char* scene,
                                 const char* name,
                                 const char* folder,
                                 const pent_mesh* meshes,
                                 int64_t mesh_count,
                                 int threads) {
    return guarded<pent_simulation*>(nullptr, [&] {
        require(scene, "scene");
        require(name, "name");
        require(folder, "folder");
        require(meshes, "meshes");
        const Scene read = runs::parse_scene(scene, name, folder);
        const auto bodies = static_cast<std::int64_t>(read.bodies.size());
        if (mesh_count != bodies) {
            throw Error("the scene has " + counted(bodies, "body", "bodies") + "; got "
                        + counted(mesh_count, "mesh", "meshes"));
        }
        return open(read, meshes, threads);
    });
}

int pent_close(pent_simulation* simulation) {
    return release(simulations(), simulation, "simulation");
}

pent_kept* pent_keep(const pent_simulation* simulation) {
    return with<pent_kept*>(simulation, nullptr, [](auto& held, Opened& opened) {
        return kept_arrays().add(std::make_shared<Kept>(Kept{held.arrays(), opened.boundaries}));
    });
}

int pent_free_kept(pent_kept* kept) {
    return release(kept_arrays(), kept, "set of kept arrays");
}

int pent_step(pent_simulation* simulation, pent_step_report* report) {
    return with(simulation, -1, [&](auto& held, Opened& /*opened*/) {
        const simulator::StepReport step = held.step();
        if (report != nullptr) {
            *report = c_report(step);
        }
        if (!step.is_accepted) {
            throw Error(step.failure);
        }
        return 0;
    });
}

pent_state* pent_save(const pent_simulation* simulation) {
    return with<pent_state*>(simulation, nullptr, [](auto& held, Opened& /*opened*/) {
        return states().add(std::make_shared<Offered::Snapshots>(held.save()));
    });
}

int pent_restore(pent_simulation* simulation, const pent_state* state) {
    return with(simulation, -1, [&](auto& held, Opened& /*opened*/) {
        constexpr int kDim = kDimOf<std::remove_reference_t<decltype(held)>>;
        const std::shared_ptr<Offered::Snapshots> saved = states().find(state, "state");
        const auto* snapshot = std::get_if<simulator::Snapshot<kDim>>(saved.get());
        if (snapshot == nullptr) {
            throw Error("the state is of a simulation of another dimension");
        }
        held.restore(*snapshot);
        return 0;
    });
}

int pent_free_state(pent_state* state) {
    return release(states(), state, "state");
}
