#include <pent/equal_runs.h>

#include <gtest/gtest.h>

#include <string>
#include <utility>
#include <vector>

namespace pent {
namespace {

using Runs = std::vector<std::pair<std::size_t, std::size_t>>;

Runs runs_of(const std::string& letters) {
    Runs runs;
    for_each_equal_run(
        letters, [](char a, char b) { return a == b; },
        [&](std::size_t first, std::size_t count) { runs.emplace_back(first, count); });
    return runs;
}

TEST(EqualRuns, CoverEveryElementOnceInOrder) {
    EXPECT_EQ(runs_of(""), Runs{});
    EXPECT_EQ(runs_of("a"), (Runs{{0, 1}}));
    EXPECT_EQ(runs_of("aaa"), (Runs{{0, 3}}));
    EXPECT_EQ(runs_of("abbcda"), (Runs{{0, 1}, {1, 2}, {3, 1}, {4, 1}, {5, 1}}));
}

}  // namespace
}  // namespace pent
