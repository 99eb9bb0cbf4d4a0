#include "polytopes.h"
#include "support/kuhn_box.h"

#include <pent/pent_file.h>

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
