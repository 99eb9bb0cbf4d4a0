#pragma once

#include "record/journal.h"
#include "simulator_names.h"

#include <filesystem>
#include <string>
#include <vector>

namespace pent::runs {

/// What earlier calls left where a run is to be written.

[[nodiscard]] std::vector<std::string> names_of_bodies(const Scene& scene);

/// What is known of the run in a folder: its journal, or the report of a run of version 0.1.0,
/// which has no journal. Throws an Error if there is no run, if it is one of another scene, or if
/// its journal is missing.
[[nodiscard]] Journal read_earlier_parts(const Scene& scene, const std::filesystem::path& folder);

/// Where the cells are written that cross at the start of a run: beside its folder, and never over
/// a file that something else wrote.
///
/// @param created_by  As it stands in such a file.
[[nodiscard]] std::filesystem::path crossings_path(const std::filesystem::path& folder,
                                                   const std::string& created_by);

}  // namespace pent::runs
