#pragma once

#include "elastic_box.h"
#include "kernels/kernels.h"

#include <pent/simulator/energy.h>
#include <pent/simulator/words.h>

#include <Eigen/Eigenvalues>
#include <Eigen/LU>
#include <gtest/gtest.h>

// Energy, forces and Hessian of elements one by one in dense matrices: what the kernels are tested
// against.

namespace pent::simulator::test {

using Eigen::MatrixXd;

// A place where an element has a deformation gradient. Row v of `gradients` is the rest gradient of
// vertex v.
struct ReferencePoint {
    double volume = 0;
    MatrixXd gradients;
};

// What an element adds to: a cell, all cells at an edge, of which it has the mean deformation
// gradient, or a quadratic cell, which has several points.
struct ReferenceElement {
    std::vector<ReferencePoint> points;
    double volume = 0;
};

template <int Dim>
ReferencePoint cell_point(const SimplexMesh<Dim>& mesh, Eigen::Index cell) {
    MatrixXd Dm(Dim, Dim);
    for (int a = 0; a < Dim; ++a) {
        Dm.col(a) =
            mesh.positions.col(mesh.cells(a + 1, cell)) - mesh.positions.col(mesh.cells(0, cell));
    }
    const MatrixXd inverse = Dm.inverse();
    ReferencePoint point{cell_volume<Dim>(mesh.positions, mesh.cells, cell),
                         MatrixXd::Zero(mesh.vertex_count(), Dim)};
    for (int a = 0; a < Dim; ++a) {
        point.gradients.row(mesh.cells(a + 1, cell)) = inverse.row(a);
        point.gradients.row(mesh.cells(0, cell)) -= inverse.row(a);
    }
    return point;
}

template <int Dim>
std::vector<ReferenceElement> smoothed_elements(const SimplexMesh<Dim>& mesh,
                                                const std::vector<ReferenceElement>& cells) {
    constexpr int kEdges = Dim * (Dim + 1) / 2;  // of a cell, which have a share each
    std::vector<ReferenceElement> edges;
    for (std::uint32_t v = 0; v < mesh.vertex_count(); ++v) {
        for (std::uint32_t u = 0; u < v; ++u) {
            ReferencePoint edge{0, MatrixXd::Zero(mesh.vertex_count(), Dim)};
            for (Eigen::Index cell = 0; cell < mesh.cell_count(); ++cell) {
                if ((mesh.cells.col(cell).array() == u).any()
                    && (mesh.cells.col(cell).array() == v).any()) {
                    const ReferencePoint& part = cells[static_cast<std::size_t>(cell)].points[0];
                    edge.volume += part.volume;
                    edge.gradients += part.volume * part.gradients;
                }
            }
            if (edge.volume > 0) {
                edge.gradients /= edge.volume;
                edge.volume /= kEdges;
                edges.push_back({{edge}, edge.volume});
            }
        }
    }
    return edges;
}

// From the shape functions l_a (2 l_a - 1) and 4 l_a l_b of straight simplices, at the points with
// barycentric coordinates (b, a, a, ..), a = (n + 2 - sqrt(n + 2)) / ((n + 1) (n + 2)).
template <int Dim>
std::vector<ReferenceElement> quadratic_elements(const SimplexMesh<Dim>& mesh) {
    const QuadraticSimplices<Dim> simplices = quadratic_simplices<Dim>(mesh, "box");
    const double far = (Dim + 2 - std::sqrt(Dim + 2.0)) / ((Dim + 1) * (Dim + 2));
    std::vector<ReferenceElement> elements;
    for (Eigen::Index s = 0; s < simplices.cols(); ++s) {
        SimplexMesh<Dim> straight;
        straight.positions = mesh.positions;
        straight.cells = simplices.col(s).template head<Dim + 1>();
        const ReferencePoint linear = cell_point<Dim>(straight, 0);
        ReferenceElement element{{}, linear.volume};
        for (int near = 0; near <= Dim; ++near) {
            Eigen::VectorXd l = Eigen::VectorXd::Constant(Dim + 1, far);
            l[near] = 1 - Dim * far;
            ReferencePoint point{linear.volume / (Dim + 1),
                                 MatrixXd::Zero(mesh.vertex_count(), Dim)};
            int middle = Dim + 1;
            for (int a = 0; a <= Dim; ++a) {
                const auto of_a = linear.gradients.row(simplices(a, s));
                point.gradients.row(simplices(a, s)) = (4 * l[a] - 1) * of_a;
                for (int b = a + 1; b <= Dim; ++b, ++middle) {
                    const auto of_b = linear.gradients.row(simplices(b, s));
                    point.gradients.row(simplices(middle, s)) = 4 * (l[a] * of_b + l[b] * of_a);
                }
            }
            element.points.push_back(point);
        }
        elements.push_back(element);
    }
    return elements;
}

template <int Dim>
std::vector<ReferenceElement> reference_elements(const SimplexMesh<Dim>& mesh, ElementKind kind) {
    if (kind == ElementKind::Quadratic) {
        return quadratic_elements<Dim>(mesh);
    }
    std::vector<ReferenceElement> cells;
    for (Eigen::Index cell = 0; cell < mesh.cell_count(); ++cell) {
        const ReferencePoint point = cell_point<Dim>(mesh, cell);
        cells.push_back({{point}, point.volume});
    }
    return kind == ElementKind::Linear ? cells : smoothed_elements<Dim>(mesh, cells);
}

// The measure of volume that an energy has the square of, times lambda / 2.
struct Swelling {
    double value = 0;
    MatrixXd slope;   // by F
    MatrixXd second;  // by vec F
};

inline Swelling swelling(Model model, const MatrixXd& F) {
    const Eigen::Index dim = F.rows();
    if (model == Model::StableNeoHookean || model == Model::MooneyRivlin) {
        return {invariant(Invariant::I3, F) - 1, invariant_gradient(Invariant::I3, F),
                dense(invariant_hessian(Invariant::I3, F))};
    }
    if (model == Model::StVenantKirchhoff) {
        return {(F.squaredNorm() - static_cast<double>(dim)) / 2, F,
                MatrixXd::Identity(dim * dim, dim * dim)};
    }
    return {F.trace() - static_cast<double>(dim), MatrixXd::Identity(dim, dim),
            MatrixXd::Zero(dim * dim, dim * dim)};
}

inline MatrixXd filtered_matrix(const MatrixXd& H, Filter filter) {
    if (filter == Filter::None) {
        return H;
    }
    const Eigen::SelfAdjointEigenSolver<MatrixXd> eigen(H);
    const Eigen::VectorXd values = filter == Filter::Clamp
                                       ? Eigen::VectorXd(eigen.eigenvalues().cwiseMax(0))
                                       : Eigen::VectorXd(eigen.eigenvalues().cwiseAbs());
    return eigen.eigenvectors() * values.asDiagonal() * eigen.eigenvectors().transpose();
}

// Energy, forces and stiffness element by element from energy.h: slow and plain.
template <int Dim>
struct Reference {
    double energy = 0;
    Positions<Dim> forces;
    MatrixXd stiffness;

