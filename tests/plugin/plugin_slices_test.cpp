#include "plugin_scenes.h"
#include "stored_mesh.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cstdint>
#include <pent_plugin_meshes.h>
#include <utility>
#include <vector>

// Slices of meshes without a simulation, and what is shown of them.

namespace pent {
namespace {

using test::closed_c_mesh;
using test::Host;
using Mesh = test::StoredMesh;

// At rest and displaced: what pent_slice() gives of the same body.
TEST(PluginSlices, AreThoseOfBodies) {
    const Host host = test::open4();
    const pent_mesh arrays = closed_c_mesh(test::box<4>());
    const Mesh stored(pent_store_mesh(4, &arrays, nullptr));
    const std::array<double, 4> normal = {0.1, 0.2, 0.3, 1};
    for (int i = 0; i < 2; ++i) {
        pent_surface own = {};
        ASSERT_EQ(pent_slice(host, 0, normal.data(), 0.5, &own), 0) << pent_last_error();
        pent_surface slice = {};
        const double* positions = i == 0 ? nullptr : pent_positions(host, 0);
        ASSERT_EQ(pent_slice_mesh(stored, positions, normal.data(), 0.5, &slice), 0);
        ASSERT_EQ(slice.vertices, own.vertices);
        ASSERT_GT(slice.triangle_count, 0);
        ASSERT_EQ(slice.triangle_count, own.triangle_count);
        EXPECT_TRUE(std::equal(own.positions, own.positions + 3 * own.vertices, slice.positions));
        EXPECT_TRUE(
            std::equal(own.triangles, own.triangles + 3 * own.triangle_count, slice.triangles));
        EXPECT_TRUE(std::equal(own.ends, own.ends + 2 * own.vertices, slice.ends));
        EXPECT_TRUE(std::equal(std::begin(own.frame), std::end(own.frame), slice.frame));
        ASSERT_EQ(pent_step(host, nullptr), 0);
    }
    const pent_mesh solid = closed_c_mesh(test::box<3>());
    const Mesh stored3(pent_store_mesh(3, &solid, nullptr));
    pent_surface skin = {};
    ASSERT_EQ(pent_slice_mesh(stored3, nullptr, nullptr, 0, &skin), 0);
    EXPECT_EQ(skin.triangle_count, 12);
}

// Removed bodies take their boundaries with them: those behind get their numbers, and others cells.
template <int Dim>
void expect_slices_follow_bodies() {
    std::array<int, Dim> count{};
    std::array<double, Dim> size{};
    count.fill(2);
    size.fill(1);
    const SimplexMesh<Dim> fine = test::kuhn_box<Dim>(count, size);
    const std::array<pent_mesh, 2> meshes = {closed_c_mesh(test::box<Dim>()), closed_c_mesh(fine)};
    const Host host(pent_open_text(Dim == 4 ? test::kScene4 : test::kScene3, meshes.data(), 2, 1));
    const std::array<double, 4> normal = {0.1, 0.2, 0.3, 1};
    const auto slice_of = [&](int body) {
        pent_surface slice = {};
        EXPECT_EQ(pent_slice(host, body, normal.data(), 0.8, &slice), 0) << pent_last_error();
        return std::pair(std::vector<double>(slice.positions, slice.positions + 3 * slice.vertices),
                         std::vector<std::uint32_t>(slice.triangles,
                                                    slice.triangles + 3 * slice.triangle_count));
    };
    const auto low = slice_of(0);
    const auto high = slice_of(1);
    ASSERT_GT(high.second.size(), low.second.size());
    EXPECT_EQ(slice_of(0), low);
    ASSERT_EQ(pent_remove_body(host, 0), 0) << pent_last_error();
    EXPECT_EQ(slice_of(0), high);
    ASSERT_EQ(pent_add_body(host, "[[body]]\nname = \"low\"\nmesh = \"-\"\n", meshes.data()), 0)
        << pent_last_error();
    EXPECT_EQ(slice_of(0), high);
    EXPECT_EQ(slice_of(1), low);
}

TEST(PluginSlices, FollowBodiesThatComeAndGo) {
    expect_slices_follow_bodies<3>();
    expect_slices_follow_bodies<4>();
}

// Without turns the slice by a normal along w, to the bit; a quarter turn takes x to w.
TEST(PluginSlices, TurnBodiesFirst) {
    const pent_mesh arrays = closed_c_mesh(test::box<4>());
    const Mesh stored(pent_store_mesh(4, &arrays, nullptr));
    pent_surface slice = {};
    const std::array<double, 4> w = {0, 0, 0, 1};
    ASSERT_EQ(pent_slice_mesh(stored, nullptr, w.data(), 0.3, &slice), 0);
    const std::vector<double> straight(slice.positions, slice.positions + 3 * slice.vertices);
    pent_hyperplane plane = {.turns = nullptr, .turn_count = 0, .offset = 0.3};
    ASSERT_EQ(pent_slice_turned(stored, nullptr, &plane, &slice, nullptr), 0);
    EXPECT_EQ(straight, std::vector<double>(slice.positions, slice.positions + 3 * slice.vertices));

    const std::array<pent_turn, 2> turns = {{{0, 3, 90}, {1, 2, 180}}};
    plane = {.turns = turns.data(), .turn_count = 2, .offset = 0.3};
    const double* normals = nullptr;
    ASSERT_EQ(pent_slice_turned(stored, nullptr, &plane, &slice, &normals), 0);
    ASSERT_GT(slice.triangle_count, 0);
    const Eigen::Map<const Positions<3>> points(slice.positions, 3, slice.vertices);
    // w' = x = 0.3; x' = -w, y' = -y, z' = -z; and rounding of the sines.
    EXPECT_LT((points.rowwise().minCoeff() + Eigen::Vector3d(1, 1, 1)).norm(), 1e-15);
    EXPECT_LT(points.rowwise().maxCoeff().norm(), 1e-15);
    for (std::int64_t corner = 0; corner < 3 * slice.triangle_count; ++corner) {
        const Eigen::Map<const Eigen::Vector3d> normal(normals + 3 * corner);
        const Eigen::Vector3d place = points.col(slice.triangles[corner]);
        EXPECT_NEAR(normal.cwiseAbs().maxCoeff(), 1, 1e-15);  // a box has six
        EXPECT_GT(normal.dot(place + Eigen::Vector3d::Constant(0.5)), 0);
    }
    const pent_mesh solid = closed_c_mesh(test::box<3>());
    const Mesh stored3(pent_store_mesh(3, &solid, nullptr));
    ASSERT_EQ(pent_slice_turned(stored3, nullptr, nullptr, &slice, &normals), 0);
    EXPECT_EQ(slice.triangle_count, 12);
}

// A normal has any length, also where its square is no number of doubles.
TEST(PluginSlices, DoNotDependOnTheLengthOfTheNormal) {
    const pent_mesh arrays = closed_c_mesh(test::box<4>());
    const Mesh stored(pent_store_mesh(4, &arrays, nullptr));
    for (const double length : {1e-300, 1e-200, 1.0, 1e200, 1e300}) {
        const std::array<double, 4> normal = {0, 0, 0, length};
        pent_surface slice = {};
        ASSERT_EQ(pent_slice_mesh(stored, nullptr, normal.data(), 0.25 * length, &slice), 0);
        ASSERT_GT(slice.triangle_count, 0) << length;
        for (std::int64_t vertex = 0; vertex < slice.vertices; ++vertex) {
            const double* ends = arrays.positions;
            const double below = ends[4 * slice.ends[2 * vertex] + 3];
            const double above = ends[4 * slice.ends[2 * vertex + 1] + 3];
            const double w = below + slice.weights[vertex] * (above - below);
            EXPECT_NEAR(w, 0.25, 1e-15) << length;
        }
    }
}

// x stretched by s: E = (s^2 - 1) / 2 in xx, and nothing else.
TEST(PluginSlices, HaveTheStrainOfAStretch) {
    const pent_mesh arrays = closed_c_mesh(test::box<4>());
    const Mesh stored(pent_store_mesh(4, &arrays, nullptr));
    Positions<4> stretched = test::box<4>().positions;
    const double* strain = pent_mesh_strain(stored, stretched.data());
    ASSERT_NE(strain, nullptr) << pent_last_error();
    EXPECT_EQ(*std::max_element(strain, strain + stored.info.arrays.vertices), 0);
    stretched.row(0) *= 1.5;
    strain = pent_mesh_strain(stored, stretched.data());
    for (std::int64_t vertex = 0; vertex < stored.info.arrays.vertices; ++vertex) {
        EXPECT_NEAR(strain[vertex], 0.625, 1e-15);
    }
}

TEST(PluginColors, GoFromTheFirstToTheLastAndStayThere) {
    const std::array<double, 4> values = {-5, 0, 1, 7};
    const float* colors = pent_colors("speed", values.data(), 4, 0, 1);
    ASSERT_NE(colors, nullptr) << pent_last_error();
    EXPECT_TRUE(std::equal(colors, colors + 3, colors + 3));
    EXPECT_TRUE(std::equal(colors + 6, colors + 9, colors + 9));
    EXPECT_FALSE(std::equal(colors, colors + 3, colors + 6));
    const std::array<double, 3> bodies = {0, 1, 0};
    colors = pent_colors("body", bodies.data(), 3, 0, 0);
    EXPECT_TRUE(std::equal(colors, colors + 3, colors + 6));
    EXPECT_FALSE(std::equal(colors, colors + 3, colors + 3));
    EXPECT_NE(pent_colors("w", nullptr, 0, 0, 1), nullptr);
}

}  // namespace
}  // namespace pent
