#pragma once

#include "support/messages.h"
#include "support/temp_folder.h"

#include <pent/exchange/exchange.h>

#include <Eigen/LU>
#include <gtest/gtest.h>

#include <array>
#include <fstream>
#include <string>

namespace pent::exchange::test {

/// The 5-cell with corners at 0 and the ends of the axes: 1/24 m^4.
inline TetSurface five_cell() {
    TetSurface surface;
    surface.points.setZero(4, 5);
    surface.points.rightCols<4>().setIdentity();
    surface.tetrahedra.resize(4, 5);
    surface.tetrahedra << 1, 0, 0, 0, 0,  //
        2, 2, 1, 1, 1,                    //
        3, 3, 3, 2, 2,                    //
        4, 4, 4, 4, 3;
    orient(surface, "5-cell");
    return surface;
}

/// The 16-cell on the ends of the axes: 2/3 m^4.
inline TetSurface sixteen_cell() {
    TetSurface surface;
    surface.points.resize(4, 8);
    surface.points << Eigen::Matrix4d::Identity(), -Eigen::Matrix4d::Identity();
    surface.tetrahedra.resize(4, 16);
    for (unsigned signs = 0; signs < 16; ++signs) {
        for (unsigned axis = 0; axis < 4; ++axis) {
            surface.tetrahedra(axis, signs) = axis + (signs >> axis & 1U) * 4;
        }
    }
    orient(surface, "16-cell");
    return surface;
}

/// The same tetrahedra, each with points of its own.
inline TetSurface taken_apart(const TetSurface& surface) {
    TetSurface apart{Positions<4>(4, surface.tetrahedra.size()),
                     Simplices<4>(4, surface.tetrahedra.cols())};
    for (Eigen::Index i = 0; i < apart.points.cols(); ++i) {
        apart.points.col(i) = surface.points.col(surface.tetrahedra(i % 4, i / 4));
        apart.tetrahedra(i % 4, i / 4) = static_cast<std::uint32_t>(i);
    }
    return apart;
}

/// The same with a point before all others and one behind them that no tetrahedron has.
inline TetSurface with_unused_points(const TetSurface& surface) {
    TetSurface more{Positions<4>::Constant(4, surface.points.cols() + 2, 5),
                    (surface.tetrahedra.array() + 1).matrix()};
    more.points.middleCols(1, surface.points.cols()) = surface.points;
    return more;
}

/// Reads a file with this text.
inline Content read_as(const std::string& name, const std::string& text) {
    const pent::test::TempFolder folder;
    std::ofstream(folder / name, std::ios::binary) << text;
    return read(folder / name);
}

/// What read() says of it.
inline std::string error_as(const std::string& name, const std::string& text) {
    return pent::test::error_of([&] { static_cast<void>(read_as(name, text)); });
}

/// What a file of this name has after a surface was written to it.
inline std::string text_as(const std::string& name,
                           const Content& content,
                           const WriteOptions& options = {}) {
    const pent::test::TempFolder folder;
    write(folder / name, content, options);
    std::ifstream file(folder / name, std::ios::binary);
    return {std::istreambuf_iterator<char>(file), std::istreambuf_iterator<char>()};
}

/// Expects that a surface is closed, faces outward and is the same body of the same size.
inline void expect_same_surface(const Content& content, const TetSurface& expected, double error) {
    const auto& surface = std::get<TetSurface>(content);
    EXPECT_TRUE(check(surface).is_oriented());
    EXPECT_EQ(surface.tetrahedra.cols(), expected.tetrahedra.cols());
    EXPECT_EQ(surface.points.cols(), expected.points.cols());
    EXPECT_LE((surface.points - expected.points).cwiseAbs().maxCoeff(), error);
    EXPECT_NEAR(enclosed_hypervolume(surface), enclosed_hypervolume(expected),
                10 * error * enclosed_hypervolume(expected));
}

/// The vector perpendicular to three, with perp(x, y, z) = w: what programs of G4MF and godot-4d
/// take for the outside of a tetrahedron.
inline Eigen::Vector4d perpendicular(const Eigen::Vector4d& a,
                                     const Eigen::Vector4d& b,
                                     const Eigen::Vector4d& c) {
    Eigen::Vector4d result;
    for (int axis = 0; axis < 4; ++axis) {
        Eigen::Matrix4d matrix;
        matrix << a, b, c, Eigen::Vector4d::Unit(axis);
        result[axis] = matrix.determinant();
    }
    return result;
}

}  // namespace pent::exchange::test
