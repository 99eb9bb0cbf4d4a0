#include "linear/sharing.h"

#include "support/messages.h"
#include "thread_ranks.h"

#include <gtest/gtest.h>

namespace pent::simulator {
namespace {

TEST(Sharing, IsNothingForOneAlone) {
    const Sharing alone;
    EXPECT_FALSE(alone.is_shared());
    EXPECT_TRUE(alone.owns(5));
    EXPECT_EQ(alone.sum(0.1), 0.1);
    EXPECT_TRUE(alone.any(true));
    EXPECT_FALSE(alone.any(false));
    Positions<3> values = Positions<3>::Random(3, 4);
    const Positions<3> before = values;
    alone.gather(values);
    EXPECT_EQ(values, before);
}

TEST(Sharing, GivesEveryVertexWhatItsOwnerSays) {
    const std::vector<std::uint32_t> owners = {2, 0, 0, 2, 1, 0};
    test::on_ranks(3, [&](const std::shared_ptr<const Ranks>& ranks) {
        const Sharing sharing(ranks, owners);
        Positions<3> values = Positions<3>::Constant(3, 6, ranks->rank());
        values.row(1).setLinSpaced(0, 5);
        sharing.gather(values);
        for (std::uint32_t v = 0; v < 6; ++v) {
            EXPECT_EQ(values(0, v), owners[v]);
            EXPECT_EQ(values(1, v), v);
        }
        EXPECT_EQ(sharing.own_count(6), ranks->rank() == 0 ? 3 : ranks->rank() == 1 ? 1 : 2);
    });
}

// So many that they do not go at a time.
TEST(Sharing, GivesAsManyAsThereAre) {
    constexpr std::uint32_t kVertices = 200000;
    std::vector<std::uint32_t> owners(kVertices);
    for (std::uint32_t v = 0; v < kVertices; ++v) {
        owners[v] = v < 100000 ? 2 : v % 7 % 2;  // of the first ones two ranks have none
    }
    test::on_ranks(3, [&](const std::shared_ptr<const Ranks>& ranks) {
        const Sharing sharing(ranks, owners);
        Positions<4> values = Positions<4>::Constant(4, kVertices, ranks->rank());
        values.row(2).setLinSpaced(0, kVertices - 1);
        sharing.gather(values);
        std::int64_t wrong = 0;
        for (std::uint32_t v = 0; v < kVertices; ++v) {
            wrong +=
                values(0, v) == owners[v] && values(2, v) == v && values(3, v) == owners[v] ? 0 : 1;
        }
        EXPECT_EQ(wrong, 0);
    });
}

// 1 + 1e-16 is 1, but 1e-16 + 1e-16 + ... + 1 would not be.
TEST(Sharing, AddsInTheOrderOfRanksOnAll) {
    test::on_ranks(4, [&](const std::shared_ptr<const Ranks>& ranks) {
        const Sharing sharing(ranks, {0, 1, 2, 3});
        EXPECT_EQ(sharing.sum(ranks->rank() == 0 ? 1.0 : 1e-16), 1.0);
        EXPECT_EQ(sharing.sum(std::int64_t{1} << ranks->rank()), 15);
        EXPECT_TRUE(sharing.any(ranks->rank() == 2));
        EXPECT_FALSE(sharing.any(false));
    });
}

TEST(Agree, FailsOnAllWithTheErrorOfTheFirst) {
    test::on_ranks(3, [&](const std::shared_ptr<const Ranks>& ranks) {
        agree(ranks.get(), [] {});
        const auto fail = [&] {
            agree(ranks.get(), [&] {
                if (ranks->rank() > 0) {
                    throw Error("disk " + std::to_string(ranks->rank()) + " is full");
                }
            });
        };
        EXPECT_EQ(pent::test::error_of(fail), "disk 1 is full");
    });
}

TEST(Agree, NamesTheRankThatHasSomethingElse) {
    test::on_ranks(3, [&](const std::shared_ptr<const Ranks>& ranks) {
        refuse_others(ranks.get(), 7, "another scene", "do this");
        const auto fail = [&] {
            refuse_others(ranks.get(), ranks->rank() == 2 ? 8 : 7, "another scene", "do this");
        };
        EXPECT_EQ(pent::test::error_of(fail), "rank 2 has another scene than rank 0; do this");
    });
}

}  // namespace
}  // namespace pent::simulator
