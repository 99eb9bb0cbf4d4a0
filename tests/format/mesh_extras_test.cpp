#include "support/extras.h"
#include "support/file_bytes.h"
#include "support/kuhn_box.h"
#include "support/messages.h"
#include "support/temp_folder.h"
#include "support/thread_writers.h"

#include <pent/error.h>
#include <pent/extrusion.h>
#include <pent/mesh_extras.h>

#include <gtest/gtest.h>

#include <limits>

namespace pent {
namespace {

using test::all_extras;
using test::by_writers;
using test::bytes_of;
using test::error_of;
using test::expect_contains;
using test::expect_same;

template <int Dim>
SimplexMesh<Dim> labeled_box() {
    std::array<int, Dim> count{};
    count.fill(2);
    std::array<double, Dim> size{};
    size.fill(1);
    SimplexMesh<Dim> mesh = test::kuhn_box<Dim>(count, size);
    for (Eigen::Index cell = 0; cell < mesh.cell_count(); ++cell) {
        mesh.regions.push_back(static_cast<std::uint16_t>(cell % 3));
    }
    return mesh;
}

// Of a file with everything, with some of it, and with nothing.
template <int Dim>
std::vector<MeshExtras<Dim>> kinds_of_extras(const SimplexMesh<Dim>& mesh) {
    const MeshExtras<Dim> all = all_extras(mesh);
    MeshExtras<Dim> of_vertices;
    of_vertices.vertex_fields = all.vertex_fields;
    MeshExtras<Dim> of_cells;
    of_cells.bisection_tags = all.bisection_tags;
    MeshExtras<Dim> of_facets;
    of_facets.boundary = all.boundary;
    of_facets.labels = all.labels;
    return {all, of_vertices, of_cells, of_facets, {}};
}

template <int Dim>
void expect_slabs() {
    const test::TempFolder folder;
    const SimplexMesh<Dim> mesh = labeled_box<Dim>();
    for (const MeshExtras<Dim>& extras : kinds_of_extras(mesh)) {
        for (const Encoding encoding : {Encoding::Binary, Encoding::Ascii}) {
            static_cast<void>(write_mesh(folder / "one.pent", mesh,
                                         {.encoding = encoding, .created_by = "t"}, extras));
            for (const int count : {1, 2, 3, 7, 1000}) {
                const auto said = by_writers(count, [&](const test::ThreadWriters& writers) {
                    const MeshSlab slab =
                        slab_of(mesh.vertex_count(), mesh.cell_count(), writers.place(), count);
                    const auto own = read_extras<Dim>(folder / "one.pent", slab);
                    validate_extras(own, slab, mesh.vertex_count(), "one");
                    write_mesh_slab(folder / "all.pent", rows_of(mesh, slab), own,
                                    {.encoding = encoding, .created_by = "t", .writers = &writers});
                });
                EXPECT_EQ(said, std::vector<std::string>(said.size()));
                EXPECT_EQ(bytes_of(folder / "all.pent"), bytes_of(folder / "one.pent")) << count;
            }
            expect_same(read_mesh<Dim>(folder / "all.pent").extras, extras);
        }
    }
}

// More writers than there are rows, too.
TEST(MeshExtras, ThatAreReadAndWrittenBySlabsAreTheFileThatOneWriterMakes) {
    expect_slabs<3>();
    expect_slabs<4>();
}

// The first Error that a slab gives, each read for itself.
template <int Dim>
std::string error_of_slabs(const std::filesystem::path& path,
                           const SimplexMesh<Dim>& mesh,
                           int count) {
    for (int place = 0; place < count; ++place) {
        const MeshSlab slab = slab_of(mesh.vertex_count(), mesh.cell_count(), place, count);
        try {
            validate_extras(read_extras<Dim>(path, slab), slab, mesh.vertex_count(), path.string());
        } catch (const Error& error) {
            return error.what();
        }
    }
    return "";
}

// Two faults at a time, of which the first row is named.
template <int Dim>
void expect_faults() {
    const test::TempFolder folder;
    const SimplexMesh<Dim> mesh = labeled_box<Dim>();
    const MeshExtras<Dim> sound = all_extras(mesh);
    MeshExtras<Dim> of_vertices = sound;
    of_vertices.vertex_fields[0].values(0, 5) = std::numeric_limits<double>::infinity();
    of_vertices.vertex_fields[1].values(1, 4) = std::numeric_limits<double>::infinity();
    MeshExtras<Dim> of_cells = sound;
    of_cells.cell_fields[1].values(0, 17) = std::numeric_limits<double>::infinity();
    MeshExtras<Dim> of_facets = sound;
    of_facets.boundary(1, 2) = 4000;
    const std::vector<std::pair<MeshExtras<Dim>, std::string>> cases = {
        {of_vertices, "vertex 4: current is not finite"},
        {of_cells, " 17: age is not finite"},
        {of_facets, "boundary 2: vertex 4000 of"}};
    for (const auto& [extras, what] : cases) {
        for (const Encoding encoding : {Encoding::Binary, Encoding::Ascii}) {
            const auto path = folder / "a.pent";
            write_mesh_slab(path, mesh, extras, {.encoding = encoding});
            const std::string whole = error_of([&] { static_cast<void>(read_mesh<Dim>(path)); });
            expect_contains(whole, {"a.pent: ", what});
            for (const int count : {1, 2, 5}) {
                EXPECT_EQ(error_of_slabs(path, mesh, count), whole);
            }
        }
    }
}

TEST(MeshExtras, OfSlabsHaveTheFaultsOfTheWhole) {
    expect_faults<3>();
    expect_faults<4>();
}

TEST(MeshExtras, OfBaseAndLayersAreNone) {
    const test::TempFolder folder;
    Extrusion<3> made;
    made.base = test::kuhn_box<2>({1, 1}, {1, 1});
    made.ordered.cells = made.base.cells;
    made.ordered.is_odd.resize(static_cast<std::size_t>(made.base.cell_count()), 0);
    for (Eigen::Index cell = 0; cell < made.base.cell_count(); ++cell) {
        auto corners = made.ordered.cells.col(cell);
        std::sort(corners.begin(), corners.end());
    }
    made.layers.resize(2, {Eigen::Matrix<double, 3, 2>::Identity(), {0, 0, 0}});
    made.layers[1].offset[2] = 1;
    static_cast<void>(write_extrusion<3>(folder / "base.pent", made));
    expect_same(read_extras<3>(folder / "base.pent", {0, 8, 0, 6}), {});
}

TEST(MeshExtras, OfAFileThatBecameAnotherAreRefused) {
    const test::TempFolder folder;
    const SimplexMesh<3> mesh = labeled_box<3>();
    static_cast<void>(write_mesh(folder / "a.pent", mesh, {}, all_extras(mesh)));
    const MeshSlab whole = {0, mesh.vertex_count(), 0, mesh.cell_count()};
    EXPECT_NO_THROW(static_cast<void>(read_extras<3>(folder / "a.pent", whole)));
    for (const MeshSlab& slab :
         {MeshSlab{0, mesh.vertex_count() + 1, 0, 0}, MeshSlab{0, 0, 0, mesh.cell_count() + 1}}) {
        expect_contains(
            error_of([&] { static_cast<void>(read_extras<3>(folder / "a.pent", slab)); }),
            {"a.pent: became another mesh"});
    }
    expect_contains(error_of([&] {
                        static_cast<void>(read_extras<4>(folder / "a.pent", {0, 1, 0, 1}));
                    }),
                    {"a.pent: became another mesh"});
}

}  // namespace
}  // namespace pent
