#include "model/partition.h"

#include "scenes.h"
#include "support/messages.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <map>
#include <set>

namespace pent::simulator {
namespace {

Columns columns_of(const SimplexMesh<4>& mesh) {
    return {mesh.columns, mesh.layers};
}

TEST(Partition, KeepsColumnsTogetherAndGivesEveryPartAsMuch) {
    const SimplexMesh<4> mesh = test::bar(10);
    for (const int parts : {1, 2, 3, 7}) {
        const auto owners = partition_columns<4>(mesh.positions, columns_of(mesh), parts);
        std::map<std::uint32_t, std::set<std::uint32_t>> parts_of_column;
        std::map<std::uint32_t, int> sizes;
        for (std::size_t v = 0; v < owners.size(); ++v) {
            parts_of_column[mesh.columns[v]].insert(owners[v]);
            ++sizes[owners[v]];
        }
        for (const auto& [column, of] : parts_of_column) {
            EXPECT_EQ(of.size(), 1U) << column;
        }
        ASSERT_EQ(sizes.size(), static_cast<std::size_t>(parts));
        // Each cut is right to a column, of 3 vertices here, and there are at most three in a row.
        for (const auto& [part, size] : sizes) {
            EXPECT_NEAR(size, static_cast<double>(owners.size()) / parts, 9) << part;
        }
    }
}

TEST(Partition, CutsALongBodyAcross) {
    const SimplexMesh<4> mesh = test::bar(10);
    const auto owners = partition_columns<4>(mesh.positions, columns_of(mesh), 2);
    double end_of_first = 0;
    double begin_of_second = 1e9;
    for (std::size_t v = 0; v < owners.size(); ++v) {
        const double x = mesh.positions(0, static_cast<Eigen::Index>(v));
        end_of_first = owners[v] == 0 ? std::max(end_of_first, x) : end_of_first;
        begin_of_second = owners[v] == 1 ? std::min(begin_of_second, x) : begin_of_second;
    }
    EXPECT_LE(end_of_first, begin_of_second);  // the layer in the middle may be shared
}

TEST(Partition, GivesAPartToEachWhereThereAreJustAsManyColumns) {
    const SimplexMesh<4> mesh = pent::test::kuhn_box<4>({1, 1, 1, 1}, {1, 1, 1, 1});
    Columns own;
    for (std::uint32_t v = 0; v < mesh.vertex_count(); ++v) {
        own.columns.push_back(v);
        own.layers.push_back(v);
    }
    const auto owners = partition_columns<4>(mesh.positions, own, 16);
    EXPECT_EQ(std::set(owners.begin(), owners.end()).size(), 16U);
    const std::string message = pent::test::error_of(
        [&] { static_cast<void>(partition_columns<4>(mesh.positions, own, 17)); });
    pent::test::expect_contains(message, {"16 columns", "17 ranks", "start fewer"});
}

}  // namespace
}  // namespace pent::simulator
