#include "potentials/elements.h"

#include "kernel_reference.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <map>
#include <set>
#include <utility>

// Elements of several materials, more of them than a chunk has, laid out for kernels: what they add
// up to against the theory, element by element.

namespace pent::simulator {
namespace {

using test::ElasticBox;
using test::MatrixXd;
using test::Reference;

using Dimensions = testing::Types<std::integral_constant<int, 3>, std::integral_constant<int, 4>>;

template <typename T>
class ElementsTest : public testing::Test {};
TYPED_TEST_SUITE(ElementsTest, Dimensions);

const Material kFirst{.lame = {.lambda = 1.3, .mu = 0.7}};
const Material kSecond{.model = Model::StVenantKirchhoff, .lame = {.lambda = 3, .mu = 2}};

// 576 cells, or 72 (in 4D 48) quadratic ones.
template <int Dim>
SimplexMesh<Dim> mesh_for(ElementKind kind) {
    const bool is_quadratic = kind == ElementKind::Quadratic;
    std::array<int, Dim> count{};
    std::array<double, Dim> size{};
    count.fill(is_quadratic && Dim == 4 ? 1 : 2);
    count[0] = is_quadratic && Dim == 4 ? 2 : 3;
    if (!is_quadratic && Dim == 3) {
        count = {6, 4, 4};
    }
    size.fill(1);
    size[0] = 1.4;
    return is_quadratic ? pent::test::quadratic_kuhn_box<Dim>(count, size)
                        : pent::test::kuhn_box<Dim>(count, size);
}

// A body of which the last tenth of the elements has another material.
template <int Dim>
struct TwoMaterials {
    ElementKind kind;
    ElasticBox<Dim> box;  // its cells become those of a range where a reference is asked for
    SimplexMesh<Dim> mesh = box.mesh;
    QuadraticCells<Dim> quadratic;
    std::vector<CellRange> ranges;
    ElementLayout<Dim> layout;

    TwoMaterials(ElementKind of, const std::vector<bool>& is_held)
        : kind(of), box(mesh_for<Dim>(of), kFirst, of, is_held), layout(lay_out()) {
        box.scramble(0.02, 5);
    }

    ElementLayout<Dim> lay_out() {
        const bool is_quadratic = kind == ElementKind::Quadratic;
        if (is_quadratic) {
            quadratic.nodes = quadratic_simplices<Dim>(mesh, "box");
        }
        const Eigen::Index count = is_quadratic ? quadratic.nodes.cols() : mesh.cell_count();
        const Eigen::Index cut = count - count / 10;
        ranges = {{.begin = 0, .end = cut, .material = kFirst},
                  {.begin = cut, .end = count, .material = kSecond, .region = 1}};
        quadratic.ranges = ranges;
        return is_quadratic
                   ? lay_out_elements<Dim>(mesh.positions, quadratic, box.dofs)
                   : lay_out_elements<Dim>(mesh.positions, mesh.cells, ranges, box.dofs, kind);
    }

    // Those of the range alone.
    [[nodiscard]] SimplexMesh<Dim> part(const CellRange& range) const {
        SimplexMesh<Dim> part = mesh;
        if (kind != ElementKind::Quadratic) {
            part.cells = mesh.cells.middleCols(range.begin, range.end - range.begin);
            return part;
        }
        constexpr std::ptrdiff_t kChildren = 1 << Dim;
        const std::vector<Eigen::Index> children = child_cells<Dim>(mesh, "box");
        const std::vector<Eigen::Index> own(children.begin() + kChildren * range.begin,
                                            children.begin() + kChildren * range.end);
        part.cells = mesh.cells(Eigen::all, own);
        part.parents.clear();
        for (const Eigen::Index cell : own) {
            part.parents.push_back(mesh.parents[static_cast<std::size_t>(cell)]);
        }
        return part;
    }

