#include "plugin_scenes.h"
#include "stored_mesh.h"
#include "support/temp_folder.h"

#include <pent/facets.h>
#include <pent/pent_file.h>
#include <pent/read_text.h>

#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <functional>
#include <limits>
#include <pent_plugin_meshes.h>
#include <string>
#include <thread>
#include <vector>

// Meshes, frames and scenes of a host without a simulation, and arrays that outlive one.

namespace pent {
namespace {

using test::closed_c_mesh;
using test::expect_error;
using test::Host;
using Mesh = test::StoredMesh;
using test::TempFolder;

constexpr double kNan = std::numeric_limits<double>::quiet_NaN();

// A mesh with everything that meshes may have.
template <int Dim>
SimplexMesh<Dim> full_mesh() {
    std::array<int, Dim> count{};
    std::array<double, Dim> size{};
    count.fill(1);
    size.fill(1);
    SimplexMesh<Dim> mesh = test::quadratic_kuhn_box<Dim>(count, size);
    const auto cells = static_cast<std::size_t>(mesh.cell_count());
    const auto vertices = static_cast<std::size_t>(mesh.vertex_count());
    mesh.fibers = Positions<Dim>::Random(Dim, mesh.cell_count());
    for (std::size_t i = 0; i < cells; ++i) {
        mesh.regions.push_back(static_cast<std::uint16_t>(i % 7));
    }
    for (std::size_t i = 0; i < vertices; ++i) {
        mesh.columns.push_back(static_cast<std::uint32_t>(i / 2));
        mesh.layers.push_back(static_cast<std::uint32_t>(i % 2));
    }
    return mesh;
}

template <int Dim>
pent_mesh full_c_mesh(const SimplexMesh<Dim>& mesh) {
    pent_mesh made = closed_c_mesh(mesh);
    made.regions = mesh.regions.data();
    made.columns = mesh.columns.data();
    made.layers = mesh.layers.data();
    made.parents = mesh.parents.data();
    made.fibers = mesh.fibers.data();
    return made;
}

template <int Dim>
MeshExtras<Dim> full_extras(const SimplexMesh<Dim>& mesh) {
    MeshExtras<Dim> extras;
    extras.vertex_fields.push_back({"heat", Eigen::MatrixXd::Random(1, mesh.vertex_count())});
    extras.cell_fields.push_back({"flow", Eigen::MatrixXd::Random(Dim, mesh.cell_count())});
    extras.boundary = match_facets<Dim>(mesh.cells, mesh.vertex_count()).boundary;
    extras.labels.assign(static_cast<std::size_t>(extras.boundary.cols()), 7);
    extras.base_labels.assign(extras.labels.size(), 3);
    extras.bisection_tags.assign(static_cast<std::size_t>(mesh.cell_count()), 1);
    return extras;
}

template <int Dim>
void expect_round_trip(const TempFolder& folder, int is_ascii) {
    const SimplexMesh<Dim> mesh = full_mesh<Dim>();
    const std::string first = folder / "first.pent";
    const std::string second = folder / "second.pent";
    const Encoding encoding = is_ascii != 0 ? Encoding::Ascii : Encoding::Binary;
    write_mesh(first, mesh, {.encoding = encoding, .created_by = "somebody 1.2"});
    const Mesh read(pent_read_mesh(first.c_str()));
    EXPECT_EQ(read.info.dimension, Dim);
    EXPECT_STREQ(read.info.created_by, "somebody 1.2");
    EXPECT_EQ(read.info.crc32c, read_info(first).crc32c);
    EXPECT_NEAR(read.info.hypervolume, 1, 1e-14);  // a few hundred roundings
    ASSERT_NE(read.info.arrays.parents, nullptr);
    EXPECT_TRUE(std::equal(mesh.parents.begin(), mesh.parents.end(), read.info.arrays.parents));
    ASSERT_EQ(pent_write_mesh(read, second.c_str(), "somebody 1.2", is_ascii), 0);
    EXPECT_EQ(read_text(first, "a mesh"), read_text(second, "a mesh"));
    const pent_mesh arrays = full_c_mesh(mesh);
    const Mesh stored(pent_store_mesh(Dim, &arrays, nullptr));
    ASSERT_EQ(pent_write_mesh(stored, second.c_str(), "somebody 1.2", is_ascii), 0);
    EXPECT_EQ(read_text(first, "a mesh"), read_text(second, "a mesh"));
    write_mesh(first, mesh, {.encoding = encoding, .created_by = "us"}, full_extras(mesh));
    const Mesh rich(pent_read_mesh(first.c_str()));
    ASSERT_EQ(pent_write_mesh(rich, second.c_str(), "us", is_ascii), 0);
    EXPECT_EQ(read_text(first, "a mesh"), read_text(second, "a mesh"));
    pent_mesh_extras extras = {};
    ASSERT_EQ(pent_mesh_extras_of(rich, &extras), 0);
    const Mesh given(pent_store_mesh(Dim, &rich.info.arrays, &extras));
    ASSERT_EQ(pent_write_mesh(given, second.c_str(), "us", is_ascii), 0);
    EXPECT_EQ(read_text(first, "a mesh"), read_text(second, "a mesh"));
}

TEST(PluginMeshes, GoThroughFilesAndArraysToTheByte) {
    const TempFolder folder;
    for (const int is_ascii : {0, 1}) {
        expect_round_trip<2>(folder, is_ascii);
        expect_round_trip<3>(folder, is_ascii);
        expect_round_trip<4>(folder, is_ascii);
    }
}

TEST(PluginMeshes, HaveNoParentsWhereNoneWereGiven) {
    const pent_mesh arrays = closed_c_mesh(test::box<4>());
    EXPECT_EQ(Mesh(pent_store_mesh(4, &arrays, nullptr)).info.arrays.parents, nullptr);
}

TEST(PluginMeshes, HaveBesideThemWhatTheyWereGiven) {
    const SimplexMesh<4> mesh = full_mesh<4>();
    const MeshExtras<4> given = full_extras(mesh);
    const TempFolder folder;
    write_mesh(folder / "a.pent", mesh, {}, given);
    const Mesh read(pent_read_mesh((folder / "a.pent").string().c_str()));
    pent_mesh_extras extras = {};
    ASSERT_EQ(pent_mesh_extras_of(read, &extras), 0);
    ASSERT_EQ(extras.vertex_field_count, 1);
    EXPECT_STREQ(extras.vertex_fields[0].name, "heat");
    EXPECT_EQ(extras.vertex_fields[0].rows, 1);
    const Eigen::MatrixXd& heat = given.vertex_fields[0].values;
    EXPECT_TRUE(std::equal(heat.data(), heat.data() + heat.size(), extras.vertex_fields[0].values));
    ASSERT_EQ(extras.cell_field_count, 1);
    EXPECT_STREQ(extras.cell_fields[0].name, "flow");
    EXPECT_EQ(extras.cell_fields[0].rows, 4);
    const Eigen::MatrixXd& flow = given.cell_fields[0].values;
    EXPECT_TRUE(std::equal(flow.data(), flow.data() + flow.size(), extras.cell_fields[0].values));
    ASSERT_EQ(extras.facet_count, given.boundary.cols());
    EXPECT_TRUE(std::equal(given.boundary.data(), given.boundary.data() + given.boundary.size(),
                           extras.facets));
    EXPECT_TRUE(std::equal(given.labels.begin(), given.labels.end(), extras.labels));
    EXPECT_TRUE(std::equal(given.base_labels.begin(), given.base_labels.end(), extras.base_labels));
    EXPECT_TRUE(std::equal(given.bisection_tags.begin(), given.bisection_tags.end(),
                           extras.bisection_tags));
}

TEST(PluginMeshes, HaveNothingBesideThemWhereNothingWasGiven) {
    const pent_mesh arrays = closed_c_mesh(test::box<3>());
    const Mesh plain(pent_store_mesh(3, &arrays, nullptr));
    pent_mesh_extras extras = {};
    extras.facet_count = 9;
    ASSERT_EQ(pent_mesh_extras_of(plain, &extras), 0);
    EXPECT_EQ(extras.vertex_field_count + extras.cell_field_count + extras.facet_count, 0);
    EXPECT_EQ(extras.labels, nullptr);
    EXPECT_EQ(extras.bisection_tags, nullptr);
}

TEST(PluginMeshes, HaveTheBoundaryThatTheLibraryFinds) {
    const SimplexMesh<4> mesh = full_mesh<4>();
    const pent_mesh arrays = full_c_mesh(mesh);
    const Mesh stored(pent_store_mesh(4, &arrays, nullptr));
    std::int64_t count = 0;
    const std::uint32_t* boundary = pent_mesh_boundary(stored, &count);
    const Simplices<4> facets = match_facets<4>(mesh.cells, mesh.vertex_count()).boundary;
    ASSERT_EQ(count, facets.cols());
    EXPECT_TRUE(std::equal(facets.data(), facets.data() + facets.size(), boundary));
    const std::uint32_t* seen = nullptr;
    std::thread([&] { seen = pent_mesh_boundary(stored, &count); }).join();
    EXPECT_EQ(seen, boundary);
}

// Two pentachora on one side of a tetrahedron.
TEST(PluginMeshes, SayWhereCellsDoNotFit) {
    const std::vector<double> positions = {0, 0, 0, 0, 1, 0, 0, 0, 0, 1, 0,   0,
                                           0, 0, 1, 0, 0, 0, 0, 1, 0, 0, 0.1, 2};
    const std::vector<std::uint32_t> cells = {0, 1, 2, 3, 4, 0, 1, 2, 3, 5};
    pent_mesh arrays = {};
    arrays.positions = positions.data();
    arrays.vertices = 6;
    arrays.cells = cells.data();
    arrays.cell_count = 2;
    const Mesh stored(pent_store_mesh(4, &arrays, nullptr));
    std::int64_t count = 0;
    EXPECT_EQ(pent_mesh_boundary(stored, &count), nullptr);
    expect_error("mesh: pentachoron 0 does not fit its neighbors");
    const std::array<double, 4> w = {0, 0, 0, 1};
    pent_surface slice = {};
    EXPECT_EQ(pent_slice_mesh(stored, nullptr, w.data(), 0.5, &slice), -1);
    expect_error("does not fit its neighbors");
}

TEST(PluginFrames, HaveAllThatAFileHas) {
    const TempFolder folder;
    Frame<4> frame;
    frame.positions = Positions<4>::Random(4, 9);
    frame.contact_forces = Positions<4>::Random(4, 9);
    frame.fields = {{"heat", Eigen::MatrixXd::Random(1, 9)},
                    {"pull", Eigen::MatrixXd::Random(4, 9)}};
    frame.mesh_name = "a.pent";
    frame.mesh_crc = 0x12345678;
    frame.frame = 3;
    frame.step = 7;
    frame.time = 0.25;
    const std::string path = folder / "frame.pent";
    write_frame(path, frame);
    pent_stored_frame* stored = pent_read_frame(path.c_str());
    pent_frame_info info = {};
    ASSERT_EQ(pent_frame_info_of(stored, &info), 0) << pent_last_error();
    EXPECT_EQ(info.dimension, 4);
    EXPECT_EQ(info.vertices, 9);
    EXPECT_TRUE(std::equal(info.positions, info.positions + 36, frame.positions.data()));
    EXPECT_EQ(info.velocities, nullptr);
    EXPECT_TRUE(
        std::equal(info.contact_forces, info.contact_forces + 36, frame.contact_forces.data()));
    EXPECT_STREQ(info.mesh_name, "a.pent");
    EXPECT_EQ(info.mesh_crc32c, 0x12345678U);
    EXPECT_EQ(info.frame, 3U);
    EXPECT_EQ(info.step, 7U);
    EXPECT_EQ(info.time, 0.25);
    ASSERT_EQ(info.field_count, 2);
    for (std::int64_t i = 0; i < 2; ++i) {
        const VertexField& own = frame.fields[static_cast<std::size_t>(i)];
        pent_field field = {};
        ASSERT_EQ(pent_frame_field(stored, i, &field), 0);
        EXPECT_EQ(field.name, own.name);
        EXPECT_EQ(field.rows, own.values.rows());
        EXPECT_TRUE(std::equal(field.values, field.values + own.values.size(), own.values.data()));
    }
    EXPECT_EQ(pent_free_frame(stored), 0);
    EXPECT_EQ(pent_frame_info_of(stored, &info), -1);
    expect_error("there is no such frame");
}

TEST(PluginScenes, ComeBackWithEveryDefaultAndReadAgainTheSame) {
    const char* text =
        pent_scene_text("[[body]]\nname = \"a\"\nmesh = \"a.pent\"\n", "s", "/models");
    ASSERT_NE(text, nullptr) << pent_last_error();
    const std::string once = text;
    EXPECT_NE(once.find("/models/a.pent"), std::string::npos) << once;
    EXPECT_NE(once.find("integrator"), std::string::npos) << once;
    EXPECT_EQ(pent_scene_text(once.c_str(), "s", ""), once);
    EXPECT_EQ(pent_scene_text("[scene]\ngravitty = 3\n", "my.toml", ""), nullptr);
    expect_error("my.toml:2:1: ");
}

TEST(PluginKeeps, WhatArraysShowedLastWhateverBecomesOfTheSimulation) {
    const double* positions = nullptr;
    const std::uint32_t* boundary = nullptr;
    std::vector<double> last;
    pent_kept* kept = nullptr;
    std::int64_t count = 0;
    {
        const Host host = test::open4();
        positions = pent_positions(host, 1);
        boundary = pent_boundary(host, 1, &count);
        const std::vector<double> first(positions, positions + 64);
        kept = pent_keep(host);
        ASSERT_NE(kept, nullptr);
        ASSERT_EQ(pent_step(host, nullptr), 0);
        EXPECT_EQ(pent_positions(host, 1), positions);
        last.assign(positions, positions + 64);
        EXPECT_NE(last, first);
        ASSERT_EQ(pent_remove_body(host, 0), 0);
        ASSERT_EQ(pent_step(host, nullptr), 0);
        EXPECT_NE(pent_positions(host, 0), positions);
        EXPECT_NE(pent_boundary(host, 0, &count), boundary);
    }
    EXPECT_TRUE(std::equal(last.begin(), last.end(), positions));
    EXPECT_LT(*std::max_element(boundary, boundary + 4 * count), 16U);
    EXPECT_EQ(pent_free_kept(kept), 0);
    EXPECT_EQ(pent_free_kept(kept), -1);
    expect_error("there is no such set of kept arrays");
}

TEST(PluginMeshesMisuse, GivesASentence) {
    const TempFolder folder;
    const std::string nowhere = (folder / "none" / "a.pent").string();
    const pent_mesh right = closed_c_mesh(test::box<4>());
    const Mesh mesh(pent_store_mesh(4, &right, nullptr));
    const std::array<double, 4> w = {0, 0, 0, 1};
    const std::vector<double> nans(64, kNan);
    pent_surface surface = {};
    const auto found = [](const void* pointer) { return pointer != nullptr ? 0 : -1; };
    const auto store = [&](const auto& change) {
        pent_mesh changed = right;
        change(changed);
        return found(pent_store_mesh(4, &changed, nullptr));
    };
    const auto store_with = [&](const auto& change) {
        static const std::vector<double> kValues(256, 1);
        pent_field field = {.name = "heat", .values = kValues.data(), .rows = 1};
        pent_mesh_extras extras = {};
        extras.vertex_fields = &field;
        extras.vertex_field_count = 1;
        change(extras, field);
        return found(pent_store_mesh(4, &right, &extras));
    };
    EXPECT_EQ(store_with([](auto&, auto&) {}), 0);
    const std::vector<std::uint32_t> far(5, 99);
    const std::vector<std::uint32_t> mirrored = {1, 0, 2, 3, 4};
    const pent_mesh arrays2 = closed_c_mesh(test::box<2>());
    const Mesh mesh2(pent_store_mesh(2, &arrays2, nullptr));
    const std::array<double, 1> minus = {-1};
    const std::string long_name(5000, 'a');
    const std::array<pent_turn, 3> wrong_turns = {{{0, 4, 9}, {2, 2, 9}, {0, 3, kNan}}};
    const auto turned = [&](const pent_hyperplane& plane) {
        return pent_slice_turned(mesh, nullptr, &plane, &surface, nullptr);
    };
    const std::vector<std::pair<std::function<int()>, std::string>> wrongs = {
        {[&] { return found(pent_read_mesh(nullptr)); }, "path is NULL"},
        {[&] { return found(pent_read_mesh(nowhere.c_str())); }, nowhere},
        {[&] { return found(pent_read_frame(nowhere.c_str())); }, nowhere},
        {[&] { return found(pent_store_mesh(4, nullptr, nullptr)); }, "mesh is NULL"},
        {[&] { return found(pent_store_mesh(5, &right, nullptr)); }, "5 dimensions"},
        {[&] { return store_with([](auto& e, auto&) { e.vertex_fields = nullptr; }); },
         "vertex_fields is NULL"},
        {[&] { return store_with([](auto& e, auto&) { e.cell_field_count = 1; }); },
         "cell_fields is NULL"},
        {[&] { return store_with([](auto&, auto& f) { f.name = nullptr; }); },
         "the name of a field is NULL"},
        {[&] { return store_with([](auto&, auto& f) { f.name = "x"; }); },
         "mesh: vertex quantity 'x': the property x has a meaning of its own"},
        {[&] { return store_with([](auto&, auto& f) { f.values = nullptr; }); }, "heat is NULL"},
        {[&] { return store_with([&](auto&, auto& f) { f.values = nans.data(); }); },
         "mesh: vertex 0: heat is not finite"},
        {[&] { return store_with([](auto&, auto& f) { f.rows = 0; }); }, "heat has 0 rows"},
        {[&] { return store_with([](auto&, auto& f) { f.rows = 3; }); }, "mesh: heat has 3 x 16"},
        {[&] { return store_with([](auto& e, auto&) { e.facet_count = 1; }); }, "facets is NULL"},
        {[&] {
             return store_with([&](auto& e, auto&) {
                 e.facets = mirrored.data();
                 e.facet_count = 1;
             });
         },
         "mesh: 0 labels of the boundary, expected 1"},
        {[&] { return pent_mesh_extras_of(mesh, nullptr); }, "extras is NULL"},
        {[&] { return found(pent_mesh_means(mesh, nullptr, 1)); }, "values is NULL"},
        {[&] { return found(pent_mesh_means(mesh, nans.data(), 0)); },
         "rows is 0; expected 1 to 4"},
        {[&] { return found(pent_mesh_means(mesh, nans.data(), 5)); },
         "rows is 5; expected 1 to 4"},
        {[&] { return found(pent_mesh_means(mesh2, nans.data(), 1)); }, "2 dimensions"},
        {[&] { return store([](auto& m) { m.vertices = 0; }); }, "mesh: 0 vertices"},
        {[&] { return store([](auto& m) { m.cells = nullptr; }); }, "cells is NULL"},
        {[&] {
             return store([&](auto& m) {
                 m.cells = far.data();
                 m.cell_count = 1;
             });
         },
         "99"},
        {[&] {
             return store([&](auto& m) {
                 m.cells = mirrored.data();
                 m.cell_count = 1;
             });
         },
         "mesh: pentachoron 0"},
        {[&] { return store([&](auto& m) { m.positions = nans.data(); }); }, "mesh: "},
        {[&] { return pent_write_mesh(mesh, nullptr, "", 0); }, "path is NULL"},
        {[&] { return pent_write_mesh(mesh, nowhere.c_str(), nullptr, 0); }, "created_by is NULL"},
        {[&] { return pent_write_mesh(mesh, nowhere.c_str(), "", 0); }, nowhere},
        {[&] { return pent_write_mesh(mesh, nowhere.c_str(), long_name.c_str(), 0); },
         "created_by is longer than a line of a header may be"},
        {[&] { return pent_mesh_info_of(mesh, nullptr); }, "info is NULL"},
        {[&] { return pent_mesh_info_of(nullptr, nullptr); }, "there is no such mesh"},
        {[&] { return found(pent_mesh_boundary(mesh, nullptr)); }, "count is NULL"},
        {[&] { return pent_slice_mesh(mesh, nullptr, nullptr, 0, &surface); }, "normal is NULL"},
        {[&] { return pent_slice_mesh(mesh, nullptr, w.data(), kNan, &surface); }, "finite"},
        {[&] { return pent_slice_mesh(mesh, nans.data(), w.data(), 0, &surface); }, "finite"},
        {[&] { return pent_slice_mesh(mesh, nullptr, w.data(), 0, nullptr); }, "surface is NULL"},
        {[&] { return pent_slice_mesh(mesh2, nullptr, w.data(), 0, &surface); }, "2 dimensions"},
        {[&] { return pent_slice_turned(mesh, nullptr, nullptr, &surface, nullptr); },
         "plane is NULL"},
        {[&] {
             return turned({nullptr, 0, kNan});
         },
         "finite"},
        {[&] {
             return turned({nullptr, 1, 0});
         },
         "turns is NULL"},
        {[&] {
             return turned({nullptr, -1, 0});
         },
         "turn_count is -1"},
        {[&] {
             return turned({wrong_turns.data(), 1, 0});
         },
         "axes 0 and 4"},
        {[&] {
             return turned({wrong_turns.data() + 1, 1, 0});
         },
         "axes 2 and 2"},
        {[&] {
             return turned({wrong_turns.data() + 2, 1, 0});
         },
         "angle that is not finite"},
        {[&] { return found(pent_mesh_strain(mesh, nans.data())); }, "finite"},
        {[&] { return found(pent_mesh_strain(mesh2, nullptr)); }, "2 dimensions"},
        {[&] { return found(pent_colors(nullptr, w.data(), 4, 0, 1)); }, "quantity is NULL"},
        {[&] { return found(pent_colors("w", nullptr, 4, 0, 1)); }, "values is NULL"},
        {[&] { return found(pent_colors("w", w.data(), -1, 0, 1)); }, "count is -1"},
        {[&] { return found(pent_colors("w", w.data(), 4, 0, kNan)); }, "finite"},
        {[&] { return found(pent_colors("w", w.data(), 4, -1e308, 1e308)); }, "finite"},
        {[&] { return found(pent_colors("body", nans.data(), 1, 0, 1)); }, "finite"},
        {[&] { return found(pent_colors("body", minus.data(), 1, 0, 1)); }, "number of a body"},
        {[&] { return pent_free_mesh(nullptr); }, "there is no such mesh"},
        {[&] { return pent_free_frame(nullptr); }, "there is no such frame"},
        {[&] { return pent_frame_field(nullptr, 0, nullptr); }, "there is no such frame"},
        {[&] { return found(pent_scene_text(nullptr, "", "")); }, "scene is NULL"},
        {[&] { return found(pent_scene_text("", nullptr, "")); }, "name is NULL"},
        {[&] { return found(pent_scene_text("", "", nullptr)); }, "folder is NULL"},
        {[&] { return found(pent_keep(nullptr)); }, "there is no such simulation"},
    };
    for (const auto& [wrong, text] : wrongs) {
        EXPECT_EQ(wrong(), -1) << text;
        expect_error(text);
    }
}

}  // namespace
}  // namespace pent
