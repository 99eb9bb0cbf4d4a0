#include "extremes.h"

#include <gtest/gtest.h>

#include <cctype>
#include <string>
#include <tuple>

namespace pent::stability {
namespace {

using simulator::Precision;
constexpr Precision kPrecisions[] = {Precision::Float, Precision::Double};

// What every case is run with.
struct Asked {
    Precision precision;
    simulator::ElementKind elements;
    Motion motion;
};

std::vector<Asked> all_asked() {
    std::vector<Asked> all;
    for (const Precision precision : kPrecisions) {
        for (const auto elements :
             {simulator::ElementKind::Linear, simulator::ElementKind::Smoothed}) {
            for (const Motion motion : kMotions) {
                all.push_back({precision, elements, motion});
            }
        }
    }
    return all;
}

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
    for (const Asked& asked : all_asked()) {
        Extreme extreme = GetParam().extreme;
        extreme.elements = asked.elements;
        const Outcome outcome = run(extreme, asked.motion, asked.precision);
        EXPECT_NE(outcome.kind, Outcome::Kind::Wrong) << text(outcome);
        if (GetParam().is_inside) {
            EXPECT_EQ(outcome.kind, Outcome::Kind::Right) << text(outcome);
        } else if (outcome.kind != Outcome::Kind::Right) {
            EXPECT_FALSE(outcome.reason.empty());
        }
    }
}

class Corners : public testing::TestWithParam<Case> {};
INSTANTIATE_TEST_SUITE_P(All, Corners, testing::ValuesIn(corners()), [](const auto& one) {
    return test_name(one.param.name);
});

// Inside: right in double. Float is asked for no more than a word.
TEST_P(Corners, OfTheBoxAreRightUntilInertiaDrownsAndNeverSilentlyWrong) {
    for (const Asked& asked : all_asked()) {
        Extreme extreme = GetParam().extreme;
        extreme.elements = asked.elements;
        const Outcome outcome = run(extreme, asked.motion, asked.precision);
        EXPECT_NE(outcome.kind, Outcome::Kind::Wrong) << text(outcome);
        if (GetParam().is_inside && asked.precision == Precision::Double) {
            EXPECT_EQ(outcome.kind, Outcome::Kind::Right) << text(outcome);
        }
    }
}

class Starts : public testing::TestWithParam<Start> {};
INSTANTIATE_TEST_SUITE_P(All, Starts, testing::ValuesIn(starts()), [](const auto& one) {
    return test_name(one.param.name);
});

// linear_euler takes one linear step however far it goes: it may fail, never silently.
TEST_P(Starts, ComeBackToRestOrAreReported) {
    for (const Precision precision : kPrecisions) {
        const Outcome newton = run(GetParam(), simulator::Integrator::NewtonEuler, precision);
        EXPECT_NE(newton.kind, Outcome::Kind::Wrong) << text(newton);
        if (GetParam().comes_back) {
            EXPECT_EQ(newton.kind, Outcome::Kind::Right) << text(newton);
        }
        const Outcome linear = run(GetParam(), simulator::Integrator::LinearEuler, precision);
        EXPECT_NE(linear.kind, Outcome::Kind::Wrong) << text(linear);
    }
}

using Contacts = std::tuple<Touch, simulator::ContactModel, Precision>;
class Touches : public testing::TestWithParam<Contacts> {};
std::string contacts_name(const testing::TestParamInfo<Contacts>& info) {
    const auto& [touch, model, precision] = info.param;
    return test_name(touch.name
                     + (model == simulator::ContactModel::Barrier ? " barrier" : " penalty")
                     + (precision == Precision::Float ? " float" : " double"));
}

INSTANTIATE_TEST_SUITE_P(All,
                         Touches,
                         testing::Combine(testing::ValuesIn(touches()),
                                          testing::Values(simulator::ContactModel::Penalty,
                                                          simulator::ContactModel::Barrier),
                                          testing::ValuesIn(kPrecisions)),
                         contacts_name);

TEST_P(Touches, KeepMomentumAndDoNotCrossOrAreReported) {
    const auto& [touch, model, precision] = GetParam();
    const Outcome outcome = run(touch, model, precision);
    EXPECT_NE(outcome.kind, Outcome::Kind::Wrong) << text(outcome);
}

}  // namespace
}  // namespace pent::stability
