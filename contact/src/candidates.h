#pragma once

#include "candidate.h"
#include "colliders.h"
#include "convex_body.h"
#include "meetings.h"
#include "overlaps.h"
#include "self_proximity.h"
#include "shared_work.h"
#include "surface_patches.h"
#include "surface_trees.h"

#include <cstdint>
#include <optional>
#include <utility>
#include <vector>

namespace pent::contact {

/// The work of all searches for candidates so far.
struct SearchWork {
    std::int64_t searches = 0;  ///< Of two colliders each, or within one.
    std::int64_t overlaps = 0;  ///< As those of a CandidateList.
    std::int64_t trees_built = 0;
    std::int64_t trees_refit = 0;
    double tree_seconds = 0;
};

/// The pairs of simplices of a scene that can come within the activation distance (with the
/// separation) of each other while vertices move along straight paths; a single position is a path
/// of no length. Pairs that share a vertex are left out.
///
/// Lists are kept, as Verlet lists are: vertices may leave their paths by an inflation. The pairs
/// of two colliders hold for all positions at which, up to a common translation and at one common
/// time, each of their vertices is that near to its path. Only for others are they searched again,
/// or when much shorter motions are asked for elsewhere. So what lies still is searched once,
/// whatever goes on beside it, and colliders that fly together are not searched again.
///
/// Each candidate knows how far apart it was at the ends of the paths, which is where Newton's
/// method goes on: a DistanceCull holds most of them back there.
///
/// Under a penalty, mixed pairs are those whose closest points are inside both, unless they are
/// kept for other positions (a margin). Candidates within bodies are then found anew each time, by
/// a SelfProximity: only those that can be in contact.
template <int Dim>
class Candidates {
public:
    /// @param colliders  Must outlive this.
    /// @param shared     Of a team each has the candidates that it finds, and all have the same
    ///                   lists, if empty ones.
    explicit Candidates(const Colliders<Dim>& colliders, const SharedWork& shared = {});

    /// Makes the lists hold for straight paths between two positions, without many more pairs than
    /// these need.
    void cover(const PositionsView<Dim>& from, const PositionsView<Dim>& to);

    /// Makes the lists hold for these positions.
    void cover(const PositionsView<Dim>& positions);

    /// Under a penalty, drops pairs that are not kept for another evaluation, or that are too many
    /// to be.
    void drop_what_is_not_kept();

    [[nodiscard]] const Meetings<Dim>& meetings() const { return meetings_; }

    /// How far the vertices of each meeting get from where its distances were measured on the way
    /// between two positions; of no vertex where it has no pairs.
    [[nodiscard]] std::vector<Displacement> displacements(const PositionsView<Dim>& from,
                                                          const PositionsView<Dim>& to) const;

    /// How near simplices of two colliders have to be found, m.
    [[nodiscard]] double activation_distance(int first, int second) const {
        return activation_distance_ + colliders_.radius(first) + colliders_.radius(second);
    }

    /// Whether the mixed pairs between colliders are exactly those that are near now, with closest
    /// points inside both.
    [[nodiscard]] bool is_exact() const { return is_penalty() && min_inflation_ == 0; }

    [[nodiscard]] const Colliders<Dim>& colliders() const { return colliders_; }
    [[nodiscard]] const SharedWork& shared() const { return shared_; }

    /// The trees, under a penalty, over boxes around the vertices and facets, where they are now,
    /// of a collider that meets others.
    [[nodiscard]] const SurfaceTrees<Dim>& trees(int collider) const {
        return trees_[static_cast<std::size_t>(collider)];
    }

    [[nodiscard]] SearchWork work() const;
    [[nodiscard]] std::int64_t bytes() const;

private:
    using Pair = typename Meetings<Dim>::Pair;

    [[nodiscard]] bool is_penalty() const { return !colliders_.is_barrier(); }

    [[nodiscard]] std::vector<Pair> covered(const Paths<Dim>& paths) const;
    [[nodiscard]] bool does_cover(const Meeting<Dim>& meeting, const Paths<Dim>& paths) const;
    void insert(const Pair& pair, Meeting<Dim> meeting);
    void cover_within(const Paths<Dim>& paths, const std::vector<Pair>& covered);
    [[nodiscard]] Meeting<Dim> find_within(int body, Paths<Dim> paths);
    [[nodiscard]] SelfProximity<Dim>& proximity(int body);
    void cover_between(const Paths<Dim>& paths, const std::vector<Pair>& covered);
    [[nodiscard]] std::vector<Pair> overlapping(Paths<Dim> paths);
    void search_between(const std::vector<Pair>& pairs, Paths<Dim> paths);
    [[nodiscard]] Simplices<1> vertices_of(const std::vector<int>& colliders) const;
    void fit_patches(int collider, const Paths<Dim>& paths);
    void fit_trees(const PositionsView<Dim>& positions);
    [[nodiscard]] CandidatePairs find_between(const Pair& pair, const Paths<Dim>& paths) const;
    // The distance up to which distances are measured under a barrier, m.
    [[nodiscard]] double measured_within(double distance) const;
    template <int K, int L>
    [[nodiscard]] CandidateList search(int first, int second, const Paths<Dim>& paths) const;
    template <int K, int L, typename Test>
    [[nodiscard]] CandidateList search(int first,
                                       int second,
                                       bool is_still,
                                       const Test& test) const;

    const Colliders<Dim>& colliders_;
    SharedWork shared_;
    double activation_distance_;  // m, with the separation
    double min_inflation_;        // m
    Meetings<Dim> meetings_;
    std::vector<SurfaceTrees<Dim>> trees_;  // of vertices and facets, under a penalty
    std::vector<std::optional<SurfacePatches<Dim>>> patches_;  // of colliders that were near others
    std::vector<std::optional<SelfProximity<Dim>>>
        proximity_;                                       // of bodies that may be near themselves
    std::vector<std::optional<ConvexBody<Dim>>> convex_;  // of bodies that may meet themselves
    std::vector<Box> boxes_;     // around the path of each vertex, while it is searched
    Eigen::VectorXd inflation_;  // of each path, m, while it is searched
    SearchWork work_;
};

}  // namespace pent::contact
