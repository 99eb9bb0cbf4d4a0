#include "near_lanes.h"

#include "closest_points_oracle.h"
#include "lanes.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <random>
#include <vector>

namespace pent::contact {
namespace {

// Some simplices at the start and at the end of their paths, as the kernels have them.
template <int Dim, int Count>
class Patch {
public:
    // The vertices of all, corner after corner, are numbered from the given one on.
    Patch(int count, std::int32_t first_vertex)
        : of_(static_cast<std::size_t>(count)), first_vertex_(first_vertex) {}

    [[nodiscard]] std::int32_t vertex(int i) const { return first_vertex_ + Count * i; }

    [[nodiscard]] int count() const { return static_cast<int>(of_.size()); }
    std::array<Corners<Dim, Count>, 2>& operator[](int i) {
        return of_[static_cast<std::size_t>(i)];
    }

    [[nodiscard]] Corners<Dim, Count> at(int i, double t) const {
        const auto& ends = of_[static_cast<std::size_t>(i)];
        return (1 - t) * ends[0] + t * ends[1];
    }

    LanesView view(int end) {
        Vector<Dim>& origin = origins_[static_cast<std::size_t>(end)];
        origin = (*this)[0][static_cast<std::size_t>(end)].col(0);
        auto& lanes = lanes_[static_cast<std::size_t>(end)];
        auto& [low, high] = boxes_[static_cast<std::size_t>(end)];
        low.setConstant(std::numeric_limits<float>::infinity());
        high = -low;
        for (int i = 0; i < kLanes; ++i) {
            const auto& simplex = (*this)[i < count() ? i : 0][static_cast<std::size_t>(end)];
            for (int corner = 0; corner < Count; ++corner) {
                vertices_[static_cast<std::size_t>(corner * kLanes + i)] =
                    vertex(i < count() ? i : 0) + corner;
                for (int axis = 0; axis < Dim; ++axis) {
                    const auto x = static_cast<float>(simplex(axis, corner) - origin[axis]);
                    lanes[static_cast<std::size_t>((corner * Dim + axis) * kLanes + i)] = x;
                    low[axis] = std::min(low[axis], x);
                    high[axis] = std::max(high[axis], x);
                }
            }
        }
        return {.corners = lanes.data(),
                .vertices = vertices_.data(),
                .origin = origin.data(),
                .low = low.data(),
                .high = high.data(),
                .extent = std::max(high.maxCoeff(), -low.minCoeff()),
                .count = count()};
    }

private:
    std::vector<std::array<Corners<Dim, Count>, 2>> of_;
    std::int32_t first_vertex_;
    std::array<std::int32_t, static_cast<std::size_t>(Count) * kLanes> vertices_;
    std::array<Vector<Dim>, 2> origins_;
    std::array<std::array<Eigen::Matrix<float, Dim, 1>, 2>, 2> boxes_;
    std::array<std::array<float, static_cast<std::size_t>(Count) * Dim * kLanes>, 2> lanes_;
};

constexpr std::array<LanesIsa, 3> kAll{LanesIsa::Baseline, LanesIsa::Avx2, LanesIsa::Avx512};

// Kernels that this processor can run: as often is each pair of simplices counted.
int kernels() {
    return static_cast<int>(std::count_if(kAll.begin(), kAll.end(), is_supported));
}

using Near = std::array<std::uint16_t, kLanes>;

template <int Dim, int K, int L>
Near find(LanesIsa isa, Patch<Dim, K>& first, Patch<Dim, L>& second, bool is_still, double limit) {
    const LanesView a = first.view(0);
    const LanesView b = second.view(0);
    Near near;
    near.fill(0xffff);
    const bool is_any = lanes_kernels<Dim>(isa).template find_near<K>()(
        {a, is_still ? a : first.view(1), b, is_still ? b : second.view(1)}, limit, near.data());
    if (!is_any) {
        near.fill(0);
    }
    EXPECT_EQ(is_any,
              std::any_of(near.begin(), near.end(), [](auto of_one) { return of_one != 0; }));
    return near;
}

template <typename T>
class NearLanesTest : public testing::Test {
protected:
    static constexpr int kD = T::value;

