#include "elastic_box.h"
#include "scenes.h"

#include <pent/simulator/energy.h>
#include <pent/simulator/simulation.h>

#include <gtest/gtest.h>

namespace pent::simulator {
namespace {

using test::box_scene;
using test::ElasticBox;

// A base of tetrahedra extruded by two layers, as the mesher does it: {b0..bk, tk..t3}.
SimplexMesh<4> extruded(const SimplexMesh<3>& base, const std::vector<double>& heights) {
    const Eigen::Index n = base.vertex_count();
    SimplexMesh<4> mesh;
    mesh.positions.resize(4, n * static_cast<Eigen::Index>(heights.size()));
    for (std::size_t layer = 0; layer < heights.size(); ++layer) {
        const auto at = static_cast<Eigen::Index>(layer) * n;
        mesh.positions.block(0, at, 3, n) = base.positions;
        mesh.positions.row(3).segment(at, n).setConstant(heights[layer]);
    }
    const auto slabs = static_cast<Eigen::Index>(heights.size()) - 1;
    mesh.cells.resize(5, base.cell_count() * slabs * 4);
    Eigen::Index next = 0;
    for (Eigen::Index slab = 0; slab < slabs; ++slab) {
        for (Eigen::Index cell = 0; cell < base.cell_count(); ++cell) {
            Eigen::Matrix<std::uint32_t, 4, 1> corners = base.cells.col(cell);
            std::sort(corners.begin(), corners.end());
            const auto low = static_cast<std::uint32_t>(slab * n);
            for (int k = 0; k < 4; ++k, ++next) {
                for (int c = 0; c <= k; ++c) {
                    mesh.cells(c, next) = corners[c] + low;
                }
                for (int c = k; c < 4; ++c) {
                    mesh.cells(c + 1, next) = corners[c] + low + static_cast<std::uint32_t>(n);
                }
                if (cell_volume<4>(mesh.positions, mesh.cells, next) < 0) {
                    std::swap(mesh.cells(3, next), mesh.cells(4, next));
                }
            }
        }
    }
    return mesh;
}

template <int Dim>
struct Assembled {
    Positions<Dim> forces;
    Eigen::MatrixXd stiffness;

    Assembled(const SimplexMesh<Dim>& mesh, const Positions<Dim>& x, const Material& material) {
        std::vector<std::uint32_t> own(static_cast<std::size_t>(mesh.vertex_count()));
        std::iota(own.begin(), own.end(), 0U);
        const DofMap dofs =
            number_dofs<Dim>(mesh.cells, std::vector<bool>(own.size(), false), {own, own});
        const BlockPattern pattern = make_pattern<Dim>(mesh.cells, dofs);
        const std::vector<CellRange> ranges = {{0, mesh.cell_count(), material}};
        const Elements<Dim> elements(mesh.positions, mesh.cells, ranges, dofs, pattern);
        forces.setZero(Dim, mesh.vertex_count());
        static_cast<void>(
            elements.add_gradient(Workers(1), kernels<Dim>(Isa::Baseline), x, forces));
        forces = -forces;
        BlockMatrix<Dim, double> K(pattern);
        elements.add_hessian(Workers(1), kernels<Dim>(Isa::Baseline), x,
                             target_in(K, 1, Filter::None));
        const Eigen::MatrixXd by_unknown = ElasticBox<Dim>::dense(K);
        stiffness.resizeLike(by_unknown);
        for (Eigen::Index a = 0; a < mesh.vertex_count(); ++a) {
            for (Eigen::Index b = 0; b < mesh.vertex_count(); ++b) {
                stiffness.template block<Dim, Dim>(Dim * a, Dim * b) =
                    by_unknown.template block<Dim, Dim>(
                        Dim * dofs.dof_of(static_cast<std::uint32_t>(a)),
                        Dim * dofs.dof_of(static_cast<std::uint32_t>(b)));
            }
        }
    }
};

// E copies a 3D state to every layer: E^T f4(E x) = H f3(x), E^T K4 E = H K3, H the thickness.
TEST(ExtrudedBody, ReducedByColumnsIsTheBodyInThreeDimensions) {
    const SimplexMesh<3> base = pent::test::kuhn_box<3>({2, 1, 1}, {1, 0.5, 0.7});
    const SimplexMesh<4> mesh = extruded(base, {-0.2, 0.1, 0.7});
    const double thickness = 0.9;
    const Eigen::Index n = base.vertex_count();
    std::mt19937 random(3);
    std::normal_distribution<double> normal(0, 0.1);
    const Positions<3> x3 = base.positions.unaryExpr([&](double x) { return x + normal(random); });
    Positions<4> x4 = mesh.positions;
    for (Eigen::Index v = 0; v < mesh.vertex_count(); ++v) {
        x4.col(v).head<3>() = x3.col(v % n);
    }
    for (const Model model : {Model::StableNeoHookean, Model::StVenantKirchhoff, Model::Linear}) {
        const Material material{.model = model, .lame = {.lambda = 1.3, .mu = 0.7}};
        const Assembled<3> three(base, x3, material);
        const Assembled<4> four(mesh, x4, material);
        Positions<3> forces = Positions<3>::Zero(3, n);
        Eigen::MatrixXd stiffness = Eigen::MatrixXd::Zero(3 * n, 3 * n);
        for (Eigen::Index a = 0; a < mesh.vertex_count(); ++a) {
            forces.col(a % n) += four.forces.col(a).head<3>();
            for (Eigen::Index b = 0; b < mesh.vertex_count(); ++b) {
                stiffness.block<3, 3>(3 * (a % n), 3 * (b % n)) +=
                    four.stiffness.block<3, 3>(4 * a, 4 * b);
            }
        }
        EXPECT_LT((forces - thickness * three.forces).norm(), 1e-12 * three.forces.norm());
        EXPECT_LT((stiffness - thickness * three.stiffness).norm(), 1e-12 * three.stiffness.norm());
    }
}

TEST(ExtrudedBody, HasColumnMassesOfTheBodyInThreeDimensions) {
    const SimplexMesh<3> base = pent::test::kuhn_box<3>({2, 1, 1}, {1, 0.5, 0.7});
    const SimplexMesh<4> mesh = extruded(base, {-0.2, 0.1, 0.7});
    const Simulation<3> three(box_scene<3>(), {base});
    const Simulation<4> four(box_scene<4>(), {mesh});
    Eigen::VectorXd sums = Eigen::VectorXd::Zero(base.vertex_count());
    for (Eigen::Index v = 0; v < mesh.vertex_count(); ++v) {
        sums[v % base.vertex_count()] += four.masses(0)[v];
    }
    EXPECT_LT((sums - 0.9 * three.masses(0)).norm(), 1e-12 * sums.norm());
}

}  // namespace
}  // namespace pent::simulator
