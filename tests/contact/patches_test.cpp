#include "patches.h"

#include "boxes_around.h"
#include "closest_points_oracle.h"
#include "gather.h"
#include "scenes.h"

#include <Eigen/SVD>
#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <span>
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
        Patches<kD> edge_patches;
        Patches<kD> ridge_patches;
        std::vector<PatchMotion<kD>> edges;
        std::vector<PatchMotion<kD>> ridges;

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
            edge_patches =
                Patches<kD>(PatchVertices(surface.edges, edge_partition), scene.positions);
            ridge_patches =
                Patches<kD>(PatchVertices(surface.ridges, ridge_partition), scene.positions);
        }

        // How they move from some positions to others.
        void move(const Positions<kD>& earlier, const Positions<kD>& now) {
            edges = edge_patches.motions(edge_patches.place(earlier), edge_patches.place(now));
            ridges = ridge_patches.motions(ridge_patches.place(earlier), ridge_patches.place(now));
        }

        // The same for paths.
        void move(const Positions<kD>& earlier,
                  const Positions<kD>& from,
                  const Positions<kD>& to) {
            edges = edge_patches.motions(edge_patches.place(earlier), edge_patches.place(from),
                                         edge_patches.place(to));
            ridges = ridge_patches.motions(ridge_patches.place(earlier), ridge_patches.place(from),
                                           ridge_patches.place(to));
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

    // Where patches were earlier, and these paths: from rest, and from a bent and a shaken bar.
    struct Way {
        Positions<kD> earlier;
        Positions<kD> from;
        Positions<kD> to;
    };
    static std::vector<Way> ways(const Positions<kD>& rest) {
        const std::vector<Positions<kD>> places = deformed(rest);
        std::vector<Way> all;
        for (const auto& [from, to] : paths(rest)) {
            for (const std::size_t earlier : {0, 2, 5}) {
                all.push_back({places[earlier], from, to});
            }
        }
        return all;
    }
};

template <int Dim>
PatchBound bound_of(const PatchMotion<Dim>& first, const PatchMotion<Dim>& second) {
    PatchBound bound;
    PatchMotions<Dim>({first}).bound(0, PatchMotions<Dim>({second}), std::array{0U},
                                     std::span(&bound, 1));
    return bound;
}

// Whether pairs that were so far apart are certainly farther apart now than a distance.
template <int Dim>
bool stay_apart(const PatchMotion<Dim>& first,
                const PatchMotion<Dim>& second,
                double earlier_distance,
                double distance) {
    return bound_of<Dim>(first, second).is_apart(earlier_distance, distance);
}

using Dimensions = testing::Types<std::integral_constant<int, 3>, std::integral_constant<int, 4>>;
TYPED_TEST_SUITE(PatchesTest, Dimensions);

