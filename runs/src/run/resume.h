#pragma once

#include "record/state_blocks.h"
#include "run/run_ranks.h"
#include "simulator_names.h"

#include <pent/pent_file.h>

#include <cstdint>
#include <filesystem>
#include <string>
#include <vector>

namespace pent::runs {

/// What a run folder must be to go on with the run in it. Each throws an Error that names the file
/// and says what to do.

/// The scene of the folder is this one, but for the number of frames and for where its meshes are.
/// Keys that it lacks have their defaults.
void check_same_scene(const std::filesystem::path& scene_file, const Scene& scene);

/// The mesh of the folder is this one, regions, parents and fibers included; what a file has beside
/// a mesh does not count. Gives the checksum of the file.
///
/// @param slab   Of the mesh, as rows_of() has it, where several processes compare it together.
/// @param ranks  These.
template <int Dim>
[[nodiscard]] std::uint32_t check_same_mesh(const std::filesystem::path& mesh_file,
                                            const SimplexMesh<Dim>& slab,
                                            const RunRanks& ranks);

/// Reads a frame that is whole, of this mesh and of this moment.
template <int Dim>
[[nodiscard]] Frame<Dim> read_own_frame(const std::filesystem::path& path,
                                        std::uint32_t mesh_crc,
                                        std::uint64_t frame,
                                        std::uint64_t step);

/// What a simulation carries from step to step beside positions and velocities: the stiffness to
/// which a barrier has adapted, which bodies sleep, and for BDF2 the state one step before.
///
/// @param bodies  Their names.
template <int Dim>
[[nodiscard]] StateBlocks carried_state(const Simulation<Dim>& simulation,
                                        const std::vector<std::string>& bodies);

/// Puts what carried_state() gave into a snapshot that has all the rest. Throws an Error if
/// something is missing or does not fit.
///
/// @param simulation  Of the same scene.
template <int Dim>
void read_carried_state(const StateBlocks& blocks,
                        const std::vector<std::string>& bodies,
                        const Simulation<Dim>& simulation,
                        Snapshot<Dim>& snapshot);

/// The same of a run without a journal, as version 0.1.0 left it: JSON that says who sleeps, and
/// frame files with the state one step before. One with a barrier is refused: its stiffness was not
/// kept.
///
/// @param mesh_crcs  Checksums of the meshes, one a body.
template <int Dim>
[[nodiscard]] StateBlocks carried_state_of_old_run(const std::filesystem::path& folder,
                                                   const std::vector<std::string>& bodies,
                                                   const std::vector<std::uint32_t>& mesh_crcs,
                                                   const Scene& scene,
                                                   int frame);

/// Where version 0.1.0 kept a body one step before a frame, and who slept there.
[[nodiscard]] std::string old_checkpoint_file(const std::string& body, int frame);
[[nodiscard]] std::string old_sleep_file(int frame);

}  // namespace pent::runs
