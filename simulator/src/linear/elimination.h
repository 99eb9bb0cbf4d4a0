#pragma once

#include "linear/links.h"

#include <Eigen/Core>

#include <cstdint>
#include <vector>

namespace pent::simulator {

/// Consecutive columns of a sparse Cholesky factor that have nearly the same rows below them and
/// are eliminated together, as one dense matrix. A column is that of a dof, Dim scalars wide.
struct Supernode {
    std::uint32_t begin = 0;          ///< Its first column, in the order of elimination.
    std::uint32_t width = 0;          ///< How many columns it has.
    std::vector<std::uint32_t> rows;  ///< Below its columns, in that order, increasing.
    std::int64_t parent = -1;         ///< The supernode that takes its update; -1 for a root.
};

/// Symbolic Cholesky factorization: the order of elimination, the structure of the factor, and what
/// it costs.
struct Elimination {
    std::vector<std::uint32_t> order;   ///< The dof at each place.
    std::vector<std::uint32_t> place;   ///< The place of each dof.
    std::vector<Supernode> supernodes;  ///< In postorder: children before their parents.
    std::int64_t blocks = 0;            ///< Dim x Dim blocks of the factor.
    std::int64_t peak_blocks = 0;       ///< Most blocks of factor and updates at the same time.
    double products = 0;                ///< Products of blocks that make the factor.
};

/// Orders by nested dissection [george1973]: the two halves of a body, cut across its longest side,
/// then the separator between them, and the halves in the same way. Where it takes fewer products
/// the order of the dofs is kept, which suits slender bodies, numbered from end to end. Columns are
/// merged into supernodes where that stores few zeros.
///
/// @param places  Rest positions, a column for each dof, m.
[[nodiscard]] Elimination eliminate(const Links& links,
                                    const Eigen::Ref<const Eigen::MatrixXd>& places);

/// The same for a given order of the dofs, which is changed only to a postorder of its elimination
/// tree, with the same factor.
[[nodiscard]] Elimination eliminate(const Links& links, const std::vector<std::uint32_t>& order);

}  // namespace pent::simulator
