#include "pent/runs/relocated.h"

#include "simulator_names.h"

#include <pent/runs/recipe.h>

#include <string>
#include <system_error>

namespace pent::runs {

namespace fs = std::filesystem;

namespace {

std::string path_from(const fs::path& folder, const fs::path& path) {
    return fs::proximate(fs::absolute(path), fs::absolute(folder)).string();
}

// Arguments of a recipe, and their values, are paths where there is such a file. All else stays as
// it is, blanks included: a run keeps the scene as it was written.
std::string relocated_recipe(const std::string& recipe,
                             const fs::path& origin,
                             const fs::path& folder) {
    std::string moved;
    std::size_t end = 0;
    for (const RecipeWord& word : words_of_recipe(recipe)) {
        const std::size_t value = value_in(word.text);
        const fs::path path = word.text.substr(value);
        std::error_code ignored;
        const bool is_file =
            !path.empty() && path.is_relative() && fs::is_regular_file(origin / path, ignored);
        moved.append(recipe, end, word.begin - end);
        moved += is_file ? recipe_word(path_from(folder, origin / path), word.text.substr(0, value))
                         : recipe.substr(word.begin, word.end - word.begin);
        end = word.end;
    }
    return moved.append(recipe, end);
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
