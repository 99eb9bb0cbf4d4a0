#include "model/held_vertices.h"

#include "scenes.h"
#include "support/messages.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cstdint>
#include <limits>
#include <set>
#include <vector>

// What constraints and a host hold, found vertex by vertex.

namespace pent::simulator {
namespace {

using test::bar;
using test::box_scene;
using test::hold;
using test::left_end;
using test::still;

using Vertices = std::set<std::uint32_t>;

HalfSpaceSelection right_end(double x) {
    return {.normal = -Eigen::Vector4d::UnitX(), .offset = -x + 1e-6};
}

// Two bars beside each other, of 2 and 3 cells: of the first the left end is held all the time and
// the right end in the steps [3, 7), the second is held wholly in the steps [0, 5).
Scene two_bars() {
    Scene scene = box_scene<4>();
    scene.bodies.push_back(scene.bodies[0]);
    scene.bodies[1].name = "other";
    scene.bodies[1].place.translate = 2 * Eigen::Vector4d::UnitY();
    scene.constraints = {hold(left_end(), still(4)), hold(right_end(0.5), still(4)),
                         hold(EverythingSelection{}, still(4))};
    const double dt = scene.dt();
    scene.constraints[1].from = 3 * dt;
    scene.constraints[1].to = 7 * dt;
    scene.constraints[2].body = "other";
    scene.constraints[2].to = 5 * dt;
    return scene;
}

Bodies<4> make_bars(const Scene& scene) {
    return make_bodies<4>(scene, {bar(2), bar(3)});
}

Vertices held_in(std::uint64_t step, const Bodies<4>& bodies) {
    Vertices held;
    for (Eigen::Index v = 0; v < bodies.vertex_count(); ++v) {
        const bool is_first = v < bodies.first_vertex[1];
        const double x = bodies.rest()(0, v);
        if (is_first ? x < 1e-6 || (x > 0.5 - 1e-6 && 3 <= step && step < 7) : step < 5) {
            held.insert(static_cast<std::uint32_t>(v));
        }
    }
    return held;
}

Vertices marked(const std::vector<bool>& marks) {
    Vertices all;
    for (std::uint32_t v = 0; v < marks.size(); ++v) {
        if (marks[v]) {
            all.insert(v);
        }
    }
    return all;
}

void expect_held(const HeldVertices<4>& held, const Vertices& expected) {
    EXPECT_EQ(marked(held.now()), expected);
    for (std::uint32_t v = 0; v < held.now().size(); ++v) {
        EXPECT_EQ(held.is_held(v), expected.contains(v)) << v;
    }
}

// From each step to each other, as resume and steps that are cut go: what is held hangs on the step
// alone, and the bodies that are told are those of which something has changed.
TEST(HeldVertices, AreThoseOfTheConstraintsOfAStepWhateverWasBefore) {
    const Scene scene = two_bars();
    const Bodies<4> bodies = make_bars(scene);
    for (std::uint64_t from = 0; from < 9; ++from) {
        for (std::uint64_t to = 0; to < 9; ++to) {
            HeldVertices<4> held(scene, bodies);
            expect_held(held, held_in(0, bodies));
            static_cast<void>(held.hold(from, bodies.rest()));
            const std::vector<std::size_t> changed = held.hold(to, bodies.rest());
            expect_held(held, held_in(to, bodies));
            const auto is_changed = [&](std::size_t body) {
                return std::find(changed.begin(), changed.end(), body) != changed.end();
            };
            const auto is_between = [](std::uint64_t i) { return 3 <= i && i < 7; };
            EXPECT_EQ(is_changed(0), is_between(from) != is_between(to)) << from << " " << to;
            EXPECT_EQ(is_changed(1), (from < 5) != (to < 5)) << from << " " << to;
            for (std::size_t i = 0; i < 3; ++i) {
                const bool is_on[] = {true, is_between(to), to < 5};
                EXPECT_EQ(held.is_held(held.sets()[i]), is_on[i]);
            }
        }
    }
}

TEST(HeldVertices, AreHeldAlwaysWhereNothingEnds) {
    Scene scene = two_bars();
    const Bodies<4> bodies = make_bars(scene);
    const HeldVertices<4> held(scene, bodies);
    EXPECT_EQ(marked(held.always()), held_in(8, bodies));
    EXPECT_FALSE(held.is_kinematic(0));
    EXPECT_FALSE(held.is_kinematic(1));
    scene.constraints[2].to = std::numeric_limits<double>::infinity();
    const HeldVertices<4> longer(scene, bodies);
    EXPECT_FALSE(longer.is_kinematic(0));
    EXPECT_TRUE(longer.is_kinematic(1));
    scene.constraints[2].from = scene.dt();  // free in the first step
    const HeldVertices<4> later(scene, bodies);
    EXPECT_EQ(marked(later.always()), marked(held.always()));
    EXPECT_FALSE(later.is_kinematic(1));
}

// The velocity of what is given is the derivative of where it is, by central differences.
TEST(HeldVertices, MoveWithTheVelocityOfTheirMotion) {
    Scene scene = box_scene<4>();
    Motion motion = still(4);
    motion.translate = Eigen::Vector4d(1, 2, 3, 4);
    motion.rotate = {{{0, 3}, 60}, {{1, 2}, -100}};
    scene.constraints = {hold(left_end(), motion)};
    const Bodies<4> bodies = make_bodies<4>(scene, {bar(2)});
    const HeldVertices<4> held(scene, bodies);
    const double time = 0.3;
    const double step = 1e-6;
    const auto at = [&](double moment, Positions<4>* velocities) {
        Positions<4> positions = bodies.rest();
        held.place(moment, positions, velocities);
        return positions;
    };
    Positions<4> velocities = Positions<4>::Zero(4, bodies.vertex_count());
    const Positions<4> now = at(time, &velocities);
    const Positions<4> slope = (at(time + step, nullptr) - at(time - step, nullptr)) / (2 * step);
    EXPECT_LT((velocities - slope).norm(), 1e-8 * slope.norm());
    EXPECT_GT(slope.norm(), 1);
    for (std::uint32_t v = 0; v < now.cols(); ++v) {
        if (!held.is_held(v)) {
            EXPECT_EQ(now.col(v), bodies.rest().col(v));
            EXPECT_EQ(velocities.col(v).norm(), 0);
        }
    }
}

// Taken up in step 3 of a body that has moved and is bent: it stays there, and what a snapshot has
// of it puts another one in the same place.
TEST(HeldVertices, StayWhereTheyAreTakenUp) {
    Scene scene = two_bars();
    scene.constraints[1].motion[0].rotate = {{{0, 1}, 90}};  // about where it is taken up
    const Bodies<4> bodies = make_bars(scene);
    HeldVertices<4> held(scene, bodies);
    Positions<4> moved = bodies.rest();
    moved.row(0).array() += 0.3;
    moved.row(3).array() += moved.row(1).array().square() + 0.7;
    static_cast<void>(held.hold(3, moved));
    Positions<4> placed = moved;
    held.place(3 * scene.dt(), placed, nullptr);
    for (const std::uint32_t vertex : held.sets()[1].vertices) {
        EXPECT_EQ(placed.col(vertex), moved.col(vertex));
    }
    // A rotation about their middle keeps it, and moves all that is not in it.
    const auto later = [&](const HeldVertices<4>& of) {
        Positions<4> positions = moved;
        of.place(5 * scene.dt(), positions, nullptr);
        return positions;
    };
    const std::vector<std::uint32_t>& vertices = held.sets()[1].vertices;
    const Positions<4> way = later(held)(Eigen::all, vertices) - moved(Eigen::all, vertices);
    EXPECT_LT(way.rowwise().sum().norm(), 1e-13);
    EXPECT_GT(way.norm(), 1e-3);

    EXPECT_EQ(held.places(), Positions<4>(moved(Eigen::all, vertices)));
    HeldVertices<4> other(scene, bodies);
    static_cast<void>(other.hold(3, bodies.rest()));
    EXPECT_NE(later(other), later(held));
    other.set_places(held.places());
    EXPECT_EQ(later(other), later(held));
}

// With what constraints hold, whose vertices it may have as well; it moves on a straight way.
TEST(HeldVertices, AreThoseOfAHostTooUntilItLetsGo) {
    const Scene scene = two_bars();
    const Bodies<4> bodies = make_bars(scene);
    HeldVertices<4> held(scene, bodies);
    static_cast<void>(held.hold(1, bodies.rest()));
    Vertices expected = held_in(1, bodies);
    const std::uint32_t both = *expected.begin();
    const std::vector<std::uint32_t> vertices = {both, both + 1, both + 2};
    const Positions<4> targets =
        bodies.rest()(Eigen::all, vertices).colwise() + Eigen::Vector4d(1, 2, 3, 4);
    EXPECT_TRUE(held.hold_for_host(vertices, targets));
    EXPECT_FALSE(held.hold_for_host(vertices, targets));
    expected.insert(vertices.begin(), vertices.end());
    EXPECT_GT(expected.size(), held_in(1, bodies).size());
    expect_held(held, expected);

    held.begin_step_of_host(bodies.rest(), 2, 2.5);
    for (const double part : {0.0, 0.25, 1.0}) {
        Positions<4> positions = bodies.rest();
        Positions<4> velocities = Positions<4>::Zero(4, positions.cols());
        held.place(2 + 0.5 * part, positions, &velocities);
        for (const std::uint32_t vertex : vertices) {
            const Eigen::Vector4d way = positions.col(vertex) - bodies.rest().col(vertex);
            EXPECT_LT((way - part * Eigen::Vector4d(1, 2, 3, 4)).norm(), 1e-14) << part;
            EXPECT_LT((velocities.col(vertex) - Eigen::Vector4d(2, 4, 6, 8)).norm(), 1e-14);
        }
    }
    EXPECT_TRUE(held.hold_for_host({}, Positions<4>(4, 0)));
    expect_held(held, held_in(1, bodies));
}

// However the times of steps are rounded: 111 times 1/60 s is less than 1.85 s.
TEST(HeldVertices, AreTakenUpBeforeTheirFirstKeyframe) {
    Scene scene = box_scene<4>();
    scene.frames_per_second = 60;
    const Bodies<4> bodies = make_bodies<4>(scene, {bar(2)});
    const auto hold_from = [&](double from, double keyframe) {
        Motion motion;
        motion.keyframes.resize(1);
        motion.keyframes[0].time = keyframe;
        motion.keyframes[0].translate = Eigen::Vector4d(0, 0.1, 0, 0);
        scene.constraints = {hold(left_end(), motion)};
        scene.constraints[0].from = from;
        static_cast<void>(HeldVertices<4>(scene, bodies));
    };
    for (const double time : {1.8, 1.85}) {
        pent::test::expect_contains(pent::test::error_of([&] { hold_from(time - 0.01, time); }),
                                    {"the first of \"keyframes\" is at 1.8", "expected it behind"});
        EXPECT_NO_THROW(hold_from(time - 0.01, time + 0.001));
        EXPECT_NO_THROW(hold_from(time, time + 0.001));
    }
}

TEST(HeldVertices, OfTwoConstraintsAtOneTimeAndOfNoneAreRefused) {
    Scene scene = box_scene<4>();
    const Bodies<4> bodies = make_bodies<4>(scene, {bar(2)});
    scene.constraints = {hold(left_end(), still(4)), hold(EverythingSelection{}, still(4))};
    pent::test::expect_contains(
        pent::test::error_of([&] { static_cast<void>(HeldVertices<4>(scene, bodies)); }),
        {"vertex 0", "\"box\""});
    scene.constraints = {
        hold(HalfSpaceSelection{.normal = Eigen::Vector4d::UnitX(), .offset = -1}, still(4))};
    EXPECT_NE(pent::test::error_of([&] { static_cast<void>(HeldVertices<4>(scene, bodies)); }), "");
}

}  // namespace
}  // namespace pent::simulator
