#pragma once

#include <pent/pent_file.h>

#include <cstdint>
#include <filesystem>
#include <string>

namespace pent::simulator {

/// What a run folder must be to go on with the run in it. Each throws an Error that names the file and
/// says what to do.

/// The scene of the folder is this one, but for the number of frames. Keys that it lacks have their defaults.
///
/// @param text  As scene_text() gives it.
void check_same_scene(const std::filesystem::path& scene_file, const std::string& text);

/// The mesh of the folder is this one, to the bit. Gives its checksum.
template <int Dim>
[[nodiscard]] std::uint32_t check_same_mesh(const std::filesystem::path& mesh_file,
                                            const SimplexMesh<Dim>& mesh);

/// Reads a frame that is whole, of this mesh and of this moment.
template <int Dim>
[[nodiscard]] Frame<Dim> read_own_frame(const std::filesystem::path& path,
                                        std::uint32_t mesh_crc,
                                        std::uint64_t frame,
                                        std::uint64_t step);

/// Removes what a killed run left half written.
void remove_temporaries(const std::filesystem::path& folder);

/// The instruction set of the run in the folder: frames agree to the bit on one only. Empty if there is no
/// report.
[[nodiscard]] std::string isa_of_run(const std::filesystem::path& folder);

}  // namespace pent::simulator
