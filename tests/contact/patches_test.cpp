#include "patches.h"

#include "boxes_around.h"
#include "closest_points_oracle.h"
#include "gather.h"
#include "scenes.h"

#include <Eigen/SVD>
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <utility>
#include <vector>

namespace pent::contact {
namespace {

template <int Dim>
using Map = Eigen::Matrix<double, Dim, Dim>;

template <typename T>
class PatchesTest : public testing::Test {
protected:
    static constexpr int kD = T::value;

    // Edges and ridges of a bar along the first axis, and their patches.
    struct Bar {
        test::Scene<kD> scene;
        PatchPartition edge_partition;
        PatchPartition ridge_partition;
        Patches<kD> edges;
        Patches<kD> ridges;

        Bar() {
            std::array<int, kD> count{};
            std::array<double, kD> size{};
            count.fill(kD == 3 ? 2 : 1);
            size.fill(kD == 3 ? 2 : 1);
            count[0] = 12;
            size[0] = 12;
            scene.add(pent::test::kuhn_box<kD>(count, size), Vector<kD>::Zero());
            test::shake<kD>(scene.positions, 0.05, 3);
            const Surface<kD>& surface = scene.surfaces[0];
            edge_partition = PatchPartition(boxes_around<kD, 2>(surface.edges, scene.positions, 0));
            ridge_partition =
                PatchPartition(boxes_around<kD, kD - 1>(surface.ridges, scene.positions, 0));
            edges = Patches<kD>(surface.edges, edge_partition, scene.positions);
            ridges = Patches<kD>(surface.ridges, ridge_partition, scene.positions);
        }

        void fit(const Positions<kD>& positions) {
            const PositionsView<kD> here = positions;
            edges.fit({here, here});
            ridges.fit({here, here});
        }

        void fit(const Positions<kD>& from, const Positions<kD>& to) {
            const PositionsView<kD> start = from;
            const PositionsView<kD> end = to;
            edges.fit({start, end});
            ridges.fit({start, end});
        }
    };

    // A bar rolled up to a circle of that radius, stretched by 1 on a line through its axis.
    static Positions<kD> rolled(const Positions<kD>& rest, double radius) {
        Positions<kD> positions = rest;
        for (auto x : positions.colwise()) {
            const double angle = x[0] / radius;
            const double r = radius - x[1];
            x[0] = r * std::sin(angle);
            x[1] = radius - r * std::cos(angle);
        }
        return positions;
    }

    static std::vector<Positions<kD>> deformed(const Positions<kD>& rest) {
        std::vector<Positions<kD>> all{rest, rolled(rest, 20), rolled(rest, 4), rolled(rest, 2)};
        for (const double size : {0.02, 0.2, 2.0}) {
            all.push_back(test::tilt<kD>() * rest);
            test::shake<kD>(all.back(), size, 11);
        }
        all.push_back(Positions<kD>::Zero(kD, rest.cols()));
        return all;
    }

