#pragma once

#include <filesystem>
#include <string>
#include <vector>

namespace pent::apps {

/// A file of the command line, and what errors call it, as in "the input" or "--json".
struct NamedFile {
    std::string what;
    std::filesystem::path path;
};

/// Whether two paths lead to the same regular file, through links of either kind; where neither is there
/// yet, whether both would make the same one. Devices and pipes are never the same.
[[nodiscard]] bool is_same_file(const std::filesystem::path& a, const std::filesystem::path& b);

/// Throws an Error if an output is the same file as an input or as another output: to write it would
/// destroy what was to be read or was just written. Empty paths are passed over.
void require_apart(const std::vector<NamedFile>& inputs, const std::vector<NamedFile>& outputs);

}  // namespace pent::apps
