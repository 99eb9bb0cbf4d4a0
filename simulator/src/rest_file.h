#pragma once

#include <pent/simulator/simulation.h>

#include <filesystem>
#include <string>
#include <vector>

namespace pent::simulator {

/// What a run has to know beside its frames to go on with bodies that sleep: JSON, one entry a body.

/// @param bodies  Their names; as many as `rest`.
void write_rest(const std::filesystem::path& path,
                const std::vector<std::string>& bodies,
                const std::vector<BodyRest>& rest);

/// Throws an Error that names the file if it is not there or not that of these bodies.
[[nodiscard]] std::vector<BodyRest> read_rest(const std::filesystem::path& path,
                                              const std::vector<std::string>& bodies);

}  // namespace pent::simulator
