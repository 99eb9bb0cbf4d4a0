#include "dense_oracle.h"

#include <Eigen/Eigenvalues>
#include <Eigen/LU>
#include <Eigen/SparseCholesky>

#include <array>

namespace pent::simulator::bench {

namespace {

using Eigen::Index;
using Eigen::Matrix4d;
using Matrix16 = Eigen::Matrix<double, 16, 16>;
using Gradients = Eigen::Matrix<double, 5, 4>;  // row a: rest gradient of corner a
using CellMatrix = Eigen::Matrix<double, 20, 20>;

struct Cell {
    Gradients gradients;
    double volume = 0;
    Matrix4d F;
};

Cell make_cell(const SimplexMesh<4>& mesh, const Positions<4>& positions, Index cell) {
    Matrix4d Dm;
    Matrix4d Ds;
    for (int a = 0; a < 4; ++a) {
        const auto corner = mesh.cells(a + 1, cell);
        const auto origin = mesh.cells(0, cell);
        Dm.col(a) = mesh.positions.col(corner) - mesh.positions.col(origin);
        Ds.col(a) = positions.col(corner) - positions.col(origin);
    }
    Cell result;
    result.gradients.bottomRows<4>() = Dm.inverse();
    result.gradients.row(0) = -result.gradients.bottomRows<4>().colwise().sum();
    result.volume = Dm.determinant() / 24;
    result.F = Ds * result.gradients.bottomRows<4>();
    return result;
}

// The determinant of F without two rows and two columns.
double second_minor(const Matrix4d& F, int i, int p, int j, int q) {
    std::array<int, 2> rows{};
    std::array<int, 2> columns{};
    for (int k = 0, r = 0, c = 0; k < 4; ++k) {
        if (k != i && k != p) {
            rows[r++] = k;
        }
        if (k != j && k != q) {
            columns[c++] = k;
        }
    }
    return F(rows[0], columns[0]) * F(rows[1], columns[1])
           - F(rows[0], columns[1]) * F(rows[1], columns[0]);
}

Matrix16 density_hessian(const Matrix4d& F, const Material& material) {
    const auto [lambda, mu] = material.lame;
    const Matrix4d cofactor = F.determinant() * F.inverse().transpose();
    const double pressure = (lambda + mu) * (F.determinant() - 1) - mu;
    const Eigen::Matrix<double, 16, 1> growth = cofactor.reshaped();
    Matrix16 H = mu * Matrix16::Identity() + (lambda + mu) * growth * growth.transpose();
    for (int i = 0; i < 4; ++i) {
        for (int p = 0; p < 4; ++p) {
            for (int j = 0; j < 4; ++j) {
                for (int q = 0; q < 4; ++q) {
                    if (i != p && j != q) {
                        const bool is_odd = (i + j + p + q) % 2 != 0;
                        const bool is_crossed = (i < p) != (j < q);
                        H(4 * j + i, 4 * q + p) += (is_odd != is_crossed ? -pressure : pressure)
                                                   * second_minor(F, i, p, j, q);
                    }
                }
            }
        }
    }
    return H;
}

CellMatrix projected_hessian(const Cell& cell, const Material& material) {
    const Eigen::SelfAdjointEigenSolver<Matrix16> solver(density_hessian(cell.F, material));
    const Matrix16 H = solver.eigenvectors() * solver.eigenvalues().cwiseMax(0).asDiagonal()
                       * solver.eigenvectors().transpose();
    Eigen::Matrix<double, 16, 20> B = Eigen::Matrix<double, 16, 20>::Zero();  // dF / dx
    for (int a = 0; a < 5; ++a) {
        for (int j = 0; j < 4; ++j) {
            B.block<4, 4>(Index{4} * j, Index{4} * a).diagonal().setConstant(cell.gradients(a, j));
        }
    }
    return cell.volume * B.transpose() * H * B;
}

}  // namespace

Positions<4> oracle_forces(const SimplexMesh<4>& mesh,
                           const Material& material,
                           const Positions<4>& positions) {
    const auto [lambda, mu] = material.lame;
    Positions<4> forces = Positions<4>::Zero(4, mesh.vertex_count());
    for (Index c = 0; c < mesh.cell_count(); ++c) {
        const Cell cell = make_cell(mesh, positions, c);
        const double J = cell.F.determinant();
        const Matrix4d P =
            mu * cell.F + ((lambda + mu) * (J - 1) - mu) * J * cell.F.inverse().transpose();
        for (int a = 0; a < 5; ++a) {
            forces.col(mesh.cells(a, c)) -= cell.volume * P * cell.gradients.row(a).transpose();
        }
    }
    return forces;
}

double oracle_hessians(const SimplexMesh<4>& mesh,
                       const Material& material,
                       const Positions<4>& positions,
                       Index count) {
    double sum = 0;
    for (Index c = 0; c < count; ++c) {
        sum += projected_hessian(make_cell(mesh, positions, c), material).norm();
    }
    return sum;
}

Positions<4> oracle_step(const SimplexMesh<4>& mesh,
                         const Material& material,
                         const Eigen::Vector4d& gravity,
                         double h) {
    std::vector<Index> unknown(static_cast<std::size_t>(mesh.vertex_count()), -1);
    Index free_count = 0;
    for (Index v = 0; v < mesh.vertex_count(); ++v) {
        if (mesh.positions(0, v) > 1e-6) {
            unknown[static_cast<std::size_t>(v)] = free_count++;
        }
    }
    std::vector<Eigen::Triplet<double>> entries;
    Eigen::VectorXd right = Eigen::VectorXd::Zero(4 * free_count);
    for (Index c = 0; c < mesh.cell_count(); ++c) {
        const Cell cell = make_cell(mesh, mesh.positions, c);
        const CellMatrix K = projected_hessian(cell, material);
        const double share = material.density * cell.volume / 5;
        for (int a = 0; a < 5; ++a) {
            const Index row = unknown[mesh.cells(a, c)];
            if (row < 0) {
                continue;
            }
            right.segment<4>(4 * row) += h * h * share * gravity;  // no stress at rest
            for (int b = 0; b < 5; ++b) {
                const Index column = unknown[mesh.cells(b, c)];
                for (int i = 0; column >= 0 && i < 16; ++i) {
                    const double mass = a == b && i / 4 == i % 4 ? share : 0;
                    entries.emplace_back(static_cast<int>(4 * row + i / 4),
                                         static_cast<int>(4 * column + i % 4),
                                         mass + h * h * K(4 * a + i / 4, 4 * b + i % 4));
                }
            }
        }
    }
    Eigen::SparseMatrix<double> A(4 * free_count, 4 * free_count);
    A.setFromTriplets(entries.begin(), entries.end());
    const Eigen::VectorXd solved =
        Eigen::SimplicialLDLT<Eigen::SparseMatrix<double>>(A).solve(right);
    Positions<4> moved = Positions<4>::Zero(4, mesh.vertex_count());
    for (Index v = 0; v < mesh.vertex_count(); ++v) {
        const Index row = unknown[static_cast<std::size_t>(v)];
        if (row >= 0) {
            moved.col(v) = solved.segment<4>(4 * row);
        }
    }
    return moved;
}

}  // namespace pent::simulator::bench
