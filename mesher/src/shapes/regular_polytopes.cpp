#include "regular_polytopes.h"

#include <algorithm>
#include <array>
#include <cassert>
#include <cmath>
#include <numbers>
#include <vector>

namespace pent::mesher {

namespace {

using Points = std::vector<Eigen::Vector4d>;

constexpr double kGolden = std::numbers::phi;

Points simplex_corners() {
    const double low = -1 / std::sqrt(5.0);
    Points points = {
        {1, 1, 1, low}, {1, -1, -1, low}, {-1, 1, -1, low}, {-1, -1, 1, low}, {0, 0, 0, -4 * low}};
    for (Eigen::Vector4d& point : points) {
        point.normalize();
    }
    return points;
}

Points axes() {
    Points points;
    for (int axis = 0; axis < 4; ++axis) {
        points.push_back(Eigen::Vector4d::Unit(axis));
        points.push_back(-Eigen::Vector4d::Unit(axis));
    }
    return points;
}

Points tesseract_corners() {
    Points points;
    for (int signs = 0; signs < 16; ++signs) {
        Eigen::Vector4d point;
        for (int axis = 0; axis < 4; ++axis) {
            point[axis] = (signs >> axis & 1) == 0 ? 0.5 : -0.5;
        }
        points.push_back(point);
    }
    return points;
}

void append(Points& points, const Points& more) {
    points.insert(points.end(), more.begin(), more.end());
}

bool is_even(const std::array<int, 4>& permutation) {
    int inversions = 0;
    for (int i = 0; i < 4; ++i) {
        for (int j = i + 1; j < 4; ++j) {
            inversions += permutation[i] > permutation[j] ? 1 : 0;
        }
    }
    return inversions % 2 == 0;
}

// The 120 corners of the 600-cell: those of the 24-cell, and the even permutations of
// (+-phi, +-1, +-1/phi, 0) / 2.
Points icosian_units() {
    Points points = axes();
    append(points, tesseract_corners());
    std::array<int, 4> order = {0, 1, 2, 3};
    do {
        if (!is_even(order)) {
            continue;
        }
        for (int signs = 0; signs < 8; ++signs) {
            const std::array<double, 4> entries = {kGolden / 2, 0.5, 0.5 / kGolden, 0};
            Eigen::Vector4d point;
            for (int i = 0; i < 4; ++i) {
                point[order[i]] = (signs >> i & 1) == 0 ? entries[i] : -entries[i];
            }
            points.push_back(point);
        }
    } while (std::next_permutation(order.begin(), order.end()));
    return points;
}

// The directions of the 600 cells between those corners: every four that are pairwise nearest.
Points centers_of_cells() {
    const Points corners = icosian_units();
    const auto are_near = [&](std::size_t a, std::size_t b) {
        return corners[a].dot(corners[b]) > kGolden / 2 - 1e-9;  // the next nearest have 1/2
    };
    Points centers;
    for (std::size_t a = 0; a < corners.size(); ++a) {
        for (std::size_t b = a + 1; b < corners.size(); ++b) {
            for (std::size_t c = b + 1; are_near(a, b) && c < corners.size(); ++c) {
                for (std::size_t d = c + 1; are_near(a, c) && are_near(b, c) && d < corners.size();
                     ++d) {
                    if (are_near(a, d) && are_near(b, d) && are_near(c, d)) {
                        centers.push_back(
                            (corners[a] + corners[b] + corners[c] + corners[d]).normalized());
                    }
                }
            }
        }
    }
    return centers;
}

}  // namespace

std::vector<Eigen::Vector4d> cell_normals(int cells) {
    switch (cells) {
        case 5:
            return simplex_corners();
        case 8:
            return axes();
        case 16:
            return tesseract_corners();
        case 24: {
            Points points = axes();
            append(points, tesseract_corners());
            return points;
        }
        case 120:
            return icosian_units();
        default:
            assert(cells == 600);
            return centers_of_cells();
    }
}

double inradius_ratio(int cells) {
    switch (cells) {
        case 5:
            return 0.25;
        case 8:
        case 16:
            return 0.5;
        case 24:
            return std::numbers::sqrt2 / 2;
        default:  // the 120-cell and the 600-cell are duals
            return kGolden * kGolden / (2 * std::numbers::sqrt2);
    }
}

}  // namespace pent::mesher
