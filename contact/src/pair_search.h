#pragma once

#include "body_trees.h"
#include "tight_pairs.h"

#include <pent/contact/contacts.h>
#include <pent/contact/near_pairs.h>

#include <array>
#include <optional>

namespace pent::contact {

/// The pairs that two bodies (or one, with itself) may have in contact.
struct BodyPair {
    int first = 0;
    int second = 0;
    NearPairs points_first = {};   ///< Vertices of the first, facets of the second.
    NearPairs points_second = {};  ///< The other way round.
    NearPairs mixed_first = {};    ///< Edges of the first, ridges of the second.
    NearPairs mixed_second = {};   ///< The other way round.

    [[nodiscard]] std::array<const NearPairs*, 4> lists() const {
        return {&points_first, &points_second, &mixed_first, &mixed_second};
    }

    [[nodiscard]] std::int64_t candidates() const {
        return points_first.candidates + points_second.candidates + mixed_first.candidates
               + mixed_second.candidates;
    }
};

/// Finds the near pairs of all bodies: their trees, and pairs between bodies kept for positions
/// nearby. Within bodies only pairs that are near at rest are kept, once for all.
template <int Dim>
class PairSearch {
public:
    /// All must outlive this.
    ///
    /// @param rest  Of all vertices of the scene; read for pairs within bodies alone.
    PairSearch(const std::vector<ContactBody<Dim>>& bodies,
               const Positions<Dim>& rest,
               const ContactOptions& options)
        : bodies_(bodies),
          rest_(rest),
          options_(options),
          trees_(bodies.size()),
          tight_(bodies.size()) {}

    /// Pairs nearer than the distance of contact, by bodies; the report is told the work.
    [[nodiscard]] std::vector<BodyPair> run(const PositionsView<Dim>& positions,
                                            ContactReport& report);

    /// As of the last run.
    [[nodiscard]] const BodyTrees<Dim>& trees(int body) const {
        return trees_[static_cast<std::size_t>(body)];
    }

    [[nodiscard]] std::int64_t bytes() const;

private:
    [[nodiscard]] double search_distance() const { return options_.distance + 2 * options_.margin; }
    [[nodiscard]] bool is_kept_valid(const PositionsView<Dim>& positions) const;
    [[nodiscard]] bool may_meet(std::size_t a, std::size_t b) const;
    void update_trees(const PositionsView<Dim>& positions, ContactReport& report);
    void search(const PositionsView<Dim>& positions, ContactReport& report);
    [[nodiscard]] BodyPair search_within(int body, const PositionsView<Dim>& positions);
    void drop_what_is_too_much();
    [[nodiscard]] NearPairs points_near(int a, int b, const PositionsView<Dim>& positions) const;
    [[nodiscard]] NearPairs mixed_near(int a,
                                       int b,
                                       const PositionsView<Dim>& positions,
                                       Closest closest) const;
    [[nodiscard]] std::vector<BodyPair> still_near(const PositionsView<Dim>& positions) const;

    const std::vector<ContactBody<Dim>>& bodies_;
    const Positions<Dim>& rest_;
    const ContactOptions& options_;
    std::vector<BodyTrees<Dim>> trees_;
    std::vector<std::optional<TightPairs>> tight_;  // of bodies that were searched within
    std::vector<BodyPair> pairs_;  // between bodies, found within the distance and the margin
    Positions<Dim> searched_at_;   // where; empty if pairs_ are of no further use
};

}  // namespace pent::contact
