#include "model/quadratic_cells.h"

#include "cut_meshes.h"
#include "model/part_bodies.h"
#include "potential_laws.h"
#include "scenes.h"
#include "support/messages.h"
#include "thread_ranks.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <memory>
#include <numeric>
#include <string>
#include <utility>
#include <vector>

namespace pent::simulator {
namespace {

using pent::test::error_of;
using pent::test::expect_contains;
using test::Dimensions;
using test::quadratic_cube;

template <typename T>
class QuadraticCellsTest : public testing::Test {};
TYPED_TEST_SUITE(QuadraticCellsTest, Dimensions);

template <int Dim>
void expect_middles_halfway(const SimplexMesh<Dim>& mesh,
                            const QuadraticSimplices<Dim>& simplices) {
    double volume = 0;
    for (Eigen::Index s = 0; s < simplices.cols(); ++s) {
        const auto places = places_of_nodes<Dim>(mesh.positions, simplices, s);
        volume += simplex_volume<Dim>(places.template leftCols<Dim + 1>());
        int middle = Dim + 1;
        for (int a = 0; a <= Dim; ++a) {
            for (int b = a + 1; b <= Dim; ++b, ++middle) {
                EXPECT_LT((places.col(middle) - 0.5 * (places.col(a) + places.col(b))).norm(),
                          1e-15);
            }
        }
    }
    EXPECT_NEAR(volume, total_volume(mesh), 1e-12);  // a rounding for each of 6144 cells
}

TYPED_TEST(QuadraticCellsTest, AreFoundByTheParentsOfTheirChildrenInAnyOrder) {
    constexpr int kDim = TypeParam::value;
    SimplexMesh<kDim> mesh = quadratic_cube<kDim>(2);
    expect_middles_halfway<kDim>(mesh, quadratic_simplices<kDim>(mesh, "box"));
    std::vector<Eigen::Index> order(static_cast<std::size_t>(mesh.cell_count()));
    std::iota(order.begin(), order.end(), Eigen::Index{0});
    std::shuffle(order.begin(), order.end(), std::mt19937(3));
    SimplexMesh<kDim> shuffled = mesh;
    for (std::size_t i = 0; i < order.size(); ++i) {
        shuffled.cells.col(static_cast<Eigen::Index>(i)) = mesh.cells.col(order[i]);
        shuffled.parents[i] = mesh.parents[static_cast<std::size_t>(order[i])];
    }
    EXPECT_EQ(quadratic_simplices<kDim>(shuffled, "box"), quadratic_simplices<kDim>(mesh, "box"));
}

// As `--subdivide 2` leaves cells, which has no parents.
TYPED_TEST(QuadraticCellsTest, AreRecognizedWhereChildrenFollowOneAnother) {
    constexpr int kDim = TypeParam::value;
    SimplexMesh<kDim> mesh = quadratic_cube<kDim>(1);
    std::vector<Eigen::Index> order(static_cast<std::size_t>(mesh.cell_count()));
    std::iota(order.begin(), order.end(), Eigen::Index{0});
    std::stable_sort(order.begin(), order.end(), [&](Eigen::Index a, Eigen::Index b) {
        return mesh.parents[static_cast<std::size_t>(a)]
               < mesh.parents[static_cast<std::size_t>(b)];
    });
    SimplexMesh<kDim> plain = mesh;
    plain.parents.clear();
    for (std::size_t i = 0; i < order.size(); ++i) {
        plain.cells.col(static_cast<Eigen::Index>(i)) = mesh.cells.col(order[i]);
    }
    EXPECT_EQ(quadratic_simplices<kDim>(plain, "box"), quadratic_simplices<kDim>(mesh, "box"));
}

TYPED_TEST(QuadraticCellsTest, AreRefusedWithHowToMakeThem) {
    constexpr int kDim = TypeParam::value;
    const auto message = [](const SimplexMesh<kDim>& mesh) {
        return error_of([&] { static_cast<void>(quadratic_simplices<kDim>(mesh, "a.pent")); });
    };
    SimplexMesh<kDim> mesh = quadratic_cube<kDim>(1);
    SimplexMesh<kDim> few = mesh;
    few.cells.conservativeResize(kDim + 1, mesh.cell_count() - 1);
    few.parents.pop_back();
    expect_contains(message(few), {"a.pent: ", "no multiple of", "pent-mesh --quadratic"});
    SimplexMesh<kDim> unlabeled = mesh;
    unlabeled.parents.clear();  // its cells are in the order of cubes
    expect_contains(message(unlabeled),
                    {"a.pent: cell 0", "do not make up", "pent-mesh --quadratic"});
    SimplexMesh<kDim> mislabeled = mesh;
    mislabeled.parents[0] = 4000;
    expect_contains(message(mislabeled), {"a.pent: parent ", "pent-mesh --quadratic"});
    SimplexMesh<kDim> swapped = mesh;
    const auto other = std::find_if(swapped.parents.begin(), swapped.parents.end(),
                                    [&](std::uint32_t p) { return p != swapped.parents[0]; });
    std::swap(swapped.parents[0], *other);
    expect_contains(message(swapped), {"a.pent: cell ", "do not make up"});
    // A quarter of the edge is where the Jacobian at its end reaches zero.
    SimplexMesh<kDim> folded = mesh;
    const QuadraticSimplices<kDim> simplices = quadratic_simplices<kDim>(mesh, "box");
    folded.positions.col(simplices(kDim + 1, 0)) =
        0.76 * mesh.positions.col(simplices(0, 0)) + 0.24 * mesh.positions.col(simplices(1, 0));
    expect_contains(message(folded), {"a.pent: ", " quadratic cells are folded at rest, the worst",
                                      " that of cell ", " m, expected none"});
}

// A bar of which several ranks have parts.
template <int Dim>
SimplexMesh<Dim> quadratic_bar() {
    std::array<int, Dim> count{};
    count.fill(1);
    count[0] = 4;
    std::array<double, Dim> size{};
    size.fill(0.5);
    size[0] = 2;
    return pent::test::quadratic_kuhn_box<Dim>(count, size);
}

// What ranks with parts of the mesh say, in the words of one process that has the whole.
template <int Dim>
std::string refused_by_all(const SimplexMesh<Dim>& mesh) {
    Scene scene = test::box_scene<Dim>();
    scene.solver.elements = ElementKind::Quadratic;
    const std::string alone = error_of([&] { (void)make_bodies<Dim>(scene, {mesh}); });
    for (const int count : {1, 2, 3, 4}) {
        test::on_ranks(count, [&](const std::shared_ptr<const Ranks>& ranks) {
            EXPECT_EQ(error_of([&] {
                          (void)make_part_bodies<Dim>(
                              scene, test::cut_meshes<Dim>(scene, {mesh}, *ranks), ranks);
                      }),
                      alone);
        });
    }
    return alone;
}

// Of several faults the lowest one, whichever ranks have found them.
TYPED_TEST(QuadraticCellsTest, AreRefusedByRanksInTheWordsOfOne) {
    constexpr int kDim = TypeParam::value;
    const SimplexMesh<kDim> mesh = quadratic_bar<kDim>();
    SimplexMesh<kDim> few = mesh;
    few.cells.conservativeResize(Eigen::NoChange, mesh.cell_count() - 1);
    few.parents.pop_back();
    expect_contains(refused_by_all<kDim>(few), {"no multiple of"});
    SimplexMesh<kDim> unlabeled = mesh;
    unlabeled.parents.clear();
    expect_contains(refused_by_all<kDim>(unlabeled), {"cell 0 and", "do not make up"});
    std::vector<std::uint32_t> parents = mesh.parents;
    std::sort(parents.begin(), parents.end());
    parents.erase(std::unique(parents.begin(), parents.end()), parents.end());
    const auto child_of = [](SimplexMesh<kDim>& changed, std::uint32_t parent) -> std::uint32_t& {
        return *std::find(changed.parents.begin(), changed.parents.end(), parent);
    };
    SimplexMesh<kDim> mislabeled = mesh;
    SimplexMesh<kDim> swapped = mesh;
    for (const double place : {1.0, 0.6, 0.3, 0.0}) {
        const auto at = static_cast<std::size_t>(place * static_cast<double>(parents.size() - 2));
        child_of(mislabeled, parents[at]) = 4000;
        expect_contains(refused_by_all<kDim>(mislabeled),
                        {"parent " + std::to_string(parents[at]) + " with "
                         + std::to_string((1 << kDim) - 1) + " cells"});
        std::uint32_t& one = child_of(swapped, parents[at]);
        std::swap(one, child_of(swapped, parents[at + 1]));
        expect_contains(refused_by_all<kDim>(swapped), {"cell ", "do not make up"});
    }
}

// As many as all ranks have found, and the worst of all.
TYPED_TEST(QuadraticCellsTest, AreFoldedForRanksAsForOne) {
    constexpr int kDim = TypeParam::value;
    SimplexMesh<kDim> mesh = quadratic_bar<kDim>();
    const QuadraticSimplices<kDim> simplices = quadratic_simplices<kDim>(mesh, "bar");
    std::string said;
    for (const auto& [place, share] :
         {std::pair(0.0, 0.235), {0.3, 0.22}, {0.6, 0.23}, {1.0, 0.21}}) {
        const auto at =
            static_cast<Eigen::Index>(place * static_cast<double>(simplices.cols() - 1));
        mesh.positions.col(simplices(kDim + 1, at)) =
            (1 - share) * mesh.positions.col(simplices(0, at))
            + share * mesh.positions.col(simplices(1, at));
        const std::string now = refused_by_all<kDim>(mesh);
        expect_contains(now, {" quadratic cells are folded at rest, the worst", " that of cell "});
        EXPECT_NE(now, said);
        said = now;
    }
}

}  // namespace
}  // namespace pent::simulator
