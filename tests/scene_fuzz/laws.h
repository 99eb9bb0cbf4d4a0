#pragma once

#include "document.h"

#include <filesystem>
#include <optional>
#include <string>
#include <vector>

namespace pent::scene_fuzz {

/// A law of docs/testing.md that a scene breaks.
struct Finding {
    std::string law;   ///< Its name, as in law_names().
    std::string what;  ///< What was seen.
};

/// What the run of a scene came to; for the statistics of many.
struct Summary {
    bool is_refused = false;
    bool has_diverged = false;
    bool has_touched = false;
    bool has_slept = false;
    bool was_cut = false;  ///< A step was taken in parts.
};

struct Checked {
    std::optional<Finding> finding;  ///< The first.
    Summary summary;
};

struct CheckOptions {
    std::string only;   ///< The law to check; empty for all.
    int seconds = 150;  ///< Of processor time, for each run of the scene.
};

/// In the order in which they are checked.
[[nodiscard]] std::vector<std::string> law_names();

/// Runs a scene in every way that a law is about, in child processes, and looks for the first law
/// that does not hold. `folder` must be empty; the scene, its meshes and its runs stay there.
[[nodiscard]] Checked check(const Json& scene,
                            const std::filesystem::path& folder,
                            const CheckOptions& options = {});

}  // namespace pent::scene_fuzz
