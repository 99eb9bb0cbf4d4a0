#pragma once

#include "kernels/kernels.h"
#include "model/bodies.h"

#include <pent/simulator/ranks.h>

#include <cstdint>
#include <memory>
#include <string>

namespace pent::simulator {

/// The instruction set of that name, or the widest of this machine; where nothing is named ranks
/// take the widest that all of them have, since others would not give the same digits. Throws an
/// Error for one that is not known or not supported.
///
/// @param ranks  Null for none.
[[nodiscard]] Isa choose_isa(const std::string& name, const Ranks* ranks);

/// Shares the bodies out to ranks, which keep the NeededCells of their vertices. Throws an Error on
/// all ranks where they have other meshes, or where there are more of them than columns.
///
/// @param ranks  Null for none: nothing is shared then.
template <int Dim>
[[nodiscard]] Bodies<Dim> share(const Scene& scene,
                                Bodies<Dim> bodies,
                                const std::shared_ptr<const Ranks>& ranks);

/// Positions that all ranks compute alike must have come out alike: else ranks would go different
/// ways from here on, and wait for one another forever. Throws an Error on all of them where they
/// differ.
template <int Dim>
void refuse_disagreement(const Sharing& sharing,
                         const Positions<Dim>& positions,
                         std::uint64_t step);

}  // namespace pent::simulator
