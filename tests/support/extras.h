#pragma once

#include <pent/facets.h>
#include <pent/pent_file.h>

#include <gtest/gtest.h>

#include <cmath>
#include <cstdint>

namespace pent::test {

/// Everything that a file may have beside a mesh: numbers and vectors of vertices and cells, labels
/// of every third facet of the boundary, and tags.
template <int Dim>
[[nodiscard]] MeshExtras<Dim> all_extras(const SimplexMesh<Dim>& mesh, double factor = 1) {
    const Eigen::Index vertices = mesh.vertex_count();
    const Eigen::Index cells = mesh.cell_count();
    const auto numbers = [factor](Eigen::Index rows, Eigen::Index count, double wave) {
        Eigen::MatrixXd values(rows, count);
        for (Eigen::Index i = 0; i < values.size(); ++i) {
            values.data()[i] = factor * std::sin(wave * static_cast<double>(i) + 0.1);
        }
        return values;
    };
    MeshExtras<Dim> extras;
    extras.vertex_fields = {{"temperature", numbers(1, vertices, 0.7)},
                            {"current", numbers(Dim, vertices, 1.1)},
                            {"salt", numbers(1, vertices, 1.3)}};
    extras.cell_fields = {{"flow", numbers(Dim, cells, 1.7)}, {"age", numbers(1, cells, 1.9)}};
    const Simplices<Dim> facets = match_facets<Dim>(mesh.cells, vertices).boundary;
    extras.boundary.resize(Dim, (facets.cols() + 2) / 3);
    for (Eigen::Index i = 0; i < extras.boundary.cols(); ++i) {
        extras.boundary.col(i) = facets.col(3 * i);
        extras.labels.push_back(static_cast<std::uint16_t>(1 + i % 5));
        extras.base_labels.push_back(static_cast<std::uint16_t>(i % 700));
    }
    for (Eigen::Index cell = 0; cell < cells; ++cell) {
        extras.bisection_tags.push_back(static_cast<std::uint8_t>(cell % 8));
    }
    return extras;
}

template <int Dim>
void expect_same(const MeshExtras<Dim>& found, const MeshExtras<Dim>& expected) {
    EXPECT_EQ(found.vertex_fields, expected.vertex_fields);
    EXPECT_EQ(found.cell_fields, expected.cell_fields);
    ASSERT_EQ(found.boundary.cols(), expected.boundary.cols());
    EXPECT_EQ(found.boundary, expected.boundary);
    EXPECT_EQ(found.labels, expected.labels);
    EXPECT_EQ(found.base_labels, expected.base_labels);
    EXPECT_EQ(found.bisection_tags, expected.bisection_tags);
}

}  // namespace pent::test
