#pragma once

#include "candidates.h"
#include "fitted_tree.h"

#include <pent/contact/contacts.h>

#include <cstdint>
#include <vector>

namespace pent::contact {

/// The pairs of simplices that can come within a reach of each other while vertices move along
/// straight paths. Pairs that share a vertex are left out.
///
/// Vertices may leave their paths by some slack: candidates hold for all positions that have every vertex
/// that near to where its path is at one and the same time. Only for others are they searched again, or
/// when much shorter motions are asked for elsewhere.
///
/// Each candidate knows how far apart it was where the paths end, which is where Newton's method goes on:
/// a Sieve holds most of them back there.
template <int Dim>
class PathCandidates {
public:
    /// @param bodies   Kept by reference.
    /// @param is_held  One for each vertex of the scene.
    /// @param self     Whether bodies meet themselves.
    /// @param reach    m, > 0.
    /// @param slack    m, >= 0: how far from their ways vertices may get, at least, before the next
    ///                 search.
    PathCandidates(const std::vector<ContactBody<Dim>>& bodies,
                   std::vector<bool> is_held,
                   bool self,
                   double reach,
                   double slack);

    /// Sees to it that pairs() hold for everything on the way between two positions, and are not many
    /// more than that needs.
    void cover(const PositionsView<Dim>& from, const PositionsView<Dim>& to);

    /// Sees to it that pairs() hold at these positions.
    void cover(const PositionsView<Dim>& positions);

    [[nodiscard]] const std::vector<CandidatePairs>& pairs() const { return pairs_; }

    /// Of the vertices on the way between two positions. After cover().
    [[nodiscard]] Travel travel(const PositionsView<Dim>& from, const PositionsView<Dim>& to) const;

    [[nodiscard]] const std::vector<bool>& is_held() const { return is_held_; }

    /// Whether all corners of a simplex are held.
    template <int Count>
    [[nodiscard]] bool is_held(const Simplices<Count>& simplices, Eigen::Index i) const {
        bool is_all = true;
        for (int corner = 0; corner < Count; ++corner) {
            is_all &= is_held_[simplices(corner, i)];
        }
        return is_all;
    }

    /// Calls visit(facet) for facets of a body, in any order, that may come within the reach of a
    /// ball. After cover().
    template <typename Visit>
    void for_each_facet_near(int body,
                             const Vector<Dim>& center,
                             double radius,
                             const Visit& visit) const {
        trees_[body].facets.tree().for_each_overlap(
            box_around<Dim, 1>(center, radius + 0.5 * reach_), visit);
    }

    [[nodiscard]] std::int64_t searches() const { return searches_; }  ///< So far.

private:
    struct Trees {
        FittedTree vertices;
        FittedTree edges;
        FittedTree ridges;  // empty in R^3, where ridges are edges
        FittedTree facets;
    };

    [[nodiscard]] bool is_covered(const PositionsView<Dim>& positions) const;
    [[nodiscard]] bool is_crude(const PositionsView<Dim>& from, double way) const;
    void search(const PositionsView<Dim>& from, const PositionsView<Dim>& to);
    void update_trees();
    void find_pairs();
    template <int Count>
    [[nodiscard]] std::vector<Box> hulls(const Simplices<Count>& simplices) const;
    template <int K, int L>
    [[nodiscard]] CandidateList search(const Simplices<K>& first,
                                       const BoxTree& first_tree,
                                       const Simplices<L>& second,
                                       const BoxTree& second_tree) const;

    const std::vector<ContactBody<Dim>>& bodies_;
    std::vector<bool> is_held_;
    bool self_;
    double reach_;
    double least_slack_;
    Positions<Dim> start_;    // where the covered paths begin
    Positions<Dim> end_;      // and end: where distances are measured
    Eigen::VectorXd way_;     // how long the path of each vertex is, m
    Eigen::VectorXd slack_;   // how far each vertex may leave its path, m
    double longest_ = 0;      // motion that candidates were searched for, m
    std::vector<Box> boxes_;  // around the path of each vertex, its slack and half the reach
    std::vector<Trees> trees_;
    std::vector<CandidatePairs> pairs_;
    std::int64_t searches_ = 0;
};

}  // namespace pent::contact
