#include "support/file_bytes.h"
#include "support/kuhn_box.h"
#include "support/messages.h"
#include "support/temp_folder.h"

#include <pent/extrusion.h>
#include <pent/formatted.h>
#include <pent/machine_memory.h>

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <fstream>
#include <limits>
#include <random>

namespace pent {
namespace {

using test::bytes_of;
using test::error_of;
using test::expect_contains;

// Cells with their corners in the order of ranks.
template <int Dim>
OrderedCells<Dim - 1> ordered_by(const Simplices<Dim>& cells,
                                 const std::vector<std::uint32_t>& ranks) {
    OrderedCells<Dim - 1> ordered;
    ordered.cells = cells;
    for (auto cell : ordered.cells.colwise()) {
        bool is_odd = false;
        for (int i = 0; i < Dim; ++i) {
            for (int j = 0; j + 1 < Dim; ++j) {
                if (ranks[cell[j]] > ranks[cell[j + 1]]) {
                    std::swap(cell[j], cell[j + 1]);
                    is_odd = !is_odd;
                }
            }
        }
        ordered.is_odd.push_back(is_odd ? 1 : 0);
    }
    return ordered;
}

// A box with numbers that have no short form, its vertices ranked at random, and layers that turn
// and shrink; points at the ends that are asked for.
template <int Dim>
Extrusion<Dim> crooked(int layers, bool has_first_point, bool has_last_point, bool alternate) {
    std::mt19937 random(7);
    std::uniform_real_distribution<double> shift(-0.05, 0.05);
    Extrusion<Dim> made;
    std::array<int, Dim - 1> count{};
    std::array<double, Dim - 1> size{};
    count.fill(2);
    size.fill(1);
    made.base = test::kuhn_box<Dim - 1>(count, size);
    for (double& value : made.base.positions.reshaped()) {
        value += shift(random);
    }
    made.base.regions.resize(made.base.cell_count());
    std::iota(made.base.regions.begin(), made.base.regions.end(), std::uint16_t{65530});
    std::vector<std::uint32_t> ranks(made.base.vertex_count());
    std::iota(ranks.begin(), ranks.end(), 0U);
    std::shuffle(ranks.begin(), ranks.end(), random);
    made.ordered = ordered_by<Dim>(made.base.cells, ranks);
    for (int l = 0; l < layers; ++l) {
        Layer<Dim> layer;
        layer.linear.setIdentity();
        layer.linear *= 1 / (1.0 + 0.1 * l);
        layer.linear(Dim - 1, 0) = 0.03 * l;
        layer.offset.setConstant(0.01 * l);
        layer.offset[Dim - 1] = 0.7 * l;
        made.layers.push_back(layer);
    }
    if (has_first_point) {
        made.layers.front().linear.setZero();
    }
    if (has_last_point) {
        made.layers.back().linear.setZero();
    }
    made.options.alternate = alternate;
    return made;
}

template <int Dim>
void expect_read_as_extruded(const Extrusion<Dim>& made) {
    const test::TempFolder folder;
    const SimplexMesh<Dim> whole = extrude<Dim>(made.base, made.ordered, made.layers, made.options);
    for (const Encoding encoding : {Encoding::Binary, Encoding::Ascii}) {
        const WriteOptions options{.encoding = encoding, .created_by = "test 1"};
        const std::uint32_t crc = write_extrusion<Dim>(folder / "a.pent", made, options);
        const MeshFile<Dim> file = read_mesh<Dim>(folder / "a.pent");
        const FileInfo info = read_info(folder / "a.pent");
        for (const FileInfo& told : {info, file.info}) {
            EXPECT_TRUE(told.is_extrusion);
            EXPECT_EQ(told.dimension, Dim);
            EXPECT_EQ(told.vertices, static_cast<std::uint64_t>(whole.vertex_count()));
            EXPECT_EQ(told.cells, static_cast<std::uint64_t>(whole.cell_count()));
            EXPECT_EQ(told.crc32c, crc);
        }
        // A mesh file has all of a mesh, so that equal files are equal meshes, to the bit.
        static_cast<void>(write_mesh(folder / "read.pent", file.mesh));
        static_cast<void>(write_mesh(folder / "whole.pent", whole));
        EXPECT_EQ(bytes_of(folder / "read.pent"), bytes_of(folder / "whole.pent"));
        static_cast<void>(write_extrusion<Dim>(folder / "b.pent",
                                               read_extrusion<Dim>(folder / "a.pent"), options));
        EXPECT_EQ(bytes_of(folder / "a.pent"), bytes_of(folder / "b.pent"));
    }
}

TEST(ExtrusionFile, IsReadAsTheMeshThatIsExtruded) {
    for (const bool alternate : {true, false}) {
        for (const int layers : {2, 3, 4, 5}) {
            expect_read_as_extruded(crooked<3>(layers, false, false, alternate));
            expect_read_as_extruded(crooked<4>(layers, false, false, alternate));
            expect_read_as_extruded(crooked<4>(layers, true, false, alternate));
            expect_read_as_extruded(crooked<4>(layers, false, true, alternate));
            if (layers > 2) {
                expect_read_as_extruded(crooked<4>(layers, true, true, alternate));
            }
        }
    }
}

TEST(ExtrusionFile, IsRefusedAsAMeshOfItsBase) {
    const test::TempFolder folder;
    static_cast<void>(write_extrusion<4>(folder / "a.pent", crooked<4>(3, false, false, true)));
    expect_contains(error_of([&] { (void)read_mesh<3>(folder / "a.pent"); }),
                    {"a.pent", "dimension 4, expected 3"});
    static_cast<void>(write_mesh(folder / "b.pent", test::kuhn_box<4>({1, 1, 1, 1}, {1, 1, 1, 1})));
    expect_contains(error_of([&] { (void)read_extrusion<4>(folder / "b.pent"); }),
                    {"b.pent", "expected base and layers of a body of dimension 4"});
}

// What is wrong with an extrusion, and what is said of it when it is written and, where a change of
// its ascii file does the same, when it is read.
TEST(ExtrusionFile, SaysWhatIsWrongWithLayersAndOrders) {
    const test::TempFolder folder;
    const auto message = [&](const auto& damage) {
        Extrusion<4> made = crooked<4>(4, false, false, true);
        damage(made);
        return error_of([&] { (void)write_extrusion<4>(folder / "a.pent", made); });
    };
    expect_contains(message([](Extrusion<4>& made) { made.layers.resize(1); }),
                    {"a.pent", "1 layers, expected two or more"});
    expect_contains(message([](Extrusion<4>& made) { made.layers[1].linear.setZero(); }),
                    {"layer 1", "is a point"});
    expect_contains(message([](Extrusion<4>& made) {
                        made.layers.resize(2);
                        made.layers[0].linear.setZero();
                        made.layers[1].linear.setZero();
                    }),
                    {"layer 1", "as the only other one"});
    expect_contains(message([](Extrusion<4>& made) {
                        made.layers[2].offset[1] = std::numeric_limits<double>::infinity();
                    }),
                    {"layer 2", "not finite"});
    expect_contains(message([](Extrusion<4>& made) {
                        std::swap(made.ordered.cells(0, 5), made.ordered.cells(1, 5));
                    }),
                    {"goes one way in one cell and back in another"});
    expect_contains(message([](Extrusion<4>& made) { made.base.cells(0, 3) = 4000; }),
                    {"tetrahedron 3", "vertex 4000 of 27"});
}

TEST(ExtrusionFile, SaysWhatIsWrongInAFile) {
    const test::TempFolder folder;
    static_cast<void>(write_extrusion<4>(folder / "a.pent", crooked<4>(4, false, false, true),
                                         {.encoding = Encoding::Ascii}));
    std::string good = bytes_of(folder / "a.pent");
    for (const char* sum : {"comment crc32c", "comment header_crc32c"}) {
        const std::size_t at = good.find(sum);
        good.erase(at, good.find('\n', at) - at + 1);
    }
    // With the end of one line, counted from the last, replaced.
    const auto message = [&](int from_last, const std::string& end) {
        std::string bytes = good;
        std::size_t line_end = bytes.size() - 1;
        for (int line = 0; line < from_last; ++line) {
            line_end = bytes.rfind('\n', line_end - 1);
        }
        const std::size_t word = bytes.rfind(' ', line_end - 1) + 1;
        bytes.replace(word, line_end - word, end);
        std::ofstream(folder / "b.pent", std::ios::binary) << bytes;
        return error_of([&] { (void)read_mesh<4>(folder / "b.pent"); });
    };
    expect_contains(message(0, "0"), {"b.pent", "reversed are not every second one"});
    expect_contains(message(4, "24"), {"tetrahedron 47", "order is 24, expected at most 23"});
    expect_contains(message(0, "x"), {"layer 3", "reversed is 'x'"});
    // Layers that turn back make cells inside out.
    Extrusion<4> turns = crooked<4>(4, false, false, true);
    turns.layers[2].offset[3] = 0;
    static_cast<void>(write_extrusion<4>(folder / "c.pent", turns));
    expect_contains(error_of([&] { (void)read_mesh<4>(folder / "c.pent"); }),
                    {"c.pent", "pentachoron"});
    std::string without = good;
    const std::size_t property = without.find("property uchar order\n");
    without.replace(property, 20, "property uchar other");
    std::ofstream(folder / "d.pent", std::ios::binary) << without;
    expect_contains(error_of([&] { (void)read_mesh<4>(folder / "d.pent"); }),
                    {"d.pent", "element tetrahedron has no order, which an extrusion needs"});
}

// A row of them would end anywhere, and the next one begin beyond the end of the file.
TEST(ExtrusionFile, IsRefusedWhereALayerHasAList) {
    const test::TempFolder folder;
    static_cast<void>(write_extrusion<4>(folder / "a.pent", crooked<4>(4, false, false, true)));
    std::string good = bytes_of(folder / "a.pent");
    const std::size_t sum = good.find("comment header_crc32c");
    good.erase(sum, good.find('\n', sum) - sum + 1);
    for (const std::string property : {"property double xx\n", "property uchar reversed\n"}) {
        const std::string list =
            "property list uchar" + property.substr(std::string("property").size());
        std::string bytes = good;
        bytes.replace(bytes.find(property), property.size(), list);
        std::ofstream(folder / "b.pent", std::ios::binary) << bytes;
        expect_contains(error_of([&] { (void)read_mesh<4>(folder / "b.pent"); }),
                        {"b.pent: header: element layer has the list property",
                         "expected properties of fixed width"});
    }
}

TEST(Extrude, MakesTheSameInParts) {
    for (const bool has_first_point : {false, true}) {
        for (const bool has_last_point : {false, true}) {
            const Extrusion<4> from = crooked<4>(5, has_first_point, has_last_point, true);
            const SimplexMesh<4> all =
                extrude<4>(from.base, from.ordered, from.layers, from.options);
            const SimplexMesh<4> vertices = extrude_vertices<4>(from);
            EXPECT_EQ(vertices.positions, all.positions);
            EXPECT_EQ(vertices.columns, all.columns);
            EXPECT_EQ(vertices.layers, all.layers);
            const Eigen::Index per_base = cells_of_column<4>(from.layers);
            ASSERT_EQ(per_base * from.base.cell_count(), all.cell_count());
            const std::vector<std::uint32_t> some = {0, 5, 6, 40};
            const SimplexMesh<4> part = extrude_cells<4>(from, some);
            ASSERT_EQ(part.cell_count(), std::ssize(some) * per_base);
            for (Eigen::Index cell = 0; cell < part.cell_count(); ++cell) {
                const Eigen::Index whole = some[cell / per_base] * per_base + cell % per_base;
                EXPECT_EQ(part.cells.col(cell), all.cells.col(whole));
                EXPECT_EQ(part.regions[cell], all.regions[whole]);
            }
        }
    }
}

// A base of 384,000 tetrahedra in a file of a few megabytes, and layers that multiply it.
TEST(ExtrusionFile, IsRefusedWhereItWouldMakeMoreThanThereIsMemoryOrNumbers) {
    constexpr double kBytesOfALayer = 384000 * 4 * 20;
    const test::TempFolder folder;
    Extrusion<4> made;
    made.base = test::kuhn_box<3>({40, 40, 40}, {1, 1, 1});
    std::vector<std::uint32_t> ranks(made.base.vertex_count());
    std::iota(ranks.begin(), ranks.end(), 0U);
    made.ordered = ordered_by<4>(made.base.cells, ranks);
    const auto message = [&](double layers) {
        made.layers.clear();
        for (int l = 0; l < layers; ++l) {
            made.layers.push_back({Eigen::Matrix<double, 4, 3>::Identity(), {0, 0, 0, 1.0 * l}});
        }
        static_cast<void>(write_extrusion<4>(folder / "a.pent", made));
        return error_of([&] { (void)read_mesh<4>(folder / "a.pent"); });
    };
    const double too_many = std::ceil(1.1 * static_cast<double>(machine_memory()) / kBytesOfALayer);
    const double most_numbers = 4294967295.0 / (384000 * 4);
    if (too_many < most_numbers) {  // of a machine with less than 86 GB
        // 41^3 vertices a layer of four doubles and two indices; cells of five indices.
        const double bytes = 41 * 41 * 41 * too_many * 40 + kBytesOfALayer * (too_many - 1);
        expect_contains(message(too_many),
                        {"a.pent: its base and", "layers make",
                         formatted(" pentachora, which take %.3g GB; this machine has %.3g: take"
                                   " fewer layers",
                                   bytes / 1e9, static_cast<double>(machine_memory()) / 1e9)});
    }
    expect_contains(message(std::ceil(most_numbers) + 1),
                    {"a.pent: its base and 2798 layers make 192840958 vertices and 4296192000"
                     " pentachora; at most 4294967295 of each can be numbered"});
}

TEST(ExtrusionFile, IsRefusedWhereverItIsCutOrDamaged) {
    const test::TempFolder folder;
    static_cast<void>(write_extrusion<4>(folder / "a.pent", crooked<4>(3, true, false, true)));
    const std::string good = bytes_of(folder / "a.pent");
    for (std::size_t at = 0; at < good.size(); at += 7) {
        std::ofstream(folder / "cut.pent", std::ios::binary) << good.substr(0, at);
        EXPECT_NE(error_of([&] { (void)read_mesh<4>(folder / "cut.pent"); }), "") << at;
        if (at < good.find("end_header")) {
            continue;  // words that nobody knows are comments
        }
        std::string damaged = good;
        damaged[at] = static_cast<char>(damaged[at] ^ 1);
        std::ofstream(folder / "damaged.pent", std::ios::binary) << damaged;
        EXPECT_NE(error_of([&] { (void)read_mesh<4>(folder / "damaged.pent"); }), "") << at;
    }
}

}  // namespace
}  // namespace pent
