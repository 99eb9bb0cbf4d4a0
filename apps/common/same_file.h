#pragma once

#include <filesystem>
#include <string>
#include <vector>

namespace pent::apps {

/// A file or folder of the command line, and what errors call it, as in "the input" or "--json".
struct NamedFile {
    std::string what;
    std::filesystem::path path;
    bool has_content = false;  ///< Stands for all that is in the folder, too.
};

/// Whether two paths lead to the same regular file or folder, through links of either kind; where
/// one is not there yet, whether it would be the other. Devices and pipes are never the same.
[[nodiscard]] bool is_same_file(const std::filesystem::path& a, const std::filesystem::path& b);

/// What pent-sim has in the folder of a run, or may have.
/// @param what  What errors call each, as in "a part of the run".
[[nodiscard]] std::vector<NamedFile> parts_of_run(const std::filesystem::path& run,
                                                  const std::string& what);

/// Throws an Error if an output is the same file or folder as an input or as another output, or is
/// in one of them that has_content: to write it would destroy what was to be read or was just
/// written. Empty paths are passed over.
void require_apart(const std::vector<NamedFile>& inputs, const std::vector<NamedFile>& outputs);

}  // namespace pent::apps
