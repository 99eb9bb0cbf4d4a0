#include "polytopes.h"
#include "support/kuhn_box.h"

#include <pent/pent_file.h>

#include <algorithm>
#include <sstream>
#include <utility>
#include <vector>

namespace pent::exchange {
namespace {

using test::five_cell;
using test::read_as;
using test::sixteen_cell;
using test::taken_apart;
using test::text_as;
using test::with_unused_points;

// From every format into every other: the same boundary, or the same body around it.
TEST(Exchange, KeepsTheHypervolumeFromEachFormatToEach) {
    const pent::test::TempFolder folder;
    const TetSurface surface = sixteen_cell();
    for (const Format& from : formats()) {
        const std::filesystem::path first = folder / ("a" + std::string(from.endings[0]));
        write(first, surface, {.in_double = true});
        if (from.read == nullptr) {
            pent::test::expect_contains(
                pent::test::error_of([&] { static_cast<void>(read(first)); }), {"written only"});
            continue;
        }
        for (const Format& to : formats()) {
            for (const std::string_view ending : to.endings) {
                const std::filesystem::path second = folder / ("b" + std::string(ending));
                write(second, read(first), {.in_double = true});
                if (to.read == nullptr) {
                    continue;
                }
                const Content content = read(second);
                const auto* body = std::get_if<Body>(&content);
                EXPECT_EQ(body != nullptr, to.has_cells);
                const double found = body != nullptr
                                         ? total_volume(body->mesh)
                                         : enclosed_hypervolume(std::get<TetSurface>(content));
                EXPECT_NEAR(found, 2.0 / 3, 1e-14) << from.name << " to " << to.name;
            }
        }
    }
}

TEST(Exchange, WritesTheBoundaryOfABodyWithThePointsThatItHas) {
    const SimplexMesh<4> mesh = pent::test::kuhn_box<4>({2, 2, 2, 2}, {1, 1, 1, 1});
    const auto surface = std::get<TetSurface>(read_as("a.4do", text_as("a.4do", Body{mesh})));
    EXPECT_EQ(surface.points.cols(), 81 - 1);  // all but the one in the middle
    EXPECT_TRUE(check(surface).is_oriented());
    EXPECT_NEAR(enclosed_hypervolume(surface), 1, 1e-14);
}

// Calls back with the first ending of each format of boundaries that is read.
template <typename Visit>
void for_each_boundary_format(const Visit& visit) {
    for (const Format& format : formats()) {
        if (!format.has_cells && format.read != nullptr) {
            visit("a" + std::string(format.endings[0]));
        }
    }
}

// A vertex without a cell would have no mass.
TEST(Exchange, MakesBodiesOfThePointsThatABoundaryUses) {
    for_each_boundary_format([](const std::string& name) {
        const Content content = read_as(name, text_as(name, with_unused_points(sixteen_cell())));
        const Positions<4>& points = std::get<TetSurface>(content).points;
        ASSERT_EQ(points.cols(), 8) << name;
        EXPECT_EQ(points, sixteen_cell().points) << name;
        const auto body = std::get<Body>(read_as("b.pent", text_as("b.pent", content)));
        std::vector<int> uses(static_cast<std::size_t>(body.mesh.vertex_count()), 0);
        for (const std::uint32_t corner : body.mesh.cells.reshaped()) {
            ++uses[corner];
        }
        EXPECT_EQ(std::count(uses.begin(), uses.end(), 0), 0) << name;
        EXPECT_NEAR(total_volume(body.mesh), 2.0 / 3, 1e-14) << name;
    });
}

TEST(Exchange, JoinsTetrahedraByThePlacesOfTheirPoints) {
    for_each_boundary_format([](const std::string& name) {
        TetSurface apart = taken_apart(sixteen_cell());
        for (Eigen::Index t = 0; t < 16; t += 3) {  // that way neighbors do not agree, either
            std::swap(apart.tetrahedra(0, t), apart.tetrahedra(1, t));
        }
        const pent::test::TempFolder folder;
        write(folder / name, apart);
        const auto joined = std::get<TetSurface>(read(folder / name));
        EXPECT_EQ(joined.points.cols(), 8) << name;
        EXPECT_TRUE(check(joined).is_oriented()) << name;
        EXPECT_NEAR(enclosed_hypervolume(joined), 2.0 / 3, 1e-14) << name;
        EXPECT_NE(text_as("b.pent", joined), "");
        const auto as_it_is = std::get<TetSurface>(read(folder / name, {.is_welded = false}));
        EXPECT_EQ(as_it_is.points, apart.points) << name;
    });
}

// Two bodies on either side of a tetrahedron, which both have: as one they would not be closed.
TEST(Exchange, LeavesPointsApartWhereBoundariesTouch) {
    const TetSurface one = sixteen_cell();
    TetSurface two{Positions<4>(4, 16), Simplices<4>(4, 32)};
    const Eigen::Vector4d normal = Eigen::Vector4d::Constant(0.5);  // of the tetrahedron x..w = 1
    two.points << one.points, one.points;
    for (Eigen::Index p = 8; p < 16; ++p) {
        two.points.col(p) -= 2 * (normal.dot(two.points.col(p)) - 0.5) * normal;
    }
    two.tetrahedra << one.tetrahedra, (one.tetrahedra.array() + 8).matrix();
    for (Eigen::Index t = 16; t < 32; ++t) {
        std::swap(two.tetrahedra(0, t), two.tetrahedra(1, t));
    }
    EXPECT_FALSE(check(weld(two).surface).is_closed());
    const auto again = std::get<TetSurface>(read_as("a.4do", text_as("a.4do", two)));
    EXPECT_EQ(again.points, two.points);
    EXPECT_TRUE(check(again).is_oriented());
    EXPECT_NEAR(enclosed_hypervolume(again), 4.0 / 3, 1e-14);
}

TEST(Exchange, KeepsAllThatAPentFileSays) {
    Body body{pent::test::kuhn_box<4>({1, 1, 1, 1}, {1, 1, 1, 1})};
    const Eigen::Index vertices = body.mesh.vertex_count();
    const Eigen::Index cells = body.mesh.cell_count();
    body.mesh.regions.assign(static_cast<std::size_t>(cells), 3);
    body.mesh.fibers.setOnes(4, cells);
    body.extras.vertex_fields = {{"heat", Eigen::MatrixXd::Random(1, vertices)},
                                 {"drift", Eigen::MatrixXd::Random(4, vertices)}};
    body.extras.cell_fields = {{"age", Eigen::MatrixXd::Random(1, cells)}};
    body.extras.bisection_tags.assign(static_cast<std::size_t>(cells), 2);
    body.extras.boundary = body.mesh.cells.topRows<4>().leftCols<2>();
    body.extras.labels = {4, 5};
    body.extras.base_labels = {0, 7};
    const std::string text = text_as("a.pent", body);
    const Content content = read_as("a.pent", text);
    const MeshExtras<4>& found = std::get<Body>(content).extras;
    EXPECT_EQ(found.vertex_fields, body.extras.vertex_fields);
    EXPECT_EQ(found.cell_fields, body.extras.cell_fields);
    EXPECT_EQ(found.bisection_tags, body.extras.bisection_tags);
    ASSERT_EQ(found.boundary.cols(), 2);
    EXPECT_EQ(found.boundary, body.extras.boundary);
    EXPECT_EQ(found.labels, body.extras.labels);
    EXPECT_EQ(found.base_labels, body.extras.base_labels);
    EXPECT_EQ(text_as("a.pent", content), text);
}

// As some editors put it in front of a text.
TEST(Exchange, PassesOverAByteOrderMark) {
    for (const char* name : {"a.off", "a.4off", "a.4do", "a.obj", "a.g4tf"}) {
        const std::string text = "\xEF\xBB\xBF" + text_as(name, sixteen_cell());
        test::expect_same_surface(read_as(name, text), sixteen_cell(), 0);
    }
    std::string text = text_as("a.obj", sixteen_cell());
    text = "\xEF\xBB\xBF" + text.substr(text.find('v'));  // the first line is a point
    test::expect_same_surface(read_as("a.obj", text), sixteen_cell(), 0);
}

// The determinants of the corners of each tetrahedron, as the lines of a text have them.
std::vector<double> determinants_in(const std::string& text, std::size_t first_index) {
    std::istringstream lines(text);
    std::vector<Eigen::Vector4d> points;
    std::vector<double> found;
    for (std::string line; std::getline(lines, line);) {
        std::istringstream words(line);
        std::string word;
        words >> word;
        if (word == "v") {
            Eigen::Vector4d& point = points.emplace_back(Eigen::Vector4d::Zero());
            words >> point[0] >> point[1] >> point[2] >> point[3];
        } else if (word == "t") {
            Eigen::Matrix4d corners;
            for (int i = 0; i < 4; ++i) {
                std::size_t corner = 0;
                words >> corner;
                corners.col(i) = points.at(corner - first_index);
            }
            found.push_back(corners.determinant());
        }
    }
    return found;
}

// Seen from the middle of the body, every tetrahedron in a text turns the same way: that of the
// first three axes and then the fourth. So the sum of what they span is the body.
TEST(Exchange, WritesTetrahedraThatFaceOutward) {
    for (const auto& [name, first_index] : {std::pair("a.4do", 0), std::pair("a.obj", 1)}) {
        const std::vector<double> parts =
            determinants_in(text_as(name, sixteen_cell()), static_cast<std::size_t>(first_index));
        ASSERT_EQ(parts.size(), 16U) << name;
        double sum = 0;
        for (const double part : parts) {
            EXPECT_EQ(part, 1) << name;
            sum += part / 24;
        }
        EXPECT_NEAR(sum, 2.0 / 3, 1e-15) << name;
    }
}

// Whichever way a program turns its tetrahedra, and if it turns some of them.
TEST(Exchange, ReadsTetrahedraThatFaceAnyWay) {
    const std::string points =
        "v 1 0 0 0\nv 0 1 0 0\nv 0 0 1 0\nv 0 0 0 1\nv -1 -1 -1 -1\n";  // around 0: 5/24
    for (unsigned turned = 0; turned < 32; ++turned) {
        std::string text = points;
        for (unsigned without = 0; without < 5; ++without) {
            std::vector<unsigned> corners;
            for (unsigned i = 0; i < 5; ++i) {
                if (i != without) {
                    corners.push_back(i + 1);
                }
            }
            if ((turned >> without & 1U) != 0) {
                std::swap(corners[0], corners[1]);
            }
            text += "t";
            for (const unsigned corner : corners) {
                text += " " + std::to_string(corner);
            }
            text += "\n";
        }
        const auto surface = std::get<TetSurface>(read_as("a.obj", text));
        EXPECT_TRUE(check(surface).is_oriented());
        EXPECT_NEAR(enclosed_hypervolume(surface), 5.0 / 24, 1e-15);
    }
}

// All that a body may have besides points and cells, each with a name; G4MF has none of it, MFEM
// meshes regions and labels, and a .pent file everything.
TEST(Exchange, NamesWhatAFormatHasNoPlaceFor) {
    const Body plain{pent::test::kuhn_box<4>({1, 1, 1, 1}, {1, 1, 1, 1})};
    Body rich = plain;
    rich.mesh.regions = {1};
    rich.mesh.fibers.resize(4, 1);
    rich.mesh.parents = {0};
    rich.mesh.layers = {0};
    rich.extras.labels = {1};
    rich.extras.base_labels = {1};
    rich.extras.bisection_tags = {1};
    rich.extras.vertex_fields = {{"heat", {}}};
    rich.extras.cell_fields = {{"age", {}}};
    const std::string more =
        "labels of the base, fibers, quadratic cells, layers, tags for bisection,"
        " heat, age";
    EXPECT_EQ(left_out(rich, format_of("a.g4b")), "regions, labels of the boundary, " + more);
    EXPECT_EQ(left_out(rich, format_of("a.mesh")), more);
    EXPECT_EQ(left_out(rich, format_of("a.pent")), "");
    EXPECT_EQ(left_out(plain, format_of("a.g4b")), "");
}

TEST(Exchange, ListsTheEndingsForOneThatItDoesNotKnow) {
    pent::test::expect_contains(
        pent::test::error_of([] { static_cast<void>(format_of("a.fbx")); }),
        {"a.fbx: a name that ends in .fbx; expected one of .pent, .off, .4off, ", ".g4b", ".4do",
         ".obj", ".mesh"});
    pent::test::expect_contains(pent::test::error_of([] { static_cast<void>(format_of("none")); }),
                                {"without an ending"});
    EXPECT_EQ(format_of("A.G4B").name, "G4MF");
}

// In the same words whichever reader it would be.
TEST(Exchange, SaysThatThereIsNoFileOrAFolder) {
    const pent::test::TempFolder folder;
    for (const Format& format : formats()) {
        if (format.read == nullptr) {
            continue;
        }
        const std::string name = "a" + std::string(format.endings[0]);
        const auto message = [&] {
            return pent::test::error_of([&] { static_cast<void>(read(folder / name)); });
        };
        EXPECT_TRUE(message().ends_with(name + ": no such file")) << message();
        std::filesystem::create_directory(folder / name);
        EXPECT_TRUE(message().ends_with(name + ": is a folder; give a file")) << message();
    }
}

// A closed surface of which one tetrahedron is flat, as a point was put on a side of it: the body
// has a flat cell there, wherever its middle is.
TEST(Exchange, RefusesABodyWithAFlatCell) {
    TetSurface flat = sixteen_cell();
    const Eigen::Vector<std::uint32_t, 4> whole = flat.tetrahedra.col(0);
    flat.points.conservativeResize(4, 9);
    flat.points.col(8) =
        (flat.points.col(whole[1]) + flat.points.col(whole[2]) + 2 * flat.points.col(whole[3])) / 4;
    flat.tetrahedra.conservativeResize(4, 19);
    for (int replaced = 0; replaced < 4; ++replaced) {
        Eigen::Vector<std::uint32_t, 4> part = whole;
        part[replaced] = 8;
        flat.tetrahedra.col(replaced == 0 ? 0 : 15 + replaced) = part;
    }
    ASSERT_TRUE(check(flat).is_oriented());
    EXPECT_NEAR(enclosed_hypervolume(flat), 2.0 / 3, 1e-14);
    pent::test::expect_contains(
        pent::test::error_of([&] { static_cast<void>(text_as("a.pent", flat)); }),
        {"a.pent: pentachoron 0: degenerate"});
}

TEST(Exchange, LeavesNothingBehindThatItCouldNotWrite) {
    const pent::test::TempFolder folder;
    TetSurface open = sixteen_cell();
    open.tetrahedra.conservativeResize(4, 15);
    EXPECT_NE(pent::test::error_of([&] { write(folder / "a.pent", open); }), "");
    EXPECT_FALSE(std::filesystem::exists(folder / "a.pent"));
    EXPECT_NE(pent::test::error_of([&] { static_cast<void>(read(folder / "none.4do")); }), "");
}

}  // namespace
}  // namespace pent::exchange
