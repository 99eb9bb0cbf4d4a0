#include "meetings.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cstdint>
#include <map>
#include <random>

namespace pent::contact {
namespace {

using Pair = Meetings<4>::Pair;

// Of so many candidates, by which it is told from others.
Meeting<4> meeting_of(std::size_t candidates) {
    Meeting<4> meeting;
    meeting.pairs.mixed_first.pairs.resize(candidates);
    return meeting;
}

// What a map would have, after each of many changes at random.
TEST(MeetingsTest, AreAMapByColliders) {
    std::mt19937 random(5);
    std::uniform_int_distribution<int> collider(0, 4);
    Meetings<4> meetings;
    std::map<Pair, std::size_t> expected;
    for (std::size_t change = 1; change < 200; ++change) {
        const Pair pair = std::minmax({collider(random), collider(random)});
        if (change % 3 == 0) {
            meetings.erase_if(
                [&](const Meeting<4>& meeting) { return meeting.colliders() == pair; });
            expected.erase(pair);
        } else {
            meetings.put(pair, meeting_of(change));
            expected[pair] = change;
        }
        ASSERT_EQ(meetings.size(), expected.size());
        std::size_t place = 0;
        std::size_t candidates = 0;
        for (const auto& [colliders, size] : expected) {
            EXPECT_EQ(meetings[place].colliders(), colliders);
            EXPECT_EQ(meetings[place].pairs.size(), size);
            candidates += size;
            ++place;
        }
        EXPECT_EQ(meetings.bytes(), static_cast<std::int64_t>(candidates * sizeof(Candidate)));
    }
    meetings.clear();
    EXPECT_EQ(meetings.size(), 0U);
    EXPECT_EQ(meetings.bytes(), 0);
}

}  // namespace
}  // namespace pent::contact