    [[nodiscard]] Reference<Dim> reference(std::size_t range, Filter filter) {
        box.mesh = part(ranges[range]);
        return {box, ranges[range].material, filter, kind};
    }

    // Corners of the elements of a range, found without the layout: cells, all cells at an edge, or
    // quadratic cells.
    [[nodiscard]] std::vector<std::set<std::uint32_t>> corners_of(const CellRange& range) const {
        std::vector<std::set<std::uint32_t>> corners;
        std::map<std::pair<std::uint32_t, std::uint32_t>, std::set<std::uint32_t>> edges;
        for (Eigen::Index i = range.begin; i < range.end; ++i) {
            if (kind == ElementKind::Quadratic) {
                corners.emplace_back(quadratic.nodes.col(i).begin(), quadratic.nodes.col(i).end());
                continue;
            }
            const std::set<std::uint32_t> cell(mesh.cells.col(i).begin(), mesh.cells.col(i).end());
            corners.push_back(cell);
            for (const std::uint32_t a : cell) {
                for (const std::uint32_t b : cell) {
                    if (a < b) {
                        edges[{a, b}].insert(cell.begin(), cell.end());
                    }
                }
            }
        }
        if (kind == ElementKind::Smoothed) {
            corners.clear();
            for (const auto& [edge, around] : edges) {
                corners.push_back(around);
            }
        }
        return corners;
    }
};

template <int Dim>
std::vector<bool> held_below(ElementKind kind, double x) {
    const SimplexMesh<Dim> mesh = mesh_for<Dim>(kind);
    std::vector<bool> is_held;
    for (Eigen::Index v = 0; v < mesh.vertex_count(); ++v) {
        is_held.push_back(mesh.positions(0, v) < x);
    }
    return is_held;
}

TYPED_TEST(ElementsTest, AddUpToTheTheoryOfEachMaterial) {
    constexpr int kDim = TypeParam::value;
    for (const ElementKind kind : test::kElementKinds) {
        SCOPED_TRACE(static_cast<int>(kind));
        std::vector<bool> is_held = held_below<kDim>(kind, -1);
        is_held[0] = is_held[3] = true;
        TwoMaterials<kDim> body(kind, is_held);
        const Positions<kDim>& x = body.box.positions;
        const Elements<kDim>& elements = body.layout.elements;
        for (const Filter filter : {Filter::None, Filter::Clamp}) {
            const Reference<kDim> first = body.reference(0, filter);
            const Reference<kDim> second = body.reference(1, filter);
            BlockMatrix<kDim, double> matrix(body.layout.pattern);
            static_cast<void>(elements.add_hessian(Workers(2), kernels<kDim>(best_isa()), x,
                                                   target_in(matrix, 1, filter)));
            const MatrixXd stiffness = first.stiffness + second.stiffness;
            EXPECT_LT((ElasticBox<kDim>::dense(matrix) - stiffness).norm(),
                      1e-9 * stiffness.norm());  // as of kernels, see kernels_test.cpp
            Positions<kDim> gradient = Positions<kDim>::Zero(kDim, x.cols());
            const ElasticEnergy energy =
                elements.add_gradient(Workers(2), kernels<kDim>(best_isa()), x, gradient);
            const Positions<kDim> forces = first.forces + second.forces;
            EXPECT_LT((gradient + forces).norm(), 1e-11 * (1 + forces.norm()));
            ASSERT_EQ(energy.of_ranges.size(), 2U);
            EXPECT_NEAR(energy.of_ranges[0], first.energy, 1e-12 * (1 + first.energy));
            EXPECT_NEAR(energy.of_ranges[1], second.energy, 1e-12 * (1 + second.energy));
            EXPECT_NEAR(energy.energy, first.energy + second.energy, 1e-12 * (1 + energy.energy));
        }
    }
}

// An element of which every corner is held has nothing to say of anything that is solved for.
TYPED_TEST(ElementsTest, AreThoseWithAFreeCornerAndSayTheSameOfIt) {
    constexpr int kDim = TypeParam::value;
    for (const ElementKind kind : test::kElementKinds) {
        SCOPED_TRACE(static_cast<int>(kind));
        TwoMaterials<kDim> all(kind, held_below<kDim>(kind, -1));
        TwoMaterials<kDim> some(kind, held_below<kDim>(kind, 0.8));
        for (const TwoMaterials<kDim>* body : {&all, &some}) {
            std::int64_t expected = 0;
            for (const CellRange& range : body->ranges) {
                for (const std::set<std::uint32_t>& corners : body->corners_of(range)) {
                    expected +=
                        std::any_of(corners.begin(), corners.end(),
                                    [&](std::uint32_t v) { return body->box.dofs.has_dof(v); })
                            ? 1
                            : 0;
                }
            }
            EXPECT_EQ(body->layout.elements.count(), expected);
        }
        EXPECT_LT(some.layout.elements.count(), all.layout.elements.count());
        EXPECT_LT(some.layout.elements.bytes(), all.layout.elements.bytes());
        const Positions<kDim>& x = all.box.positions;
        Positions<kDim> of_all = Positions<kDim>::Zero(kDim, x.cols());
        Positions<kDim> of_some = of_all;
        const Kernels<kDim>& isa = kernels<kDim>(best_isa());
        static_cast<void>(all.layout.elements.add_gradient(Workers(1), isa, x, of_all));
        static_cast<void>(some.layout.elements.add_gradient(Workers(1), isa, x, of_some));
        // The same sums in another order.
        const BlockVector<kDim> expected = at_dofs<kDim>(some.box.dofs, of_all);
        EXPECT_LT((at_dofs<kDim>(some.box.dofs, of_some) - expected).norm(),
                  1e-13 * expected.norm());
    }
}

TYPED_TEST(ElementsTest, AreTheSameToTheBitForAnyNumberOfThreads) {
    constexpr int kDim = TypeParam::value;
    const Kernels<kDim>& isa = kernels<kDim>(best_isa());
    for (const ElementKind kind : test::kElementKinds) {
        const TwoMaterials<kDim> body(kind, held_below<kDim>(kind, 0.1));
        const Positions<kDim>& x = body.box.positions;
        std::vector<Positions<kDim>> gradients;
        std::vector<MatrixXd> hessians;
        std::vector<double> energies;
        for (const int threads : {1, 2, 3}) {
            gradients.push_back(Positions<kDim>::Zero(kDim, x.cols()));
            energies.push_back(
                body.layout.elements.add_gradient(Workers(threads), isa, x, gradients.back())
                    .energy);
            BlockMatrix<kDim, double> matrix(body.layout.pattern);
            static_cast<void>(body.layout.elements.add_hessian(Workers(threads), isa, x,
                                                               target_in(matrix, 1, Filter::None)));
            hessians.push_back(ElasticBox<kDim>::dense(matrix));
        }
        for (std::size_t i = 1; i < 3; ++i) {
            EXPECT_EQ(gradients[i], gradients[0]);
            EXPECT_EQ(hessians[i], hessians[0]);
            EXPECT_EQ(energies[i], energies[0]);
        }
    }
}

TEST(ElasticEnergy, AddsRangeByRange) {
    ElasticEnergy sum;
    sum.of_ranges = {1, 2};
    sum.energy = 3;
    sum.inverted = 4;
    ElasticEnergy other = sum;
    other.collapsed = 5;
    sum.add(other);
    EXPECT_EQ(sum.of_ranges, (std::vector<double>{2, 4}));
    EXPECT_EQ(sum.energy, 6);
    EXPECT_EQ(sum.inverted, 8);
    EXPECT_EQ(sum.collapsed, 5);
    sum.add({});  // of nothing, as where no body sleeps
    EXPECT_EQ(sum.energy, 6);
}

}  // namespace
}  // namespace pent::simulator
