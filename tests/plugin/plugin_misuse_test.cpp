#include "plugin_scenes.h"
#include "support/messages.h"
#include "support/misfits.h"
#include "support/temp_folder.h"

#include <pent/output_file.h>
#include <pent/pent_file.h>
#include <pent/runs/scene_file.h>
#include <pent/runs/scene_meshes.h>

#include <gtest/gtest.h>

#include <array>
#include <atomic>
#include <cmath>
#include <functional>
#include <limits>
#include <pent_plugin_meshes.h>
#include <random>
#include <string>
#include <thread>
#include <vector>

// What is wrong gives an error with a sentence, changes nothing, and never crashes.

namespace pent {
namespace {

using test::closed_c_mesh;
using test::expect_error;
using test::Host;

constexpr double kNan = std::numeric_limits<double>::quiet_NaN();

using Call = std::function<std::int64_t(pent_simulation*)>;

// Every function that takes a simulation, with arguments that are right; as a number below 0 where
// it fails.
std::vector<Call> all_calls() {
    static const std::array<double, 4> some = {0.1, 0.2, 0.3, 0.4};
    static const std::array<double, 64> many = {};
    static const std::uint32_t vertex = 2;
    static std::int64_t count = 0;
    static pent_hit hit = {};
    static pent_surface surface = {};
    static pent_grab grab = {};
    grab.point.weights[0] = 1;
    grab.stiffness = 10;
    static const pent_mesh mesh = closed_c_mesh(test::box<4>());
    const auto found = [](const void* pointer) -> std::int64_t { return pointer ? 0 : -1; };
    return {
        [](auto* s) { return pent_dimension(s); },
        [](auto* s) { return pent_time_step(s) < 0 ? -1 : 0; },
        [](auto* s) { return pent_time(s) < 0 ? -1 : 0; },
        [](auto* s) { return pent_body_count(s); },
        [](auto* s) { return pent_obstacle_count(s); },
        [=](auto* s) { return found(pent_body_name(s, 0)); },
        [](auto* s) { return pent_find_body(s, "low"); },
        [](auto* s) { return pent_vertex_count(s, 0); },
        [](auto* s) { return pent_cell_count(s, 0); },
        [=](auto* s) { return found(pent_cells(s, 0)); },
        [=](auto* s) { return found(pent_rest_positions(s, 0)); },
        [=](auto* s) { return found(pent_positions(s, 0)); },
        [=](auto* s) { return found(pent_velocities(s, 0)); },
        [=](auto* s) { return found(pent_forces(s, 0)); },
        [=](auto* s) { return found(pent_masses(s, 0)); },
        [](auto* s) { return pent_is_asleep(s, 0); },
        [=](auto* s) { return found(pent_boundary(s, 0, &count)); },
        [](auto* s) { return pent_slice(s, 0, some.data(), 0.1, &surface); },
        [](auto* s) { return pent_pick(s, nullptr, 0, some.data(), some.data(), &hit); },
        [=](auto* s) { return found(pent_contacts(s, &count)); },
        [=](auto* s) { return found(pent_energies(s, &count)); },
        [](auto* s) { return pent_step(s, nullptr); },
        [](auto* s) { return pent_set_targets(s, 0, &vertex, 1, some.data()); },
        [](auto* s) { return pent_release(s, 0, &vertex, 1); },
        [](auto* s) { return pent_add_grab(s, &grab); },
        [](auto* s) { return pent_move_grab(s, 1, some.data()); },
        [](auto* s) { return pent_remove_grab(s, 1); },
        [](auto* s) { return pent_set_forces(s, 0, nullptr); },
        [](auto* s) { return pent_set_gravity(s, some.data()); },
        [](auto* s) { return pent_set_state(s, 0, many.data(), many.data()); },
        [=](auto* s) {
            pent_state* state = pent_save(s);
            return state == nullptr ? -1 : pent_restore(s, state) + pent_free_state(state);
        },
        [](auto* s) {
            return pent_add_body(s,
                                 "[[body]]\nname = \"c\"\nmesh = \"-\"\n"
                                 "place = { translate = [0, 9, 0, 0] }\n",
                                 &mesh);
        },
        [](auto* s) { return pent_remove_body(s, 2); },
        [](auto* s) {
            return pent_add_obstacle(s, "[[obstacle]]\nhalf_space = { normal = [0, 1, 0, 0] }\n");
        },
        [](auto* s) { return pent_remove_obstacle(s, 1); },
        [](auto* s) {
            pent_kept* kept = pent_keep(s);
            return kept == nullptr ? -1 : pent_free_kept(kept);
        },
        [](auto* s) { return pent_close(s); },
    };
}

TEST(PluginMisuse, EveryFunctionWorksWithASimulationAndRefusesNullAndAClosedOne) {
    const std::vector<Call> calls = all_calls();
    pent_simulation* simulation = nullptr;
    {
        const std::array<pent_mesh, 2> meshes = {closed_c_mesh(test::box<4>()),
                                                 closed_c_mesh(test::box<4>())};
        simulation = pent_open_text(test::kScene4, meshes.data(), 2, 1);
    }
    for (std::size_t i = 0; i < calls.size(); ++i) {
        EXPECT_LT(calls[i](nullptr), 0) << i;
        expect_error("there is no such simulation");
        EXPECT_GE(calls[i](simulation), 0) << i << ": " << pent_last_error();
        const bool closes = i + 1 == calls.size();
        EXPECT_STREQ(pent_last_error(), closes
                                            ? "there is no such simulation: it is NULL, was never"
                                              " opened, or is closed"
                                            : "")
            << i;
    }
    for (std::size_t i = 0; i < calls.size(); ++i) {  // the last one has closed it
        EXPECT_LT(calls[i](simulation), 0) << i;
        expect_error("there is no such simulation: it is NULL, was never opened, or is closed");
    }
    const Host another = test::open4();  // a new one does not get its number
    EXPECT_LT(calls[0](simulation), 0);
}

// A scene that pent-sim refuses is refused in the same words, from a file or from memory.
template <int Dim>
void expect_refused_as_by_programs(const std::string& more,
                                   const SimplexMesh<Dim>& mesh,
                                   const std::string& why) {
    const test::TempFolder folder;
    const std::string path = (folder / "scene.toml").string();
    const std::string text = "[scene]\ndimension = " + std::to_string(Dim)
                             + "\n[[body]]\nname = \"a\"\nmesh = \"a.pent\"\n" + more;
    write_text(path, text);
    write_mesh(folder / "a.pent", mesh, {});
    const simulator::Scene scene = runs::read_scene(path);
    const std::string expected = test::error_of(
        [&] { simulator::Simulation<Dim>(scene, runs::read_meshes<Dim>(scene).meshes); });
    EXPECT_NE(expected.find(why), std::string::npos) << expected;
    EXPECT_EQ(pent_open_file(path.c_str(), 1), nullptr);
    EXPECT_EQ(pent_last_error(), expected);
    const pent_mesh arrays = closed_c_mesh(mesh);
    const std::string where = folder.path().string();
    EXPECT_EQ(pent_open_scene(text.c_str(), path.c_str(), where.c_str(), &arrays, 1, 1), nullptr);
    EXPECT_EQ(pent_last_error(), expected);
}

template <int Dim>
void expect_refused_as_by_programs() {
    const SimplexMesh<Dim>& mesh = test::box<Dim>();
    expect_refused_as_by_programs("[contact]\n", test::with_cells_twice(mesh, {0}),
                                  "contact needs a closed surface");
    expect_refused_as_by_programs("[contact]\n", test::with_cells_on_one_side(mesh, {0}),
                                  "have both cells on one side");
    SimplexMesh<Dim> small = mesh;
    small.positions *= 1e-4;
    expect_refused_as_by_programs("place = { scale = 1e-29 }\n", small,
                                  "e-33 m large; expected a size");
    expect_refused_as_by_programs(
        "[[constraint]]\nbody = \"a\"\nselect = \"everything\"\nto = 0.04\n"
        "[[constraint]]\nbody = \"a\"\nselect = \"everything\"\nfrom = 0.035\n",
        mesh, "is held by two constraints at one time, this one and that at ");
}

TEST(PluginMisuse, OfScenesIsRefusedAsByPrograms) {
    expect_refused_as_by_programs<3>();
    expect_refused_as_by_programs<4>();
}

// As by the library in C++: none is not one.
TEST(PluginMisuse, OfThreadsIsRefused) {
    const std::array<pent_mesh, 2> meshes = {closed_c_mesh(test::box<4>()),
                                             closed_c_mesh(test::box<4>())};
    for (const int threads : {0, -3}) {
        EXPECT_EQ(pent_open_text(test::kScene4, meshes.data(), 2, threads), nullptr);
        expect_error(std::to_string(threads) + " threads, expected at least 1");
    }
}

TEST(PluginMisuse, OfMeshesThatDoNotFitIsRefusedWhereBodiesAreAdded) {
    const Host host = test::open4();  // with contact
    const SimplexMesh<4> mesh = test::with_cells_twice(test::box<4>(), {3});
    const pent_mesh arrays = closed_c_mesh(mesh);
    const char* body =
        "[[body]]\nname = \"c\"\nmesh = \"-\"\nplace = { translate = [0, 9, 0, 0] }\n";
    EXPECT_LT(pent_add_body(host, body, &arrays), 0);
    expect_error("contact needs a closed surface");
    EXPECT_EQ(pent_body_count(host), 2);
}

TEST(PluginMisuse, IsSaidAndChangesNothing) {
    const Host host = test::open4();
    const std::array<double, 4> some = {0.1, 0.2, 0.3, 0.4};
    const std::array<double, 4> nan = {0.1, kNan, 0.3, 0.4};
    const std::array<double, 4> zero = {};
    const std::uint32_t vertex = 2;
    const std::uint32_t far = 99;
    const std::vector<double> nans(64, kNan);
    const std::vector<double> many_nans(96, kNan);  // of 24 cells
    pent_hit hit = {};
    pent_surface surface = {};
    const pent_mesh mesh = closed_c_mesh(test::box<4>());
    const char* body = "[[body]]\nname = \"c\"\nmesh = \"-\"\n";
    const auto grab_with = [&](const auto& change) {
        pent_grab grab = {};
        grab.point.weights[0] = 1;
        grab.stiffness = 10;
        change(grab);
        return pent_add_grab(host, &grab);
    };
    const auto mesh_with = [&](const auto& change) {
        pent_mesh changed = mesh;
        change(changed);
        return pent_add_body(host, body, &changed);
    };
    const std::vector<std::pair<std::function<std::int64_t()>, std::string>> wrongs = {
        {[&] { return pent_vertex_count(host, -1); }, "body -1 of 2"},
        {[&] { return pent_find_body(host, nullptr); }, "name is NULL"},
        {[&] { return pent_find_body(host, "x"); }, "no body is called \"x\"; there are "},
        {[&] { return pent_boundary(host, 0, nullptr) ? 0 : -1; }, "count is NULL"},
        {[&] { return pent_contacts(host, nullptr) ? 0 : -1; }, "count is NULL"},
        {[&] { return pent_energies(host, nullptr) ? 0 : -1; }, "count is NULL"},
        {[&] { return pent_slice(host, 0, some.data(), 0, nullptr); }, "surface is NULL"},
        {[&] { return pent_slice(host, 0, nullptr, 0, &surface); }, "normal is NULL"},
        {[&] { return pent_slice(host, 0, zero.data(), 0, &surface); }, "normal"},
        {[&] { return pent_slice(host, 0, some.data(), kNan, &surface); }, "finite"},
        {[&] { return pent_pick(host, nullptr, 0, nullptr, some.data(), &hit); }, "origin is NULL"},
        {[&] { return pent_pick(host, nullptr, 0, some.data(), zero.data(), &hit); }, "not 0"},
        {[&] { return pent_pick(host, nullptr, 0, some.data(), some.data(), nullptr); }, "hit"},
        {[&] { return pent_pick(host, some.data(), 0, some.data(), some.data(), &hit); }, "normal"},
        {[&] { return pent_set_targets(host, 0, nullptr, 1, some.data()); }, "vertices is NULL"},
        {[&] { return pent_set_targets(host, 0, &vertex, 1, nullptr); }, "targets is NULL"},
        {[&] { return pent_set_targets(host, 0, &vertex, -1, some.data()); }, "-1 vertices"},
        {[&] { return pent_set_targets(host, 0, &vertex, 1000000000, some.data()); }, "has 16"},
        {[&] { return pent_set_targets(host, 0, &far, 1, some.data()); }, "vertex 99 of 16"},
        {[&] { return pent_set_targets(host, 0, &vertex, 1, nan.data()); },
         "targets: found nan for y of vertex 2; expected finite numbers"},
        {[&] { return pent_release(host, 5, &vertex, 1); }, "body 5 of 2"},
        {[&] { return pent_add_grab(host, nullptr); }, "grab is NULL"},
        {[&] { return grab_with([](auto& g) { g.point.weights[0] = 2; }); }, "the sum 2"},
        {[&] { return grab_with([](auto& g) { g.point.weights[1] = kNan; }); }, "barycentric"},
        {[&] { return grab_with([](auto& g) { g.point.body = 7; }); }, "body 7 of 2"},
        {[&] { return grab_with([](auto& g) { g.point.cell = -1; }); }, "cell -1 of 24"},
        {[&] { return grab_with([](auto& g) { g.anchor[2] = kNan; }); }, "anchor"},
        {[&] { return grab_with([](auto& g) { g.stiffness = -1; }); }, "stiffness -1"},
        {[&] { return grab_with([](auto& g) { g.max_force = -1; }); }, "max_force -1"},
        {[&] { return pent_move_grab(host, 1, some.data()); }, "there is no grab 1"},
        {[&] { return pent_remove_grab(host, -3); }, "there is no grab 0"},
        {[&] { return pent_set_forces(host, 0, nans.data()); }, "finite"},
        {[&] { return pent_set_gravity(host, nullptr); }, "gravity is NULL"},
        {[&] { return pent_set_gravity(host, nan.data()); }, "finite"},
        {[&] { return pent_set_state(host, 0, nullptr, nullptr); }, "positions is NULL"},
        {[&] { return pent_set_state(host, 0, nans.data(), nans.data()); }, "finite"},
        {[&] { return pent_restore(host, nullptr); }, "there is no such state"},
        {[&] { return pent_free_state(nullptr); }, "there is no such state"},
        {[&] { return pent_add_body(host, nullptr, &mesh); }, "text is NULL"},
        {[&] { return pent_add_body(host, body, nullptr); }, "mesh is NULL"},
        {[&] { return pent_add_body(host, "[[body]]\nnam = 3\n", &mesh); }, "body:1:1"},
        {[&] {
             return pent_add_body(host, "[sleep]\n[[body]]\nname = \"c\"\nmesh = \"-\"\n", &mesh);
         },
         "one [[body]] and nothing else"},
        {[&] {
             return pent_add_body(host,
                                  "[[body]]\nname = \"c\"\nmesh = \"-\"\n"
                                  "[solver]\nintegrator = \"newton_euler\"\n",
                                  &mesh);
         },
         "one [[body]] and nothing else"},
        {[&] {
             return pent_add_obstacle(host,
                                      "[[obstacle]]\nhalf_space = { normal = [0, 1, 0, 0] }\n"
                                      "[output]\nbalance = true\n");
         },
         "one [[obstacle]] and nothing else"},
        {[&] { return pent_open_file("a\r\nb.toml", 1) != nullptr ? 0 : -1; }, "a  b.toml: "},
        {[&] { return pent_add_body(host, "[[body]]\nname = \"low\"\nmesh = \"-\"\n", &mesh); },
         "low"},
        {[&] {
             return pent_add_body(host,
                                  "[[body]]\nname = \"c\"\nmesh = \"-\"\n[[activation]]\n"
                                  "body = \"c\"\nselect = \"everything\"\nstretch = 2\n",
                                  &mesh);
         },
         "one [[body]] and nothing else"},
        {[&] { return mesh_with([&](auto& m) { m.fibers = many_nans.data(); }); }, "fiber"},
        {[&] { return mesh_with([](auto& m) { m.vertices = -1; }); }, "-1 vertices"},
        {[&] { return mesh_with([](auto& m) { m.cell_count = 0; }); }, "0 cells"},
        {[&] { return mesh_with([](auto& m) { m.positions = nullptr; }); }, "positions is NULL"},
        {[&] { return mesh_with([](auto& m) { m.cells = nullptr; }); }, "cells is NULL"},
        {[&] { return mesh_with([](auto& m) { m.vertices = 3; }); }, "of 3"},
        {[&] { return pent_remove_body(host, 2); }, "body 2 of 2"},
        {[&] { return pent_add_obstacle(host, "rubbish"); }, "obstacle:"},
        {[&] { return pent_add_obstacle(host, body); }, "obstacle"},
        {[&] { return pent_remove_obstacle(host, 1); }, "obstacle 1 of 1"},
    };
    for (const auto& [wrong, text] : wrongs) {
        EXPECT_LT(wrong(), 0) << text;
        expect_error(text);
    }
    const Host fresh = test::open4();
    ASSERT_EQ(pent_step(host, nullptr), 0);
    ASSERT_EQ(pent_step(fresh, nullptr), 0);
    EXPECT_TRUE(std::equal(pent_positions(host, 0), pent_positions(host, 0) + 64,
                           pent_positions(fresh, 0)));
}

TEST(PluginMisuse, OfOneSimulationByTwoThreadsIsRefusedOrTakesTurns) {
    const Host host = test::open4();
    std::atomic<int> wrong = 0;
    const auto use = [&] {
        for (int i = 0; i < 50; ++i) {
            if (pent_step(host, nullptr) != 0
                && std::string(pent_last_error()).find("another thread") != 0) {
                ++wrong;
            }
        }
    };
    std::thread one(use);
    std::thread two(use);
    one.join();
    two.join();
    EXPECT_EQ(wrong, 0);
    EXPECT_EQ(pent_step(host, nullptr), 0);
}

// Arguments drawn from what is right and what is not: whatever comes, there is a number that says
// whether it worked, a sentence where it did not, and no crash.
TEST(PluginMisuse, OfAnyKindThousandsOfTimesCrashesNothing) {
    std::mt19937 random(17);
    const auto draw = [&](int count) {
        return std::uniform_int_distribution<int>(0, count - 1)(random);
    };
    const auto number = [&]() -> double {
        constexpr std::array<double, 8> kNumbers = {0, 1, -1, 0.25, 0.5, 1e300, -1e30, kNan};
        return kNumbers[static_cast<std::size_t>(draw(8))];
    };
    for (int round = 0; round < 2; ++round) {
        const Host host = test::open4();
        pent_simulation* closed = nullptr;
        pent_state* state = nullptr;
        for (int i = 0; i < 1000; ++i) {
            pent_simulation* s = draw(20) == 0 ? closed : host;
            const int body = draw(4) - 1;
            std::vector<double> numbers(64);
            for (double& x : numbers) {
                x = draw(3) == 0 ? number() : 0.1;
            }
            const std::array<std::uint32_t, 3> vertices = {static_cast<std::uint32_t>(draw(18)), 3,
                                                           static_cast<std::uint32_t>(draw(16))};
            pent_grab grab = {};
            grab.point = {body, draw(26) - 1, {draw(2) == 0 ? 1 : number(), 0, 0, 0, 0}};
            grab.stiffness = number();
            std::int64_t result = 0;
            switch (draw(14)) {
                case 0:
                    result = pent_step(s, nullptr);
                    break;
                case 1:
                    result =
                        pent_set_targets(s, body, vertices.data(), draw(5) - 1, numbers.data());
                    break;
                case 2:
                    result = pent_release(s, body, vertices.data(), draw(4) - 1);
                    break;
                case 3:
                    result = pent_add_grab(s, &grab);
                    break;
                case 4:
                    result = pent_move_grab(s, draw(6) - 1, numbers.data());
                    break;
                case 5:
                    result = pent_remove_grab(s, draw(6) - 1);
                    break;
                case 6:
                    result = pent_set_forces(s, body, numbers.data());
                    break;
                case 7:
                    result = pent_set_gravity(s, numbers.data());
                    break;
                case 8:
                    result = pent_set_state(s, body, numbers.data(), numbers.data());
                    break;
                case 9: {
                    pent_surface surface = {};
                    result = pent_slice(s, body, numbers.data(), number(), &surface);
                    break;
                }
                case 10: {
                    pent_hit hit = {};
                    result = pent_pick(s, numbers.data(), number(), numbers.data() + 4,
                                       numbers.data() + 8, &hit);
                    break;
                }
                case 11:
                    state = pent_save(s);
                    break;
                case 12:
                    result = pent_restore(s, state);
                    break;
                default:
                    result = pent_free_state(state);
                    break;
            }
            EXPECT_EQ(result < 0, result < 0 && pent_last_error()[0] != 0) << i;
        }
    }
}

}  // namespace
}  // namespace pent
