#pragma once

#include <Eigen/Core>

#include <cstdint>
#include <tbb/blocked_range.h>
#include <tbb/parallel_for.h>

namespace pent::viewer {

/// Calls action(i) for i = 0 .. count - 1, in parallel and in no order; each must write only its
/// own results. The number of threads is the caller's oneTBB arena.
template <typename Action>
void parallel_for_each(Eigen::Index count, const Action& action) {
    constexpr Eigen::Index kChunk = 4096;
    tbb::parallel_for(tbb::blocked_range<Eigen::Index>(0, count, kChunk),
                      [&](const tbb::blocked_range<Eigen::Index>& range) {
                          for (Eigen::Index i = range.begin(); i != range.end(); ++i) {
                              action(i);
                          }
                      });
}

}  // namespace pent::viewer
