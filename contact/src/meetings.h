#pragma once

#include "candidate.h"
#include "path_cover.h"

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <utility>
#include <vector>

namespace pent::contact {

/// The candidates of two colliders, or of one and itself, and the positions for which they hold.
template <int Dim>
struct Meeting {
    CandidatePairs pairs;
    PathCover<Dim> cover;  ///< Of the vertices of both; of none where pairs are found each time.

    [[nodiscard]] std::pair<int, int> colliders() const { return {pairs.first, pairs.second}; }
};

/// Meetings ascending by their colliders, one at most for the same two.
template <int Dim>
class Meetings {
public:
    using Pair = std::pair<int, int>;

    /// Takes a meeting of two colliders, the first not above the second, in the place of what is
    /// there of the same two.
    void put(const Pair& colliders, Meeting<Dim> meeting) {
        meeting.pairs.first = colliders.first;
        meeting.pairs.second = colliders.second;
        const auto place = std::lower_bound(list_.begin(), list_.end(), colliders, is_below);
        if (place == list_.end() || place->colliders() != colliders) {
            list_.insert(place, std::move(meeting));
        } else {
            *place = std::move(meeting);
        }
    }

    template <typename Test>
    void erase_if(const Test& test) {
        std::erase_if(list_, test);
    }

    /// Erases all and lets go of their memory.
    void clear() { std::vector<Meeting<Dim>>().swap(list_); }

    [[nodiscard]] auto begin() const { return list_.begin(); }
    [[nodiscard]] auto end() const { return list_.end(); }
    [[nodiscard]] std::size_t size() const { return list_.size(); }
    [[nodiscard]] const Meeting<Dim>& operator[](std::size_t place) const { return list_[place]; }

    [[nodiscard]] std::int64_t bytes() const {
        std::int64_t sum = 0;
        for (const Meeting<Dim>& meeting : list_) {
            sum += static_cast<std::int64_t>(meeting.pairs.size() * sizeof(Candidate))
                   + meeting.cover.bytes();
        }
        return sum;
    }

private:
    [[nodiscard]] static bool is_below(const Meeting<Dim>& meeting, const Pair& colliders) {
        return meeting.colliders() < colliders;
    }

    std::vector<Meeting<Dim>> list_;
};

}  // namespace pent::contact
