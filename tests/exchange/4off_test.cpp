#include "polytopes.h"

#include <algorithm>
#include <sstream>
#include <vector>

namespace pent::exchange {
namespace {

using test::error_as;
using test::five_cell;
using test::read_as;
using test::sixteen_cell;
using test::text_as;

// A tesseract as others write it: comments, colors, blank lines, polygons of four corners, cells of
// six faces.
std::string tesseract(bool has_last_faces_first = false) {
    std::ostringstream text;
    text << "4OFF\n# points faces edges cells\n16 24 32 8\n\n";
    for (unsigned v = 0; v < 16; ++v) {
        for (unsigned axis = 0; axis < 4; ++axis) {
            text << (axis == 0 ? "" : " ") << (v >> axis & 1U);
        }
        text << "\n";
    }
    std::vector<std::array<unsigned, 4>> faces;  // fixed bits and the two that run
    for (unsigned a = 0; a < 4; ++a) {
        for (unsigned b = a + 1; b < 4; ++b) {
            for (unsigned v = 0; v < 16; ++v) {
                if ((v >> a & 1U) == 0 && (v >> b & 1U) == 0) {
                    const unsigned x = 1U << a;
                    const unsigned y = 1U << b;
                    text << "4 " << v << ' ' << v + x << ' ' << v + x + y << ' ' << v + y
                         << " 255 0 0 # red\n";
                    faces.push_back({v, v + x, v + x + y, v + y});
                }
            }
        }
    }
    for (unsigned axis = 0; axis < 4; ++axis) {
        for (unsigned side = 0; side < 2; ++side) {
            text << "6";
            for (std::size_t i = 0; i < faces.size(); ++i) {
                const std::size_t f = has_last_faces_first ? faces.size() - 1 - i : i;
                bool is_in = true;
                for (const unsigned v : faces[f]) {
                    is_in = is_in && (v >> axis & 1U) == side;
                }
                text << (is_in ? " " + std::to_string(f) : "");
            }
            text << " 0.5 0.5 0.5\n";
        }
    }
    return text.str();
}

TEST(FourOff, OfATesseractIsItsBoundary) {
    const auto surface = std::get<TetSurface>(read_as("t.off", tesseract()));
    EXPECT_TRUE(check(surface).is_oriented());
    EXPECT_EQ(surface.tetrahedra.cols(), 8 * 6);  // each cube, by its corner of lowest index
    EXPECT_NEAR(enclosed_hypervolume(surface), 1, 1e-14);
    EXPECT_NEAR(total_volume(cone_of(surface, "t")), 1, 1e-14);
}

// A cube is cut from its corner of lowest index, whichever of its faces comes first, and into
// nothing flat that welding would have to take out.
TEST(FourOff, CutsCellsAlikeInAnyOrderOfTheirFaces) {
    const pent::test::TempFolder folder;
    for (const bool has_last_faces_first : {false, true}) {
        std::ofstream(folder / "t.off") << tesseract(has_last_faces_first);
        const auto surface = std::get<TetSurface>(read(folder / "t.off", {.is_welded = false}));
        EXPECT_TRUE(check(surface).is_oriented());
        ASSERT_EQ(surface.tetrahedra.cols(), 8 * 6);
        for (Eigen::Index t = 0; t < surface.tetrahedra.cols(); ++t) {
            // The lowest corner of each cube: 0 or 1 along one axis and 0 along all others.
            EXPECT_EQ(surface.tetrahedra.col(t).minCoeff(), t / 6 % 2 << t / 12);
            const auto edge = [&](int k) -> Eigen::Vector4d {
                return surface.points.col(surface.tetrahedra(k, t))
                       - surface.points.col(surface.tetrahedra(0, t));
            };
            EXPECT_EQ(test::perpendicular(edge(1), edge(2), edge(3)).norm(), 1);  // 1/6 m^3
        }
    }
}

TEST(FourOff, IsReadAsItWasWritten) {
    for (const TetSurface& surface : {five_cell(), sixteen_cell()}) {
        test::expect_same_surface(read_as("a.4off", text_as("a.4off", surface)), surface, 0);
    }
}

// Godot-4d: the normal of a cell is perpendicular to the edge that its first two faces share, seen
// from the third corner of the first, and to the third corner of the second.
TEST(FourOff, FacesOutwardForReadersThatLookAtTheFirstTwoFaces) {
    const TetSurface surface = sixteen_cell();
    std::istringstream text(text_as("a.off", surface));
    std::string keyword;
    std::size_t points = 0;
    std::size_t faces = 0;
    std::size_t edges = 0;
    std::size_t cells = 0;
    text >> keyword >> points >> faces >> edges >> cells;
    std::vector<Eigen::Vector4d> at(points);
    for (auto& point : at) {
        text >> point[0] >> point[1] >> point[2] >> point[3];
    }
    std::vector<std::array<std::size_t, 3>> corners(faces);
    std::size_t count = 0;
    for (auto& face : corners) {
        text >> count >> face[0] >> face[1] >> face[2];
    }
    EXPECT_EQ(faces, 32U);  // each once
    EXPECT_EQ(edges, 0U);   // not counted
    for (std::size_t c = 0; c < cells; ++c) {
        std::array<std::size_t, 4> cell{};
        text >> count >> cell[0] >> cell[1] >> cell[2] >> cell[3];
        std::vector<std::size_t> edge;
        std::array<std::size_t, 2> apart{};
        for (std::size_t side = 0; side < 2; ++side) {
            const auto& other = corners[cell[1 - side]];
            for (const std::size_t corner : corners[cell[side]]) {
                if (std::find(other.begin(), other.end(), corner) == other.end()) {
                    apart[side] = corner;
                } else if (side == 0) {
                    edge.push_back(corner);
                }
            }
        }
        ASSERT_EQ(edge.size(), 2U);
        const Eigen::Vector4d origin = at[apart[0]];
        const Eigen::Vector4d normal =
            test::perpendicular(at[std::min(edge[0], edge[1])] - origin,
                                at[std::max(edge[0], edge[1])] - origin, at[apart[1]] - origin);
        EXPECT_GT(normal.dot(origin), 0);  // around 0, outward is away from it
    }
}

TEST(FourOff, NamesTheLineOfWhatIsWrong) {
    pent::test::expect_contains(error_as("a.off", "OFF\n3 1 3\n"),
                                {"a.off: line 1: ", "three dimensions"});
    pent::test::expect_contains(error_as("a.off", "3OFF\n3 1 3\n"),
                                {"a.off: line 1: ", "three dimensions"});
    pent::test::expect_contains(
        error_as("a.off", "4OFF\n3 1 0 0\n0 0 0 0\n1 0 0 0\n0 1 0 0\n2 0 1\n"),
        {"line 6: ", "found 2 of them", "corners of a face, at least 3"});
    pent::test::expect_contains(error_as("a.off", "ply\n"), {"line 1: ", "expected 4OFF"});
    pent::test::expect_contains(error_as("a.off", "abcdefghijklmnopqrstuvwxyz\n"),
                                {"line 1: ", "found \"abcdefghijklmnopqrst\", expected 4OFF"});
    pent::test::expect_contains(error_as("a.off", "4OFF\n5 0 0 0\n0 0 0 0\n1 x 0 0\n"),
                                {"line 4: ", "\"x\""});
    pent::test::expect_contains(error_as("a.off", "4OFF\n900000000 0 0 0\n"),
                                {"line 2: ", "900000000"});
    std::string text = text_as("a.off", five_cell());
    EXPECT_NE(error_as("a.off", text.substr(0, text.size() - 12)), "");
    text.replace(text.rfind('\n', text.size() - 2), std::string::npos, "\n4 0 1 2 99\n");
    pent::test::expect_contains(error_as("a.off", text), {"index 99 of 10"});
}

}  // namespace
}  // namespace pent::exchange
