#include "model/keyframes.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <optional>
#include <random>

namespace pent::simulator {
namespace {

std::vector<Keyframe> any_keyframes(unsigned seed) {
    std::mt19937 random(seed);
    std::uniform_real_distribution<double> gap(0.05, 2);
    std::uniform_real_distribution<double> factor(-1, 1);
    std::vector<Keyframe> keyframes;
    double time = 0.3;
    for (int i = 0; i < 8; ++i) {
        keyframes.push_back({time, factor(random)});
        time += gap(random);
    }
    return keyframes;
}

TEST(Keyframes, AreMetExactlyAndHeldOutside) {
    const std::vector<Keyframe> keyframes = any_keyframes(1);
    for (const Keyframe& keyframe : keyframes) {
        EXPECT_EQ(factor_at(keyframes, keyframe.time), keyframe.factor);
    }
    EXPECT_EQ(factor_at(keyframes, 0), keyframes.front().factor);
    EXPECT_EQ(factor_at(keyframes, 1e9), keyframes.back().factor);
    EXPECT_EQ(factor_at({{2, 0.5}}, 1), 0.5);
    EXPECT_EQ(factor_at({}, 1), 1);
}

// From 0 to 1 within a second: s^2 (3 - 2 s).
TEST(Keyframes, MakeTheSmoothStepBetweenTwo) {
    const std::vector<Keyframe> two = {{1, 0}, {2, 1}};
    EXPECT_DOUBLE_EQ(factor_at(two, 1.5), 0.5);
    EXPECT_DOUBLE_EQ(factor_at(two, 1.25), 0.15625);
}

TEST(Keyframes, MakeACurveWithoutKinksThatStaysBetweenItsNeighbors) {
    for (unsigned seed = 0; seed < 20; ++seed) {
        const std::vector<Keyframe> keyframes = any_keyframes(seed);
        for (std::size_t i = 0; i + 1 < keyframes.size(); ++i) {
            const auto [low, high] = std::minmax(keyframes[i].factor, keyframes[i + 1].factor);
            const double width = keyframes[i + 1].time - keyframes[i].time;
            for (int k = 1; k < 50; ++k) {
                const double factor = factor_at(keyframes, keyframes[i].time + 0.02 * k * width);
                EXPECT_GE(factor, low - 1e-12);
                EXPECT_LE(factor, high + 1e-12);
            }
        }
        // Slopes from both sides agree up to h times the curvature: below 40 for gaps of 0.05.
        constexpr double kStep = 1e-6;
        for (const auto& [time, factor] : keyframes) {
            const double left = (factor - factor_at(keyframes, time - kStep)) / kStep;
            const double right = (factor_at(keyframes, time + kStep) - factor) / kStep;
            EXPECT_NEAR(left, right, 1e-2);
        }
    }
}

// The curve hangs on the differences of times alone, and on their ratios.
TEST(Keyframes, MakeTheSameCurveByAnyClock) {
    for (unsigned seed = 0; seed < 20; ++seed) {
        const std::vector<Keyframe> keyframes = any_keyframes(seed);
        std::vector<Keyframe> later = keyframes;
        for (Keyframe& keyframe : later) {
            keyframe.time = 2 * keyframe.time + 5;
        }
        for (double time = 0; time < 10; time += 0.07) {
            EXPECT_NEAR(factor_at(later, 2 * time + 5), factor_at(keyframes, time), 1e-12);
        }
    }
}

// Between the second of them and the last but one, where slopes have something on both sides.
TEST(Keyframes, OnALineMakeTheLine) {
    const std::vector<Keyframe> line = {{1, 2}, {2, 4}, {2.5, 5}, {5, 10}, {6, 12}};
    for (double time = 2; time <= 5; time += 0.03) {
        EXPECT_NEAR(factor_at(line, time), 2 * time, 1e-13);
    }
}

// Rises in one direction keep going through a keyframe between them.
TEST(Keyframes, DoNotStopWhereTheCurveGoesOn) {
    const std::vector<Keyframe> rising = {{0, 0}, {1, 1}, {3, 2}};
    EXPECT_GT(factor_at(rising, 1.001) - factor_at(rising, 0.999), 0.0005);
}

// A cubic is its Hermite data: whatever is given is met, and slopes are those of the values.
TEST(Curves, HaveTheSlopesThatAreGivenAndTheirOwnAreDifferencesOfTheirValues) {
    const std::vector<CurvePoint> points = {
        {0.5, 1, 0}, {0.8, -2, 7.5}, {1.4, -2, std::nullopt}, {2, 3, -4.0}};
    const auto at = [&](double time) {
        return curve_at(
            points.size(), [&](std::size_t i) { return points[i]; }, time);
    };
    for (const CurvePoint& point : points) {
        EXPECT_NEAR(at(point.time).value, point.value, 1e-14);
        EXPECT_NEAR(at(point.time).slope, point.slope.value_or(0), 1e-13);
    }
    for (double time = 0.33; time < 2.5; time += 0.07) {  // no keyframe, where curvature jumps
        const double h = 1e-5;  // of h^2 times a third derivative of up to 1e3, and of rounding / h
        EXPECT_NEAR(at(time).slope, (at(time + h).value - at(time - h).value) / (2 * h), 1e-6);
    }
    EXPECT_EQ(at(0.4).slope, 0);
    EXPECT_EQ(at(2.1).slope, 0);
    EXPECT_EQ(at(2.1).value, 3);
}

}  // namespace
}  // namespace pent::simulator
