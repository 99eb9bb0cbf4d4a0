#pragma once

#include "candidate.h"

namespace pent::contact {

/// The pairs of one body that are nearly near enough at rest to be in contact there, ascending. All
/// others are either nearer, and no contact at all, or at least `rest_distance` apart at rest.
struct RestProximityPairs {
    double rest_distance =
        0;                 ///< m; 0 if pairs have not been told apart, then there are none here.
    CandidateList points;  ///< Vertices and facets.
    CandidateList mixed;   ///< Edges and ridges.

    [[nodiscard]] std::int64_t bytes() const {
        return static_cast<std::int64_t>((points.pairs.size() + mixed.pairs.size())
                                         * sizeof(Candidate));
    }
};

/// Finds them, up to twice the distance of contact; none where edges are so short against that that
/// they would be very many. Parallel.
///
/// @param rest      Rest positions of all vertices of the scene.
/// @param distance  Of contact, m.
template <int Dim>
[[nodiscard]] RestProximityPairs find_rest_proximity_pairs(const Surface<Dim>& surface,
                                                           const PositionsView<Dim>& rest,
                                                           double distance);

}  // namespace pent::contact
