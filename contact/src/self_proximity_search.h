#pragma once

#include "apart.h"
#include "near_lanes.h"
#include "near_on_paths.h"
#include "overlaps.h"
#include "self_proximity.h"

#include <algorithm>
#include <array>
#include <bit>
#include <cmath>
#include <span>
#include <utility>
#include <vector>

namespace pent::contact {

/// Where a pair of simplices is.
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

/// All lists in one, ascending, of unknown distances.
[[nodiscard]] inline CandidateList united(const std::vector<CandidateList>& lists) {
    CandidateList all = sorted(joined(lists));
    for (Candidate& pair : all.pairs) {
        pair.distance = 0;
    }
    all.known_count = 0;
    return all;
}

/// What find() does for one kind of pairs.
template <int Dim>
template <typename Test, int K, int L>
class SelfProximity<Dim>::Search {
public:
    using Found = typename Test::Found;

    // Rounding, relative, of distances.
    static constexpr double kRounding = 1e-6;

    // Patches that one thread looks at in one go.
    static constexpr std::size_t kChunk = 8;

    // What pairs are of.
    struct Sides {
        const Simplices<K>& first;
        const Simplices<L>& second;
        std::vector<Row>& rows;
    };

    Search(SelfProximity& all, const Sides& sides, const Asked& asked, const Test& test)
        : all_(all),
          first_(sides.first),
          second_(sides.second),
          rows_(sides.rows),
          start_(asked.paths.from),
          activation_distance_(asked.activation_distance),
          is_still_(asked.paths.is_still()),
          find_near_(near_lanes_kernels<Dim>().template find<K>()),
          test_(test),
          found_(chunks()) {}

    // Looks where bounds hold; returns for how many pairs of patches none does.
    std::size_t look_at_lists() {
        for_each_row([&](std::size_t a, Found& found) { look_at_lists(a, found); });
        std::size_t unknown = 0;
        for (const Row& row : rows_) {
            unknown += row.unknown.size();
        }
        return unknown;
    }

    // Lists all others where paths start, and looks at them; without a list at those that would
    // need another at once.
    void look_at_others() {
        for_each_row([&](std::size_t a, Found& found) { look_at_others(a, found); });
    }

    [[nodiscard]] const std::vector<Found>& found() const { return found_; }

private:
    struct Listed {
        std::uint32_t second = 0;
        std::vector<Candidate> pairs;
    };

    static constexpr bool is_same_list() { return K == L; }
    [[nodiscard]] std::size_t chunks() const { return (rows_.size() + kChunk - 1) / kChunk; }
    [[nodiscard]] const Tree& first_tree() const { return all_.trees_[K - 1]; }
    [[nodiscard]] const Tree& second_tree() const { return all_.trees_[L - 1]; }

    template <typename Work>
    void for_each_row(const Work& work) {
        for_each_chunk(rows_.size(), kChunk,
                       [&](std::size_t chunk, std::size_t begin, std::size_t end) {
                           for (std::size_t a = begin; all_.shared_.is_own(chunk) && a < end; ++a) {
                               work(a, found_[chunk]);
                           }
                       });
    }

    void look_at_lists(std::size_t a, Found& found) {
        Row& row = rows_[a];
        row.unknown.clear();
        auto known = row.known.begin();
        second_tree().patches.for_each_overlap(first_tree().patches.box(a), [&](std::uint32_t b) {
            if (is_same_list() && b < a) {
                return;
            }
            while (known != row.known.end() && known->second < b) {
                ++known;
            }
            const bool is_known =
                known != row.known.end() && known->second == b && known->search + 1 == all_.search_;
            if (!is_known || !look_at_list(a, *known, found)) {
                row.unknown.push_back(b);
            }
        });
    }

    // Looks at what is listed of two patches, if that is all that can be near.
    bool look_at_list(std::size_t a, Known& known, Found& found) {
        known.set_bound(since(a, known.second).after(known.bound()));
        known.search = all_.search_;
        const PatchBound bound = along(a, known.second).after(known.bound());
        if (!is_apart(bound, a, known.second)) {
            return false;
        }
        const std::span<const Candidate> pairs = rows_[a].pairs;
        look_at(pairs.subspan(known.begin, known.end - known.begin), bound, near(a, known.second),
                found);
        return true;
    }

    // The next search is taken to find the patches moved as this one does.
    void look_at_others(std::size_t a, Found& found) {
        std::vector<Listed> listed;
        for (const std::uint32_t b : rows_[a].unknown) {
            const PatchBound bound = along(a, b);
            if (is_apart(is_still_ ? since(a, b) : bound, a, b)) {
                listed.push_back({b, list(a, b, found)});
                look_at(listed.back().pairs, bound, near(a, b), found);
            } else {
                look_at_all(a, b, found);
            }
        }
        add(rows_[a], listed);
    }

    [[nodiscard]] PatchBound since(std::size_t a, std::uint32_t b) const {
        return bound_of<Dim>(all_.since_[K - 1][a], all_.since_[L - 1][b]);
    }

    [[nodiscard]] PatchBound along(std::size_t a, std::uint32_t b) const {
        return is_still_ ? PatchBound{1, 0}
                         : bound_of<Dim>(all_.ahead_[K - 1][a], all_.ahead_[L - 1][b]);
    }

    // Whether pairs of two patches that are in no list are apart.
    [[nodiscard]] bool is_apart(const PatchBound& bound, std::size_t a, std::uint32_t b) const {
        return bound.is_apart(all_.listed_distance_, near(a, b));
    }

