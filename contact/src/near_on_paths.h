#pragma once

#include "apart.h"
#include "overlaps.h"
#include "paths.h"

#include <algorithm>
#include <cmath>
#include <utility>
#include <vector>

namespace pent::contact {

/// What a search along paths finds: candidates whose distance at the end has been measured, and
/// others.
struct FoundOnPaths {
    std::vector<Candidate> known;
    std::vector<Candidate> others;
    std::int64_t overlaps = 0;
};

/// All in one list, in the order of the pieces of work.
[[nodiscard]] inline CandidateList joined(const std::vector<FoundOnPaths>& pieces) {
    CandidateList all;
    std::size_t count = 0;
    for (const FoundOnPaths& piece : pieces) {
        count += piece.known.size() + piece.others.size();
        all.overlaps += piece.overlaps;
    }
    all.pairs.reserve(count);
    for (const FoundOnPaths& piece : pieces) {
        all.pairs.insert(all.pairs.end(), piece.known.begin(), piece.known.end());
    }
    all.known_count = all.pairs.size();
    for (const FoundOnPaths& piece : pieces) {
        all.pairs.insert(all.pairs.end(), piece.others.begin(), piece.others.end());
    }
    return all;
}

/// Adds pairs without a common vertex that may come within the activation distance of each other
/// while their vertices are near their paths, with their distances. Within one list (edges in R^3,
/// within one body) a pair has the lower place first.
template <int Dim, int K, int L>
struct NearOnPaths {
    using Found = FoundOnPaths;

    const Simplices<K>& first;
    const Simplices<L>& second;
    bool is_same_list = false;
    const Paths<Dim>& paths;         ///< With their inflation.
    double activation_distance = 0;  ///< m.
    double measured = 0;             ///< Up to this distances are measured, m.

    void operator()(std::uint32_t i, std::uint32_t j, FoundOnPaths& found) const {
        // Room for rounding: candidates have to be a superset.
        constexpr double kRoundUp = 1 + 1e-9;
        ++found.overlaps;
        if (is_same_list && j < i) {
            std::swap(i, j);
        }
        const double near = (activation_distance + paths.template inflation_of<K>(first, i)
                             + paths.template inflation_of<L>(second, j))
                            * kRoundUp;
        const Corners<Dim, K> p = gather<Dim, K>(first, i, paths.to);
        const Corners<Dim, L> q = gather<Dim, L>(second, j, paths.to);
        ClosestPointSearch<Dim, K, L> closest(p, q, measured * measured);
        const bool is_known = !are_apart_along_middles<Dim, K, L>(p, q, measured) && closest.run();
        const double distance = is_known ? std::sqrt(closest.best().distance_squared) : measured;
        const double length = relative_path_length<Dim, K, L>(
            gather<Dim, K>(first, i, paths.from), p, gather<Dim, L>(second, j, paths.from), q);
        if (distance < near + length * kRoundUp) {
            (is_known ? found.known : found.others).push_back({i, j, rounded_down(distance)});
        }
    }
};

}  // namespace pent::contact
