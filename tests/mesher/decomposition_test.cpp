#include <pent/mesher/decomposition.h>
#include <pent/mesher/edge_order.h>
#include <pent/mesher/straight_layers.h>

#include <gtest/gtest.h>

#include <algorithm>
#include <numeric>
#include <set>

namespace pent::mesher {
namespace {

TEST(ProveDecompositions, FindsTheKnownCounts) {
    // 2^(n (n-1) / 2) tournaments, n! of them transitive, every other one with a 3-cycle.
    const std::int64_t orientations[] = {2, 8, 64, 1024, 32768};
    const std::int64_t acyclic[] = {2, 6, 24, 120, 720};
    const std::int64_t neighbors[] = {6, 24, 120, 720, 5040};
    for (int n = 2; n <= 6; ++n) {
        const DecompositionProof proof = prove_decompositions(n);
        EXPECT_TRUE(proof.holds()) << n;
        EXPECT_EQ(proof.orientations, orientations[n - 2]);
        EXPECT_EQ(proof.acyclic, acyclic[n - 2]);
        EXPECT_EQ(proof.filled, acyclic[n - 2]);
        EXPECT_EQ(proof.with_triangle, orientations[n - 2] - acyclic[n - 2]);
        EXPECT_EQ(proof.neighbors, neighbors[n - 2]);
        EXPECT_EQ(proof.agreeing, neighbors[n - 2]);
        EXPECT_EQ(proof.is_searched, n <= 4);
    }
    EXPECT_EQ(prove_decompositions(3).impossible, 2);
    EXPECT_EQ(prove_decompositions(4).impossible, 40);
    EXPECT_EQ(prove_decompositions(4).unique, 24);
}

TEST(DecompositionProof, DoesNotHoldIfAnyCountIsShort) {
    const DecompositionProof whole = prove_decompositions(3);
    for (auto count :
         {&DecompositionProof::filled, &DecompositionProof::unique, &DecompositionProof::impossible,
          &DecompositionProof::with_triangle, &DecompositionProof::agreeing}) {
        DecompositionProof broken = whole;
        --(broken.*count);
        EXPECT_FALSE(broken.holds());
    }
    EXPECT_FALSE(DecompositionProof().holds());
}

// What extrude() makes of one simplex, as sets of corners.
template <int Dim>
std::set<Corners> extruded(const std::vector<int>& order) {
    SimplexMesh<Dim - 1> base;
    base.positions.setZero(Dim - 1, Dim);
    base.positions.rightCols(Dim - 1).setIdentity();
    base.cells.resize(Dim, 1);
    std::iota(base.cells.data(), base.cells.data() + Dim, 0U);
    std::vector<std::uint32_t> ranks(Dim);
    for (int i = 0; i < Dim; ++i) {
        ranks[order[i]] = i;
    }
    const auto ordered = order_cells<Dim - 1>(base, direct_edges<Dim - 1>(base, ranks));
    Eigen::Matrix<double, Dim, 1> up = Eigen::Matrix<double, Dim, 1>::Zero();
    up[Dim - 1] = 1;
    const SimplexMesh<Dim> mesh = extrude<Dim>(base, ordered, straight_layers<Dim>(up, 1));
    std::set<Corners> simplices;
    for (const auto& cell : mesh.cells.colwise()) {
        Corners corners = 0;
        for (const std::uint32_t v : cell) {
            corners |= 1U << (mesh.layers[v] * Dim + mesh.columns[v]);
        }
        simplices.insert(corners);
    }
    return simplices;
}

template <int Dim>
void expect_extrusion_is_proved() {
    std::vector<int> order(Dim);
    std::iota(order.begin(), order.end(), 0);
    do {
        const std::vector<Corners> proved = path_decomposition(order);
        EXPECT_EQ(extruded<Dim>(order), std::set<Corners>(proved.begin(), proved.end()));
    } while (std::next_permutation(order.begin(), order.end()));
}

TEST(PathDecomposition, IsWhatExtrudeMakes) {
    expect_extrusion_is_proved<2>();
    expect_extrusion_is_proved<3>();
    expect_extrusion_is_proved<4>();
}

}  // namespace
}  // namespace pent::mesher
