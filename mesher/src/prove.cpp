#include <pent/facets.h>
#include <pent/formatted.h>
#include <pent/mesher/prove.h>

#include <Eigen/LU>

#include <cinttypes>
#include <cmath>
#include <limits>

namespace pent::mesher {

namespace {

constexpr double kEps = std::numeric_limits<double>::epsilon();

constexpr double factorial(int n) {
    return n < 2 ? 1.0 : n * factorial(n - 1);
}

// Edges of a simplex at its first corner, one a column.
template <int Dim, int Edges>
Eigen::Matrix<double, Dim, Edges> edges(const Positions<Dim>& positions,
                                        const Simplices<Edges + 1>& simplices,
                                        Eigen::Index simplex) {
    Eigen::Matrix<double, Dim, Edges> result;
    for (int i = 0; i < Edges; ++i) {
        result.col(i) =
            positions.col(simplices(i + 1, simplex)) - positions.col(simplices(0, simplex));
    }
    return result;
}

// Sum over the cells of the largest volume that edges of these lengths could span.
template <int Dim>
double sum_of_volume_bounds(const SimplexMesh<Dim>& mesh) {
    double sum = 0;
    for (Eigen::Index cell = 0; cell < mesh.cell_count(); ++cell) {
        sum += edges<Dim, Dim>(mesh.positions, mesh.cells, cell).colwise().norm().prod();
    }
    return sum / factorial(Dim);
}

template <int Dim>
double measure(const Positions<Dim>& positions, const Simplices<Dim>& facets) {
    double sum = 0;
    for (Eigen::Index facet = 0; facet < facets.cols(); ++facet) {
        const Eigen::Matrix<double, Dim, Dim - 1> E = edges<Dim, Dim - 1>(positions, facets, facet);
        sum += std::sqrt(std::max(0.0, (E.transpose() * E).eval().determinant()));
    }
    return sum / factorial(Dim - 1);
}

// Volume by the divergence theorem, seen from the middle of the bounding box.
template <int Dim>
double volume_within(const Positions<Dim>& positions, const Simplices<Dim>& boundary) {
    const Eigen::Matrix<double, Dim, 1> origin =
        (positions.rowwise().minCoeff() + positions.rowwise().maxCoeff()) / 2;
    double sum = 0;
    for (Eigen::Index facet = 0; facet < boundary.cols(); ++facet) {
        Eigen::Matrix<double, Dim, Dim> arms;
        for (int i = 0; i < Dim; ++i) {
            arms.col(i) = positions.col(boundary(i, facet)) - origin;
        }
        sum += arms.determinant();
    }
    return sum / factorial(Dim);
}

std::int64_t faults_of_boundary(const Simplices<2>& boundary, Eigen::Index vertices) {
    // A closed curve enters each of its vertices as often as it leaves it, and does both once.
    std::vector<int> entered(vertices, 0);
    std::vector<int> left(vertices, 0);
    for (const auto& segment : boundary.colwise()) {
        ++left[segment[0]];
        ++entered[segment[1]];
    }
    std::int64_t faults = 0;
    for (Eigen::Index i = 0; i < vertices; ++i) {
        faults += entered[i] != left[i] || left[i] > 1 ? 1 : 0;
    }
    return faults;
}

template <int Corners>
std::int64_t faults_of_boundary(const Simplices<Corners>& boundary, Eigen::Index vertices) {
    const FacetMatch<Corners - 1> ridges = match_facets<Corners - 1>(boundary, vertices);
    return ridges.one_sided + ridges.overfull + ridges.boundary.cols();
}

}  // namespace

bool Proof::holds() const {
    return cells > 0 && faulty_facets == 0 && faulty_ridges == 0
           && std::abs(volume - expected_volume) <= tolerance
           && std::abs(volume - boundary_volume) <= tolerance;
}

template <int Dim>
Proof prove(const SimplexMesh<Dim>& mesh, double expected) {
    const FacetMatch<Dim> match = match_facets<Dim>(mesh.cells, mesh.vertex_count());
    Proof proof;
    proof.cells = mesh.cell_count();
    proof.interior_facets = match.interior;
    proof.boundary_facets = match.boundary.cols();
    proof.faulty_facets = match.one_sided + match.overfull;
    proof.faulty_ridges = faults_of_boundary(match.boundary, mesh.vertex_count());
    proof.volume = total_volume(mesh);
    proof.boundary_volume = volume_within<Dim>(mesh.positions, match.boundary);
    proof.expected_volume = expected > 0 ? expected : proof.boundary_volume;
    const double surface = measure<Dim>(mesh.positions, match.boundary);
    proof.tolerance =
        kEps
        * (8 * sum_of_volume_bounds(mesh)
           + static_cast<double>(mesh.cell_count() + match.boundary.cols()) * proof.volume
           + 4 * mesh.positions.cwiseAbs().maxCoeff() * surface);
    return proof;
}

std::string describe_faults(const Proof& proof, int dim) {
    if (proof.holds()) {
        return "";
    }
    const std::int64_t facets = proof.interior_facets + proof.boundary_facets + proof.faulty_facets;
    return formatted("%" PRId64 " of %" PRId64 " facets do not match, %" PRId64
                     " ridges of the boundary are open or overfull, the cells fill %.17g m^%d "
                     "(boundary: %.17g, expected: %.17g, tolerance %.3g)",
                     proof.faulty_facets, facets, proof.faulty_ridges, proof.volume, dim,
                     proof.boundary_volume, proof.expected_volume, proof.tolerance);
}

template Proof prove<2>(const SimplexMesh<2>&, double);
template Proof prove<3>(const SimplexMesh<3>&, double);
template Proof prove<4>(const SimplexMesh<4>&, double);

}  // namespace pent::mesher