    // How near simplices of two patches count as near, m: what vertices may leave their paths by
    // comes on top.
    [[nodiscard]] double near(std::size_t a, std::uint32_t b) const {
        const std::vector<double>& of_a = first_tree().patch_inflation;
        const std::vector<double>& of_b = second_tree().patch_inflation;
        return activation_distance_ + (of_a.empty() ? 0 : of_a[a] + of_b[b]);
    }

    void look_at(std::span<const Candidate> pairs,
                 const PatchBound& bound,
                 double near,
                 Found& found) const {
        for (const Candidate& pair : pairs) {
            if (!bound.is_apart(static_cast<double>(pair.distance), near)) {
                test_(pair.first, pair.second, found);
            }
        }
    }

    void look_at_all(std::size_t a, std::uint32_t b, Found& found) const {
        const LanesView first = all_.lanes_at_start_[K - 1][a];
        const LanesView second = all_.lanes_at_start_[L - 1][b];
        const LanesOnPaths patches{first, is_still_ ? first : all_.lanes_at_end_[K - 1][a], second,
                                   is_still_ ? second : all_.lanes_at_end_[L - 1][b]};
        for_each_near(a, b, patches, near(a, b),
                      [&](std::uint32_t i, std::uint32_t j) { test_(i, j, found); });
    }

    // The pairs of two patches that are within the listed distance where paths start, with a little
    // more for rounding, and can be contacts.
    [[nodiscard]] std::vector<Candidate> list(std::size_t a, std::uint32_t b, Found& found) const {
        const LanesView first = all_.lanes_at_start_[K - 1][a];
        const LanesView second = all_.lanes_at_start_[L - 1][b];
        std::vector<Candidate> pairs;
        for_each_near(a, b, {first, first, second, second}, listed_limit(),
                      [&](std::uint32_t i, std::uint32_t j) {
                          Candidate pair{i, j};
                          if (is_same_list() && j < i) {
                              std::swap(pair.first, pair.second);
                          }
                          if (!share_a_vertex<K, L>(first_, pair.first, second_, pair.second)) {
                              ++found.overlaps;
                              add_if_near(pair, pairs);
                          }
                      });
        return pairs;
    }

    // Calls visit(i, j) for the pairs of two patches that may be nearer than a distance: each once.
    template <typename Visit>
    void for_each_near(std::size_t a,
                       std::uint32_t b,
                       const LanesOnPaths& patches,
                       double distance,
                       const Visit& visit) const {
        std::array<std::uint16_t, kLanes> near;
        find_near_(patches, distance, near.data());
        const std::span<const std::uint32_t> of_a = first_tree().partition[a];
        const std::span<const std::uint32_t> of_b = second_tree().partition[b];
        const bool is_one = is_same_list() && a == b;
        for (std::size_t m = 0; m < of_a.size(); ++m) {
            unsigned bits = near[m];
            if (is_one) {
                bits &= ~0U << (m + 1);
            }
            for (; bits != 0; bits &= bits - 1) {
                visit(of_a[m], of_b[static_cast<std::size_t>(std::countr_zero(bits))]);
            }
        }
    }

    [[nodiscard]] double listed_limit() const { return (1 + kRounding) * all_.listed_distance_; }

    void add_if_near(Candidate pair, std::vector<Candidate>& pairs) const {
        const double culled = (1 - kRounding) * all_.distance_;
        const PositionsView<Dim> rest = all_.rest_;
        const double distance =
            PairAt<Dim, K, L>(first_, second_, pair, start_).distance_below(listed_limit());
        if (distance < listed_limit()
            && !(all_.is_rest_left_out_
                 && PairAt<Dim, K, L>(first_, second_, pair, rest).distance_below(culled)
                        < culled)) {
            pair.distance = rounded_down(distance);
            pairs.push_back(pair);
        }
    }

    // Puts new lists in the place of old ones, and leaves out those of patches that are not near
    // any more.
    void add(Row& row, const std::vector<Listed>& listed) {
        if (listed.empty()) {
            return;
        }
        std::vector<Known> known;
        std::vector<Candidate> pairs;
        const auto push = [&](Known entry, std::span<const Candidate> of_both) {
            entry.begin = static_cast<std::uint32_t>(pairs.size());
            pairs.insert(pairs.end(), of_both.begin(), of_both.end());
            entry.end = static_cast<std::uint32_t>(pairs.size());
            known.push_back(entry);
        };
        auto old = row.known.begin();
        const auto push_old = [&] {
            if (old->search == all_.search_) {
                push(*old, std::span(row.pairs).subspan(old->begin, old->end - old->begin));
            }
            ++old;
        };
        for (const Listed& next : listed) {
            while (old != row.known.end() && old->second < next.second) {
                push_old();
            }
            if (old != row.known.end() && old->second == next.second) {
                ++old;
            }
            push({.second = next.second, .search = all_.search_}, next.pairs);
        }
        while (old != row.known.end()) {
            push_old();
        }
        known.shrink_to_fit();
        pairs.shrink_to_fit();
        row.known.swap(known);
        row.pairs.swap(pairs);
    }

    SelfProximity& all_;
    const Simplices<K>& first_;
    const Simplices<L>& second_;
    std::vector<Row>& rows_;
    const PositionsView<Dim>& start_;
    double activation_distance_;
    bool is_still_;
    FindNearLanes find_near_;
    Test test_;
    std::vector<Found> found_;
};

}  // namespace pent::contact