    Reference(const ElasticBox<Dim>& box, const Material& of, Filter filter, ElementKind kind)
        : box_(box), material_(of) {
        const Eigen::Index vertices = box.mesh.vertex_count();
        const auto unknowns = static_cast<Eigen::Index>(box.dofs.count());
        forces.setZero(Dim, vertices);
        stiffness.setZero(Dim * unknowns, Dim * unknowns);
        double mean_lambda = 0;  // mu stays at every point in 3D, half of it in 4D
        if (kind == ElementKind::Quadratic && of.model != Model::Arap) {
            mean_lambda = std::max(0.0, of.lame.lambda - (Dim == 3 ? 1 : 0.5) * of.lame.mu);
        }
        material_.lame.lambda -= mean_lambda;
        for (const ReferenceElement& element : reference_elements<Dim>(box.mesh, kind)) {
            add(element, mean_lambda, filter);
        }
    }

    void add(const ReferenceElement& element, double mean_lambda, Filter filter) {
        double mean = 0;
        MatrixXd mean_slope = MatrixXd::Zero(Dim, box_.mesh.vertex_count());
        for (const ReferencePoint& point : element.points) {
            const Swelling at = swelling(material_.model, box_.positions * point.gradients);
            const double share = point.volume / element.volume;
            mean += share * at.value;
            mean_slope += share * at.slope * point.gradients.transpose();
        }
        const double pressure = mean_lambda * mean;
        energy += element.volume * pressure * mean / 2;
        forces -= element.volume * pressure * mean_slope;
        for (const ReferencePoint& point : element.points) {
            const MatrixXd F = box_.positions * point.gradients;
            energy += point.volume * energy_density(material_, F);
            forces -= point.volume * stress(material_, F) * point.gradients.transpose();
            MatrixXd H = dense(hessian(material_, F));
            if (pressure != 0) {
                H += pressure * swelling(material_.model, F).second;
            }
            H = filtered_matrix(H, filter);
            for_each_pair(point.gradients, [&](std::uint32_t a, std::uint32_t b) {
                for (int l = 0; l < Dim; ++l) {
                    for (int m = 0; m < Dim; ++m) {
                        block(a, b) += point.volume * point.gradients(a, l) * point.gradients(b, m)
                                       * H.block<Dim, Dim>(Dim * l, Dim * m);
                    }
                }
            });
        }
        if (mean_lambda > 0) {
            for_each_pair(mean_slope.transpose(), [&](std::uint32_t a, std::uint32_t b) {
                block(a, b) += element.volume * mean_lambda * mean_slope.col(a)
                               * mean_slope.col(b).transpose();
            });
        }
    }

    // Pairs of free vertices with rows that are not zero.
    template <typename Visit>
    void for_each_pair(const MatrixXd& rows, const Visit& visit) const {
        std::vector<std::uint32_t> chosen;
        for (std::uint32_t v = 0; v < rows.rows(); ++v) {
            if (box_.dofs.has_dof(v) && !rows.row(v).isZero(0)) {
                chosen.push_back(v);
            }
        }
        for (const std::uint32_t a : chosen) {
            for (const std::uint32_t b : chosen) {
                visit(a, b);
            }
        }
    }

    Eigen::Block<MatrixXd, Dim, Dim> block(std::uint32_t a, std::uint32_t b) {
        return stiffness.block<Dim, Dim>(Dim * box_.dofs.dof_of(a), Dim * box_.dofs.dof_of(b));
    }

private:
    const ElasticBox<Dim>& box_;
    Material material_;
};

}  // namespace pent::simulator::test
