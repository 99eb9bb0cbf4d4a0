#pragma once

#include <Eigen/Core>

#include <array>
#include <cmath>

namespace pent::mesher {

/// The lattice A4*, with the 24 simplices at each point along the paths from it to the opposite
/// corner of its cell. They fill space and are all congruent; their mean ratio is 0.894. Source:
/// [conway1999, ch. 4].
struct Lattice {
    double spacing = 1;  ///< m.

    /// With edges of this mean length, m: five of a simplex are sqrt(0.8) long, five sqrt(1.2).
    static Lattice with_mean_edge(double length) {
        return {2 * length / (std::sqrt(0.8) + std::sqrt(1.2))};
    }

    [[nodiscard]] double mean_edge() const {
        return (std::sqrt(0.8) + std::sqrt(1.2)) / 2 * spacing;
    }

    [[nodiscard]] double longest_edge() const { return std::sqrt(1.2) * spacing; }

    /// Of a simplex, m^4: a cell of the lattice is 1 / sqrt(5) of the cube of its spacing.
    [[nodiscard]] double cell_volume() const {
        return spacing * spacing * spacing * spacing / (24 * std::sqrt(5.0));
    }

    [[nodiscard]] Eigen::Vector4d point(const Eigen::Vector4i& z) const {
        return place(z.cast<double>());
    }

    /// Where coordinates of the lattice lie in space, whole or not.
    [[nodiscard]] Eigen::Vector4d place(const Eigen::Vector4d& z) const {
        return spacing * (z.array() - kLean * z.sum()).matrix();
    }

    /// The coordinates in the lattice of a point of space.
    [[nodiscard]] Eigen::Vector4d coordinates(const Eigen::Vector4d& p) const {
        return (p.array() + kLean / (1 - 4 * kLean) * p.sum()).matrix() / spacing;
    }

private:
    static constexpr double kLean = 0.13819660112501053;  // (1 - 1 / sqrt(5)) / 4
};

/// A simplex at a lattice point: its corners as sets of axes along which to step, and whether
/// that order turns it over.
struct LatticePath {
    std::array<unsigned, 5> steps{};
    bool is_odd = false;
};

/// All 24, in the order of their permutations of the axes.
[[nodiscard]] const std::array<LatticePath, 24>& lattice_paths();

}  // namespace pent::mesher
