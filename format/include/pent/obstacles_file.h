#pragma once

#include <pent/obstacle.h>

#include <filesystem>
#include <string>
#include <vector>

namespace pent {

/// The obstacles of a run, in RUN/obstacles.json: specified in docs/pent-format.md.

/// What the file holds.
///
/// @param obstacles  In the order of the scene; numbers are finite, not checked.
template <int Dim>
[[nodiscard]] std::string obstacles_text(const std::vector<ObstacleShape<Dim>>& obstacles);

/// Writes the file through an OutputFile; throws an Error as that does.
template <int Dim>
void write_obstacles(const std::filesystem::path& path,
                     const std::vector<ObstacleShape<Dim>>& obstacles);

/// Reads the file back to the last bit. Throws an Error that says which obstacle is damaged, of
/// another dimension, of a kind or with a key that this reader does not know, or out of range.
template <int Dim>
[[nodiscard]] std::vector<ObstacleShape<Dim>> read_obstacles(const std::filesystem::path& path);

}  // namespace pent
