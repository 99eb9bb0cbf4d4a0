#include "explain/trial.h"

#include "explain/doubts.h"
#include "scene/scene_meshes.h"

#include <pent/facets.h>
#include <pent/machine_memory.h>
#include <pent/runs/explain.h>
#include <pent/simulator/placed_mesh.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <utility>

namespace pent::runs {

namespace {

template <int Dim>
TrialBody body_at_start(const Scene& scene, const Simulation<Dim>& simulation, int index) {
    const SimplexMesh<Dim>& mesh = simulation.mesh(index);
    const auto positions = simulation.positions(index);
    TrialBody body{.cells = mesh.cell_count(),
                   .cells_across = cells_across(mesh),
                   .has_parents = !mesh.parents.empty(),
                   .free_vertices = mesh.vertex_count(),
                   .box = {positions.rowwise().minCoeff(), positions.rowwise().maxCoeff()}};
    for (const Constraint& constraint : scene.constraints) {
        // One that comes or goes leaves them their unknowns.
        const bool lasts = constraint.from == 0 && std::isinf(constraint.to);
        if (lasts && constraint.body == scene.bodies[static_cast<std::size_t>(index)].name) {
            body.free_vertices -=
                static_cast<std::int64_t>(select_vertices(mesh, constraint).size());
        }
    }
    return body;
}

}  // namespace

template <int Dim>
Trial make_trial(const Scene& scene,
                 int threads,
                 const std::shared_ptr<const simulator::Ranks>& ranks) {
    SceneMeshes<Dim> meshes = read_meshes<Dim>(scene);
    Simulation<Dim> simulation(scene, std::move(meshes.meshes),
                               {.threads = threads, .ranks = ranks, .memory = machine_memory()});
    Trial trial{.scene = scene, .ranks = ranks.get()};
    const std::vector<std::string> overlaps = overlaps_at_start(scene, simulation);
    for (std::size_t i = 0; i < scene.bodies.size(); ++i) {
        trial.bodies.push_back(body_at_start(scene, simulation, static_cast<int>(i)));
    }
    for (const Attachment& one : scene.attachments) {
        const auto body = static_cast<int>(index_of(scene, one.body));
        trial.springs.push_back(std::ssize(select_vertices(simulation.mesh(body), one)));
    }
    if (ranks != nullptr) {
        static_cast<void>(ranks->take_traffic());  // of setting up
    }
    trial.step = simulation.step();
    if (ranks != nullptr) {
        trial.traffic = ranks->take_traffic();
    }
    trial.size = simulation.size();
    for (const auto& lines :
         {meshes.warnings, simulation.warnings(), doubts_of_units(scene, simulation), overlaps,
          soft_contacts(scene, simulation)}) {
        trial.warnings.insert(trial.warnings.end(), lines.begin(), lines.end());
    }
    return trial;
}

template <int Dim>
int cells_across(const SimplexMesh<Dim>& mesh) {
    constexpr int kUnseen = std::numeric_limits<int>::max();
    std::vector<int> depth(static_cast<std::size_t>(mesh.vertex_count()), kUnseen);
    const auto facets = match_facets<Dim>(mesh.cells, mesh.vertex_count());
    for (const std::uint32_t vertex : facets.boundary.reshaped()) {
        depth[vertex] = 0;
    }
    // One pass over the cells takes the depth at least one edge further in.
    int deepest = 0;
    for (bool has_changed = true; has_changed;) {
        has_changed = false;
        for (Eigen::Index cell = 0; cell < mesh.cell_count(); ++cell) {
            int least = kUnseen;
            for (const std::uint32_t vertex : mesh.cells.col(cell)) {
                least = std::min(least, depth[vertex]);
            }
            for (const std::uint32_t vertex : mesh.cells.col(cell)) {
                if (least < kUnseen && depth[vertex] > least + 1) {
                    depth[vertex] = least + 1;
                    has_changed = true;
                }
            }
        }
    }
    for (const int edges : depth) {
        deepest = edges < kUnseen ? std::max(deepest, edges) : deepest;
    }
    return std::max(1, 2 * deepest);
}

template Trial make_trial<3>(const Scene&, int, const std::shared_ptr<const simulator::Ranks>&);
template Trial make_trial<4>(const Scene&, int, const std::shared_ptr<const simulator::Ranks>&);
template int cells_across<3>(const SimplexMesh<3>&);
template int cells_across<4>(const SimplexMesh<4>&);

}  // namespace pent::runs
