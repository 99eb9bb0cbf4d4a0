#include "support/file_bytes.h"
#include "support/kuhn_box.h"
#include "support/messages.h"
#include "support/temp_folder.h"
#include "support/thread_writers.h"

#include <pent/extrusion.h>
#include <pent/facets.h>
#include <pent/mesh_part.h>
#include <pent/validate_parts.h>

#include <gtest/gtest.h>

#include <algorithm>
#include <fstream>
#include <limits>
#include <numeric>

namespace pent {
namespace {

using test::by_writers;
using test::bytes_of;
using test::error_of;
using test::expect_contains;

// Everything that a file may have of a mesh, but for what only children of quadratic cells have.
SimplexMesh<4> rich_box() {
    SimplexMesh<4> mesh = test::kuhn_box<4>({2, 1, 2, 1}, {1, 2, 3, 4});
    std::srand(3);
    mesh.positions += 0.01 * Positions<4>::Random(4, mesh.vertex_count());
    mesh.regions.resize(static_cast<std::size_t>(mesh.cell_count()));
    mesh.columns.resize(static_cast<std::size_t>(mesh.vertex_count()));
    mesh.layers.resize(mesh.columns.size());
    std::iota(mesh.regions.begin(), mesh.regions.end(), std::uint16_t{3});
    std::iota(mesh.columns.begin(), mesh.columns.end(), 100U);
    std::iota(mesh.layers.begin(), mesh.layers.end(), 7U);
    mesh.fibers = Positions<4>::Random(4, mesh.cell_count());
    return mesh;
}

Extrusion<4> box_with_layers(bool has_points) {
    Extrusion<4> made;
    made.base = test::kuhn_box<3>({2, 2, 1}, {1, 1, 1});
    for (Eigen::Index cell = 0; cell < made.base.cell_count(); ++cell) {
        made.base.regions.push_back(static_cast<std::uint16_t>(cell % 3));
    }
    made.ordered.cells = made.base.cells;
    for (auto cell : made.ordered.cells.colwise()) {
        int exchanges = 0;
        for (int i = 0; i < 4; ++i) {
            for (int j = 0; j < 3; ++j) {
                if (cell[j] > cell[j + 1]) {
                    std::swap(cell[j], cell[j + 1]);
                    ++exchanges;
                }
            }
        }
        made.ordered.is_odd.push_back(static_cast<std::uint8_t>(exchanges % 2));
    }
    for (int l = 0; l < 5; ++l) {
        made.layers.push_back({Eigen::Matrix<double, 4, 3>::Identity(), {0.1, 0, 0, 0.3 * l}});
    }
    if (has_points) {
        made.layers.front().linear.setZero();
        made.layers.back().linear.setZero();
    }
    return made;
}

void expect_same(const SimplexMesh<4>& found, const SimplexMesh<4>& expected) {
    EXPECT_EQ(found.positions, expected.positions);
    EXPECT_EQ(found.cells, expected.cells);
    EXPECT_EQ(found.regions, expected.regions);
    EXPECT_EQ(found.columns, expected.columns);
    EXPECT_EQ(found.layers, expected.layers);
    EXPECT_EQ(found.fibers, expected.fibers);
}

TEST(MeshSource, HasTheVerticesAndAnyCellsOfTheWholeMesh) {
    const test::TempFolder folder;
    MeshExtras<4> extras;
    extras.vertex_fields = {{"heat", Eigen::MatrixXd::Random(1, 36)}};
    extras.bisection_tags.resize(96, 2);
    static_cast<void>(write_mesh(folder / "rich.pent", rich_box(), {}, extras));
    static_cast<void>(
        write_mesh(folder / "plain.pent", test::kuhn_box<4>({1, 1, 1, 1}, {1, 1, 1, 1})));
    static_cast<void>(write_extrusion(folder / "prisms.pent", box_with_layers(false)));
    static_cast<void>(write_extrusion(folder / "cones.pent", box_with_layers(true),
                                      {.encoding = Encoding::Ascii}));
    static_cast<void>(
        write_mesh(folder / "text.pent", rich_box(), {.encoding = Encoding::Ascii}, extras));
    // More lines than one piece, of vertices, cells and what is behind them.
    const SimplexMesh<4> fine = test::kuhn_box<4>({11, 5, 4, 2}, {1, 1, 1, 1});
    MeshExtras<4> labels;
    labels.boundary = match_facets<4>(fine.cells, fine.vertex_count()).boundary;
    labels.labels.resize(static_cast<std::size_t>(labels.boundary.cols()), 5);
    static_cast<void>(
        write_mesh(folder / "long.pent", fine, {.encoding = Encoding::Ascii}, labels));
    for (const char* name :
         {"rich.pent", "plain.pent", "prisms.pent", "cones.pent", "text.pent", "long.pent"}) {
        const SimplexMesh<4> whole = read_mesh<4>(folder / name).mesh;
        const MeshSource<4> source(folder / name, 1);
        EXPECT_EQ(source.info().cells, static_cast<std::uint64_t>(whole.cell_count()));
        SimplexMesh<4> vertices = source.vertices();
        EXPECT_EQ(vertices.cell_count(), 0);
        const Eigen::Index stride = whole.cell_count() / 17 + 1;
        for (Eigen::Index first = 0; first <= whole.cell_count(); first += stride) {
            for (Eigen::Index last = first; last <= whole.cell_count(); last += stride + 2) {
                SimplexMesh<4> part = source.cells(first, last);
                const SimplexMesh<4> expected = rows_of(whole, {0, 0, first, last});
                EXPECT_EQ(part.cells, expected.cells);
                EXPECT_EQ(part.regions, expected.regions);
                EXPECT_EQ(part.fibers, expected.fibers);
            }
        }
        SimplexMesh<4> all = source.cells(0, whole.cell_count());
        all.positions = vertices.positions;
        all.columns = vertices.columns;
        all.layers = vertices.layers;
        expect_same(all, whole);
    }
}

TEST(MeshSource, ExtrudesTheCellsOverSomeVerticesOfTheBase) {
    const test::TempFolder folder;
    for (const bool has_points : {false, true}) {
        const Extrusion<4> extrusion = box_with_layers(has_points);
        static_cast<void>(write_extrusion(folder / "a.pent", extrusion));
        const SimplexMesh<4> whole = read_mesh<4>(folder / "a.pent").mesh;
        const MeshSource<4> source(folder / "a.pent", 2);
        ASSERT_TRUE(source.is_extrusion());
        std::vector<bool> is_wanted(static_cast<std::size_t>(extrusion.base.vertex_count()));
        is_wanted[2] = is_wanted[5] = true;
        const MeshPart<4> part = source.cells_over(is_wanted);
        EXPECT_EQ(part.cell_count, whole.cell_count());
        std::vector<std::uint32_t> expected;
        for (Eigen::Index cell = 0; cell < whole.cell_count(); ++cell) {
            const Eigen::Index base = cell / cells_of_column<4>(extrusion.layers);
            const auto corners = extrusion.base.cells.col(base);
            if (std::any_of(corners.begin(), corners.end(),
                            [](std::uint32_t v) { return v == 2 || v == 5; })) {
                expected.push_back(static_cast<std::uint32_t>(cell));
            }
        }
        ASSERT_LT(expected.size(), static_cast<std::size_t>(whole.cell_count()));
        EXPECT_EQ(part.numbers, expected);
        for (std::size_t i = 0; i < expected.size(); ++i) {
            EXPECT_EQ(part.mesh.cells.col(static_cast<Eigen::Index>(i)),
                      whole.cells.col(expected[i]));
            EXPECT_EQ(part.mesh.regions[i], whole.regions[expected[i]]);
        }
    }
}

// More writers than some have rows, too.
TEST(MeshSlabs, AreTheFileThatOneWriterMakes) {
    const test::TempFolder folder;
    SimplexMesh<4> children = test::kuhn_box<4>({2, 1, 1, 1}, {1, 1, 1, 1});
    for (Eigen::Index cell = 0; cell < children.cell_count(); ++cell) {
        children.parents.push_back(static_cast<std::uint32_t>(cell / 16));
    }
    for (const SimplexMesh<4>& mesh :
         {rich_box(), test::kuhn_box<4>({1, 1, 1, 1}, {1, 1, 1, 1}), children}) {
        for (const Encoding encoding : {Encoding::Binary, Encoding::Ascii}) {
            const std::uint32_t crc =
                write_mesh(folder / "one.pent", mesh, {.encoding = encoding, .created_by = "t"});
            for (const int count : {1, 2, 3, 7, 53}) {
                const auto said = by_writers(count, [&](const test::ThreadWriters& writers) {
                    const SimplexMesh<4> rows = rows_of(
                        mesh,
                        slab_of(mesh.vertex_count(), mesh.cell_count(), writers.place(), count));
                    EXPECT_EQ(write_mesh_slab(
                                  folder / "all.pent", rows, {},
                                  {.encoding = encoding, .created_by = "t", .writers = &writers}),
                              crc);
                    if (encoding == Encoding::Binary) {
                        EXPECT_EQ(checksum_of_mesh(rows, &writers), crc);
                    }
                });
                EXPECT_EQ(said, std::vector<std::string>(said.size()));
                EXPECT_EQ(bytes_of(folder / "all.pent"), bytes_of(folder / "one.pent")) << count;
            }
        }
        EXPECT_EQ(checksum_of_mesh(mesh, nullptr),
                  write_mesh(folder / "one.pent", mesh, {.created_by = "t"}));
    }
}

TEST(Checksum, OfSlabsFindsWhateverByteHasChanged) {
    const test::TempFolder folder;
    static_cast<void>(write_mesh(folder / "a.pent", rich_box()));
    const std::string good = bytes_of(folder / "a.pent");
    const auto check_by = [&](int count) {
        return by_writers(count, [&](const test::ThreadWriters& readers) {
            check_checksum(folder / "a.pent", &readers);
        });
    };
    EXPECT_EQ(check_by(3), std::vector<std::string>(3));
    EXPECT_NO_THROW(check_checksum(folder / "a.pent", nullptr));
    for (std::size_t at = good.find("end_header") + 11; at < good.size(); at += 997) {
        std::string damaged = good;
        damaged[at] = static_cast<char>(damaged[at] ^ 4);
        std::ofstream(folder / "a.pent", std::ios::binary) << damaged;
        for (const std::string& line : check_by(4)) {
            expect_contains(line, {"a.pent", "checksum", "changed after it was written"});
        }
    }
}

TEST(MeshSource, SaysWhatIsWrongWithAFile) {
    const test::TempFolder folder;
    static_cast<void>(write_mesh(folder / "a.pent", rich_box()));
    const std::string good = bytes_of(folder / "a.pent");
    std::ofstream(folder / "cut.pent", std::ios::binary) << good.substr(0, good.size() - 9);
    expect_contains(error_of([&] { MeshSource<4>(folder / "cut.pent", 2); }),
                    {"cut.pent", "the file is truncated"});
    expect_contains(error_of([&] { MeshSource<4>(folder / "none.pent", 2); }),
                    {"none.pent", "cannot be read"});
    Frame<4> frame;
    frame.positions = rich_box().positions;
    frame.mesh_name = "a.pent";
    write_frame(folder / "frame.pent", frame);
    EXPECT_EQ(error_of([&] { MeshSource<4>(folder / "frame.pent", 2); }),
              error_of([&] { static_cast<void>(read_mesh<4>(folder / "frame.pent")); }));
    // Text, in the words of whoever reads all of it.
    const SimplexMesh<4> box = rich_box();
    MeshExtras<4> extras;
    extras.boundary = match_facets<4>(box.cells, box.vertex_count()).boundary;
    extras.labels.resize(static_cast<std::size_t>(extras.boundary.cols()), 5);
    static_cast<void>(write_mesh(folder / "text.pent", box, {.encoding = Encoding::Ascii}));
    const std::string text = bytes_of(folder / "text.pent");
    const std::size_t body = text.find("end_header\n") + 11;
    const auto line = [&](int number) {
        std::size_t at = body;
        while (number-- > 0) {
            at = text.find('\n', at) + 1;
        }
        return at;
    };
    const auto says_the_same = [&](const std::string& bytes) {
        std::ofstream(folder / "text.pent", std::ios::binary) << bytes;
        const std::string expected =
            error_of([&] { static_cast<void>(read_mesh<4>(folder / "text.pent")); });
        EXPECT_NE(expected, "");
        EXPECT_EQ(error_of([&] {
                      const MeshSource<4> slabs(folder / "text.pent", 2);
                      static_cast<void>(slabs.vertices());
                      static_cast<void>(slabs.cells(0, 40));
                      static_cast<void>(slabs.cells(40, 96));
                      check_checksum(folder / "text.pent", nullptr);
                  }),
                  expected);
    };
    says_the_same(text + "1 2 3\n");
    says_the_same(text + "7");
    says_the_same(text.substr(0, text.size() - 3));
    says_the_same(text.substr(0, line(36 + 94)));
    static_cast<void>(write_mesh(folder / "text.pent", box, {.encoding = Encoding::Ascii}, extras));
    const std::string more = bytes_of(folder / "text.pent");
    const auto count = static_cast<int>(extras.labels.size());
    for (const int lines : {1, 2, 7}) {  // behind the last cell, of the boundary
        std::size_t end = more.size();
        for (int i = 0; i < lines; ++i) {
            end = more.rfind('\n', end - 2) + 1;
        }
        std::ofstream(folder / "text.pent", std::ios::binary) << more.substr(0, end);
        const std::string words =
            "text.pent: boundary " + std::to_string(count - lines) + ": the file ends ";
        expect_contains(error_of([&] { (void)read_mesh<4>(folder / "text.pent"); }), {words});
        expect_contains(error_of([&] { MeshSource<4>(folder / "text.pent", 2); }), {words});
    }
    says_the_same(more + "7");
    std::string changed = text;
    changed[line(36 + 50) + 1] = 'x';
    says_the_same(changed);
    changed = text;
    changed[line(3)] = 'x';
    says_the_same(changed);
    changed = text;
    changed[line(36 + 95) - 2] = changed[line(36 + 95) - 2] == '7' ? '8' : '7';
    says_the_same(changed);
    // A file that is changed while it is open.
    const MeshSource<4> source(folder / "a.pent", 2);
    std::ofstream(folder / "a.pent", std::ios::binary) << good.substr(0, good.size() / 2);
    expect_contains(error_of([&] { (void)source.cells(90, 96); }), {"a.pent", "truncated"});
}

TEST(ValidatePart, CallsCellsByTheirNumbersInTheWhole) {
    SimplexMesh<4> part = rows_of(rich_box(), {0, 36, 10, 14});
    const std::vector<std::uint32_t> numbers = {10, 11, 12, 13};
    EXPECT_NO_THROW(validate_part<4>(part, "a", numbers));
    std::swap(part.cells(0, 2), part.cells(1, 2));
    expect_contains(error_of([&] { validate_part<4>(part, "a", numbers); }),
                    {"a: pentachoron 12: inverted"});
    std::swap(part.cells(0, 2), part.cells(1, 2));
    part.fibers(1, 3) = std::numeric_limits<double>::quiet_NaN();
    expect_contains(error_of([&] { validate_part<4>(part, "a", numbers); }),
                    {"a: pentachoron 13: fiber_y is nan"});
    EXPECT_NO_THROW(validate_part<4>(rows_of(rich_box(), {0, 36, 5, 5}), "a", {}));
}

// Of several faults the one that is found in the whole, whoever has which cells.
TEST(ValidateParts, SaysOnAllWhatIsSaidOfTheWhole) {
    SimplexMesh<4> mesh = rich_box();
    const auto expect_said_by_all = [&](const std::string& words) {
        const std::string alone = error_of([&] { validate(mesh, "a"); });
        expect_contains(alone, {words});
        for (const int count : {1, 2, 3, 5}) {
            // From the last cells to the first ones, as whose they are is in no order.
            const auto said = by_writers(count, [&](const test::ThreadWriters& writers) {
                const MeshSlab rows = slab_of(0, 96, count - 1 - writers.place(), count);
                std::vector<std::uint32_t> numbers;
                for (Eigen::Index cell = rows.first_cell; cell < rows.last_cell; ++cell) {
                    numbers.push_back(static_cast<std::uint32_t>(cell));
                }
                validate_parts<4>(rows_of(mesh, {0, 36, rows.first_cell, rows.last_cell}), "a",
                                  numbers, writers);
            });
            EXPECT_EQ(said, std::vector<std::string>(said.size(), alone));
        }
    };
    for (const Eigen::Index cell : {90, 40, 5}) {
        std::swap(mesh.cells(0, cell), mesh.cells(1, cell));
        expect_said_by_all("pentachoron " + std::to_string(cell) + ": inverted");
    }
    mesh.cells(2, 3) = 36;
    expect_said_by_all("pentachoron 3: vertex 36 of 36");
    for (const Eigen::Index cell : {80, 20}) {
        mesh.fibers(1, cell) = std::numeric_limits<double>::quiet_NaN();
        expect_said_by_all("pentachoron " + std::to_string(cell) + ": fiber_y is nan");
    }
    mesh.positions(0, 7) = std::numeric_limits<double>::infinity();
    expect_said_by_all("vertex 7: x is inf");
}

}  // namespace
}  // namespace pent
