#pragma once

#include "support/kuhn_box.h"

#include <pent/contact/contact_finder.h>

#include <array>
#include <random>

namespace pent::contact::test {

/// Some bodies in one array of positions.
template <int Dim>
struct Scene {
    Positions<Dim> positions;
    std::vector<Surface<Dim>> surfaces;
    std::vector<Eigen::Index> begin{0};  ///< First vertex of each body, and one past the last.

    void add(const SimplexMesh<Dim>& mesh, const Vector<Dim>& offset) {
        const Eigen::Index first = positions.cols();
        positions.conservativeResize(Dim, first + mesh.vertex_count());
        positions.rightCols(mesh.vertex_count()) = mesh.positions.colwise() + offset;
        surfaces.push_back(
            make_surface<Dim>(mesh.cells, mesh.vertex_count(), static_cast<std::uint32_t>(first)));
        begin.push_back(positions.cols());
    }

    [[nodiscard]] auto body(int i) {
        return positions.middleCols(begin[i], begin[i + 1] - begin[i]);
    }
};

/// The bodies of a scene, called "a", "b" and so on, with these options, at rest where they are.
/// All vertices are free.
template <int Dim>
[[nodiscard]] ContactScene<Dim> contact_scene(
    const Scene<Dim>& scene,
    const ContactOptions& options,
    const std::vector<ObstacleShape<Dim>>& obstacles = {}) {
    ContactScene<Dim> result;
    result.options = options;
    result.rest = scene.positions;
    for (const Surface<Dim>& surface : scene.surfaces) {
        result.bodies.push_back(
            {std::string(1, static_cast<char>('a' + result.bodies.size())), surface, false});
    }
    for (const ObstacleShape<Dim>& obstacle : obstacles) {
        result.obstacles.push_back({obstacle, options.distance, 1000});
    }
    result.is_fixed.assign(static_cast<std::size_t>(scene.positions.cols()), false);
    return result;
}

/// A box of `count` cells of 1 m along each axis.
template <int Dim>
[[nodiscard]] SimplexMesh<Dim> cube(int count) {
    std::array<int, Dim> cells{};
    std::array<double, Dim> size{};
    cells.fill(count);
    size.fill(count);
    return pent::test::kuhn_box<Dim>(cells, size);
}

/// Moves every vertex by up to `size` m along each axis.
template <int Dim>
void shake(Positions<Dim>& positions, double size, unsigned seed) {
    std::mt19937 random(seed);
    std::uniform_real_distribution<double> step(-size, size);
    for (Eigen::Index i = 0; i < positions.size(); ++i) {
        positions.data()[i] += step(random);
    }
}

/// A rotation that treats no axis as special: a product of turns in all planes.
template <int Dim>
[[nodiscard]] Eigen::Matrix<double, Dim, Dim> tilt() {
    using Rotation = Eigen::Matrix<double, Dim, Dim>;
    Rotation product = Rotation::Identity();
    double angle = 0.3;
    for (int i = 0; i < Dim; ++i) {
        for (int j = i + 1; j < Dim; ++j) {
            Rotation turn = Rotation::Identity();
            turn(i, i) = turn(j, j) = std::cos(angle);
            turn(j, i) = std::sin(angle);
            turn(i, j) = -turn(j, i);
            product = turn * product;
            angle += 0.37;
        }
    }
    return product;
}

}  // namespace pent::contact::test
