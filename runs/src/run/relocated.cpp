#include "run/relocated.h"

#include <algorithm>
#include <string>
#include <string_view>
#include <system_error>

namespace pent::runs {

namespace fs = std::filesystem;

namespace {

std::string path_from(const fs::path& folder, const fs::path& path) {
    return fs::proximate(fs::absolute(path), fs::absolute(folder)).string();
}

// Words of a recipe are paths where there is such a file; none has spaces in it. All else stays as
// it is, spaces included: a run keeps the scene as it was written.
std::string relocated_recipe(const std::string& recipe,
                             const fs::path& origin,
                             const fs::path& folder) {
    constexpr std::string_view kSpaces = " \t\n\v\f\r";
    std::string moved;
    for (std::size_t end = 0; end < recipe.size();) {
        const std::size_t begin = std::min(recipe.find_first_not_of(kSpaces, end), recipe.size());
        moved.append(recipe, end, begin - end);
        end = std::min(recipe.find_first_of(kSpaces, begin), recipe.size());
        const std::string word = recipe.substr(begin, end - begin);
        std::error_code ignored;
        const bool is_file = !word.empty() && fs::path(word).is_relative()
                             && fs::is_regular_file(origin / word, ignored);
        moved += is_file ? path_from(folder, origin / word) : word;
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
