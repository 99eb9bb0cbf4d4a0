#include "same_file.h"

#include <pent/error.h>

#include <system_error>

namespace pent::apps {

namespace fs = std::filesystem;

bool is_same_file(const fs::path& a, const fs::path& b) {
    std::error_code ignored;
    const bool has_a = fs::exists(a, ignored);
    const bool has_b = fs::exists(b, ignored);
    if (has_a != has_b) {
        return false;
    }
    if (has_a) {
        return fs::is_regular_file(a, ignored) && fs::equivalent(a, b, ignored);
    }
    return fs::weakly_canonical(fs::absolute(a, ignored), ignored)
           == fs::weakly_canonical(fs::absolute(b, ignored), ignored);
}

void require_apart(const std::vector<NamedFile>& inputs, const std::vector<NamedFile>& outputs) {
    std::vector<NamedFile> others = inputs;
    for (const NamedFile& output : outputs) {
        if (output.path.empty()) {
            continue;
        }
        for (const NamedFile& other : others) {
            if (!other.path.empty() && is_same_file(output.path, other.path)) {
                throw Error(output.path.string() + ": " + output.what + " is the same file as "
                            + other.what
                            + (other.path == output.path ? "" : ", " + other.path.string())
                            + "; give it another name");
            }
        }
        others.push_back(output);
    }
}

}  // namespace pent::apps
