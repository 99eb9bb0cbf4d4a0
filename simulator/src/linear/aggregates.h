#pragma once

#include <pent/simplex_mesh.h>

#include <cstdint>
#include <vector>

namespace pent::simulator {

/// A partition of the unknowns into compact pieces of about equal size.
struct Aggregates {
    std::vector<std::uint32_t> of_unknown;            ///< Which aggregate an unknown belongs to.
    std::vector<std::vector<std::uint32_t>> members;  ///< Increasing.

    [[nodiscard]] int count() const { return static_cast<int>(members.size()); }
};

/// Cuts the unknowns of each body in two along the longest side of their box, until the pieces
/// are small: at most 550 unknowns, or more where that would make over 100 pieces, whose number
/// then grows as the root of that of the unknowns.
///
/// @param rest    Dim x unknowns, rest positions, m.
/// @param bodies  The body of each unknown.
template <int Dim>
[[nodiscard]] Aggregates make_aggregates(const Positions<Dim>& rest,
                                         const std::vector<std::uint32_t>& bodies);

}  // namespace pent::simulator
