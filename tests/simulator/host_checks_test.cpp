#include "host_scenes.h"
#include "support/messages.h"

#include <gtest/gtest.h>

#include <cmath>
#include <functional>
#include <limits>
#include <string>
#include <utility>
#include <vector>

// What a host asks for and cannot have.

namespace pent::simulator {
namespace {

using test::corner;
using test::cube;
using test::Dimensions;
using test::floating_cube;

template <typename T>
class HostChecks : public testing::Test {};
TYPED_TEST_SUITE(HostChecks, Dimensions);

TYPED_TEST(HostChecks, SayWhatIsNotRightAndNothingHasChanged) {
    constexpr int kDim = TypeParam::value;
    Simulation<kDim> simulation(floating_cube<kDim>(), {cube<kDim>(1)});
    const Positions<kDim> one = simulation.positions(0).leftCols(1);
    const Positions<kDim> nan = one * std::numeric_limits<double>::quiet_NaN();
    const Grab<kDim> good = corner(simulation, 0);
    const auto with = [&](const auto& change) {
        return [&, change] {
            Grab<kDim> grab = good;
            change(grab);
            static_cast<void>(simulation.add_grab(grab));
        };
    };
    const std::vector<std::pair<std::function<void()>, std::string>> wrongs = {
        {[&] { simulation.set_targets(1, {0}, one); }, "body 1 of 1"},
        {[&] { simulation.set_targets(-1, {0}, one); }, "body -1 of 1"},
        {[&] { simulation.set_targets(0, {99}, one); }, "vertex 99 of"},
        {[&] {
             simulation.set_targets(0, {0, 0}, one.replicate(1, 2));
         },
         "vertex 0 is in the list"},
        {[&] {
             simulation.set_targets(0, {0, 1}, one);
         },
         "targets were given for 1 vertex; expected "},
        {[&] { simulation.set_targets(0, {0}, nan); },
         "targets: found nan for x of vertex 0; expected finite numbers"},
        {[&] { simulation.release(3, {0}); }, "body 3 of 1"},
        {[&] { simulation.set_forces(0, one); }, "forces were given for 1 vertex; "},
        {[&] { simulation.set_forces(1, simulation.positions(0)); }, "body 1 of 1"},
        {[&] { simulation.set_gravity(nan.col(0)); }, "gravity must be finite"},
        {[&] { simulation.move_grab(7, one.col(0)); }, "there is no grab 7"},
        {[&] { simulation.move_grab(7, nan.col(0)); }, "anchor of a grab must be finite"},
        {[&] { simulation.remove_grab(7); }, "there is no grab 7"},
        {[&] { simulation.remove_obstacle(0); }, "obstacle 0 of 0"},
        {[&] { simulation.remove_body(1); }, "body 1 of 1"},
        {[&] { simulation.remove_body(0); }, "no body"},
        {with([](auto& g) { g.point.body = 4; }), "body 4 of 1"},
        {with([&](auto& g) { g.point.cell = simulation.mesh(0).cell_count(); }), " of body 0"},
        {with([](auto& g) { g.point.cell = -1; }), "cell -1 of"},
        {with([](auto& g) { g.point.weights *= 2; }), "the sum 2"},
        {with([](auto& g) { g.point.weights.template head<2>() += Eigen::Vector2d(-2, 2); }),
         "the least is -"},
        {with([](auto& g) { g.anchor[0] /= 0; }), "anchor of a grab must be finite"},
        {with([](auto& g) { g.stiffness = 0; }), "stiffness 0"},
        {with([](auto& g) { g.stiffness = INFINITY; }), "stiffness inf"},
        {with([](auto& g) { g.damping = -1; }), "damping -1"},
        {with([](auto& g) { g.damping = INFINITY; }), "damping inf"},
        {with([](auto& g) { g.max_force = 0; }), "max_force 0"},
    };
    for (const auto& [wrong, text] : wrongs) {
        pent::test::expect_contains(pent::test::error_of(wrong), {text});
    }
    const HostState<kDim> host = simulation.host();
    EXPECT_TRUE(!host.gravity && host.grabs.empty() && host.held.empty() && host.next_grab == 1);
}

// Every number of an array, by the vertex that the host named, whatever its place in the list.
TYPED_TEST(HostChecks, SayWhichNumberIsNotFinite) {
    constexpr int kDim = TypeParam::value;
    Simulation<kDim> simulation(floating_cube<kDim>(), {cube<kDim>(1)});
    const Positions<kDim> good = simulation.positions(0);
    const std::vector<std::uint32_t> chosen = {6, 1, 4};
    const std::string end = "; expected finite numbers";
    const auto message = [](const auto& call) { return pent::test::error_of(call); };
    for (int axis = 0; axis < kDim; ++axis) {
        const std::string of = " for " + std::string(1, "xyzw"[axis]) + " of vertex ";
        for (std::uint32_t i = 0; i < 3; ++i) {
            Positions<kDim> targets = good.leftCols(3);
            targets(axis, i) = INFINITY;
            EXPECT_EQ(message([&] { simulation.set_targets(0, chosen, targets); }),
                      "targets: found inf" + of + std::to_string(chosen[i]) + end);
            Snapshot<kDim> snapshot = simulation.save();
            snapshot.host.held = {2, 3, 7};
            snapshot.host.targets = targets;
            EXPECT_EQ(message([&] { simulation.restore(snapshot); }),
                      "targets: found inf" + of + std::to_string(snapshot.host.held[i]) + end);
        }
        for (std::uint32_t vertex = 0; vertex < good.cols(); ++vertex) {
            Positions<kDim> wrong = good;
            wrong(axis, vertex) = -INFINITY;
            const std::string found = ": found -inf" + of + std::to_string(vertex) + end;
            EXPECT_EQ(message([&] { simulation.set_forces(0, wrong); }), "forces" + found);
            EXPECT_EQ(message([&] { simulation.set_state(0, wrong, good); }),
                      "positions of body 0" + found);
            EXPECT_EQ(message([&] { simulation.set_state(0, good, wrong); }),
                      "velocities of body 0" + found);
        }
    }
    EXPECT_EQ(Positions<kDim>(simulation.positions(0)), good);
    EXPECT_TRUE(simulation.host().held.empty());
}

TEST(HostStates, ThatNoSimulationHasAreRefused) {
    Simulation<3> simulation(floating_cube<3>(), {cube<3>(1)});
    for (int i = 0; i < 2; ++i) {
        static_cast<void>(simulation.add_grab(corner(simulation, 0)));
    }
    simulation.set_targets(0, {1, 3}, simulation.positions(0).leftCols(2));
    const Snapshot<3> good = simulation.save();
    const auto refused = [&](const auto& change) {
        Snapshot<3> snapshot = good;
        change(snapshot.host);
        return pent::test::error_of([&] { simulation.restore(snapshot); });
    };
    const double nan = std::numeric_limits<double>::quiet_NaN();
    pent::test::expect_contains(refused([&](auto& h) { h.gravity = Vector<3>::Constant(nan); }),
                                {"gravity"});
    pent::test::expect_contains(refused([&](auto& h) { h.forces.setOnes(3, 2); }),
                                {"forces were given for 2 vertices"});
    pent::test::expect_contains(refused([&](auto& h) { h.held[1] = 8; }), {"below 8"});
    for (const std::uint32_t second : {0U, 1U}) {  // behind 1
        pent::test::expect_contains(refused([&](auto& h) { h.held[1] = second; }), {"increase"});
    }
    pent::test::expect_contains(refused([&](auto& h) { h.targets.setOnes(3, 1); }),
                                {"targets were given for 1 vertex"});
    pent::test::expect_contains(refused([&](auto& h) { h.next_grab = 1; }), {"grab 1"});
    pent::test::expect_contains(refused([&](auto& h) { h.grabs[0].from[2] = nan; }),
                                {"grab 1", "finite anchors"});
    pent::test::expect_contains(refused([&](auto& h) { h.grabs[1].id = 1; }),
                                {"grab 1", "increase from 2 to 2"});
    pent::test::expect_contains(refused([&](auto& h) { h.grabs[0].grab.max_force.reset(); }),
                                {"max_force"});
    pent::test::expect_contains(refused([&](auto& h) { h.grabs[0].grab.point.body = 1; }),
                                {"body 1 of 1"});
    EXPECT_NO_THROW(simulation.restore(good));
}

}  // namespace
}  // namespace pent::simulator