    // Paths among these: some that stay, and short, long and wild ones.
    static std::vector<std::pair<Positions<kD>, Positions<kD>>> paths(const Positions<kD>& rest) {
        const std::vector<Positions<kD>> places = deformed(rest);
        std::vector<std::pair<Positions<kD>, Positions<kD>>> all;
        for (std::size_t i = 0; i < places.size(); ++i) {
            all.emplace_back(places[i], places[i]);
            all.emplace_back(places[i], places[(i + 1) % places.size()]);
        }
        // Half a turn ends where it began, through a body of no size.
        all.emplace_back(rest, -rest);
        all.emplace_back(rolled(rest, 4), test::tilt<kD>() * rolled(rest, 4.2));
        // One half comes out of the other: patches that do not deform at all.
        Positions<kD> halves = rest;
        for (auto x : halves.colwise()) {
            x[0] -= x[0] > 6 ? 5.5 : 0;
        }
        all.emplace_back(halves, rest);
        all.emplace_back(rest, halves);
        return all;
    }
};

// Whether pairs so far apart at rest are certainly farther apart now than a distance.
template <int Dim>
bool stay_apart(const PatchMotion<Dim>& first,
                const PatchMotion<Dim>& second,
                double rest_distance,
                double distance) {
    return bound_of<Dim>(first, second).is_apart(rest_distance, distance);
}

using Dimensions = testing::Types<std::integral_constant<int, 3>, std::integral_constant<int, 4>>;
TYPED_TEST_SUITE(PatchesTest, Dimensions);

TYPED_TEST(PatchesTest, DeviateFromTheirMapsByNoMoreThanTheySay) {
    constexpr int kDim = TypeParam::value;
    typename TestFixture::Bar bar;
    const Positions<kDim>& rest = bar.scene.positions;
    const PatchPartition& partition = bar.ridge_partition;
    ASSERT_EQ(partition.size(), bar.ridges.motions().size());
    for (const auto& [from, to] : TestFixture::paths(rest)) {
        bar.fit(from, to);
        for (std::size_t patch = 0; patch < partition.size(); ++patch) {
            const PatchMotion<kDim>& motion = bar.ridges.motions()[patch];
            for (const std::uint32_t i : partition[patch]) {
                const auto corners = bar.scene.surfaces[0].ridges.col(i);
                for (const std::uint32_t v : corners) {
                    const Vector<kDim> offset = rest.col(v) - motion.rest_center;
                    const auto at = [&](const PatchPlace<kDim>& place) -> Vector<kDim> {
                        return place.center + place.map * offset;
                    };
                    EXPECT_LE((to.col(v) - at(motion.end)).norm(), motion.deviation);
                    EXPECT_LE((from.col(v) - at(motion.start)).norm(), motion.deviation);
                    EXPECT_LE(offset.norm(), motion.radius);
                }
            }
        }
    }
}

// Singular values on the way, by another decomposition.
TYPED_TEST(PatchesTest, StretchNoLessThanTheySayAtAnyTime) {
    constexpr int kDim = TypeParam::value;
    typename TestFixture::Bar bar;
    double tightest = 0;
    for (const auto& [from, to] : TestFixture::paths(bar.scene.positions)) {
        bar.fit(from, to);
        for (const PatchMotion<kDim>& motion : bar.edges.motions()) {
            double least = std::numeric_limits<double>::infinity();
            for (const double t : {0.0, 0.2, 0.5, 0.7, 1.0}) {
                const Map<kDim> map = (1 - t) * motion.start.map + t * motion.end.map;
                const double stretch = Eigen::JacobiSVD<Map<kDim>>(map).singularValues()[kDim - 1];
                EXPECT_GE(stretch, motion.least_stretch - 1e-9);
                least = std::min(least, stretch);
            }
            tightest = std::max(tightest, motion.least_stretch / std::max(least, 1e-9));
        }
    }
    EXPECT_GT(tightest, 0.99);
}

// Corners at a face of the bar, where the fit has nothing to go by across, included.
TYPED_TEST(PatchesTest, FollowAnAffineMapExactly) {
    constexpr int kDim = TypeParam::value;
    typename TestFixture::Bar bar;
    const Map<kDim> stretch = Vector<kDim>::LinSpaced(0.8, 1.3).asDiagonal();
    const Positions<kDim> positions =
        (test::tilt<kDim>() * stretch * bar.scene.positions).colwise() + Vector<kDim>::Ones();
    bar.fit(positions);
    for (const PatchMotion<kDim>& motion : bar.edges.motions()) {
        // The vertices were shaken by a twentieth: how far a flat patch is from flat.
        EXPECT_LT(motion.deviation, 0.05);
        EXPECT_GT(motion.least_stretch, 0.75);
        EXPECT_LT(motion.least_stretch, 1.01);
    }
}

TYPED_TEST(PatchesTest, OfABodyThatMovesRigidlyStayApart) {
    constexpr int kDim = TypeParam::value;
    typename TestFixture::Bar bar;
    const Positions<kDim> positions =
        (test::tilt<kDim>() * bar.scene.positions).colwise() + 100 * Vector<kDim>::Ones();
    bar.fit(positions);
    for (const PatchMotion<kDim>& a : bar.edges.motions()) {
        for (const PatchMotion<kDim>& b : bar.ridges.motions()) {
            EXPECT_TRUE(stay_apart<kDim>(a, b, 0.1001, 0.1));
            EXPECT_FALSE(stay_apart<kDim>(a, b, 0.1, 0.1));
        }
    }
}

// The definition, by all pairs of all patches.
TYPED_TEST(PatchesTest, StayApartOnlyWhereAllTheirPairsDo) {
    constexpr int kDim = TypeParam::value;
    constexpr double kInfinite = std::numeric_limits<double>::infinity();
    typename TestFixture::Bar bar;
    const Positions<kDim>& rest = bar.scene.positions;
    const Surface<kDim>& surface = bar.scene.surfaces[0];
    const double rest_distance = 0.5;
    const double distance = 0.25;
    int apart = 0;
    int others = 0;
    const auto expect_apart = [&](std::uint32_t i, std::uint32_t j,
                                  const std::vector<Positions<kDim>>& way) {
        const auto far = test::closest_points<kDim, 2, kDim - 1>(
            gather<kDim, 2>(surface.edges, i, rest),
            gather<kDim, kDim - 1>(surface.ridges, j, rest));
        if (far.distance_squared < rest_distance * rest_distance) {
            return;
        }
        for (const Positions<kDim>& positions : way) {
            const auto now = test::closest_points<kDim, 2, kDim - 1>(
                gather<kDim, 2>(surface.edges, i, positions),
                gather<kDim, kDim - 1>(surface.ridges, j, positions));
            EXPECT_GT(now.distance_squared, distance * distance);
        }
    };
    for (const auto& [from, to] : TestFixture::paths(rest)) {
        bar.fit(from, to);
        const std::vector<Positions<kDim>> way{from, 0.5 * (from + to), to};
        for (std::size_t a = 0; a < bar.edge_partition.size(); ++a) {
            for (std::size_t b = 0; b < bar.ridge_partition.size(); ++b) {
                if (!stay_apart<kDim>(bar.edges.motions()[a], bar.ridges.motions()[b],
                                      rest_distance, distance)) {
                    ++others;
                    continue;
                }
                ++apart;
                // A sample of the pairs: the first of one patch with all of the other.
                for (const std::uint32_t j : bar.ridge_partition[b]) {
                    expect_apart(bar.edge_partition[a][0], j, way);
                }
            }
        }
        EXPECT_FALSE(stay_apart<kDim>(bar.edges.motions()[0], bar.ridges.motions()[0],
                                      rest_distance, kInfinite));
    }
    EXPECT_GT(apart, 100);
    EXPECT_GT(others, 100);
}

TYPED_TEST(PatchesTest, NeverStayApartWhereNothingIsKnown) {
    constexpr int kDim = TypeParam::value;
    typename TestFixture::Bar bar;
    Positions<kDim> positions = bar.scene.positions;
    positions.setConstant(std::numeric_limits<double>::quiet_NaN());
    bar.fit(positions);
    const PatchMotion<kDim> nowhere = bar.edges.motions()[0];
    EXPECT_FALSE(stay_apart<kDim>(nowhere, nowhere, 2, 1));
    // All vertices on a line: a map across it is anyone's guess.
    test::Scene<kDim> line = bar.scene;
    line.positions.bottomRows(kDim - 1).setZero();
    Patches<kDim> patches(line.surfaces[0].edges, bar.edge_partition, line.positions);
    const PositionsView<kDim> there = line.positions;
    patches.fit({there, there});
    EXPECT_FALSE(stay_apart<kDim>(patches.motions()[0], patches.motions()[0], 2, 1));
    EXPECT_FALSE(stay_apart<kDim>(PatchMotion<kDim>(), PatchMotion<kDim>(), 2, 1));
}

}  // namespace
}  // namespace pent::contact
