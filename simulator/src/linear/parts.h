#pragma once

#include <pent/parallel.h>

#include <algorithm>
#include <cstdint>

namespace pent::simulator {

/// Calls work(first, last), in parallel, for parts of [begin, end) of `size` each.
template <typename Work>
void for_each_part(const Workers& workers,
                   std::int64_t begin,
                   std::int64_t end,
                   std::int64_t size,
                   const Work& work) {
    workers.for_each((end - begin + size - 1) / size, [&](std::int64_t part) {
        const std::int64_t first = begin + part * size;
        work(first, std::min(first + size, end));
    });
}

inline constexpr std::int64_t kModeRows = 16;  ///< Rows of a coarse matrix to a part.

}  // namespace pent::simulator
