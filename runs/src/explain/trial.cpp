#include "explain/trial.h"

#include "explain/doubts.h"
#include "run/run_meshes.h"

#include <pent/machine_memory.h>
#include <pent/simulator/placed_mesh.h>

#include <cmath>

namespace pent::runs {

namespace {

// What its mesh tells.
template <int Dim>
TrialBody body_of(const LoadedMesh<Dim>& mesh) {
    const simulator::MeshDepth depth = simulator::depth_of(mesh.share);
    return {.cells = mesh.cells,
            .cells_across = depth.cells_across,
            .boundary_vertices = depth.boundary_vertices,
            .has_parents = mesh.has_parents};
}

// One an attachment of the body: how many vertices it selects.
template <int Dim>
void count_springs(const Scene& scene,
                   std::size_t body,
                   const simulator::MeshShare<Dim>& share,
                   std::vector<std::int64_t>& springs) {
    SimplexMesh<Dim> placed;
    for (std::size_t i = 0; i < scene.attachments.size(); ++i) {
        const Attachment& one = scene.attachments[i];
        if (index_of(scene, one.body) != body) {
            continue;
        }
        if (placed.vertex_count() == 0) {
            placed = share.mesh;
            put_in_place(placed, scene.bodies[body].place);
        }
        springs[i] = simulator::count_selected<Dim>({placed, share.owners, share.ranks}, one.select,
                                                    place_and_name(one));
    }
}

// Where bodies are before the step.
template <int Dim>
void add_start(const Simulation<Dim>& simulation, Trial& trial) {
    for (std::size_t i = 0; i < trial.bodies.size(); ++i) {
        TrialBody& body = trial.bodies[i];
        const auto positions = simulation.positions(static_cast<int>(i));
        body.free_vertices = positions.cols();
        body.box = {positions.rowwise().minCoeff(), positions.rowwise().maxCoeff()};
    }
}

// What constraints hold all the time, by the step; one that comes or goes leaves its vertices their
// unknowns.
void hold_what_lasts(const Scene& scene, Trial& trial) {
    for (std::size_t i = 0; i < scene.constraints.size(); ++i) {
        const Constraint& constraint = scene.constraints[i];
        if (constraint.from == 0 && std::isinf(constraint.to)) {
            trial.bodies[index_of(scene, constraint.body)].free_vertices -=
                trial.step.constraints[i].held;
        }
    }
}

}  // namespace

template <int Dim>
Trial make_trial(const Scene& scene,
                 int threads,
                 const std::shared_ptr<const simulator::Ranks>& ranks) {
    Trial trial{.scene = scene, .ranks = ranks.get()};
    trial.bodies.resize(scene.bodies.size());
    trial.springs.resize(scene.attachments.size());
    const RunRanks together(ranks.get());
    RunMeshes<Dim> meshes(scene, together);
    Simulation<Dim> simulation =
        meshes.simulate({.threads = threads, .ranks = ranks, .memory = machine_memory()},
                        [&](std::size_t body, const LoadedMesh<Dim>& mesh) {
                            trial.bodies[body] = body_of(mesh);
                            count_springs(scene, body, mesh.share, trial.springs);
                        });
    const std::vector<std::string> overlaps = overlaps_at_start(scene, simulation);
    add_start(simulation, trial);
    if (ranks != nullptr) {
        static_cast<void>(ranks->take_traffic());  // of setting up
    }
    trial.step = simulation.step();
    if (ranks != nullptr) {
        trial.traffic = ranks->take_traffic();
    }
    hold_what_lasts(scene, trial);
    trial.size = simulation.size();
    std::vector<std::int64_t> boundary_vertices;
    for (const TrialBody& body : trial.bodies) {
        boundary_vertices.push_back(body.boundary_vertices);
    }
    for (const auto& lines :
         {meshes.warnings(), simulation.warnings(), doubts_of_units(scene, simulation), overlaps,
          soft_contacts(scene, simulation, boundary_vertices)}) {
        trial.warnings.insert(trial.warnings.end(), lines.begin(), lines.end());
    }
    return trial;
}

template Trial make_trial<3>(const Scene&, int, const std::shared_ptr<const simulator::Ranks>&);
template Trial make_trial<4>(const Scene&, int, const std::shared_ptr<const simulator::Ranks>&);

}  // namespace pent::runs
