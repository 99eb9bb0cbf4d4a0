#pragma once

#include "linear/links.h"

#include <Eigen/Core>

#include <cstdint>
#include <vector>

namespace pent::simulator {

/// Columns of a factor of a sparse symmetric matrix that have the same rows below them, and are
/// eliminated together. A column is that of a dof, Dim scalars wide.
struct Supernode {
    std::uint32_t begin = 0;          ///< First of its columns, in the order of elimination.
    std::uint32_t width = 0;          ///< How many.
    std::vector<std::uint32_t> rows;  ///< Below them, increasing, in that order.
    std::int64_t parent = -1;         ///< What takes its update; -1 for a root.
};

/// In which order a sparse symmetric matrix is factored, and what that costs.
struct Elimination {
    std::vector<std::uint32_t> order;   ///< Dof of each place.
    std::vector<std::uint32_t> place;   ///< Place of each dof.
    std::vector<Supernode> supernodes;  ///< Children before their parents.
    std::int64_t blocks = 0;            ///< Of the factor, Dim x Dim.
    std::int64_t peak_blocks = 0;       ///< Of the factor and of updates at the same time, at most.
    double products = 0;                ///< Of Dim x Dim blocks, that make the factor.
};

/// Orders by nested dissection [george1973]: halves of a body, cut across its longest side, and
/// behind both what links them; or, where that takes fewer products, as slender bodies from end to
/// end do, as the dofs are numbered. Columns become supernodes where that stores few zeros.
///
/// @param places  A column for each dof, m: where they are at rest.
[[nodiscard]] Elimination eliminate(const Links& links,
                                    const Eigen::Ref<const Eigen::MatrixXd>& places);

/// The same in a given order of the dofs.
[[nodiscard]] Elimination eliminate(const Links& links, const std::vector<std::uint32_t>& order);

}  // namespace pent::simulator
