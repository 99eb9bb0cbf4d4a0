#include "potentials/element_layout.h"

#include "elastic_box.h"
#include "model/rotation.h"

#include <gtest/gtest.h>

#include <set>
#include <utility>

namespace pent::simulator {
namespace {

using test::ElasticBox;

using Dimensions = testing::Types<std::integral_constant<int, 3>, std::integral_constant<int, 4>>;

template <typename T>
class ElementLayoutTest : public testing::Test {};
TYPED_TEST_SUITE(ElementLayoutTest, Dimensions);

using Pairs = std::set<std::pair<std::uint32_t, std::uint32_t>>;

Pairs pairs_of(const BlockPattern& pattern) {
    Pairs pairs;
    for (std::int64_t row = 0; row < pattern.rows(); ++row) {
        const auto r = static_cast<std::size_t>(row);
        for (std::int64_t k = pattern.row_start[r]; k < pattern.row_start[r + 1]; ++k) {
            pairs.emplace(static_cast<std::uint32_t>(row),
                          pattern.columns[static_cast<std::size_t>(k)]);
        }
    }
    return pairs;
}

// Pairs of vertices, found by moving one after the other: those whose forces change with the place
// of another. Forces of a body that is pulled in every direction depend on all that an element has.
template <int Dim>
Pairs pairs_that_feel_each_other(const ElasticBox<Dim>& box) {
    Positions<Dim> before;
    static_cast<void>(box.forces(Isa::Baseline, box.positions, before));
    Pairs pairs;
    for (Eigen::Index v = 0; v < box.positions.cols(); ++v) {
        Positions<Dim> moved = box.positions;
        moved.col(v) += Vector<Dim>::LinSpaced(0.01, 0.03);
        Positions<Dim> after;
        static_cast<void>(box.forces(Isa::Baseline, moved, after));
        const std::uint32_t own = box.dofs.index_of(static_cast<std::uint32_t>(v));
        for (Eigen::Index u = 0; u < box.positions.cols(); ++u) {
            const std::uint32_t other = box.dofs.index_of(static_cast<std::uint32_t>(u));
            const bool both = own < box.dofs.count() && other < box.dofs.count();
            if (both && own <= other && (after.col(u) - before.col(u)).norm() > 1e-9) {
                pairs.emplace(own, other);
            }
        }
    }
    return pairs;
}

// A block for every pair that feels each other, and, since memory and time go with their number,
// none but those of vertices of one element.
TYPED_TEST(ElementLayoutTest, HasABlockForEveryPairThatFeelsEachOther) {
    constexpr int kDim = TypeParam::value;
    for (const ElementKind kind : test::kElementKinds) {
        ElasticBox<kDim> box({.lame = {.lambda = 2, .mu = 1}}, {0, 3}, kind);
        box.scramble(0.02, 1);
        const Pairs expected = pairs_that_feel_each_other(box);
        EXPECT_GT(expected.size(), box.dofs.count());
        EXPECT_EQ(pairs_of(box.pattern), expected) << static_cast<int>(kind);
    }
}

}  // namespace
}  // namespace pent::simulator
