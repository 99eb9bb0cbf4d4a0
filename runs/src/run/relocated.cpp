#include "run/relocated.h"

#include <sstream>
#include <string>
#include <system_error>

namespace pent::runs {

namespace fs = std::filesystem;

namespace {

std::string path_from(const fs::path& folder, const fs::path& path) {
    return fs::proximate(fs::absolute(path), fs::absolute(folder)).string();
}

// Words of a recipe are paths where there is such a file; none has spaces in it.
std::string relocated_recipe(const std::string& recipe,
                             const fs::path& origin,
                             const fs::path& folder) {
    std::istringstream words(recipe);
    std::string moved;
    for (std::string word; words >> word;) {
        std::error_code ignored;
        if (fs::path(word).is_relative() && fs::is_regular_file(origin / word, ignored)) {
            word = path_from(folder, origin / word);
        }
        moved += (moved.empty() ? "" : " ") + word;
    }
    return moved;
}

}  // namespace

Scene relocated(const Scene& scene, const fs::path& origin, const fs::path& folder) {
    Scene moved = scene;
    for (Body& body : moved.bodies) {
        body.mesh = path_from(folder, body.mesh);
        body.recipe = relocated_recipe(body.recipe, origin, folder);
    }
    return moved;
}

}  // namespace pent::runs
