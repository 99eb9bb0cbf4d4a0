#include "step/crossing_error.h"

#include "potential_laws.h"

#include <gtest/gtest.h>

#include <string>
#include <vector>

namespace pent::simulator {
namespace {

using test::barrier_scene;
using test::Dimensions;
using test::Setting;

template <typename T>
class CrossingErrorTest : public testing::Test {};
TYPED_TEST_SUITE(CrossingErrorTest, Dimensions);

// The second of two cubes pushed into the first: every cell that is named has a simplex that
// crosses, stands where it is, and has the number of its body.
TYPED_TEST(CrossingErrorTest, HasTheCellsThatCrossWithTheirBodies) {
    constexpr int kDim = TypeParam::value;
    const Setting<kDim> setting(barrier_scene<kDim>(), 1);
    const Bodies<kDim>& bodies = setting.bodies;
    ContactPotential<kDim> contacts(setting.workers, setting.scene, setting.bodies, setting.held);
    Positions<kDim> x = bodies.rest();
    EXPECT_TRUE(contacts.find_crossings(x).empty());
    const auto [begin, size] = bodies.vertices(1);
    // Each vertex by 0.7 of the way to the same one of the other cube.
    x.middleCols(begin, size) = 0.7 * x.leftCols(begin) + 0.3 * x.middleCols(begin, size);
    const std::vector<contact::Crossing> crossings = contacts.find_crossings(x);
    ASSERT_FALSE(crossings.empty());
    const CrossingError<kDim> error = crossing_error<kDim>(bodies, contacts, crossings, x);
    const std::string message = error.what();
    EXPECT_NE(message.find(contacts.describe(crossings[0])), std::string::npos) << message;
    const std::size_t more = crossings.size() > 3 ? crossings.size() - 3 : 0;
    EXPECT_EQ(message.find("and " + std::to_string(more) + " more") != std::string::npos, more > 0);
    const SimplexMesh<kDim>& cells = error.offenders();
    ASSERT_GT(cells.cell_count(), 0);
    EXPECT_EQ(cells.regions.size(), static_cast<std::size_t>(cells.cell_count()));
    for (Eigen::Index cell = 0; cell < cells.cell_count(); ++cell) {
        const auto body = static_cast<std::size_t>(cells.regions[static_cast<std::size_t>(cell)]);
        const auto [first, count] = bodies.vertices(body);
        for (int corner = 0; corner <= kDim; ++corner) {
            const auto place = cells.positions.col(cells.cells(corner, cell));
            EXPECT_EQ((x.middleCols(first, count).colwise() - place).colwise().norm().minCoeff(),
                      0);
        }
    }
}

}  // namespace
}  // namespace pent::simulator
