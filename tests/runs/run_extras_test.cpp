#include "falling_bar.h"
#include "run/run_meshes.h"
#include "simulator/thread_ranks.h"
#include "support/extras.h"
#include "support/fork.h"
#include "support/messages.h"

#include <pent/mesh_extras.h>
#include <pent/runs/run.h>

#include <gtest/gtest.h>

#include <filesystem>
#include <limits>
#include <numbers>
#include <string>
#include <vector>

namespace pent::runs {
namespace {

namespace fs = std::filesystem;
namespace scenes = simulator::test;
using pent::test::all_extras;
using pent::test::error_of;
using pent::test::expect_contains;
using pent::test::expect_same;
using pent::test::TempFolder;
using test::bytes_of;

template <int Dim>
SimplexMesh<Dim> rich_box() {
    std::array<int, Dim> count{};
    count.fill(1);
    count[0] = 2;
    std::array<double, Dim> size{};
    size.fill(0.5);
    SimplexMesh<Dim> mesh = pent::test::quadratic_kuhn_box<Dim>(count, size);
    mesh.fibers.resize(Dim, mesh.cell_count());
    for (Eigen::Index cell = 0; cell < mesh.cell_count(); ++cell) {
        mesh.regions.push_back(static_cast<std::uint16_t>(cell % 7));
        for (int axis = 0; axis < Dim; ++axis) {
            mesh.fibers(axis, cell) = std::cos(static_cast<double>(cell + axis));
        }
    }
    return mesh;
}

// Two bodies of one mesh: the first as it is, the second scaled, moved, and turned by 30 degrees
// from the first axis to the last.
template <int Dim>
Scene scene_of_twins(const fs::path& mesh) {
    Scene scene = scenes::box_scene<Dim>();
    scene.frames = 1;
    scene.bodies[0].mesh = mesh.string();
    scene.bodies.push_back(scene.bodies[0]);
    scene.bodies[1].name = "turned";
    scene.bodies[1].place.scale = 2;
    scene.bodies[1].place.rotate = {{.plane = {.from = 0, .to = Dim - 1}, .degrees = 30}};
    scene.bodies[1].place.translate[1] = 3;
    return scene;
}

template <int Dim>
Eigen::Matrix<double, Dim, Dim> turned_by_30_degrees() {
    Eigen::Matrix<double, Dim, Dim> rotation = Eigen::Matrix<double, Dim, Dim>::Identity();
    rotation(0, 0) = rotation(Dim - 1, Dim - 1) = std::sqrt(0.75);
    rotation(Dim - 1, 0) = 0.5;
    rotation(0, Dim - 1) = -0.5;
    return rotation;
}

template <int Dim>
void expect_turned(const std::vector<VertexField>& found,
                   const std::vector<VertexField>& expected) {
    ASSERT_EQ(found.size(), expected.size());
    for (std::size_t i = 0; i < found.size(); ++i) {
        EXPECT_EQ(found[i].name, expected[i].name);
        if (expected[i].values.rows() == 1) {
            EXPECT_EQ(found[i].values, expected[i].values);
            continue;
        }
        const Eigen::MatrixXd turned = turned_by_30_degrees<Dim>() * expected[i].values;
        ASSERT_EQ(found[i].values.cols(), turned.cols());
        // A sum of some products of numbers of at most 1.
        EXPECT_LT((found[i].values - turned).cwiseAbs().maxCoeff(), 1e-15);
    }
}

template <int Dim>
void expect_extras_in_folder(Encoding encoding) {
    const TempFolder folder;
    const SimplexMesh<Dim> mesh = rich_box<Dim>();
    const MeshExtras<Dim> extras = all_extras(mesh);
    static_cast<void>(write_mesh(folder / "a.pent", mesh, {.encoding = encoding}, extras));
    static_cast<void>(run(scene_of_twins<Dim>(folder / "a.pent"), {.folder = folder / "run"}));
    const MeshFile<Dim> same = read_mesh<Dim>(folder / "run/meshes/box.pent");
    EXPECT_EQ(same.mesh.positions, mesh.positions);
    EXPECT_EQ(same.mesh.cells, mesh.cells);
    EXPECT_EQ(same.mesh.regions, mesh.regions);
    EXPECT_EQ(same.mesh.parents, mesh.parents);
    EXPECT_EQ(same.mesh.fibers, mesh.fibers);
    expect_same(same.extras, extras);
    const MeshFile<Dim> turned = read_mesh<Dim>(folder / "run/meshes/turned.pent");
    EXPECT_EQ(turned.mesh.regions, mesh.regions);
    EXPECT_LT((turned.mesh.fibers - turned_by_30_degrees<Dim>() * mesh.fibers).norm(), 1e-13);
    expect_turned<Dim>(turned.extras.vertex_fields, extras.vertex_fields);
    expect_turned<Dim>(turned.extras.cell_fields, extras.cell_fields);
    ASSERT_EQ(turned.extras.boundary.cols(), extras.boundary.cols());
    EXPECT_EQ(turned.extras.boundary, extras.boundary);
    EXPECT_EQ(turned.extras.labels, extras.labels);
    EXPECT_EQ(turned.extras.base_labels, extras.base_labels);
    EXPECT_EQ(turned.extras.bisection_tags, extras.bisection_tags);
}

TEST(RunExtras, OfTheMeshAreInTheFolderAsPlaced) {
    for (const Encoding encoding : {Encoding::Binary, Encoding::Ascii}) {
        expect_extras_in_folder<3>(encoding);
        expect_extras_in_folder<4>(encoding);
    }
}

template <int Dim>
void expect_same_on_ranks(Encoding encoding) {
    const TempFolder folder;
    const SimplexMesh<Dim> mesh = rich_box<Dim>();
    static_cast<void>(
        write_mesh(folder / "a.pent", mesh, {.encoding = encoding}, all_extras(mesh)));
    const Scene scene = scene_of_twins<Dim>(folder / "a.pent");
    const auto write_all = [&](const std::shared_ptr<const simulator::Ranks>& ranks,
                               const std::string& prefix) {
        const RunRanks together(ranks.get());
        RunMeshes<Dim> meshes(scene, together);
        const Simulation<Dim> simulation = meshes.simulate({.ranks = ranks});
        for (const int body : {0, 1}) {
            static_cast<void>(
                meshes.write(folder / (prefix + std::to_string(body)), simulation, body, "t"));
        }
    };
    write_all(nullptr, "alone");
    expect_same(read_mesh<Dim>(folder / "alone0").extras, all_extras(mesh));
    for (const int count : {1, 2, 3, 5}) {
        scenes::on_ranks(count, [&](const std::shared_ptr<const simulator::Ranks>& ranks) {
            write_all(ranks, "ranks");
        });
        EXPECT_EQ(bytes_of(folder / "ranks0"), bytes_of(folder / "alone0"));
        EXPECT_EQ(bytes_of(folder / "ranks1"), bytes_of(folder / "alone1"));
    }
}

TEST(RunExtras, AreTheSameToTheBitOnAnyRanks) {
    for (const Encoding encoding : {Encoding::Binary, Encoding::Ascii}) {
        expect_same_on_ranks<3>(encoding);
        expect_same_on_ranks<4>(encoding);
    }
}

TEST(RunExtras, ThatATurnMakesEndlessAreRefused) {
    const TempFolder folder;
    const SimplexMesh<4> mesh = rich_box<4>();
    MeshExtras<4> extras;
    extras.vertex_fields = {
        {"wind",
         Eigen::MatrixXd::Constant(4, mesh.vertex_count(), std::numeric_limits<double>::max())}};
    static_cast<void>(write_mesh(folder / "a.pent", mesh, {}, extras));
    expect_contains(error_of([&] {
                        static_cast<void>(
                            run(scene_of_twins<4>(folder / "a.pent"), {.folder = folder / "run"}));
                    }),
                    {"meshes/turned.pent: vertex 0: wind is not finite"});
}

class ResumeExtras : public testing::Test {
protected:
    ResumeExtras() : mesh_(scenes::bar(3)), scene_(test::falling_bar(folder_, 1)) {
        mesh_.fibers = Positions<4>::Constant(4, mesh_.cell_count(), 0.5);
    }

