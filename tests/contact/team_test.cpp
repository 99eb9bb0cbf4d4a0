// What a team finds, its members being threads of this process, beside what one alone finds.

#include "penalty_scenes.h"
#include "shared_work.h"
#include "support/meeting_table.h"
#include "two_cubes.h"

#include <pent/contact/team.h>

#include <gtest/gtest.h>

#include <algorithm>
#include <numeric>

namespace pent::contact {
namespace {

using pent::test::MeetingTable;

class ThreadTeam final : public Team {
public:
    ThreadTeam(MeetingTable& table, int rank) : table_(&table), rank_(rank) {}

    [[nodiscard]] std::size_t count() const override {
        return static_cast<std::size_t>(table_->count());
    }
    [[nodiscard]] std::size_t rank() const override { return static_cast<std::size_t>(rank_); }
    [[nodiscard]] std::vector<std::vector<std::byte>> gather(
        std::span<const std::byte> own) const override {
        std::vector<std::vector<std::byte>> all;
        table_->meet(rank_, &own, [&](const std::vector<const void*>& places) {
            for (const void* place : places) {
                const auto& bytes = *static_cast<const std::span<const std::byte>*>(place);
                all.emplace_back(bytes.begin(), bytes.end());
            }
        });
        return all;
    }

private:
    MeetingTable* table_;
    int rank_;
};

// Calls work(team, rank) for all members of a team of so many.
template <typename Work>
void as_a_team(int count, const Work& work) {
    MeetingTable table(count);
    pent::test::at_a_table(
        count, [&](int rank) { work(std::make_shared<const ThreadTeam>(table, rank), rank); });
}

template <int Dim>
bool is_equal(const Contact<Dim>& a, const Contact<Dim>& b) {
    return a.vertices == b.vertices && a.weights == b.weights && a.direction == b.direction
           && a.distance == b.distance && a.radius == b.radius && a.share == b.share
           && a.multiplicity == b.multiplicity && a.mollifier.threshold == b.mollifier.threshold
           && a.first == b.first && a.second == b.second && a.kind == b.kind
           && a.is_fading == b.is_fading && a.count == b.count && a.first_count == b.first_count
           && a.corner_count == b.corner_count && a.active == b.active && a.energy == b.energy
           && a.slope == b.slope;
}

bool is_equal(const StepLimit& a, const StepLimit& b) {
    return a.fraction == b.fraction
           && (a.fraction == 1
               || (a.limiting.first == b.limiting.first && a.limiting.second == b.limiting.second
                   && a.limiting.first_corners == b.limiting.first_corners
                   && a.limiting.second_corners == b.limiting.second_corners));
}

// What a finder says at some places, one after the other, and on the way from each to the next.
template <int Dim>
struct Story {
    std::vector<Contacts<Dim>> contacts;
    std::vector<StepLimit> limits;
};

template <int Dim>
Story<Dim> tell(const ContactScene<Dim>& scene,
                const std::vector<Positions<Dim>>& places,
                std::shared_ptr<const Team> team) {
    ContactFinder<Dim> finder(scene, std::move(team));
    Story<Dim> story;
    for (std::size_t i = 0; i < places.size(); ++i) {
        story.contacts.push_back(finder.find(places[i], test::kStiffness));
        if (i + 1 < places.size()) {
            story.limits.push_back(finder.limit_step(places[i], places[i + 1]));
        }
    }
    return story;
}

// Every member of every team has what one alone has, to the bit.
template <int Dim>
void expect_same_for_teams(const ContactScene<Dim>& scene,
                           const std::vector<Positions<Dim>>& places) {
    const Story<Dim> alone = tell<Dim>(scene, places, nullptr);
    std::size_t contacts = 0;
    for (const Contacts<Dim>& at : alone.contacts) {
        contacts += at.list.size();
    }
    ASSERT_GT(contacts, 20U);
    for (const int count : {1, 2, 3, 7}) {
        SCOPED_TRACE(count);
        std::vector<Story<Dim>> stories(static_cast<std::size_t>(count));
        as_a_team(count, [&](std::shared_ptr<const Team> team, int rank) {
            stories[static_cast<std::size_t>(rank)] = tell<Dim>(scene, places, std::move(team));
        });
        for (const Story<Dim>& story : stories) {
            for (std::size_t i = 0; i < places.size(); ++i) {
                const Contacts<Dim>& own = story.contacts[i];
                const Contacts<Dim>& other = alone.contacts[i];
                ASSERT_EQ(own.list.size(), other.list.size()) << i;
                EXPECT_EQ(own.pair_count, other.pair_count);
                EXPECT_TRUE(
                    std::equal(own.list.begin(), own.list.end(), other.list.begin(), is_equal<Dim>))
                    << i;
                EXPECT_EQ(own.body_energy, other.body_energy);
                EXPECT_EQ(own.obstacle_energy, other.obstacle_energy);
                EXPECT_EQ(own.report.candidates, stories.front().contacts[i].report.candidates);
            }
            for (std::size_t i = 0; i < alone.limits.size(); ++i) {
                EXPECT_TRUE(is_equal(story.limits[i], alone.limits[i])) << i;
            }
        }
    }
}

template <typename T>
class TeamTest : public testing::Test {
protected:
    static constexpr int kSpace = T::value;

