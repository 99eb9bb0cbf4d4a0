#include "model/distance_field.h"

#include "cut_meshes.h"
#include "scenes.h"
#include "support/fork.h"
#include "support/kuhn_box.h"
#include "thread_ranks.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <numeric>
#include <random>

namespace pent::simulator {
namespace {

using pent::test::kuhn_box;

template <typename T>
class DistanceWithin : public testing::Test {};
using Dimensions = testing::Types<std::integral_constant<int, 3>, std::integral_constant<int, 4>>;
TYPED_TEST_SUITE(DistanceWithin, Dimensions);

template <int Dim>
std::array<int, Dim> counts(int count) {
    std::array<int, Dim> all{};
    all.fill(count);
    return all;
}

template <int Dim>
std::array<double, Dim> sides(double side) {
    std::array<double, Dim> all{};
    all.fill(side);
    return all;
}

template <int Dim, typename IsSource>
std::vector<std::uint32_t> vertices_where(const SimplexMesh<Dim>& mesh, const IsSource& is_source) {
    std::vector<std::uint32_t> found;
    for (std::uint32_t v = 0; v < mesh.vertex_count(); ++v) {
        if (is_source(mesh.positions.col(v))) {
            found.push_back(v);
        }
    }
    return found;
}

// A plane wave is what each update supposes: exact.
TYPED_TEST(DistanceWithin, FromAFaceOfABoxIsTheCoordinateAndItsGradientTheAxis) {
    constexpr int kDim = TypeParam::value;
    SimplexMesh<kDim> mesh = kuhn_box<kDim>(counts<kDim>(3), sides<kDim>(0.9));
    mesh.positions.row(1) *= 1.7;
    const Eigen::VectorXd distance = distance_within<kDim>(
        {mesh}, vertices_where(mesh, [](const auto& x) { return x[1] < 1e-9; }));
    EXPECT_LT((distance.transpose() - mesh.positions.row(1)).cwiseAbs().maxCoeff(), 1e-13);
    for (Eigen::Index cell = 0; cell < mesh.cell_count(); ++cell) {
        const Eigen::Matrix<double, kDim, 1> up = Eigen::Matrix<double, kDim, 1>::Unit(1);
        EXPECT_LT((gradient_in_cell(mesh, cell, distance) - up).norm(), 1e-12);
    }
}

// Ways from a corner of a box are straight lines, which a mesh makes longer, never shorter; less so
// the finer it is, and no longer than the way along its edges, which lead along every diagonal:
// with the coordinates in decreasing order, (a - b) + (b - c) sqrt(2) + c sqrt(3) in three
// dimensions.
TYPED_TEST(DistanceWithin, FromACornerIsNoShorterThanALineAndConvergesToIt) {
    constexpr int kDim = TypeParam::value;
    const auto largest_error = [](int count) {
        const SimplexMesh<kDim> mesh = kuhn_box<kDim>(counts<kDim>(count), sides<kDim>(1));
        const Eigen::VectorXd distance = distance_within<kDim>({mesh}, {0});
        const Eigen::VectorXd line =
            (mesh.positions.colwise() - mesh.positions.col(0)).colwise().norm();
        EXPECT_GT((distance - line).minCoeff(), -1e-12);
        for (Eigen::Index v = 0; v < mesh.vertex_count(); ++v) {
            Eigen::Matrix<double, kDim, 1> x = mesh.positions.col(v);
            std::sort(x.begin(), x.end());
            double along_edges = 0;
            for (int axis = 0; axis < kDim; ++axis) {
                const double rise = x[axis] - (axis > 0 ? x[axis - 1] : 0);
                along_edges += rise * std::sqrt(kDim - axis);
            }
            EXPECT_LT(distance[v], along_edges + 1e-12);
        }
        return (distance - line).maxCoeff();
    };
    EXPECT_LT(largest_error(6), largest_error(3));
}

// Around a corner of an L the shortest way is that along its inner edges.
TYPED_TEST(DistanceWithin, GoesAroundWhatIsNotOfTheBody) {
    constexpr int kDim = TypeParam::value;
    std::array<int, kDim> count = counts<kDim>(1);
    std::array<double, kDim> side = sides<kDim>(1);
    count[0] = count[1] = 6;
    side[0] = side[1] = 6;
    SimplexMesh<kDim> mesh = kuhn_box<kDim>(count, side);
    Simplices<kDim + 1> kept(kDim + 1, 0);
    for (Eigen::Index cell = 0; cell < mesh.cell_count(); ++cell) {
        Eigen::Matrix<double, kDim, 1> center = Eigen::Matrix<double, kDim, 1>::Zero();
        for (const std::uint32_t v : mesh.cells.col(cell)) {
            center += mesh.positions.col(v) / (kDim + 1);
        }
        if (center[0] < 1 || center[1] < 1) {
            kept.conservativeResize(Eigen::NoChange, kept.cols() + 1);
            kept.rightCols(1) = mesh.cells.col(cell);
        }
    }
    mesh.cells = kept;
    const auto at = [&](double x, double y) {
        return vertices_where(mesh, [&](const auto& p) {
            return std::abs(p[0] - x) < 1e-9 && std::abs(p[1] - y) < 1e-9;
        });
    };
    const Eigen::VectorXd distance = distance_within<kDim>({mesh}, at(6, 1));
    for (const std::uint32_t v : at(1, 6)) {
        EXPECT_NEAR(distance[v], 10, 1e-9);  // 5 to the inner corner, 5 from there
    }
    for (const std::uint32_t v : at(6, 6)) {
        EXPECT_EQ(distance[v], std::numeric_limits<double>::infinity());  // of no cell
    }
}

// A box whose cells lean so far that many of their angles are obtuse, no two alike.
template <int Dim>
SimplexMesh<Dim> leaning_box(int count) {
    SimplexMesh<Dim> mesh = kuhn_box<Dim>(counts<Dim>(count), sides<Dim>(1));
    mesh.positions.row(0) -= 0.8 * mesh.positions.row(1) + 0.5 * mesh.positions.row(Dim - 1);
    std::mt19937 random(3);
    std::uniform_real_distribution<double> shift(-0.1 / count, 0.1 / count);
    for (double& x : mesh.positions.reshaped()) {
        x += shift(random);
    }
    return mesh;
}

// The least of a convex function over the simplex of weights that add up to at most `left`, the
// first of which are set: by thirds, one weight after the other.
template <int Dim, typename Function>
double least_over_weights(Eigen::Matrix<double, Dim, 1>& weights,
                          int next,
                          double left,
                          const Function& function) {
    if (next == Dim - 1) {
        weights[next] = left;
        return function(weights);
    }
    double low = 0;
    double high = left;
    const auto at = [&](double weight) {
        weights[next] = weight;
        return least_over_weights<Dim>(weights, next + 1, left - weight, function);
    };
    while (high - low > 1e-6) {
        const double one = low + (high - low) / 3;
        const double other = high - (high - low) / 3;
        if (at(one) < at(other)) {
            high = other;
        } else {
            low = one;
        }
    }
    return std::min({at(low), at(0), at(left)});
}

// Each distance is the least of those of points of opposite facets and the way from there, whatever
// the angles of cells; thirds find it to 1e-6 of a cell.
TYPED_TEST(DistanceWithin, IsTheLeastByWayOfAnyPointOfAnOppositeFacet) {
    constexpr int kDim = TypeParam::value;
    const SimplexMesh<kDim> mesh = leaning_box<kDim>(kDim == 3 ? 2 : 1);
    const Eigen::VectorXd distance = distance_within<kDim>({mesh}, {0});
    Eigen::VectorXd least =
        Eigen::VectorXd::Constant(mesh.vertex_count(), std::numeric_limits<double>::infinity());
    for (const auto cell : mesh.cells.colwise()) {
        for (int corner = 0; corner <= kDim; ++corner) {
            Eigen::Matrix<double, kDim, kDim> facet;
            Eigen::Matrix<double, kDim, 1> known;
            for (int other = 0, column = 0; other <= kDim; ++other) {
                if (other != corner) {
                    facet.col(column) = mesh.positions.col(cell[other]);
                    known[column++] = distance[cell[other]];
                }
            }
            const Eigen::Matrix<double, kDim, 1> x = mesh.positions.col(cell[corner]);
            Eigen::Matrix<double, kDim, 1> weights;
            least[cell[corner]] =
                std::min(least[cell[corner]],
                         least_over_weights<kDim>(weights, 0, 1, [&](const auto& w) -> double {
                             return w.dot(known) + (x - facet * w).norm();
                         }));
        }
    }
    for (Eigen::Index v = 1; v < mesh.vertex_count(); ++v) {
        EXPECT_NEAR(distance[v], least[v], 1e-6) << v;
    }
}

// Which vertex comes first decides about rounding alone.
TYPED_TEST(DistanceWithin, DependsOnNoOrderOfVerticesOrCells) {
    constexpr int kDim = TypeParam::value;
    const SimplexMesh<kDim> mesh = leaning_box<kDim>(3);
    const Eigen::VectorXd distance = distance_within<kDim>({mesh}, {0});
    std::vector<std::uint32_t> order(static_cast<std::size_t>(mesh.vertex_count()));
    std::iota(order.begin(), order.end(), 0U);
    std::shuffle(order.begin() + 1, order.end(), std::mt19937(5));
    SimplexMesh<kDim> other = mesh;
    for (Eigen::Index v = 0; v < mesh.vertex_count(); ++v) {
        other.positions.col(order[static_cast<std::size_t>(v)]) = mesh.positions.col(v);
    }
    for (Eigen::Index cell = 0; cell < mesh.cell_count(); ++cell) {
        for (int corner = 0; corner <= kDim; ++corner) {
            other.cells(kDim - corner, mesh.cell_count() - 1 - cell) =
                order[mesh.cells(corner, cell)];
        }
    }
    const Eigen::VectorXd again = distance_within<kDim>({other}, {0})(order);
    for (Eigen::Index v = 0; v < mesh.vertex_count(); ++v) {
        EXPECT_NEAR(again[v], distance[v], 1e-12 * distance[v]) << v;
    }
}

// What ranks find is what one finds, but for rounding, and the same to the bit on all of them.
template <int Dim>
void expect_same_on_ranks(const SimplexMesh<Dim>& mesh, const std::vector<std::uint32_t>& sources) {
    const Scene scene = test::box_scene<Dim>();
    const Eigen::VectorXd alone = distance_within<Dim>({mesh}, sources);
    for (const int count : {1, 2, 3, 4}) {
        const std::vector<std::uint32_t> owners = share_vertices<Dim>(scene, {mesh}, count);
        std::vector<Eigen::VectorXd> found(static_cast<std::size_t>(count));
        test::on_ranks(count, [&](const std::shared_ptr<const Ranks>& ranks) {
            const MeshPart<Dim> part = test::cut_meshes<Dim>(scene, {mesh}, *ranks)[0];
            ASSERT_EQ(part.mesh.cell_count() < mesh.cell_count(), count > 1);
            Eigen::VectorXd& own = found[static_cast<std::size_t>(ranks->rank())];
            own = distance_within<Dim>({part.mesh, owners, ranks.get()}, sources);
            for (const std::uint32_t v : part.mesh.cells.reshaped()) {
                EXPECT_NEAR(own[v], alone[v], 1e-12 * alone[v]) << count << " " << v;
            }
            std::vector<bool> is_here(owners.size(), false);
            for (const std::uint32_t v : part.mesh.cells.reshaped()) {
                is_here[v] = true;
            }
            for (std::uint32_t v = 0; v < owners.size(); ++v) {
                own[v] = is_here[v] ? own[v] : std::numeric_limits<double>::quiet_NaN();
            }
        });
        for (std::uint32_t v = 0; v < owners.size(); ++v) {
            for (const Eigen::VectorXd& own : found) {
                EXPECT_TRUE(std::isnan(own[v]) || own[v] == found[owners[v]][v]) << count << v;
            }
        }
    }
}

TYPED_TEST(DistanceWithin, IsTheSameOnRanks) {
    constexpr int kDim = TypeParam::value;
    const SimplexMesh<kDim> box = leaning_box<kDim>(3);
    expect_same_on_ranks(box, {0});
    const auto last = static_cast<std::uint32_t>(box.vertex_count() - 1);
    expect_same_on_ranks(box, {0, last / 3, last});
}

// All sources are on one rank, with the ends of both arms of a fork: ways lead through the other.
TYPED_TEST(DistanceWithin, LeadsThroughOtherRanksAndBack) {
    constexpr int kDim = TypeParam::value;
    const SimplexMesh<kDim> mesh = pent::test::fork<kDim>();
    const auto end_of_arm = [&](double low, double high) {
        return vertices_where(
            mesh, [&](const auto& x) { return x[0] > 5.5 && low < x[1] && x[1] < high; });
    };
    const std::vector<std::uint32_t> sources = end_of_arm(-0.5, 1.5);
    const std::vector<std::uint32_t> others = end_of_arm(1.5, 3.5);
    const std::vector<std::uint32_t> owners =
        share_vertices<kDim>(test::box_scene<kDim>(), {mesh}, 2);
    for (const std::uint32_t v : sources) {
        ASSERT_EQ(owners[v], owners[others[0]]);
    }
    for (const std::uint32_t v : vertices_where(mesh, [](const auto& x) { return x[0] < 1.5; })) {
        ASSERT_NE(owners[v], owners[others[0]]);
    }
    const Eigen::VectorXd distance = distance_within<kDim>({mesh}, sources);
    for (const std::uint32_t v : end_of_arm(1.5, 2.5)) {
        EXPECT_NEAR(distance[v], 11, 1e-9);  // along the inner edges
    }
    expect_same_on_ranks(mesh, sources);
}

}  // namespace
}  // namespace pent::simulator
