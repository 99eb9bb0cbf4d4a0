#include "model/nearest_in_body.h"

#include "scenes.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <limits>
#include <numeric>

namespace pent::simulator {
namespace {

using test::bar;

// Two bars side by side, some of whose vertices the other has in it; the second is turned.
Bodies<4> overlapping_bars() {
    Scene scene = test::box_scene<4>();
    scene.bodies.resize(2, scene.bodies[0]);
    scene.bodies[1].name = "second";
    scene.bodies[1].place.rotate = {{{0, 3}, 30}};
    scene.bodies[1].place.translate = Eigen::Vector4d(0.3, 0.1, 0.2, 0);
    return make_bodies<4>(scene, {bar(2), bar(3)});
}

// Cell by cell.
TEST(NearestInBody, IsTheNearestOfAllCellsOfTheBodyAndTheFirstOfThoseAlikeFar) {
    const Bodies<4> bodies = overlapping_bars();
    std::vector<std::uint32_t> vertices(static_cast<std::size_t>(bodies.vertex_count()));
    std::iota(vertices.begin(), vertices.end(), 0U);
    for (std::size_t body = 0; body < 2; ++body) {
        const MaterialPoints<4> found = nearest_in_body<4>(Workers(2), bodies, body, vertices);
        ASSERT_EQ(found.size(), vertices.size());
        const auto [begin, size] = bodies.cells_of(body);
        int inside = 0;  // of those of the other body
        for (std::size_t i = 0; i < vertices.size(); ++i) {
            const Vector<4> point = bodies.rest().col(vertices[i]);
            std::vector<MaterialPoint<4>> of_cells;
            double least = std::numeric_limits<double>::infinity();
            for (Eigen::Index cell = begin; cell < begin + size; ++cell) {
                const Simplices<5> alone = bodies.cells().col(cell);
                of_cells.push_back(
                    NearestPointSearch<4>(bodies.rest(), alone).nearest_in(0, point));
                least = std::min(least, of_cells.back().distance);
            }
            const auto first = std::find_if(of_cells.begin(), of_cells.end(), [&](const auto& one) {
                return one.distance <= least + 1e-12;
            });
            inside += bodies.body_of(vertices[i]) != body && least == 0 ? 1 : 0;
            EXPECT_NEAR(found[i].distance, least, 1e-13);
            EXPECT_EQ(found[i].vertices, first->vertices);
            EXPECT_EQ(found[i].weights, first->weights);
        }
        EXPECT_GT(inside, 0);
    }
}

TEST(NearestInBody, IsTheVertexItselfOfItsOwnBody) {
    const Bodies<4> bodies = overlapping_bars();
    const auto last = static_cast<std::uint32_t>(bodies.vertex_count() - 1);
    const MaterialPoints<4> found = nearest_in_body<4>(Workers(1), bodies, 1, {last});
    EXPECT_NEAR(found[0].distance, 0, 1e-14);
    for (int k = 0; k < 5; ++k) {
        EXPECT_NEAR(found[0].weights[k],
                    found[0].vertices[static_cast<std::size_t>(k)] == last ? 1 : 0, 1e-12);
    }
    EXPECT_TRUE(nearest_in_body<4>(Workers(1), bodies, 1, {}).empty());
}

}  // namespace
}  // namespace pent::simulator
