#pragma once

#include "linear/block_matrix.h"
#include "linear/dof_map.h"
#include "potentials/element_layout.h"
#include "support/kuhn_box.h"

#include <Eigen/Core>

#include <memory>
#include <random>
#include <vector>

namespace pent::simulator::test {

inline constexpr ElementKind kElementKinds[] = {ElementKind::Linear, ElementKind::Smoothed,
                                                ElementKind::Quadratic};

/// A small box of one material with everything the kernels need, positions scrambled at will.
template <int Dim>
struct ElasticBox {
    SimplexMesh<Dim> mesh;
    DofMap dofs;
    BlockPattern pattern;
    std::unique_ptr<Elements<Dim>> elements;
    Positions<Dim> positions;

    explicit ElasticBox(const Material& material,
                        const std::vector<std::uint32_t>& held = {},
                        ElementKind kind = ElementKind::Linear)
        : mesh(kind == ElementKind::Quadratic
                   ? pent::test::quadratic_kuhn_box<Dim>(one_cube(), sizes())
                   : pent::test::kuhn_box<Dim>(counts(), sizes())) {
        std::vector<bool> is_held(static_cast<std::size_t>(mesh.vertex_count()), false);
        for (const std::uint32_t vertex : held) {
            is_held[vertex] = true;
        }
        lay_out(material, is_held, kind);
    }

    /// A mesh of one's own.
    ///
    /// @param is_held  One a vertex, or empty.
    ElasticBox(SimplexMesh<Dim> of,
               const Material& material,
               ElementKind kind,
               std::vector<bool> is_held = {})
        : mesh(std::move(of)) {
        is_held.resize(static_cast<std::size_t>(mesh.vertex_count()), false);
        lay_out(material, is_held, kind);
    }

    void lay_out(const Material& material, const std::vector<bool>& is_held, ElementKind kind) {
        std::vector<std::uint32_t> columns;
        for (std::uint32_t v = 0; v < is_held.size(); ++v) {
            columns.push_back(v);
        }
        dofs = number_dofs<Dim>(
            mesh.cells, is_held,
            mesh.columns.empty() ? Columns{columns, columns} : Columns{mesh.columns, mesh.layers});
        const std::vector<CellRange> ranges = {{0, mesh.cell_count(), material}};
        QuadraticCells<Dim> quadratic;
        if (kind == ElementKind::Quadratic) {
            quadratic.nodes = quadratic_simplices<Dim>(mesh, "box");
            quadratic.ranges = {{0, quadratic.nodes.cols(), material}};
        }
        ElementLayout<Dim> layout =
            kind == ElementKind::Quadratic
                ? lay_out_elements<Dim>(mesh.positions, quadratic, dofs)
                : lay_out_elements<Dim>(mesh.positions, mesh.cells, ranges, dofs, kind);
        pattern = std::move(layout.pattern);
        elements = std::make_unique<Elements<Dim>>(std::move(layout.elements));
        positions = mesh.positions;
    }

    /// Moves every vertex by a normal deviate of the given size, m.
    void scramble(double size, unsigned seed) {
        std::mt19937 random(seed);
        std::normal_distribution<double> normal(0, size);
        positions = mesh.positions.unaryExpr([&](double x) { return x + normal(random); });
    }

    /// Elastic energy and forces at positions p.
    RunEnergy forces(Isa isa, const Positions<Dim>& p, Positions<Dim>& out) const {
        out.setZero(Dim, p.cols());
        const RunEnergy energy = elements->add_gradient(Workers(1), kernels<Dim>(isa), p, out);
        out = -out;
        return energy;
    }

    /// Filtered stiffness matrix of the free vertices, dense, unknowns in their own order.
    template <typename Scalar>
    [[nodiscard]] Eigen::MatrixXd stiffness(Isa isa, Filter filter) const {
        BlockMatrix<Dim, Scalar> matrix(pattern);
        elements->add_hessian(Workers(1), kernels<Dim>(isa), positions,
                              target_in(matrix, 1, filter));
        return dense(matrix);
    }

    template <typename Scalar>
    static Eigen::MatrixXd dense(const BlockMatrix<Dim, Scalar>& matrix) {
        const BlockPattern& pattern = matrix.pattern();
        Eigen::MatrixXd full = Eigen::MatrixXd::Zero(Dim * pattern.rows(), Dim * pattern.rows());
        for (std::int64_t row = 0; row < pattern.rows(); ++row) {
            const auto r = static_cast<std::size_t>(row);
            for (std::int64_t k = pattern.row_start[r]; k < pattern.row_start[r + 1]; ++k) {
                const Eigen::Index column = pattern.columns[static_cast<std::size_t>(k)];
                const Eigen::Matrix<double, Dim, Dim> block =
                    matrix.block(k).template cast<double>();
                full.template block<Dim, Dim>(Dim * row, Dim * column) = block;
                full.template block<Dim, Dim>(Dim * column, Dim * row) = block.transpose();
            }
        }
        return full;
    }

    static std::array<int, Dim> counts() {
        std::array<int, Dim> count{};
        count.fill(1);
        count[0] = 2;
        return count;
    }
    static std::array<int, Dim> one_cube() {
        std::array<int, Dim> count{};
        count.fill(1);
        return count;
    }
    static std::array<double, Dim> sizes() {
        std::array<double, Dim> size{};
        for (int axis = 0; axis < Dim; ++axis) {
            size[static_cast<std::size_t>(axis)] = 1.0 + 0.2 * axis;
        }
        return size;
    }
};

/// Instruction sets this machine can run.
inline std::vector<Isa> supported_isas() {
    std::vector<Isa> isas;
    for (const Isa isa : {Isa::Scalar, Isa::Baseline, Isa::Avx2, Isa::Avx512}) {
        if (is_supported(isa)) {
            isas.push_back(isa);
        }
    }
    return isas;
}

}  // namespace pent::simulator::test
