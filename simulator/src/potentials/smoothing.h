#pragma once

#include "linear/block_pattern.h"

#include <pent/simplex_mesh.h>

#include <cstdint>
#include <vector>

namespace pent::simulator {

/// The domains of edge-based smoothed finite elements [liu2009, cazes2013], one around every edge
/// of a mesh of linear simplices.
///
/// A domain has an equal share of the volume of each cell at its edge, and the mean of their
/// deformation gradients, weighted by those shares: F = sum over corners of x_a g_a^T. Its energy
/// is that of the material at F, times its volume. Such elements lock far less in bending than
/// cells, and have no zero-energy modes but the rigid ones.
template <int Dim>
struct SmoothingDomains : CornerLists {  // corners increase within a domain
    Positions<Dim> gradients;            ///< A column for each corner, 1/m; they add up to zero.
    std::vector<double> volumes;         ///< m^Dim.

    [[nodiscard]] Eigen::Index count() const { return static_cast<Eigen::Index>(volumes.size()); }
};

/// The domains of the cells in [begin, end), in the order of their edges.
///
/// @param rest   Dim x vertices, m.
/// @param cells  Positively oriented.
template <int Dim>
[[nodiscard]] SmoothingDomains<Dim> smoothing_domains(const Positions<Dim>& rest,
                                                      const Simplices<Dim + 1>& cells,
                                                      Eigen::Index begin,
                                                      Eigen::Index end);

}  // namespace pent::simulator
