#include "pent/runs/recipe.h"

namespace pent::runs {

namespace {

constexpr std::string_view kBlanks = " \t\n\v\f\r";
constexpr std::string_view kQuotes = "\"'";

}  // namespace

std::size_t value_in(std::string_view argument) {
    return argument.starts_with("--") ? argument.find('=') + 1 : 0;
}

std::vector<RecipeWord> words_of_recipe(std::string_view recipe) {
    std::vector<RecipeWord> words;
    for (std::size_t at = recipe.find_first_not_of(kBlanks); at < recipe.size();
         at = recipe.find_first_not_of(kBlanks, at)) {
        RecipeWord word;
        word.begin = at;
        while (at < recipe.size() && kBlanks.find(recipe[at]) == std::string_view::npos) {
            const bool has_value = value_in(word.text) == word.text.size();
            const std::size_t closing =
                has_value && kQuotes.find(recipe[at]) != std::string_view::npos
                    ? recipe.find(recipe[at], at + 1)
                    : std::string_view::npos;
            if (closing == std::string_view::npos) {
                word.text += recipe[at++];
            } else {
                word.text += recipe.substr(at + 1, closing - at - 1);
                at = closing + 1;
            }
        }
        word.end = at;
        words.push_back(word);
    }
    return words;
}

std::string recipe_word(const std::string& argument, const std::string& prefix) {
    std::string plain = prefix + argument;
    const std::size_t value = value_in(plain);
    const bool may_open = value < plain.size() && kQuotes.find(plain[value]) != std::string::npos;
    if (plain.empty() || may_open || plain.find_first_of(kBlanks) != std::string::npos) {
        for (const char quote : kQuotes) {
            if (argument.find(quote) == std::string::npos) {
                return prefix + quote + argument + quote;
            }
        }
    }
    return plain;
}

}  // namespace pent::runs
