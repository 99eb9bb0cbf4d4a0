#include "pent/simplex_mesh.h"

#include <pent/error.h>
#include <pent/geometry.h>
#include <pent/mesh_part.h>
#include <pent/validate_parts.h>

#include <Eigen/LU>

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <string>
#include <vector>

namespace pent {

namespace {

// Below this fraction of the Hadamard bound (the product of the edge lengths at corner 0) rounding
// of the coordinates, 2^-53 each, may have decided the sign of the determinant.
constexpr double kDegenerate = 1e-14;

constexpr double factorial(int n) {
    return n < 2 ? 1 : n * factorial(n - 1);
}

// @param numbers  The number of each element in messages; empty if that is its index.
std::string where(std::string_view name,
                  std::string_view element,
                  std::span<const std::uint32_t> numbers,
                  Eigen::Index index) {
    const Eigen::Index number =
        numbers.empty() ? index
                        : static_cast<Eigen::Index>(numbers[static_cast<std::size_t>(index)]);
    return std::string(name) + ": " + std::string(element) + " " + std::to_string(number) + ": ";
}

// @param what    What a column belongs to, as in "vertex".
// @param prefix  What names of its entries have in front of the axis.
template <int Dim>
void validate_finite(const Positions<Dim>& vectors,
                     std::string_view what,
                     std::span<const std::uint32_t> numbers,
                     const std::string& prefix,
                     std::string_view name,
                     Eigen::Index column) {
    constexpr std::array<char, 4> kAxes = {'x', 'y', 'z', 'w'};
    for (int axis = 0; axis < Dim; ++axis) {
        const double value = vectors(axis, column);
        if (!std::isfinite(value)) {
            throw Error(where(name, what, numbers, column) + prefix + kAxes[axis] + " is "
                        + std::to_string(value) + ", expected a finite number");
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

// Calls validate_cell(cell) for the cells of one process, or of several together: then all throw
// what it throws of the lowest cell of the whole.
template <typename Validate>
void validate_each(Eigen::Index cells,
                   std::span<const std::uint32_t> numbers,
                   const SlabWriters* processes,
                   const Validate& validate_cell) {
    Eigen::Index cell = 0;
    const auto validate_own = [&] {
        for (; cell < cells; ++cell) {
            validate_cell(cell);
        }
    };
    if (processes == nullptr) {
        validate_own();
        return;
    }
    double own = std::numeric_limits<double>::infinity();
    std::string found;
    try {
        validate_own();
    } catch (const Error& error) {
        own = numbers[static_cast<std::size_t>(cell)];
        found = error.what();
    }
    const std::vector<double> all = processes->list(own);
    const bool is_first = own == *std::min_element(all.begin(), all.end());
    processes->agree([&] {
        if (is_first && !found.empty()) {
            throw Error(found);
        }
    });
}

template <int Dim>
void validate_by(const SlabWriters* processes,
                 const SimplexMesh<Dim>& mesh,
                 std::string_view name,
                 std::span<const std::uint32_t> numbers) {
    const auto validate_vertices = [&] {
        validate_length(mesh.regions.size(), mesh.cell_count(), "regions", name);
        validate_length(mesh.parents.size(), mesh.cell_count(), "parents", name);
        validate_length(static_cast<std::size_t>(mesh.fibers.cols()), mesh.cell_count(), "fibers",
                        name);
        validate_length(mesh.columns.size(), mesh.vertex_count(), "columns", name);
        validate_length(mesh.layers.size(), mesh.vertex_count(), "layers", name);
        for (Eigen::Index vertex = 0; vertex < mesh.vertex_count(); ++vertex) {
            validate_finite<Dim>(mesh.positions, "vertex", {}, "", name, vertex);
        }
    };
    processes != nullptr ? processes->agree(validate_vertices) : validate_vertices();
    validate_each(mesh.fibers.cols(), numbers, processes, [&](Eigen::Index cell) {
        validate_finite<Dim>(mesh.fibers, cell_name(Dim), numbers, "fiber_", name, cell);
    });
    validate_each(mesh.cell_count(), numbers, processes, [&](Eigen::Index cell) {
        validate_indices(mesh, name, numbers, cell);
        validate_orientation(mesh, name, numbers, cell);
    });
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
    validate_by(nullptr, mesh, name, numbers);
}

template <int Dim>
void validate_parts(const SimplexMesh<Dim>& mesh,
                    std::string_view name,
                    std::span<const std::uint32_t> numbers,
                    const SlabWriters& processes) {
    validate_by(&processes, mesh, name, numbers);
}

#define PENT_INSTANTIATE(Dim)                                                          \
    template double simplex_volume<Dim>(const Eigen::Matrix<double, Dim, Dim + 1>&);   \
    template double cell_volume<Dim>(const Positions<Dim>&, const Simplices<Dim + 1>&, \
                                     Eigen::Index);                                    \
    template double total_volume<Dim>(const SimplexMesh<Dim>&);                        \
    template void validate<Dim>(const SimplexMesh<Dim>&, std::string_view);            \
    template void validate_part<Dim>(const SimplexMesh<Dim>&, std::string_view,        \
                                     std::span<const std::uint32_t>);                  \
    template void validate_parts<Dim>(const SimplexMesh<Dim>&, std::string_view,       \
                                      std::span<const std::uint32_t>, const SlabWriters&);
PENT_INSTANTIATE(2)
PENT_INSTANTIATE(3)
PENT_INSTANTIATE(4)
#undef PENT_INSTANTIATE

}  // namespace pent
