#pragma once

#include <pent/simd.h>

// Of internal linkage: each file has its own, compiled for its instruction set.

namespace pent::contact {
namespace {

/// Rows of four numbers become columns.
template <typename Number>
[[gnu::always_inline]] inline void transpose(Pack<Number, 4>* rows) {
    using Four = Pack<Number, 4>;
    const auto& p = rows[0].lanes;
    const auto& q = rows[1].lanes;
    const auto& r = rows[2].lanes;
    const auto& s = rows[3].lanes;
    const typename Four::Vector a = __builtin_shufflevector(p, q, 0, 4, 1, 5);
    const typename Four::Vector b = __builtin_shufflevector(p, q, 2, 6, 3, 7);
    const typename Four::Vector c = __builtin_shufflevector(r, s, 0, 4, 1, 5);
    const typename Four::Vector d = __builtin_shufflevector(r, s, 2, 6, 3, 7);
    rows[0] = Four(__builtin_shufflevector(a, c, 0, 1, 4, 5));
    rows[1] = Four(__builtin_shufflevector(a, c, 2, 3, 6, 7));
    rows[2] = Four(__builtin_shufflevector(b, d, 0, 1, 4, 5));
    rows[3] = Four(__builtin_shufflevector(b, d, 2, 3, 6, 7));
}

}  // namespace
}  // namespace pent::contact
