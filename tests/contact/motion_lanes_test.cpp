#include "motion_lanes.h"

#include "lanes.h"

#include <Eigen/Dense>
#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <limits>
#include <random>
#include <vector>

namespace pent::contact {
namespace {

using Axes = Eigen::Vector4d;
using Map = Eigen::Matrix4d;

constexpr std::array<LanesIsa, 3> kAll{LanesIsa::Baseline, LanesIsa::Avx2, LanesIsa::Avx512};

// A patch as it has moved: a point X of it is near center + map (X - earlier center).
struct Moved {
    Axes earlier_center;
    double least_stretch = 0;
    double radius = 0;
    double deviation = 0;
    std::array<Axes, 2> center;
    std::array<Map, 2> map;
};

class MotionLanesTest : public testing::Test {
protected:
    Moved moved() {
        Moved patch;
        patch.earlier_center = axes();
        patch.least_stretch = 1 + number_(random_);
        patch.radius = 1 + number_(random_);
        patch.deviation = 0.1 + 0.1 * number_(random_);
        for (std::size_t place = 0; place < 2; ++place) {
            patch.center[place] = axes();
            patch.map[place] << axes(), axes(), axes(), axes();
        }
        return patch;
    }

    // As many of them as they have places.
    static std::vector<double> rows_of(const std::vector<Moved>& patches, int places) {
        std::vector<double> numbers;
        for (const Moved& patch : patches) {
            push(numbers, patch.earlier_center);
            push(numbers, Axes(patch.least_stretch, patch.radius, patch.deviation, 0));
            for (std::size_t place = 0; place < static_cast<std::size_t>(places); ++place) {
                push(numbers,
                     (patch.center[place] - patch.map[place] * patch.earlier_center).eval());
                push(numbers, patch.map[place]);
            }
        }
        return numbers;
    }

    // By the definition: with the mean of both maps.
    static PatchBound bound_of(const Moved& first, const Moved& second, int places) {
        double turn = 0;
        double shift = 0;
        for (std::size_t place = 0; place < static_cast<std::size_t>(places); ++place) {
            const Map mean = 0.5 * (first.map[place] + second.map[place]);
            turn = std::max(turn, 0.5 * (first.map[place] - second.map[place]).norm());
            shift = std::max(shift, (first.center[place] - second.center[place]
                                     - mean * (first.earlier_center - second.earlier_center))
                                        .norm());
        }
        return {std::max(first.least_stretch, second.least_stretch) - turn,
                shift + turn * (first.radius + second.radius) + first.deviation + second.deviation};
    }

    static std::vector<PatchBound> bounds_of(LanesIsa isa,
                                             const Moved& first,
                                             const std::vector<Moved>& others,
                                             const std::vector<std::uint32_t>& which,
                                             int places) {
        const std::vector<double> row = rows_of({first}, places);
        const std::vector<double> rows = rows_of(others, places);
        std::vector<PatchBound> bounds(which.size() + 1, PatchBound{-1, -1});
        lanes_kernels<4>(isa).bound_motions(row.data(), {rows.data(), places}, which.data(),
                                            static_cast<int>(which.size()), bounds.data());
        EXPECT_EQ(-1, bounds.back().lack) << "writes behind the end";
        bounds.pop_back();
        return bounds;
    }

private:
    template <typename Numbers>
    static void push(std::vector<double>& numbers, const Numbers& of) {
        numbers.insert(numbers.end(), of.data(), of.data() + of.size());
    }
    Axes axes() {
        return Axes::NullaryExpr([&] { return number_(random_); });
    }

    std::mt19937 random_{5};
    std::uniform_real_distribution<double> number_{-1, 1};
};

TEST_F(MotionLanesTest, BoundAsTheDefinitionDoes) {
    const Moved first = moved();
    std::vector<Moved> others(7);
    std::generate(others.begin(), others.end(), [&] { return moved(); });
    for (const LanesIsa isa : kAll) {
        for (std::size_t count = 0; is_supported(isa) && count <= 9; ++count) {
            std::vector<std::uint32_t> which(count);
            for (std::size_t k = 0; k < count; ++k) {
                which[k] = static_cast<std::uint32_t>((3 * k + 2) % others.size());
            }
            for (const int places : {1, 2}) {
                const auto bounds = bounds_of(isa, first, others, which, places);
                for (std::size_t k = 0; k < count; ++k) {
                    const PatchBound expected = bound_of(first, others[which[k]], places);
                    EXPECT_NEAR(expected.stretch, bounds[k].stretch, 1e-14);
                    EXPECT_NEAR(expected.lack, bounds[k].lack, 1e-13);
                }
            }
        }
    }
}

// Bit for bit, whatever is beside them.
TEST_F(MotionLanesTest, BoundEachPairAsIfItWereAlone) {
    const Moved first = moved();
    std::vector<Moved> others(5);
    std::generate(others.begin(), others.end(), [&] { return moved(); });
    for (const LanesIsa isa : kAll) {
        if (!is_supported(isa)) {
            continue;
        }
        const auto together = bounds_of(isa, first, others, {0, 1, 2, 3, 4}, 2);
        for (std::uint32_t i = 0; i < others.size(); ++i) {
            const auto alone = bounds_of(isa, first, others, {i}, 2);
            EXPECT_EQ(alone[0].stretch, together[i].stretch);
            EXPECT_EQ(alone[0].lack, together[i].lack);
        }
    }
}

TEST_F(MotionLanesTest, TellNothingOfWhatIsNotFinite) {
    const Moved first = moved();
    for (const double bad : {std::nan(""), std::numeric_limits<double>::infinity(), 1e300}) {
        Moved second = moved();
        second.center[0][1] = second.map[0](2, 3) = bad;
        second.deviation = std::nan("");
        for (const LanesIsa isa : kAll) {
            if (is_supported(isa)) {
                EXPECT_FALSE(bounds_of(isa, first, {second}, {0}, 1)[0].is_apart(1e6, 1e-6));
                EXPECT_FALSE(bounds_of(isa, second, {first}, {0}, 2)[0].is_apart(1e6, 1e-6));
            }
        }
    }
}

}  // namespace
}  // namespace pent::contact
