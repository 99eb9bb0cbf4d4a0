#pragma once

#include <pent/parallel.h>

#include <Eigen/Core>

#include <algorithm>

namespace pent::simulator {

/// Sum of work(v) over all vertices, in chunks that are added in their order.
template <typename Work>
[[nodiscard]] double sum_vertices(const Workers& workers, Eigen::Index vertices, const Work& work) {
    constexpr Eigen::Index kChunk = 1024;
    return workers.sum(static_cast<int>((vertices + kChunk - 1) / kChunk), [&](int chunk) {
        const Eigen::Index begin = chunk * kChunk;
        double sum = 0;
        for (Eigen::Index v = begin; v < std::min(begin + kChunk, vertices); ++v) {
            sum += work(v);
        }
        return sum;
    });
}

}  // namespace pent::simulator
