#pragma once

#include <cstddef>
#include <string>
#include <string_view>
#include <vector>

namespace pent::runs {

/// A word of the recipe of a body: an argument of pent-mesh.
struct RecipeWord {
    std::string text;       ///< Without quotes.
    std::size_t begin = 0;  ///< Where it begins in the recipe, with its quotes.
    std::size_t end = 0;    ///< Behind it.
};

/// Words have blanks between them, and in them where these are in quotes, ' or ", which begin at
/// the beginning of the word, or of the value of --option=value, and go to the next of their kind.
/// A quote elsewhere, or without another one, is a letter as all others.
[[nodiscard]] std::vector<RecipeWord> words_of_recipe(std::string_view recipe);

/// An argument as it has to stand in a recipe: in quotes where it has blanks, or begins with a
/// quote. With quotes of both kinds in it, too, there is no way, and it comes as it is.
///
/// @param prefix  In front of it, as "--option=".
[[nodiscard]] std::string recipe_word(const std::string& argument, const std::string& prefix = "");

/// Where the value of an argument begins: behind the "=" of --option=value; 0 for all others.
[[nodiscard]] std::size_t value_in(std::string_view argument);

}  // namespace pent::runs
