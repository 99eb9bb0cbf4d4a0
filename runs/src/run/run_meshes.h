#pragma once

#include "run/run_ranks.h"
#include "scene/scene_parts.h"
#include "simulator_names.h"

#include <pent/mesh_part.h>
#include <pent/simulator/mesh_share.h>
#include <pent/simulator/simulation.h>

#include <cstdint>
#include <filesystem>
#include <functional>
#include <string>
#include <vector>

namespace pent::runs {

/// The mesh of a body as loaded, whole or in part.
template <int Dim>
struct LoadedMesh {
    simulator::MeshShare<Dim> share;
    std::int64_t cells = 0;    ///< Of the whole.
    bool has_parents = false;  ///< Whether its file has them, for quadratic elements.
};

/// The meshes of a run: from their files into a simulation, and from there, as placed, into the
/// run's folder. Ranks have parts of them, and slabs of a file while they read and write.
template <int Dim>
class RunMeshes {
public:
    using Look = std::function<void(std::size_t body, const LoadedMesh<Dim>& mesh)>;

    /// Both must outlive this.
    RunMeshes(const Scene& scene, const RunRanks& ranks) : scene_(scene), ranks_(ranks) {}

    /// Reads them: ranks as read_parts(), a program on its own as read_meshes(). Throws an Error
    /// that says what to do where a file is missing.
    ///
    /// @param look  Sees each of them before the simulation has them, on all ranks together.
    [[nodiscard]] Simulation<Dim> simulate(const simulator::SimulationOptions& options,
                                           const Look& look = {});

    /// What was found to be said of them.
    [[nodiscard]] const std::vector<std::string>& warnings() const { return warnings_; }

    /// Writes a mesh with what its file has beside it, each rank a slab. Gives its checksum.
    [[nodiscard]] std::uint32_t write(const std::filesystem::path& file,
                                      const Simulation<Dim>& simulation,
                                      int body,
                                      const std::string& created_by) const;

    /// Compares a mesh with a file, see check_same_mesh().
    [[nodiscard]] std::uint32_t compare(const std::filesystem::path& file,
                                        const Simulation<Dim>& simulation,
                                        int body) const;

    /// Once they are in the folder.
    void let_go() { sources_.clear(); }

private:
    void show(const SceneParts<Dim>& parts, const simulator::Ranks* ranks, const Look& look) const;
    [[nodiscard]] MeshSlab slab_of_rows(const SimplexMesh<Dim>& mesh, int body) const;
    [[nodiscard]] SimplexMesh<Dim> slab_of_mesh(const SimplexMesh<Dim>& mesh, int body) const;

    const Scene& scene_;
    const RunRanks& ranks_;
    std::vector<MeshSource<Dim>> sources_;  // of ranks
    std::vector<std::string> warnings_;
};

}  // namespace pent::runs
