#include "shapes/half_spaces.h"

#include <gtest/gtest.h>

#include <random>

namespace pent::mesher {
namespace {

using Eigen::Vector4d;

// Some of them twice, so that several decide at once.
std::vector<HalfSpace> scattered(int count, std::mt19937& random) {
    std::normal_distribution<double> normal;
    std::uniform_real_distribution<double> uniform(0.5, 1);
    std::vector<HalfSpace> pieces;
    for (int i = 0; i < count; ++i) {
        const Vector4d direction(normal(random), normal(random), normal(random), normal(random));
        pieces.push_back(i % 5 == 4 ? pieces[static_cast<std::size_t>(i) / 2]
                                    : HalfSpace{direction.normalized(), uniform(random)});
    }
    return pieces;
}

TEST(HalfSpaces, AreDecidedAsALookAtAllOfThemSays) {
    std::mt19937 random(1);
    std::uniform_real_distribution<double> uniform(-2, 2);
    for (const int count : {1, 2, 5, 30, 600}) {
        const std::vector<HalfSpace> pieces = scattered(count, random);
        const HalfSpaces tree(pieces);
        ASSERT_EQ(tree.count(), count);
        for (int i = 0; i < 200; ++i) {
            const Vector4d p = i == 0 ? Vector4d::Zero()
                                      : Vector4d(uniform(random), uniform(random), uniform(random),
                                                 uniform(random));
            int deciding = 0;
            for (int piece = 1; piece < count; ++piece) {
                if (tree[piece].value(p) > tree[deciding].value(p)) {
                    deciding = piece;
                }
            }
            EXPECT_EQ(tree.deciding(p), deciding);
            const double least = tree[deciding].value(p) - 0.2 * (i % 3);
            std::vector<int> above;
            for (int piece = 0; piece < count; ++piece) {
                if (tree[piece].value(p) >= least) {
                    above.push_back(piece);
                }
            }
            EXPECT_EQ(tree.pieces_above(p, least), above);
        }
    }
}

}  // namespace
}  // namespace pent::mesher
