#include "pent_plugin.h"

#include <pent/error.h>
#include <pent/pent_file.h>
#include <pent/runs/scene_file.h>
#include <pent/simulator/simulation.h>

#include <algorithm>
#include <memory>
#include <string>
#include <variant>
#include <vector>

using pent::simulator::Scene;
using pent::simulator::Simulation;
using pent::simulator::StepReport;

struct pent_simulation {
    Scene scene;
    std::variant<std::unique_ptr<Simulation<3>>, std::unique_ptr<Simulation<4>>> simulation;
    StepReport last_step = {};
};

namespace {

// A plain C interface has nowhere else to keep this.
// NOLINTNEXTLINE(cppcoreguidelines-avoid-non-const-global-variables)
thread_local std::string last_error;

// Calls work(); what it throws becomes last_error and the value for failure.
template <typename Value, typename Work>
Value guarded(Value failure, const Work& work) noexcept {
    try {
        last_error.clear();
        return work();
    } catch (const std::exception& error) {
        last_error = error.what();
    } catch (...) {  // GCOVR_EXCL_START: C cannot catch, so nothing may get out, whatever it is
        last_error = "unknown failure";
    }  // GCOVR_EXCL_STOP
    return failure;
}

void check_body(const pent_simulation& simulation, int body) {
    if (body < 0 || body >= static_cast<int>(simulation.scene.bodies.size())) {
        throw pent::Error("body " + std::to_string(body) + " of "
                          + std::to_string(simulation.scene.bodies.size()) + "; count from 0");
    }
}

// Calls work(simulation) with a simulation of either dimension, for a body that exists.
template <typename Value, typename Work>
Value of_body(const pent_simulation* simulation, int body, Value failure, const Work& work) {
    return guarded(failure, [&]() -> Value {
        check_body(*simulation, body);
        return std::visit([&](const auto& held) -> Value { return work(*held); },
                          simulation->simulation);
    });
}

template <int Dim>
std::unique_ptr<Simulation<Dim>> make_simulation(const Scene& scene, int threads) {
    std::vector<pent::SimplexMesh<Dim>> meshes;
    for (const pent::simulator::Body& body : scene.bodies) {
        meshes.push_back(pent::read_mesh<Dim>(body.mesh).mesh);
    }
    return std::make_unique<Simulation<Dim>>(
        scene, std::move(meshes), pent::simulator::SimulationOptions{.threads = threads});
}

pent_step_report c_report(const StepReport& step) {
    return {.step = step.step,
            .time = step.time,
            .iterations = step.iterations,
            .substeps = step.substeps,
            .residual = step.residual,
            .inverted = step.inverted,
            .kinetic = step.energies.kinetic,
            .elastic = step.energies.of("elastic"),
            .gravity = step.energies.of("gravity"),
            .obstacle = step.energies.of("obstacle")};
}

pent_contact_report c_contacts(const StepReport& step) {
    return {.point_facet = step.contact.point_facet,
            .mixed = step.contact.mixed,
            .obstacle = step.contact.obstacle,
            .energy = step.energies.of("contact"),
            .deepest = step.contact.deepest,
            .smallest_distance = step.contact.smallest_distance,
            .seconds = step.contact.seconds};
}

}  // namespace

int pent_plugin_version(void) {
    return PENT_PLUGIN_VERSION;
}

const char* pent_last_error(void) {
    return last_error.c_str();
}

pent_simulation* pent_open(const char* scene_path, int threads) {
    return guarded<pent_simulation*>(nullptr, [&] {
        auto opened = std::make_unique<pent_simulation>();
        opened->scene = pent::runs::read_scene(scene_path);
        const int count = std::max(threads, 1);
        if (opened->scene.dimension == 3) {
            opened->simulation = make_simulation<3>(opened->scene, count);
        } else {
            opened->simulation = make_simulation<4>(opened->scene, count);
        }
        return opened.release();
    });
}

void pent_close(pent_simulation* simulation) {
    const std::unique_ptr<pent_simulation> owned(simulation);
}

int pent_dimension(const pent_simulation* simulation) {
    return simulation->scene.dimension;
}

int pent_body_count(const pent_simulation* simulation) {
    return static_cast<int>(simulation->scene.bodies.size());
}

const char* pent_body_name(const pent_simulation* simulation, int body) {
    return guarded<const char*>(nullptr, [&] {
        check_body(*simulation, body);
        return simulation->scene.bodies[static_cast<std::size_t>(body)].name.c_str();
    });
}

int64_t pent_vertex_count(const pent_simulation* simulation, int body) {
    return of_body<int64_t>(simulation, body, -1,
                            [&](const auto& s) { return s.mesh(body).vertex_count(); });
}

int64_t pent_cell_count(const pent_simulation* simulation, int body) {
    return of_body<int64_t>(simulation, body, -1,
                            [&](const auto& s) { return s.mesh(body).cell_count(); });
}

const uint32_t* pent_cells(const pent_simulation* simulation, int body) {
    return of_body<const uint32_t*>(simulation, body, nullptr,
                                    [&](const auto& s) { return s.mesh(body).cells.data(); });
}

const double* pent_positions(const pent_simulation* simulation, int body) {
    return of_body<const double*>(simulation, body, nullptr,
                                  [&](const auto& s) { return s.positions(body).data(); });
}

const double* pent_velocities(const pent_simulation* simulation, int body) {
    return of_body<const double*>(simulation, body, nullptr,
                                  [&](const auto& s) { return s.velocities(body).data(); });
}

const double* pent_forces(const pent_simulation* simulation, int body) {
    return of_body<const double*>(simulation, body, nullptr,
                                  [&](const auto& s) { return s.forces(body).data(); });
}

int pent_step(pent_simulation* simulation, pent_step_report* report) {
    return guarded(-1, [&] {
        const StepReport step =
            std::visit([](const auto& held) { return held->step(); }, simulation->simulation);
        if (report != nullptr) {
            *report = c_report(step);
        }
        simulation->last_step = step;
        last_error = step.is_accepted ? "" : step.failure;
        return step.is_accepted ? 0 : -1;
    });
}

int pent_contacts(const pent_simulation* simulation, pent_contact_report* report) {
    return guarded(-1, [&] {
        *report = c_contacts(simulation->last_step);
        return 0;
    });
}
