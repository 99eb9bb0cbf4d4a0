#include "same_file.h"

#include <pent/error.h>
#include <pent/output_folder.h>
#include <pent/run_files.h>

#include <algorithm>
#include <system_error>

namespace pent::apps {

namespace fs = std::filesystem;

namespace {

// Where a path leads, as far as it is there; as it stands where that cannot be found out.
fs::path resolved(const fs::path& path) {
    std::error_code error;
    const fs::path absolute = fs::absolute(path, error);
    const fs::path real = fs::weakly_canonical(absolute, error);
    const fs::path& found = error ? absolute : real;
    return found.has_filename() ? found : found.parent_path();  // "run/" is "run"
}

bool is_within(const fs::path& path, const fs::path& folder) {
    const fs::path inner = resolved(path);
    const fs::path outer = resolved(folder);
    return std::mismatch(outer.begin(), outer.end(), inner.begin(), inner.end()).first
           == outer.end();
}

void require_apart(const NamedFile& output, const NamedFile& other) {
    if (output.path.empty() || other.path.empty()) {
        return;
    }
    const auto fail = [&](const std::string& is) {
        throw Error(output.path.string() + ": " + output.what + " is " + is + other.what
                    + (other.path == output.path ? "" : ", " + other.path.string())
                    + "; give it another name");
    };
    std::error_code ignored;
    if (is_same_file(output.path, other.path)) {
        fail(fs::is_directory(output.path, ignored) ? "the same folder as " : "the same file as ");
    }
    if (other.has_content && is_within(output.path, other.path)) {
        fail("in ");
    }
}

}  // namespace

bool is_same_file(const fs::path& a, const fs::path& b) {
    std::error_code ignored;
    if (fs::exists(a, ignored) && fs::exists(b, ignored)) {
        return (fs::is_regular_file(a, ignored) || fs::is_directory(a, ignored))
               && fs::equivalent(a, b, ignored);
    }
    return resolved(a) == resolved(b);
}

std::vector<NamedFile> parts_of_run(const fs::path& run, const std::string& what) {
    std::vector<NamedFile> parts;
    parts.push_back({what, run / kFolderList, true});
    for (const char* part : kPartsOfRun) {
        parts.push_back({what, run / part, true});
    }
    return parts;
}

void require_apart(const std::vector<NamedFile>& inputs, const std::vector<NamedFile>& outputs) {
    std::vector<NamedFile> others = inputs;
    for (const NamedFile& output : outputs) {
        for (const NamedFile& other : others) {
            require_apart(output, other);
        }
        others.push_back(output);
    }
}

}  // namespace pent::apps
