#pragma once

#include "candidate.h"
#include "colliders.h"
#include "overlaps.h"
#include "path_cover.h"
#include "self_proximity.h"
#include "shared_work.h"
#include "surface_patches.h"
#include "surface_trees.h"

#include <cstdint>
#include <optional>
#include <utility>
#include <vector>

namespace pent::contact {

/// What the search for candidates took so far.
struct SearchWork {
    std::int64_t searches = 0;
    std::int64_t overlaps = 0;  ///< As those of a CandidateList.
    std::int64_t trees_built = 0;
    std::int64_t trees_refit = 0;
    double tree_seconds = 0;
};

/// The pairs of simplices of a scene that can come within the activation distance (with the
/// separation) of each other while vertices move along straight paths; a single position is a path
/// of no length. Pairs that share a vertex are left out.
///
/// Vertices may leave their paths by an inflation: candidates hold for all positions that have
/// every vertex that near to where its path is at one and the same time, but for a shift of all.
/// Only for others are they searched again, or when much shorter motions are asked for elsewhere.
/// Pairs within a body under a barrier have a cover of their own: only how its vertices move
/// against each other matters to them.
///
/// Each candidate knows how far apart it was where the paths end, which is where Newton's method
/// goes on: a DistanceCull holds most of them back there.
///
/// Of a penalty, mixed pairs are those whose closest points are inside both, unless they are kept
/// for other positions (a margin). Within bodies its candidates are found anew each time, by a
/// SelfProximity: those alone that can be in contact.
template <int Dim>
class Candidates {
public:
    /// @param colliders  Must outlive this.
    /// @param shared     Of a team each has the candidates that it finds, and all have the same
    ///                   lists, if empty ones.
    explicit Candidates(const Colliders<Dim>& colliders, const SharedWork& shared = {});

    /// Sees to it that pairs() hold for everything on the way between two positions, and are not
    /// many more than that needs.
    void cover(const PositionsView<Dim>& from, const PositionsView<Dim>& to);

    /// Sees to it that pairs() hold at these positions.
    void cover(const PositionsView<Dim>& positions);

    /// Drops pairs that would not be of use again, or that are too many to keep for penalties.
    void drop_what_is_not_kept();

    /// By colliders.
    [[nodiscard]] const std::vector<CandidatePairs>& pairs() const { return pairs_; }

    /// Calls visit<K, L>(list, first, second) for each list, K and L being the corners of its
    /// simplices and first and second the colliders that these belong to.
    template <typename Visit>
    void for_each_list(const Visit& visit) const {
        for (const CandidatePairs& pairs : pairs_) {
            visit.template operator()<1, Dim>(pairs.points_first, pairs.first, pairs.second);
            visit.template operator()<1, Dim>(pairs.points_second, pairs.second, pairs.first);
            visit.template operator()<2, Dim - 1>(pairs.mixed_first, pairs.first, pairs.second);
            visit.template operator()<2, Dim - 1>(pairs.mixed_second, pairs.second, pairs.first);
        }
    }

    /// How near simplices of two colliders have to be found, m.
    [[nodiscard]] double activation_distance(int first, int second) const {
        return activation_distance_ + colliders_.radius(first) + colliders_.radius(second);
    }

    /// Whether mixed pairs are all that are near now, inside both, and no other.
    [[nodiscard]] bool is_exact() const { return is_penalty() && min_inflation_ == 0; }

    /// Of the vertices on the way between two positions, from where distances were measured.
    [[nodiscard]] Displacements displacements(const PositionsView<Dim>& from,
                                              const PositionsView<Dim>& to) const;

    [[nodiscard]] const Colliders<Dim>& colliders() const { return colliders_; }
    [[nodiscard]] const SharedWork& shared() const { return shared_; }

    /// Over boxes that hold the vertices and facets of what was covered between bodies, under a
    /// penalty.
    [[nodiscard]] const SurfaceTrees<Dim>& trees(int collider) const {
        return trees_[static_cast<std::size_t>(collider)];
    }

    [[nodiscard]] SearchWork work() const;
    [[nodiscard]] std::int64_t bytes() const;

private:
    [[nodiscard]] bool is_penalty() const { return !colliders_.is_barrier(); }

    // Up to where distances are measured under a barrier, m.
    [[nodiscard]] double measured_within(double distance) const;
    [[nodiscard]] bool does_cover(int body, const Paths<Dim>& paths) const;
    [[nodiscard]] bool is_too_coarse(double searched, double measured_from, double asked) const;
    void search_between(const Paths<Dim>& paths);
    void search_within(int body, const Paths<Dim>& paths);
    void fit(const Paths<Dim>& paths);
    void fit_patches(int collider, const Paths<Dim>& paths);
    void find_pairs_between(bool is_still);
    void insert(CandidatePairs pairs);
    [[nodiscard]] SelfProximity<Dim>& proximity(int body);
    void insert_within(int body, CandidatePairs pairs);
    template <int K, int L>
    [[nodiscard]] CandidateList search(int first, int second, bool is_still) const;
    template <int K, int L, typename Test>
    [[nodiscard]] CandidateList search(int first,
                                       int second,
                                       bool is_still,
                                       const Test& test) const;

    const Colliders<Dim>& colliders_;
    SharedWork shared_;
    double activation_distance_;   // m, with the separation
    double min_inflation_;         // m
    Simplices<1> vertices_;        // of all surfaces
    PathCover<Dim> between_;       // what pairs of two colliders hold for
    PathCover<Dim> within_;        // the same of pairs within a body, under a barrier
    double longest_between_ = 0;   // motion that candidates were searched for, m
    std::vector<double> longest_;  // the same within each collider; below 0 where not searched
    std::vector<Box> boxes_;  // around the path of each vertex, its inflation and half a distance
    std::vector<SurfaceTrees<Dim>> trees_;  // of vertices and facets, under a penalty
    std::vector<std::optional<SurfacePatches<Dim>>> patches_;  // of colliders that were near others
    std::vector<std::optional<SelfProximity<Dim>>>
        proximity_;                             // of bodies that may meet themselves
    std::vector<std::pair<int, int>> meeting_;  // colliders whose boxes overlap
    std::vector<CandidatePairs> pairs_;
    SearchWork work_;
};

}  // namespace pent::contact