    TeamTest() {
        const int cells = kSpace == 3 ? 4 : 2;
        scene_.add(test::cube<kSpace>(cells), Vector<kSpace>::Zero());
        Vector<kSpace> aside = Vector<kSpace>::Constant(0.31);
        aside[0] = cells + 0.15;
        scene_.add(test::cube<kSpace>(cells), aside);
        rest_ = scene_.positions;
        test::shake<kSpace>(scene_.positions, 0.02, 4);
    }

    // The second body comes so far towards the first, less far back, and nearer again.
    [[nodiscard]] std::vector<Positions<kSpace>> approach(double way) {
        std::vector<Positions<kSpace>> places = {scene_.positions};
        for (const double part : {0.3, 0.2, 0.9, 1.0}) {
            Positions<kSpace> x = scene_.positions;
            x.rightCols(scene_.begin[2] - scene_.begin[1]).row(0).array() -= part * way;
            test::shake<kSpace>(x, 0.01, static_cast<unsigned>(1000 * part));
            places.push_back(x);
        }
        return places;
    }

    [[nodiscard]] ContactScene<kSpace> model(const ContactOptions& options) const {
        const Vector<kSpace> up = Vector<kSpace>::Unit(1);
        ContactScene<kSpace> model = test::contact_scene<kSpace>(
            scene_, options,
            {HalfSpace<kSpace>{.normal = up, .offset = -0.1},
             Ball<kSpace>{.center = Vector<kSpace>::Constant(-0.25), .radius = 0.3}});
        model.rest = rest_;
        return model;
    }

    test::Scene<kSpace> scene_;
    Positions<kSpace> rest_;
};

using Dimensions = testing::Types<std::integral_constant<int, 3>, std::integral_constant<int, 4>>;
TYPED_TEST_SUITE(TeamTest, Dimensions);

TYPED_TEST(TeamTest, FindsPenaltiesThatOneAloneFinds) {
    for (const double margin : {0.0, 0.05}) {
        expect_same_for_teams<TypeParam::value>(
            this->model({.distance = test::kEps, .margin = margin}), this->approach(0.8));
    }
}

// Bodies folded upon themselves: what is far at rest is near.
TYPED_TEST(TeamTest, FindsPenaltiesWithinBodies) {
    constexpr int kDim = TypeParam::value;
    std::vector<Positions<kDim>> places;
    for (const double fold : {0.5, 0.75, 0.85, 0.8}) {
        Positions<kDim> x = this->scene_.positions;
        for (Eigen::Index v = 0; v < x.cols(); ++v) {
            x(1, v) *= 1 - fold;
        }
        test::shake<kDim>(x, 0.03, static_cast<unsigned>(100 * fold));
        places.push_back(x);
    }
    expect_same_for_teams<kDim>(this->model({.distance = test::kEps, .self = true, .margin = 0.05}),
                                places);
}

TYPED_TEST(TeamTest, FindsBarriersAndHowFarStepsMayGo) {
    for (const bool self : {false, true}) {
        const ContactOptions options{
            .model = ContactModel::Barrier, .distance = 0.2, .separation = 0.01, .self = self};
        expect_same_for_teams<TypeParam::value>(this->model(options), this->approach(0.06));
    }
}

TYPED_TEST(TeamTest, NamesWhatIsInTheWay) {
    constexpr int kDim = TypeParam::value;
    const ContactScene<kDim> model = this->model({.model = ContactModel::Barrier, .distance = 0.1});
    const Positions<kDim>& start = this->scene_.positions;
    for (const int axis : {0, 1}) {  // into the other body, and into the floor
        Positions<kDim> end = start;
        end.rightCols(this->scene_.begin[2] - this->scene_.begin[1]).row(axis).array() -= 1;
        const StepLimit alone = ContactFinder<kDim>(model).limit_step(start, end);
        ASSERT_LT(alone.fraction, 1);
        EXPECT_EQ(alone.limiting.second.is_obstacle(), axis == 1);
        as_a_team(3, [&](const std::shared_ptr<const Team>& team, int /*rank*/) {
            EXPECT_TRUE(is_equal(ContactFinder<kDim>(model, team).limit_step(start, end), alone));
        });
    }
}

TEST(SharedWork, HasEveryPieceOnceAndListsInOrder) {
    for (const int count : {1, 2, 5}) {
        as_a_team(count, [&](const std::shared_ptr<const Team>& team, int rank) {
            const SharedWork shared(team.get());
            std::vector<int> own;
            for (int piece = 0; piece < 23; ++piece) {
                if (shared.is_own(static_cast<std::size_t>(piece))) {
                    own.push_back(piece);
                }
            }
            EXPECT_NEAR(static_cast<double>(own.size()), 23.0 / count, 1);
            std::vector<int> all = shared.all(own);
            std::sort(all.begin(), all.end());
            std::vector<int> expected(23);
            std::iota(expected.begin(), expected.end(), 0);
            EXPECT_EQ(all, expected);
            EXPECT_EQ(shared.sum(rank + 1), count * (count + 1) / 2);
            // Numbers that 3 does not divide, twice those that 5 does; some chunks are empty.
            const auto add = [](std::size_t i, std::vector<int>& list) {
                for (int k = 0; k < (i % 3 == 0 ? 0 : i % 5 == 0 ? 2 : 1); ++k) {
                    list.push_back(static_cast<int>(i));
                }
            };
            EXPECT_EQ(shared.collect<int>(100, 1, add), SharedWork().collect<int>(100, 7, add));
            EXPECT_TRUE(shared.collect<int>(0, 4, add).empty());
        });
    }
}

}  // namespace
}  // namespace pent::contact
