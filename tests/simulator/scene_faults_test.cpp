#include "scenes.h"

#include <pent/simulator/scene_checks.h>

#include <gtest/gtest.h>

#include <functional>
#include <string>
#include <utility>
#include <vector>

// What is wrong with a part of a scene by itself, and the key it is said of.

namespace pent::simulator {
namespace {

using test::still;

template <typename Part>
using Change = std::function<void(Part&)>;

// The part as it is has no fault, and with each change one of that key.
template <typename Part>
void expect_faults(const Part& good, const std::vector<std::pair<std::string, Change<Part>>>& bad) {
    EXPECT_FALSE(fault_of(good).has_value());
    for (const auto& [key, change] : bad) {
        Part part = good;
        change(part);
        const std::optional<Fault> fault = fault_of(part);
        ASSERT_TRUE(fault.has_value()) << key;
        EXPECT_EQ(fault->key, key) << fault->message;
    }
}

TEST(SceneFaults, OfSelectionsAreCornersAndLayersThatAreExchanged) {
    BoxSelection box;
    box.low = Eigen::Vector3d(0, 0, 0);
    box.high = Eigen::Vector3d(1, 0, 1);  // flat is no fault
    expect_faults<BoxSelection>(box, {{"low", [](auto& b) { b.low[1] = 0.1; }}});
    expect_faults<LayerSelection>({.first = 2, .last = 2},
                                  {{"last", [](auto& layers) { layers.last = 1; }}});
}

TEST(SceneFaults, OfLoadsAreNothingToPushWithAndTimesThatDoNotIncrease) {
    Load load;
    load.force = Eigen::Vector3d(0, 1, 0);
    load.keyframes = {{.time = 0, .factor = 0}, {.time = 1, .factor = 1}};
    expect_faults<Load>(load, {{"force", [](auto& l) { l.force.setZero(); }},
                               {"keyframes", [](auto& l) { l.keyframes[1].time = 0; }}});
    load.force.setZero();
    load.pressure = -1;
    EXPECT_FALSE(fault_of(load).has_value());
}

// factor 2 of a stretch of 0.6 is 1 + 2 (0.6 - 1) = 0.2, factor 2.5 is 0.
TEST(SceneFaults, OfActivationsAreCellsTurnedInsideOutAndFibersFromNowhere) {
    Activation muscle;
    muscle.stretch = 0.6;
    muscle.keyframes = {{.time = 0, .factor = 2}, {.time = 1, .factor = 1}};
    expect_faults<Activation>(
        muscle, {{"keyframes", [](auto& m) { m.keyframes[0].factor = 2.5; }},
                 {"keyframes", [](auto& m) { std::swap(m.keyframes[0], m.keyframes[1]); }},
                 {"fibers", [](auto& m) { m.fibers = Fibers::Distance; }}});
    muscle.fibers = Fibers::Distance;
    muscle.away_from = {EverythingSelection{}};
    EXPECT_FALSE(fault_of(muscle).has_value());
}

TEST(SceneFaults, OfAttachmentsAreBodiesTiedToThemselvesOrToTwoThings) {
    Attachment tie;
    tie.body = "a";
    tie.target = "b";
    expect_faults<Attachment>(tie, {{"target", [](auto& t) { t.target = "a"; }},
                                    {"point", [](auto& t) { t.point = Eigen::Vector3d::Ones(); }},
                                    {"motion", [](auto& t) { t.motion = {still(3)}; }}});
    tie.target.clear();
    tie.point = Eigen::Vector3d::Ones();
    tie.motion = {still(3)};
    EXPECT_FALSE(fault_of(tie).has_value());
}

std::vector<MotionKeyframe> keyframes_at(const std::vector<double>& times) {
    std::vector<MotionKeyframe> keyframes;
    for (const double time : times) {
        keyframes.emplace_back().time = time;
        keyframes.back().translate = Eigen::Vector3d::Ones();
    }
    return keyframes;
}

TEST(SceneFaults, OfMotionsAreTwoWaysToSayWhereTheyGo) {
    Motion motion = still(3);
    motion.from = 1;
    motion.keyframes = keyframes_at({2, 3});
    expect_faults<Motion>(motion, {{"translate", [](auto& m) { m.translate[0] = 1; }},
                                   {"rotate",
                                    [](auto& m) {
                                        m.rotate = {{{0, 1}, 90}};
                                    }},
                                   {"to", [](auto& m) { m.to = 5; }},
                                   {"keyframes", [](auto& m) { m.from = 2; }},
                                   {"keyframes", [](auto& m) { m.keyframes[1].time = 2; }}});
    motion.keyframes.clear();
    motion.translate[0] = 1;
    motion.to = 5;
    EXPECT_FALSE(fault_of(motion).has_value());
}

TEST(SceneFaults, OfConstraintsAreMovementsBeforeAnythingIsHeld) {
    Motion motion = still(3);
    motion.keyframes = keyframes_at({2});
    Constraint constraint = test::hold(EverythingSelection{}, motion);
    constraint.from = 1;
    expect_faults<Constraint>(constraint, {{"motion", [](auto& c) { c.from = 2; }}});
}

}  // namespace
}  // namespace pent::simulator
