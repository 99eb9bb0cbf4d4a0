#pragma once

#include "apart.h"
#include "candidate.h"
#include "closest_point_search.h"
#include "gather.h"

#include <cmath>

namespace pent::contact {

/// The corners of a pair of simplices.
template <int Dim, int K, int L>
struct PairAt {
    Corners<Dim, K> first;
    Corners<Dim, L> second;

    PairAt(const Simplices<K>& a,
           const Simplices<L>& b,
           const Candidate& pair,
           const PositionsView<Dim>& positions)
        : first(gather<Dim, K>(a, pair.first, positions)),
          second(gather<Dim, L>(b, pair.second, positions)) {}

    /// Their distance if it is below a limit, else the limit.
    [[nodiscard]] double distance_below(double limit) const {
        if (are_boxes_apart<Dim, K, L>(first, second, limit * limit)
            || are_apart_along_middles<Dim, K, L>(first, second, limit)) {
            return limit;
        }
        ClosestPointSearch<Dim, K, L> search(first, second, limit * limit);
        return search.run() ? std::sqrt(search.best().distance_squared) : limit;
    }
};

}  // namespace pent::contact