    double number(double size) {
        return std::uniform_real_distribution<double>(-size, size)(random_);
    }

    // Simplices of about `size`, up to that far from a place and twice that from each other, some
    // of them collapsed, that move by up to a fifth of that.
    template <int Count>
    Patch<kD, Count> patch(std::int32_t first_vertex,
                           int count,
                           const Vector<kD>& place,
                           double size) {
        const double motion = 0.2 * size;
        Patch<kD, Count> patch(count, first_vertex);
        for (int i = 0; i < count; ++i) {
            const Vector<kD> center = place + Vector<kD>::NullaryExpr([&] { return number(size); });
            Corners<kD, Count> start =
                center.replicate(1, Count)
                + Corners<kD, Count>::NullaryExpr([&] { return number(size); });
            if (i % 5 == 4) {
                start.col(Count - 1) = start.col(0);
            }
            patch[i][0] = start;
            patch[i][1] = start + Corners<kD, Count>::NullaryExpr([&] { return number(motion); });
        }
        return patch;
    }

    // Counts of pairs that are found: those within 1.2 times the distance, and others; and of those
    // that are not, since they share a vertex.
    struct Counts {
        int near = 0;
        int far = 0;
        int shared = 0;
        int all = 0;
    };

    template <int K, int L>
    void expect_all(
        Patch<kD, K>& first, Patch<kD, L>& second, bool is_still, double limit, Counts& counts) {
        const int times = is_still ? 0 : 8;
        std::vector<double> least;
        for (int i = 0; i < first.count(); ++i) {
            for (int j = 0; j < second.count(); ++j) {
                double distance = std::numeric_limits<double>::infinity();
                for (int k = 0; k <= times; ++k) {
                    const double t = times == 0 ? 0 : 1.0 * k / times;
                    distance = std::min(distance, std::sqrt(test::closest_points<kD, K, L>(
                                                                first.at(i, t), second.at(j, t))
                                                                .distance_squared));
                }
                least.push_back(distance);
            }
        }
        for (const LanesIsa isa : kAll) {
            if (!is_supported(isa)) {
                continue;
            }
            const Near near = find<kD, K, L>(isa, first, second, is_still, limit);
            for (int i = 0; i < kLanes; ++i) {
                for (int j = 0; j < kLanes; ++j) {
                    const bool is_found = (near[static_cast<std::size_t>(i)] >> j & 1) != 0;
                    if (i >= first.count() || j >= second.count()) {
                        EXPECT_FALSE(is_found);
                        continue;
                    }
                    const double distance = least[static_cast<std::size_t>(i * second.count() + j)];
                    const bool is_one_shared = first.vertex(i) < second.vertex(j) + L
                                               && second.vertex(j) < first.vertex(i) + K;
                    EXPECT_TRUE(is_found || is_one_shared || distance > limit)
                        << "lanes " << i << " and " << j << " are " << distance << " m apart";
                    EXPECT_FALSE(is_found && is_one_shared);
                    counts.shared += is_one_shared && distance < limit ? 1 : 0;
                    ++counts.all;
                    counts.near += is_found && distance < 1.2 * limit ? 1 : 0;
                    counts.far += is_found && distance >= 1.2 * limit ? 1 : 0;
                }
            }
        }
    }

    template <int K, int L>
    Counts of_all_places(bool is_still) {
        Counts counts;
        for (const double scale : {1e-4, 1.0, 1e3}) {
            for (const double away : {0.0, 1e3, 1e6}) {
                for (int round = 0; round < 60; ++round) {
                    const Vector<kD> place = scale * away * Vector<kD>::Ones();
                    const Vector<kD> other =
                        place + scale * Vector<kD>::NullaryExpr([&] { return number(3); });
                    // In every other round some have vertices in common.
                    auto first = patch<K>(0, 1 + round % 6 * 3, place, scale);
                    auto second = patch<L>(round % 2 == 0 ? 1000 : round % 7, 16 - round % 6 * 2,
                                           other, scale);
                    expect_all<K, L>(first, second, is_still, (0.1 + 0.1 * (round % 6)) * scale,
                                     counts);
                }
            }
        }
        return counts;
    }

