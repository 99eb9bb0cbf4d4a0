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

// What every case is run with.
struct Asked {
    Precision precision;
    simulator::ElementKind elements;
    Motion motion;
};

std::ostream& operator<<(std::ostream& out, const Asked& asked) {
    return out << simulator::word_of(asked.elements) << ", motion "
               << static_cast<int>(asked.motion) << ", " << simulator::word_of(asked.precision)
               << ": ";
}

// Quadratic elements are asked for less. They bend: a thin bar that is turned by 10 degrees a step
// folds on the way, and may be reported where linear ones, which lock, follow stiffly.
bool is_inside(const Case& one, simulator::ElementKind elements) {
    const double aspect = one.extreme.aspect;
    return one.is_inside
           && (elements != simulator::ElementKind::Quadratic || (aspect >= 0.1 && aspect <= 10));
}

// A quadratic pentachoron does not deform evenly by its weight: no closed form says how.
std::vector<Asked> all_asked(std::initializer_list<simulator::ElementKind> kinds) {
    std::vector<Asked> all;
    for (const Precision precision : kPrecisions) {
        for (const auto elements : kinds) {
            for (const Motion motion : kMotions) {
                if (elements != simulator::ElementKind::Quadratic || motion != Motion::Load) {
                    all.push_back({precision, elements, motion});
                }
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
    for (const Asked& asked :
         all_asked({simulator::ElementKind::Linear, simulator::ElementKind::Smoothed,
                    simulator::ElementKind::Quadratic})) {
        Extreme extreme = GetParam().extreme;
        extreme.elements = asked.elements;
        const Outcome outcome = run(extreme, asked.motion, asked.precision);
        EXPECT_NE(outcome.kind, Outcome::Kind::Wrong) << asked << text(outcome);
        if (is_inside(GetParam(), asked.elements)) {
            EXPECT_EQ(outcome.kind, Outcome::Kind::Right) << asked << text(outcome);
        } else if (outcome.kind != Outcome::Kind::Right) {
            EXPECT_FALSE(outcome.reason.empty());
        }
    }
}

class Corners : public testing::TestWithParam<Case> {};
INSTANTIATE_TEST_SUITE_P(All, Corners, testing::ValuesIn(corners()), [](const auto& one) {
    return test_name(one.param.name);
});

// Of quadratic elements, which take their time outside the box, less: one motion there, in double.
// Layers are a hundredth or a hundred times as thick as edges are long: thin ones fold in turns,
// which are asked for a word, beside no other body, and once for what statics does not know of.
bool is_asked(const Extreme& corner, const Asked& asked) {
    if (asked.elements != simulator::ElementKind::Quadratic) {
        return true;
    }
    if (drowns_inertia(corner)) {
        return asked.motion == Motion::Fall && asked.precision == Precision::Double;
    }
    return asked.motion != Motion::Turn
           || (asked.precision == Precision::Double && corner.ratio == 1 && corner.dt == 1e-5
               && corner.density == 1e5);
}

// Inside: right in double, but for turns of quadratic elements. Float is asked for no more than a
// word.
TEST_P(Corners, OfTheBoxAreRightUntilInertiaDrownsAndNeverSilentlyWrong) {
    for (const Asked& asked :
         all_asked({simulator::ElementKind::Linear, simulator::ElementKind::Smoothed,
                    simulator::ElementKind::Quadratic})) {
        Extreme extreme = GetParam().extreme;
        extreme.elements = asked.elements;
        if (!is_asked(extreme, asked)) {
            continue;
        }
        const Outcome outcome = run(extreme, asked.motion, asked.precision);
        EXPECT_NE(outcome.kind, Outcome::Kind::Wrong) << asked << text(outcome);
        const bool is_quadratic_turn =
            asked.elements == simulator::ElementKind::Quadratic && asked.motion == Motion::Turn;
        if (!drowns_inertia(extreme) && asked.precision == Precision::Double
            && !is_quadratic_turn) {
            EXPECT_EQ(outcome.kind, Outcome::Kind::Right) << asked << text(outcome);
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
