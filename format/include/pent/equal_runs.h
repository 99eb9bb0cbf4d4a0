#pragma once

#include <cstddef>

namespace pent {

/// Calls visit(first, count) for every maximal run of equal neighbors, in their order.
///
/// @param sorted  Has [] and size(); equal elements stand together.
/// @param same    bool same(a, b): whether two elements are equal.
template <typename Sorted, typename Same, typename Visit>
void for_each_equal_run(const Sorted& sorted, const Same& same, const Visit& visit) {
    for (std::size_t first = 0; first < sorted.size();) {
        std::size_t last = first + 1;
        while (last < sorted.size() && same(sorted[first], sorted[last])) {
            ++last;
        }
        visit(first, last - first);
        first = last;
    }
}

}  // namespace pent