    std::mt19937 random_{5};
};

using Dimensions = testing::Types<std::integral_constant<int, 3>, std::integral_constant<int, 4>>;
TYPED_TEST_SUITE(NearLanesTest, Dimensions);

TYPED_TEST(NearLanesTest, NoPairThatIsNearIsLostAndFewOthersAreFound) {
    constexpr int kDim = TypeParam::value;
    for (const auto& counts : {this->template of_all_places<1, kDim>(true),
                               this->template of_all_places<2, kDim - 1>(true)}) {
        EXPECT_GT(counts.near, 50 * kernels());
        EXPECT_GT(counts.shared, 3 * kernels());
        EXPECT_LT(counts.far, 0.001 * counts.all);
    }
}

// What comes near on its way counts as near; what a line keeps apart at both ends does not.
TYPED_TEST(NearLanesTest, NoPairThatComesNearOnItsWayIsLost) {
    constexpr int kDim = TypeParam::value;
    for (const auto& counts : {this->template of_all_places<1, kDim>(false),
                               this->template of_all_places<2, kDim - 1>(false)}) {
        EXPECT_GT(counts.near, 50 * kernels());
        EXPECT_GT(counts.shared, 3 * kernels());
        EXPECT_LT(counts.far, 0.001 * counts.all);
    }
}

// Exactly at a distance along an axis: a little below it is found, a little above it is not.
TYPED_TEST(NearLanesTest, TheDistanceIsMetToRounding) {
    constexpr int kDim = TypeParam::value;
    for (const double away : {0.0, 100.0}) {
        Patch<kDim, 2> edge(1, 0);
        Patch<kDim, kDim - 1> other(1, 100);
        edge[0][0] = Corners<kDim, 2>::Constant(away);
        edge[0][0](0, 1) += 1;
        other[0][0] = Corners<kDim, kDim - 1>::Constant(away);
        other[0][0](1, 0) += 1;
        other[0][0].row(kDim - 1).array() += 0.25;
        for (const LanesIsa isa : kAll) {
            if (is_supported(isa)) {
                EXPECT_EQ((find<kDim, 2, kDim - 1>(isa, edge, other, true, 0.25 * 1.0001)[0]), 1);
                EXPECT_EQ((find<kDim, 2, kDim - 1>(isa, edge, other, true, 0.25 * 0.9999)[0]), 0);
            }
        }
    }
}

// Simplices that cross in their middles, and lengths whose squares are nothing in float.
TYPED_TEST(NearLanesTest, NothingIsApartWithoutALineToTell) {
    constexpr int kDim = TypeParam::value;
    for (const double scale : {1.0, 1e-18, 1e-30}) {
        Patch<kDim, 2> edge(3, 0);
        Patch<kDim, kDim - 1> other(2, 100);
        for (int i = 0; i < 3; ++i) {
            edge[i][0].setZero();
            edge[i][0](0, 0) = -scale;
            edge[i][0](0, 1) = scale;
        }
        for (int j = 0; j < 2; ++j) {
            other[j][0].setZero();
            other[j][0](1, 0) = scale;
            other[j][0](1, 1) = -scale;
        }
        for (const LanesIsa isa : kAll) {
            if (is_supported(isa)) {
                const Near near = find<kDim, 2, kDim - 1>(isa, edge, other, true, 0.1 * scale);
                EXPECT_EQ(near[0], 3);
                EXPECT_EQ(near[2], 3);
                EXPECT_EQ(near[3], 0);
            }
        }
    }
}

}  // namespace
}  // namespace pent::contact
