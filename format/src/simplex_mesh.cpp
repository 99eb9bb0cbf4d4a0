#include "pent/simplex_mesh.h"

#include <pent/error.h>
#include <pent/geometry.h>
#include <pent/mesh_part.h>

#include <Eigen/LU>

#include <array>
#include <cmath>
#include <string>

namespace pent {

namespace {

// Below this fraction of the Hadamard bound (the product of the edge lengths at corner 0) rounding
// of the coordinates, 2^-53 each, may have decided the sign of the determinant.
constexpr double kDegenerate = 1e-14;

constexpr double factorial(int n) {
    return n < 2 ? 1 : n * factorial(n - 1);
}

// @param numbers  What elements are called; empty if as they are counted.
std::string where(std::string_view name,
                  std::string_view element,
                  std::span<const std::uint32_t> numbers,
                  Eigen::Index index) {
    const Eigen::Index number =
        numbers.empty() ? index
                        : static_cast<Eigen::Index>(numbers[static_cast<std::size_t>(index)]);
    return std::string(name) + ": " + std::string(element) + " " + std::to_string(number) + ": ";
}

// @param what    A column is of, as in "vertex".
// @param prefix  Of the names of its entries.
template <int Dim>
void validate_finite(const Positions<Dim>& vectors,
                     std::string_view what,
                     std::span<const std::uint32_t> numbers,
                     const std::string& prefix,
                     std::string_view name) {
    constexpr std::array<char, 4> kAxes = {'x', 'y', 'z', 'w'};
    for (Eigen::Index i = 0; i < vectors.cols(); ++i) {
        for (int axis = 0; axis < Dim; ++axis) {
            const double value = vectors(axis, i);
            if (!std::isfinite(value)) {
                throw Error(where(name, what, numbers, i) + prefix + kAxes[axis] + " is "
                            + std::to_string(value) + ", expected a finite number");
            }
        }
    }
}

template <int Dim>
void validate_indices(const SimplexMesh<Dim>& mesh,
                      std::string_view name,
                      std::span<const std::uint32_t> numbers,
                      Eigen::Index cell) {
    for (int i = 0; i <= Dim; ++i) {
        const std::uint32_t vertex = mesh.cells(i, cell);
        if (vertex >= mesh.vertex_count()) {
            throw Error(where(name, cell_name(Dim), numbers, cell) + "vertex "
                        + std::to_string(vertex) + " of " + std::to_string(mesh.vertex_count())
                        + ", expected at most " + std::to_string(mesh.vertex_count() - 1));
        }
        for (int j = 0; j < i; ++j) {
            if (mesh.cells(j, cell) == vertex) {
                throw Error(where(name, cell_name(Dim), numbers, cell) + "vertex "
                            + std::to_string(vertex) + " appears twice, expected "
                            + std::to_string(Dim + 1) + " different vertices");
            }
        }
    }
}

template <int Dim>
void validate_orientation(const SimplexMesh<Dim>& mesh,
                          std::string_view name,
                          std::span<const std::uint32_t> numbers,
                          Eigen::Index cell) {
    const Eigen::Matrix<double, Dim, Dim> edges =
        edge_matrix<Dim>(mesh.positions, mesh.cells, cell);
    // Scaled by the longest edge so that neither tiny nor huge bodies leave the range of double.
    const double scale = edges.cwiseAbs().maxCoeff();
    const Eigen::Matrix<double, Dim, Dim> scaled = edges / (scale > 0 ? scale : 1);
    const double determinant = scaled.determinant();
    double hadamard = 1;
    for (int k = 0; k < Dim; ++k) {
        hadamard *= scaled.col(k).norm();
    }
    if (determinant > kDegenerate * hadamard) {
        return;
    }
    if (determinant < -kDegenerate * hadamard) {
        throw Error(where(name, cell_name(Dim), numbers, cell) +
                    "inverted (its determinant is negative), expected positive orientation: swap "
                    "two of its vertices");
    }
    throw Error(where(name, cell_name(Dim), numbers, cell)
                + "degenerate (flat to rounding error), expected a positive volume");
}

void validate_length(std::size_t found,
                     Eigen::Index expected,
                     std::string_view what,
                     std::string_view name) {
    if (found != 0 && found != static_cast<std::size_t>(expected)) {
        throw Error(std::string(name) + ": " + std::to_string(found) + " " + std::string(what)
                    + ", expected none or " + std::to_string(expected));
    }
}

}  // namespace

std::string_view cell_name(int dim) {
    constexpr std::array<std::string_view, 3> kNames = {"triangle", "tetrahedron", "pentachoron"};
    return kNames.at(static_cast<std::size_t>(dim - 2));
}

std::string_view cell_name_plural(int dim) {
    constexpr std::array<std::string_view, 3> kNames = {"triangles", "tetrahedra", "pentachora"};
    return kNames.at(static_cast<std::size_t>(dim - 2));
}

template <int Dim>
double simplex_volume(const Eigen::Matrix<double, Dim, Dim + 1>& corners) {
    const Eigen::Matrix<double, Dim, Dim> edges =
        corners.template rightCols<Dim>().colwise() - corners.col(0);
    return edges.determinant() / factorial(Dim);
}

template <int Dim>
double cell_volume(const Positions<Dim>& positions,
                   const Simplices<Dim + 1>& cells,
                   Eigen::Index cell) {
    return edge_matrix<Dim>(positions, cells, cell).determinant() / factorial(Dim);
}

template <int Dim>
double total_volume(const SimplexMesh<Dim>& mesh) {
    double sum = 0;
    for (Eigen::Index cell = 0; cell < mesh.cell_count(); ++cell) {
        sum += cell_volume<Dim>(mesh.positions, mesh.cells, cell);
    }
    return sum;
}

template <int Dim>
void validate(const SimplexMesh<Dim>& mesh, std::string_view name) {
    if (mesh.cell_count() == 0) {
        throw Error(std::string(name) + ": no " + std::string(cell_name_plural(Dim))
                    + ", expected at least one");
    }
    validate_part(mesh, name, {});
}

template <int Dim>
void validate_part(const SimplexMesh<Dim>& mesh,
                   std::string_view name,
                   std::span<const std::uint32_t> numbers) {
    validate_length(mesh.regions.size(), mesh.cell_count(), "regions", name);
    validate_length(mesh.parents.size(), mesh.cell_count(), "parents", name);
    validate_length(static_cast<std::size_t>(mesh.fibers.cols()), mesh.cell_count(), "fibers",
                    name);
    validate_length(mesh.columns.size(), mesh.vertex_count(), "columns", name);
    validate_length(mesh.layers.size(), mesh.vertex_count(), "layers", name);
    validate_finite<Dim>(mesh.positions, "vertex", {}, "", name);
    validate_finite<Dim>(mesh.fibers, cell_name(Dim), numbers, "fiber_", name);
    for (Eigen::Index cell = 0; cell < mesh.cell_count(); ++cell) {
        validate_indices(mesh, name, numbers, cell);
        validate_orientation(mesh, name, numbers, cell);
    }
}

#define PENT_INSTANTIATE(Dim)                                                          \
    template double simplex_volume<Dim>(const Eigen::Matrix<double, Dim, Dim + 1>&);   \
    template double cell_volume<Dim>(const Positions<Dim>&, const Simplices<Dim + 1>&, \
                                     Eigen::Index);                                    \
    template double total_volume<Dim>(const SimplexMesh<Dim>&);                        \
    template void validate<Dim>(const SimplexMesh<Dim>&, std::string_view);            \
    template void validate_part<Dim>(const SimplexMesh<Dim>&, std::string_view,        \
                                     std::span<const std::uint32_t>);
PENT_INSTANTIATE(2)
PENT_INSTANTIATE(3)
PENT_INSTANTIATE(4)
#undef PENT_INSTANTIATE

}  // namespace pent
