#include "polytopes.h"
#include "support/kuhn_box.h"

#include <pent/pent_file.h>

#include <sstream>
#include <utility>
#include <vector>

namespace pent::exchange {
namespace {

using test::five_cell;
using test::read_as;
using test::sixteen_cell;
using test::text_as;

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
                const auto* mesh = std::get_if<SimplexMesh<4>>(&content);
                EXPECT_EQ(mesh != nullptr, to.has_cells);
                const double found = mesh != nullptr
                                         ? total_volume(*mesh)
                                         : enclosed_hypervolume(std::get<TetSurface>(content));
                EXPECT_NEAR(found, 2.0 / 3, 1e-14) << from.name << " to " << to.name;
            }
        }
    }
}

TEST(Exchange, WritesTheBoundaryOfABodyWithThePointsThatItHas) {
    const SimplexMesh<4> mesh = pent::test::kuhn_box<4>({2, 2, 2, 2}, {1, 1, 1, 1});
    const auto surface = std::get<TetSurface>(read_as("a.4do", text_as("a.4do", mesh)));
    EXPECT_EQ(surface.points.cols(), 81 - 1);  // all but the one in the middle
    EXPECT_TRUE(check(surface).is_oriented());
    EXPECT_NEAR(enclosed_hypervolume(surface), 1, 1e-14);
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

TEST(Exchange, ListsTheEndingsForOneThatItDoesNotKnow) {
    pent::test::expect_contains(
        pent::test::error_of([] { static_cast<void>(format_of("a.fbx")); }),
        {"a.fbx: a name that ends in .fbx", ".pent", ".4off", ".g4b", ".4do", ".obj", ".mesh"});
    pent::test::expect_contains(pent::test::error_of([] { static_cast<void>(format_of("none")); }),
                                {"without an ending"});
    EXPECT_EQ(format_of("A.G4B").name, "G4MF");
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