TYPED_TEST(PatchesTest, DeviateFromTheirMapsByNoMoreThanTheySay) {
    constexpr int kDim = TypeParam::value;
    typename TestFixture::Bar bar;
    const Positions<kDim>& rest = bar.scene.positions;
    const PatchPartition& partition = bar.ridge_partition;
    for (const auto& [earlier, from, to] : TestFixture::ways(rest)) {
        bar.move(earlier, from, to);
        ASSERT_EQ(partition.size(), bar.ridges.size());
        for (std::size_t patch = 0; patch < partition.size(); ++patch) {
            const PatchMotion<kDim>& motion = bar.ridges[patch];
            for (const std::uint32_t i : partition[patch]) {
                const auto corners = bar.scene.surfaces[0].ridges.col(i);
                for (const std::uint32_t v : corners) {
                    const Vector<kDim> offset = earlier.col(v) - motion.earlier_center;
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
    for (const auto& [earlier, from, to] : TestFixture::ways(bar.scene.positions)) {
        bar.move(earlier, from, to);
        for (const PatchMotion<kDim>& motion : bar.edges) {
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
    bar.move(bar.scene.positions, positions);
    for (const PatchMotion<kDim>& motion : bar.edges) {
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
    bar.move(bar.scene.positions, positions);
    for (const PatchMotion<kDim>& a : bar.edges) {
        for (const PatchMotion<kDim>& b : bar.ridges) {
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
    const double earlier_distance = 0.5;
    const double distance = 0.25;
    int apart = 0;
    int others = 0;
    const auto expect_apart = [&](std::uint32_t i, std::uint32_t j, const Positions<kDim>& earlier,
                                  const std::vector<Positions<kDim>>& way) {
        const auto far = test::closest_points<kDim, 2, kDim - 1>(
            gather<kDim, 2>(surface.edges, i, earlier),
            gather<kDim, kDim - 1>(surface.ridges, j, earlier));
        if (far.distance_squared < earlier_distance * earlier_distance) {
            return;
        }
        for (const Positions<kDim>& positions : way) {
            const auto now = test::closest_points<kDim, 2, kDim - 1>(
                gather<kDim, 2>(surface.edges, i, positions),
                gather<kDim, kDim - 1>(surface.ridges, j, positions));
            EXPECT_GT(now.distance_squared, distance * distance);
        }
    };
    for (const auto& [earlier, from, to] : TestFixture::ways(rest)) {
        bar.move(earlier, from, to);
        const std::vector<Positions<kDim>> way{from, 0.5 * (from + to), to};
        for (std::size_t a = 0; a < bar.edge_partition.size(); ++a) {
            for (std::size_t b = 0; b < bar.ridge_partition.size(); ++b) {
                if (!stay_apart<kDim>(bar.edges[a], bar.ridges[b], earlier_distance, distance)) {
                    ++others;
                    continue;
                }
                ++apart;
                // A sample of the pairs: the first of one patch with all of the other.
                for (const std::uint32_t j : bar.ridge_partition[b]) {
                    expect_apart(bar.edge_partition[a][0], j, earlier, way);
                }
            }
        }
        EXPECT_FALSE(stay_apart<kDim>(bar.edges[0], bar.ridges[0], earlier_distance, kInfinite));
    }
    EXPECT_GT(apart, 100);
    EXPECT_GT(others, 100);
}

// What a bound says, of every two vertices of two patches on their way, and that it is not far from
// what happens to some: patches that turn against each other use what their size allows for.
TYPED_TEST(PatchesTest, TellOfNoTwoVerticesThatTheyAreFartherApartThanTheyAre) {
    constexpr int kDim = TypeParam::value;
    typename TestFixture::Bar bar;
    const Surface<kDim>& surface = bar.scene.surfaces[0];
    const PatchVertices edges(surface.edges, bar.edge_partition);
    const PatchVertices ridges(surface.ridges, bar.ridge_partition);
    double most_used = 0;  // of the lack
    for (const auto& [earlier, from, to] : TestFixture::ways(bar.scene.positions)) {
        bar.move(earlier, from, to);
        const std::vector<Positions<kDim>> way{from, 0.5 * (from + to), to};
        double too_far = -1;
        for (std::size_t a = 0; a < bar.edges.size(); ++a) {
            for (std::size_t b = 0; b < bar.ridges.size(); ++b) {
                const PatchBound bound = bound_of<kDim>(bar.edges[a], bar.ridges[b]);
                for (const std::uint32_t u : edges[a]) {
                    for (const std::uint32_t v : ridges[b]) {
                        const double told =
                            bound.stretch * (earlier.col(u) - earlier.col(v)).norm();
                        for (const Positions<kDim>& x : way) {
                            const double now = (x.col(u) - x.col(v)).norm();
                            too_far = std::max(too_far, told - bound.lack - now);
                            most_used = std::max(most_used, (told - now) / bound.lack);
                        }
                    }
                }
            }
        }
        EXPECT_LT(too_far, 1e-9);
    }
    EXPECT_GT(most_used, 0.8);
}

// What a bound tells after another is no more than what is so: from one place to another, and on.
TYPED_TEST(PatchesTest, StayApartAlsoByOneBoundAfterAnother) {
    constexpr int kDim = TypeParam::value;
    typename TestFixture::Bar bar;
    const Positions<kDim>& rest = bar.scene.positions;
    const Surface<kDim>& surface = bar.scene.surfaces[0];
    const std::size_t patches = bar.edge_partition.size();
    std::vector<PatchBound> bounds(patches * bar.ridge_partition.size(), PatchBound{1, 0});
    const std::vector<Positions<kDim>> way{
        TestFixture::rolled(rest, 20), TestFixture::rolled(rest, 15), TestFixture::rolled(rest, 12),
        test::tilt<kDim>() * TestFixture::rolled(rest, 12), 1.2 * TestFixture::rolled(rest, 14)};
    for (std::size_t k = 1; k < way.size(); ++k) {
        bar.move(way[k - 1], way[k]);
        int told = 0;
        for (std::size_t a = 0; a < patches; ++a) {
            for (std::size_t b = 0; b < bar.ridge_partition.size(); ++b) {
                PatchBound& bound = bounds[b * patches + a];
                bound = bound_of<kDim>(bar.edges[a], bar.ridges[b]).after(bound);
                const std::uint32_t i = bar.edge_partition[a][0];
                const std::uint32_t j = bar.ridge_partition[b][0];
                const auto distance = [&](const Positions<kDim>& x) {
                    return std::sqrt(test::closest_points<kDim, 2, kDim - 1>(
                                         gather<kDim, 2>(surface.edges, i, x),
                                         gather<kDim, kDim - 1>(surface.ridges, j, x))
                                         .distance_squared);
                };
                EXPECT_FALSE(bound.is_apart(distance(way[0]), distance(way[k]) * (1 + 1e-9)));
                told += bound.is_apart(distance(way[0]), 0.25 * distance(way[k])) ? 1 : 0;
            }
        }
        EXPECT_GT(told, 10);
    }
    EXPECT_FALSE((PatchBound{-1, 0}.after(PatchBound{-1, 0}).is_apart(1, 0.5)));
    EXPECT_FALSE((PatchBound{1, 0}.after(PatchBound{}).is_apart(1, 0.5)));
}

TYPED_TEST(PatchesTest, NeverStayApartWhereNothingIsKnown) {
    constexpr int kDim = TypeParam::value;
    typename TestFixture::Bar bar;
    const Positions<kDim>& rest = bar.scene.positions;
    Positions<kDim> positions = rest;
    positions.setConstant(std::numeric_limits<double>::quiet_NaN());
    for (const auto& [earlier, now] : {std::pair(rest, positions), std::pair(positions, rest)}) {
        bar.move(earlier, now);
        EXPECT_FALSE(stay_apart<kDim>(bar.edges[0], bar.edges[0], 2, 1));
    }
    // One that is not finite is enough, whichever it is.
    const PatchVertices edges(bar.scene.surfaces[0].edges, bar.edge_partition);
    for (const std::uint32_t vertex : edges[0]) {
        positions = rest;
        positions(1, vertex) = std::numeric_limits<double>::quiet_NaN();
        for (const auto& [earlier, now] :
             {std::pair(rest, positions), std::pair(positions, rest)}) {
            bar.move(earlier, now);
            EXPECT_FALSE(stay_apart<kDim>(bar.edges[0], bar.edges[0], 2, 1)) << vertex;
        }
    }
    // All vertices on a line: a map across it is anyone's guess.
    Positions<kDim> line = rest;
    line.bottomRows(kDim - 1).setZero();
    bar.move(line, line);
    EXPECT_FALSE(stay_apart<kDim>(bar.edges[0], bar.edges[0], 2, 1));
    const Patches<kDim> patches(PatchVertices(bar.scene.surfaces[0].edges, bar.edge_partition),
                                line);
    const auto motions = patches.motions(patches.place(line), patches.place(line));
    EXPECT_FALSE(stay_apart<kDim>(motions[0], motions[0], 2, 1));
    EXPECT_FALSE(stay_apart<kDim>(PatchMotion<kDim>(), PatchMotion<kDim>(), 2, 1));
}

}  // namespace
}  // namespace pent::contact
