#pragma once

#include "document.h"

#include <filesystem>
#include <string>
#include <vector>

namespace pent::scene_fuzz {

/// What of report.json and journal.txt may differ between runs that are otherwise the same.
enum class Apart {
    Times,         ///< Seconds and threads.
    TimesAndWork,  ///< Also the parts, and how often trees were built and walked: a resumed run is
                   ///< another part and begins with new trees.
};

/// Says in what two run folders differ first; empty if they are the same to the byte.
[[nodiscard]] std::string first_difference(const std::filesystem::path& a,
                                           const std::filesystem::path& b,
                                           Apart apart);

/// report.json of a run, and nothing of it that is not finite.
[[nodiscard]] Json read_report(const std::filesystem::path& run);

/// The value at a path of keys, "contact.mixed"; null if it is not there.
[[nodiscard]] Json value_at(const Json& tree, const std::string& path);

}  // namespace pent::scene_fuzz
