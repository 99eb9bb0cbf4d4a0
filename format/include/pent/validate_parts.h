#pragma once

#include <pent/simplex_mesh.h>
#include <pent/slab_writers.h>

#include <cstdint>
#include <span>
#include <string_view>

namespace pent {

/// validate() of a mesh that several processes have together: each has all vertices and some of the
/// cells, and any cell is with one of them at least. All throw the Error that validate() throws of
/// the whole, of its lowest cell with a fault.
///
/// @param numbers  Which cells of the whole are here, increasing.
template <int Dim>
void validate_parts(const SimplexMesh<Dim>& mesh,
                    std::string_view name,
                    std::span<const std::uint32_t> numbers,
                    const SlabWriters& processes);

}  // namespace pent
