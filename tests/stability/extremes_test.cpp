#include "extremes.h"

#include <gtest/gtest.h>

namespace pent::stability {
namespace {

using simulator::Precision;
constexpr Precision kPrecisions[] = {Precision::Float, Precision::Double};

class Extremes : public testing::TestWithParam<Case> {};

std::string test_name(const std::string& text) {
    std::string name;
    for (const char c : text) {
        if (c == '-') {
            name += "minus";
        } else {
            name += std::isalnum(static_cast<unsigned char>(c)) != 0 ? c : '_';
        }
    }
    return name;
}

INSTANTIATE_TEST_SUITE_P(All, Extremes, testing::ValuesIn(cases()), [](const auto& one) {
    return test_name(one.param.group + " " + one.param.name);
});

// Inside the box: right. Outside: right, or refused or reported with a reason.
TEST_P(Extremes, AreRightWithinTheBoxAndNeverSilentlyWrong) {
    for (const Precision precision : kPrecisions) {
        for (const Motion motion : kMotions) {
            const Outcome outcome = run(GetParam().extreme, motion, precision);
            EXPECT_NE(outcome.kind, Outcome::Kind::Wrong) << text(outcome);
            if (GetParam().is_inside) {
                EXPECT_EQ(outcome.kind, Outcome::Kind::Right) << text(outcome);
            } else if (outcome.kind != Outcome::Kind::Right) {
                EXPECT_FALSE(outcome.reason.empty());
            }
        }
    }
}

class Starts : public testing::TestWithParam<Start> {};
INSTANTIATE_TEST_SUITE_P(All, Starts, testing::ValuesIn(starts()), [](const auto& one) {
    return test_name(one.param.name);
});

TEST_P(Starts, ComeBackToRestOrAreReported) {
    for (const Precision precision : kPrecisions) {
        const Outcome outcome = run(GetParam(), precision);
        EXPECT_NE(outcome.kind, Outcome::Kind::Wrong) << text(outcome);
        if (GetParam().comes_back) {
            EXPECT_EQ(outcome.kind, Outcome::Kind::Right) << text(outcome);
        }
    }
}

class Touches : public testing::TestWithParam<Touch> {};
INSTANTIATE_TEST_SUITE_P(All, Touches, testing::ValuesIn(touches()), [](const auto& one) {
    return test_name(one.param.name);
});

TEST_P(Touches, KeepMomentumAndStayInTheWorldOrAreReported) {
    for (const Precision precision : kPrecisions) {
        const Outcome outcome = run(GetParam(), precision);
        EXPECT_NE(outcome.kind, Outcome::Kind::Wrong) << text(outcome);
    }
}

}  // namespace
}  // namespace pent::stability
