#pragma once

#include "fitted_tree.h"

#include <pent/contact/contacts.h>

#include <cstdint>
#include <vector>

namespace pent::contact {

/// Places of two simplices in the lists of their surfaces.
struct IndexPair {
    std::uint32_t first = 0;
    std::uint32_t second = 0;
};

/// What of two bodies (or of one and itself) can come near, each list ascending.
struct CandidatePairs {
    int first_body = 0;
    int second_body = 0;
    std::vector<IndexPair> points_first;   ///< Vertices of the first, facets of the second.
    std::vector<IndexPair> points_second;  ///< The other way round; none within one body.
    std::vector<IndexPair> mixed_first;    ///< Edges of the first, ridges of the second.
    std::vector<IndexPair> mixed_second;   ///< The other way round; in R^4 between two bodies.
};

/// The pairs of simplices that can come within a reach of each other while vertices move along
/// straight paths. Pairs that share a vertex are left out.
///
/// Every vertex has a box around its path and some slack; a pair whose boxes are further apart than
/// the reach is no candidate. So candidates hold for all motions that stay in the boxes, and are
/// searched again only when a vertex leaves its own, or when much shorter motions are asked for.
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
        const Corners<Dim, 1> point = center;
        trees_[body].facets.tree().for_each_overlap(
            box_around<Dim, 1>(point, radius + 0.5 * reach_), visit);
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
    void search(const PositionsView<Dim>& from, const PositionsView<Dim>& to, double slack);
    void update_trees();
    void find_pairs();
    template <int Count>
    [[nodiscard]] std::vector<Box> hulls(const Simplices<Count>& simplices) const;
    template <int K, int L>
    [[nodiscard]] std::vector<IndexPair> search(const Simplices<K>& first,
                                                const BoxTree& first_tree,
                                                const Simplices<L>& second,
                                                const BoxTree& second_tree) const;

    const std::vector<ContactBody<Dim>>& bodies_;
    std::vector<bool> is_held_;
    bool self_;
    double reach_;
    double slack_;
    Positions<Dim> start_;         // where the covered paths begin
    std::vector<Box> boxes_;       // around the path of each vertex, its slack and half the reach
    std::vector<Box> free_boxes_;  // the same without the reach: where a vertex may go
    double longest_ = 0;           // motion that candidates were searched for, m
    Eigen::VectorXd travel_;       // how far from start_ each vertex may get, m
    std::vector<Trees> trees_;
    std::vector<CandidatePairs> pairs_;
    std::int64_t searches_ = 0;
};

}  // namespace pent::contact