    void write(const MeshExtras<4>& extras) const {
        static_cast<void>(write_mesh(folder_ / "bar.pent", mesh_, {}, extras));
    }

    // A frame more, by so many ranks that compare meshes; 0: alone.
    void go_on(int ranks) {
        const auto compare = [&](const std::shared_ptr<const simulator::Ranks>& on) {
            const RunRanks together(on.get());
            RunMeshes<4> meshes(scene_, together);
            const Simulation<4> simulation = meshes.simulate({.ranks = on});
            EXPECT_EQ(meshes.compare(file(), simulation, 0), read_info(file()).crc32c);
        };
        if (ranks > 0) {
            scenes::on_ranks(ranks, compare);
        }
        ++scene_.frames;
        const RunReport report = run(scene_, {.folder = folder_ / "run", .resume = true});
        EXPECT_EQ(report.verdict, RunVerdict::Finished);
    }

    void expect_another() {
        expect_contains(
            error_of([&] {
                static_cast<void>(run(scene_, {.folder = folder_ / "run", .resume = true}));
            }),
            {"box.pent: is another mesh than that of the scene now"});
        scenes::on_ranks(2, [&](const std::shared_ptr<const simulator::Ranks>& on) {
            const RunRanks together(on.get());
            RunMeshes<4> meshes(scene_, together);
            const Simulation<4> simulation = meshes.simulate({.ranks = on});
            expect_contains(
                error_of([&] { static_cast<void>(meshes.compare(file(), simulation, 0)); }),
                {"box.pent: is another mesh than that of the scene now"});
        });
    }

