#include "polytopes.h"

namespace pent::exchange {
namespace {

using test::error_as;
using test::five_cell;
using test::read_as;
using test::sixteen_cell;
using test::text_as;

TEST(FourDo, IsReadAsItWasWritten) {
    for (const TetSurface& surface : {five_cell(), sixteen_cell()}) {
        std::string text = text_as("a.4do", surface);
        test::expect_same_surface(read_as("a.4do", text), surface, 0);
        text[4] = '2';  // the version
        test::expect_same_surface(read_as("a.4do", text), surface, 0);
    }
}

// Readers are told which way the axes go and what the words of tetrahedra are.
TEST(FourDo, SaysWhatItsWordsMean) {
    const std::string text = text_as("a.4do", five_cell());
    pent::test::expect_contains(text, {"4DO 1\n", "\norient X Y -Z W\n", "\ntformat v\n"});
    EXPECT_LT(text.find("\norient"), text.find("\nv "));
    EXPECT_LT(text.find("\ntformat"), text.find("\nt "));
}

// In its own axes z is forward, away from the viewer, unless a line says otherwise.
TEST(FourDo, HasTheAxesThatItSays) {
    const std::string body =
        "v 0 0 0 0\nv 1 0 0 0\nv 0 2 0 0\nv 0 0 3 0\nv 0 0 0 4\nt 0 1 2 3\n"
        "t 0 1 2 4\nt 0 1 3 4\nt 0 2 3 4\nt 1 2 3 4\n";
    const auto points = [&](const std::string& axes) {
        return std::get<TetSurface>(read_as("a.4do", "4DO 1\n" + axes + body)).points;
    };
    EXPECT_EQ(points("")(2, 3), -3);
    EXPECT_EQ(points("orient X Y -Z W\n")(2, 3), 3);
    // w is up and y over.
    const Positions<4> turned = points("ORIENT x -w Z y\n");
    EXPECT_EQ(turned(1, 4), -4);
    EXPECT_EQ(turned(3, 2), 2);
    EXPECT_EQ(turned(2, 3), -3);
}

// As the format's own sample files have it: normals and colors beside points.
TEST(FourDo, TakesPointsFromCornersOfSeveralParts) {
    const std::string text =
        "4do 1 # a 5-cell\nco 255 0 0\nv 0 0 0 0\nv 1 0 0 0\nv 0 1 0 0\nv 0 0 1 0\nv 0 0 0 1\nvn 0 "
        "0"
        " 0 1\ntformat co vn/v/co\nt 0 0/0/0 0/1/0 0/2/0 0/3/0\nt 0 0/0/0 0/1/0 0/2/0 0/4/0\n"
        "t 0 0/0/0 0/1/0 0/3/0 0/4/0\nt 0 0/0/0 0/2/0 0/3/0 0/4/0\nt 0 0/1/0 0/2/0 0/3/0 0/4/0\n";
    const auto surface = std::get<TetSurface>(read_as("a.4do", text));
    EXPECT_TRUE(check(surface).is_oriented());
    EXPECT_NEAR(enclosed_hypervolume(surface), 1.0 / 24, 1e-15);
}

TEST(FourDo, NamesTheLineOfWhatIsWrong) {
    pent::test::expect_contains(error_as("a.4do", "4DO 7\n"), {"line 1: ", "version 7"});
    pent::test::expect_contains(error_as("a.4do", "5DO 1\n"), {"line 1: ", "expected 4DO"});
    for (const char* axes : {"X X Y W", "X Y Q W", "XY Z W Y", "X Y Z", "X Y Z -"}) {
        pent::test::expect_contains(error_as("a.4do", std::string("4DO 1\norient ") + axes + "\n"),
                                    {"line 2: ", "each of X, Y, Z and W once"});
    }
    pent::test::expect_contains(
        error_as("a.4do", "4DO 1\ntformat vn/v\nv 1 2 3 4\nt 0/0 0 0/0 0/0\n"), {"line 4: "});
    pent::test::expect_contains(error_as("a.4do", "4DO 1\nv 1 2 3\n"), {"line 2: "});
    pent::test::expect_contains(error_as("a.4do", "4DO 1\nv 1 2 3 4\nt 0 0 0 1\n"),
                                {"line 3: ", "index 1 of 1"});
    pent::test::expect_contains(error_as("a.4do", "4DO 1\ntformat vn/vt\n"), {"line 2: ", "v/vn"});
    pent::test::expect_contains(error_as("a.4do", "4DO 1\nv 1 2 3 4\n"), {"no tetrahedron"});
}

}  // namespace
}  // namespace pent::exchange
