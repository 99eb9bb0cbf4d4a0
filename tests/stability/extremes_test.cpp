#include "extremes.h"

#include <pent/simulator/words.h>

#include <gtest/gtest.h>

#include <cctype>
#include <string>
#include <tuple>

namespace pent::stability {
namespace {

using simulator::Precision;
constexpr Precision kPrecisions[] = {Precision::Float, Precision::Double};

constexpr simulator::ElementKind kKinds[] = {simulator::ElementKind::Linear,
                                             simulator::ElementKind::Smoothed,
                                             simulator::ElementKind::Quadratic};

std::string told(const Extreme& extreme, const Asked& asked, const Outcome& outcome) {
    return std::string(simulator::word_of(extreme.elements)) + ", motion "
           + std::to_string(static_cast<int>(asked.motion)) + ", "
           + std::string(simulator::word_of(asked.precision)) + ": " + text(outcome);
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
    for (const simulator::ElementKind elements : kKinds) {
        const Extreme extreme = with_elements(GetParam().extreme, elements);
        for (const Asked& asked : asked_of(extreme)) {
            const Outcome outcome = run(extreme, asked.motion, asked.precision);
            EXPECT_NE(outcome.kind, Outcome::Kind::Wrong) << told(extreme, asked, outcome);
            if (GetParam().is_inside
                && (asked.precision == Precision::Double || is_right_in_float(extreme))) {
                EXPECT_EQ(outcome.kind, Outcome::Kind::Right) << told(extreme, asked, outcome);
            } else if (outcome.kind != Outcome::Kind::Right) {
                EXPECT_FALSE(outcome.reason.empty());
            }
        }
    }
}

class Corners : public testing::TestWithParam<Case> {};
INSTANTIATE_TEST_SUITE_P(All, Corners, testing::ValuesIn(corners()), [](const auto& one) {
    return test_name(one.param.name);
});

// Inside: right in double. Float is asked for no more than a word.
TEST_P(Corners, OfTheBoxAreRightUntilInertiaDrownsAndNeverSilentlyWrong) {
    for (const simulator::ElementKind elements : kKinds) {
        const Extreme extreme = with_elements(GetParam().extreme, elements);
        for (const Asked& asked : asked_of_corner(extreme)) {
            const Outcome outcome = run(extreme, asked.motion, asked.precision);
            EXPECT_NE(outcome.kind, Outcome::Kind::Wrong) << told(extreme, asked, outcome);
            if (!drowns_inertia(extreme) && asked.precision == Precision::Double) {
                EXPECT_EQ(outcome.kind, Outcome::Kind::Right) << told(extreme, asked, outcome);
            }
        }
    }
}

class Starts : public testing::TestWithParam<Start> {};
INSTANTIATE_TEST_SUITE_P(All, Starts, testing::ValuesIn(starts()), [](const auto& one) {
    return test_name(one.param.name);
});

// linear_euler takes one linear step however far it goes: it may fail, never silently.
TEST_P(Starts, ComeBackToRestOrAreReported) {
    for (const auto elements :
         {simulator::ElementKind::Linear, simulator::ElementKind::Quadratic}) {
        const bool comes_back = elements == simulator::ElementKind::Linear
                                    ? GetParam().comes_back
                                    : GetParam().quadratic_comes_back;
        for (const Precision precision : kPrecisions) {
            const Outcome newton =
                run(GetParam(), elements, simulator::Integrator::NewtonEuler, precision);
            EXPECT_NE(newton.kind, Outcome::Kind::Wrong) << text(newton);
            if (comes_back) {
                EXPECT_EQ(newton.kind, Outcome::Kind::Right) << text(newton);
            }
            const Outcome linear =
                run(GetParam(), elements, simulator::Integrator::LinearEuler, precision);
            EXPECT_NE(linear.kind, Outcome::Kind::Wrong) << text(linear);
        }
    }
}

using Contacts = std::tuple<Touch, simulator::ElementKind, simulator::ContactModel, Precision>;
class Touches : public testing::TestWithParam<Contacts> {};
std::string contacts_name(const testing::TestParamInfo<Contacts>& info) {
    const auto& [touch, unused, model, precision] = info.param;
    return test_name(touch.name
                     + (model == simulator::ContactModel::Barrier ? " barrier" : " penalty")
                     + (precision == Precision::Float ? " float" : " double"));
}

auto contacts_of(simulator::ElementKind elements) {
    return testing::Combine(
        testing::ValuesIn(touches(elements)), testing::Values(elements),
        testing::Values(simulator::ContactModel::Penalty, simulator::ContactModel::Barrier),
        testing::ValuesIn(kPrecisions));
}
INSTANTIATE_TEST_SUITE_P(All, Touches, contacts_of(simulator::ElementKind::Linear), contacts_name);
INSTANTIATE_TEST_SUITE_P(Quadratic,
                         Touches,
                         contacts_of(simulator::ElementKind::Quadratic),
                         contacts_name);

TEST_P(Touches, KeepMomentumAndDoNotCrossOrAreReported) {
    const auto& [touch, elements, model, precision] = GetParam();
    const Outcome outcome = run(touch, elements, model, precision);
    EXPECT_NE(outcome.kind, Outcome::Kind::Wrong) << text(outcome);
}

}  // namespace
}  // namespace pent::stability
