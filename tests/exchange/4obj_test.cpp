#include "polytopes.h"

namespace pent::exchange {
namespace {

using test::error_as;
using test::five_cell;
using test::read_as;
using test::sixteen_cell;
using test::text_as;

TEST(FourObj, IsReadAsItWasWritten) {
    for (const TetSurface& surface : {five_cell(), sixteen_cell()}) {
        test::expect_same_surface(read_as("a.obj", text_as("a.obj", surface)), surface, 0);
    }
}

// Tesserxel leaves out zeros at the end, and corners have textures and normals.
TEST(FourObj, TakesShortPointsAndCornersOfSeveralParts) {
    const std::string text =
        "# 5-cell\nv 0\nv 1\nv 0 1\nv 0 0 1\nv 0 0 0 1\nvn 0 0 0 1\nvt 0 0 0\nt 1/1/1 2/1/1 3/1/1"
        " 4/1/1\nt 1//1 2//1 3//1 5//1\nt 1 2 4 5\nt 1 3 4 5\nt 2 3 4 5\n";
    const auto surface = std::get<TetSurface>(read_as("a.obj", text));
    EXPECT_TRUE(check(surface).is_oriented());
    EXPECT_NEAR(enclosed_hypervolume(surface), 1.0 / 24, 1e-15);
}

// As with the colors that others add to points, and triangles beside tetrahedra.
TEST(FourObj, LeavesOutWhatFollowsFourCoordinatesAndFaces) {
    std::string text = text_as("a.obj", five_cell());
    for (std::size_t at = text.find("\nv"); at != std::string::npos;
         at = text.find("\nv", at + 1)) {
        text.insert(text.find('\n', at + 1), " 0.5 7");
    }
    test::expect_same_surface(read_as("a.obj", text + "f 1 2 3\n"), five_cell(), 0);
}

TEST(FourObj, NamesTheLineOfWhatIsWrong) {
    pent::test::expect_contains(error_as("a.obj", "v 1 2 3\nv 2 3 4\nv 3 4 9\nf 1 2 3\n"),
                                {"a.obj", "three dimensions", "pent-mesh"});
    pent::test::expect_contains(error_as("a.obj", "v 1\nt 1 1 1 2\n"),
                                {"line 2: ", "index 1 of 1"});
    pent::test::expect_contains(error_as("a.obj", "v 1\nt 1 1 1\n"), {"line 2: "});
    pent::test::expect_contains(error_as("a.obj", "v\n"), {"line 1: ", "without a coordinate"});
    pent::test::expect_contains(error_as("a.obj", "v 1\n"), {"a.obj: no tetrahedron in it"});
}

}  // namespace
}  // namespace pent::exchange