    [[nodiscard]] fs::path file() const { return folder_ / "run/meshes/box.pent"; }

    TempFolder folder_;
    SimplexMesh<4> mesh_;
    Scene scene_;
};

// Nothing of a step hangs on them: a run keeps those that it began with, or none as one that an
// earlier version began.
TEST_F(ResumeExtras, GoesOnWithWhateverIsBesideTheMeshNow) {
    for (const MeshExtras<4>& before : {MeshExtras<4>(), all_extras(mesh_)}) {
        scene_.frames = 1;
        write(before);
        static_cast<void>(run(scene_, {.folder = folder_ / "run", .force = true}));
        const std::string bytes = bytes_of(file());
        for (const MeshExtras<4>& now : {all_extras(mesh_), all_extras(mesh_, 3), {}}) {
            write(now);
            for (const int ranks : {0, 1, 3}) {
                go_on(ranks);
                EXPECT_EQ(bytes_of(file()), bytes);
            }
        }
        static_cast<void>(run(scene_, {.folder = folder_ / "whole", .force = true}));
        const std::string last = frame_file_name("box", scene_.frames);
        EXPECT_EQ(read_frame<4>(folder_ / "run/frames" / last).positions,
                  read_frame<4>(folder_ / "whole/frames" / last).positions);
    }
}

TEST_F(ResumeExtras, IsRefusedWhereTheMeshItselfHasChanged) {
    const SimplexMesh<4> mesh = mesh_;
    write(all_extras(mesh));
    static_cast<void>(run(scene_, {.folder = folder_ / "run"}));
    mesh_.fibers(2, mesh_.cell_count() - 1) = 0.25;
    write(all_extras(mesh));
    expect_another();
    mesh_ = mesh;
    mesh_.positions(1, 5) += 1e-9;
    write(all_extras(mesh));
    expect_another();
    mesh_ = mesh;
    mesh_.regions.resize(static_cast<std::size_t>(mesh_.cell_count()), 1);
    write(all_extras(mesh));
    expect_another();
}

}  // namespace
}  // namespace pent::runs
