#include <pent/runs/recipe.h>

#include <gtest/gtest.h>

#include <random>
#include <string>
#include <vector>

namespace pent::runs {
namespace {

using Words = std::vector<std::string>;

Words texts(const std::string& recipe) {
    Words found;
    for (const RecipeWord& word : words_of_recipe(recipe)) {
        found.push_back(word.text);
    }
    return found;
}

TEST(Recipe, HasWordsWithBlanksBetween) {
    EXPECT_EQ(texts(""), Words());
    EXPECT_EQ(texts(" \t"), Words());
    EXPECT_EQ(texts(" a.obj\t--layers  4 "), (Words{"a.obj", "--layers", "4"}));
}

TEST(Recipe, HasBlanksWithinQuotes) {
    EXPECT_EQ(texts("'a b.obj' \"c  d\""), (Words{"a b.obj", "c  d"}));
    EXPECT_EQ(texts("--profile='a b.txt' x"), (Words{"--profile=a b.txt", "x"}));
    EXPECT_EQ(texts("\"a b\".obj"), (Words{"a b.obj"}));
    EXPECT_EQ(texts("\"bob's model.obj\" '5\" wide.obj'"),
              (Words{"bob's model.obj", "5\" wide.obj"}));
    EXPECT_EQ(texts("'' --name="), (Words{"", "--name="}));
}

TEST(Recipe, TakesQuotesElsewhereAsLetters) {
    EXPECT_EQ(texts("bob's ann's.obj"), (Words{"bob's", "ann's.obj"}));
    EXPECT_EQ(texts("'a b.obj"), (Words{"'a", "b.obj"}));
    EXPECT_EQ(texts("a='b c'"), (Words{"a='b", "c'"}));
    EXPECT_EQ(texts("--a=b='c d'"), (Words{"--a=b='c", "d'"}));
}

// Whatever arguments are, but for those with blanks and quotes of both kinds.
TEST(Recipe, GivesBackArgumentsThatWereWrittenIntoIt) {
    std::mt19937 random(1);
    const auto up_to = [&](int most) {
        return std::uniform_int_distribution<int>(0, most)(random);
    };
    int quoted = 0;
    for (int round = 0; round < 2000; ++round) {
        const std::string letters = up_to(1) == 0 ? "ab=- '" : "a-=\t\"";
        Words arguments(1 + static_cast<std::size_t>(up_to(3)));
        std::string recipe;
        std::vector<std::string> rows;
        for (std::string& argument : arguments) {
            for (int length = up_to(6); length > 0; --length) {
                argument +=
                    letters[static_cast<std::size_t>(up_to(static_cast<int>(letters.size()) - 1))];
            }
            const std::string prefix = up_to(2) == 0 ? "--option=" : "";
            rows.push_back(recipe_word(argument, prefix));
            quoted += static_cast<int>(rows.back() != prefix + argument);
            recipe += rows.back() + " ";
            argument = prefix + argument;
        }
        const std::vector<RecipeWord> words = words_of_recipe(recipe);
        ASSERT_EQ(texts(recipe), arguments) << recipe;
        for (std::size_t i = 0; i < words.size(); ++i) {
            EXPECT_EQ(recipe.substr(words[i].begin, words[i].end - words[i].begin), rows[i]);
        }
    }
    EXPECT_GT(quoted, 1000);
}

}  // namespace
}  // namespace pent::runs
