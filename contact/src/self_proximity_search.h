#pragma once

#include "near_on_paths.h"
#include "overlaps.h"
#include "pair_at.h"
#include "self_proximity.h"

#include <algorithm>
#include <array>
#include <limits>
#include <span>
#include <utility>
#include <vector>

namespace pent::contact {

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

    // Bounds found in one go.
    static constexpr std::size_t kBatch = 16;
    using Bounds = std::array<PatchBound, kBatch>;

    // The simplices of pairs, and what is known of their patches.
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
          paths_(asked.paths),
          activation_distance_(asked.activation_distance),
          is_still_(asked.paths.is_still()),
          test_(test),
          found_(chunks()) {}

    // Looks at the lists of pairs of patches whose bounds hold; returns for how many pairs of
    // patches none does.
    std::size_t look_at_lists() {
        for_each_row([&](std::size_t a, Found& found) { look_at_lists(a, found); });
        std::size_t unknown = 0;
        for (const Row& row : rows_) {
            unknown += row.unknown.size();
        }
        return unknown;
    }

    // Lists the pairs of all others where paths start, and looks at them; looks without a list at
    // those that would need another one at once.
    void look_at_others() {
        for_each_row([&](std::size_t a, Found& found) { look_at_others(a, found); });
    }

    [[nodiscard]] const std::vector<Found>& found() const { return found_; }

private:
    // Lists of a patch and others, ascending: pairs [begin, end) of these.
    struct Listed {
        std::vector<Known> known;
        std::vector<Candidate> pairs;
    };

    static constexpr bool is_same_list() { return K == L; }
    [[nodiscard]] std::size_t chunks() const { return (rows_.size() + kChunk - 1) / kChunk; }
    [[nodiscard]] const PatchesOnPaths<Dim>& first_patches() const {
        return all_.on_paths_.template of<K>();
    }
    [[nodiscard]] const PatchesOnPaths<Dim>& second_patches() const {
        return all_.on_paths_.template of<L>();
    }

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
        std::array<Known*, kBatch> listed;
        std::size_t count = 0;
        second_patches().tree.for_each_overlap(first_patches().around[a], [&](std::uint32_t b) {
            if (is_same_list() && b < a) {
                return;
            }
            while (known != row.known.end() && known->second < b) {
                ++known;
            }
            if (known == row.known.end() || known->second != b
                || known->search + 1 != all_.search_) {
                row.unknown.push_back(b);
                return;
            }
            listed[count++] = &*known;
            if (count == kBatch) {
                look_at_lists(a, listed, found);
                count = 0;
            }
        });
        look_at_lists(a, std::span(listed).first(count), found);
        std::sort(row.unknown.begin(), row.unknown.end());
    }

    // Looks at what is listed of a patch and others, at most kBatch, where that is all that can be
    // near.
    void look_at_lists(std::size_t a, std::span<Known* const> listed, Found& found) {
        std::array<std::uint32_t, kBatch> seconds;
        std::transform(listed.begin(), listed.end(), seconds.begin(),
                       [](const Known* known) { return known->second; });
        const std::span<const std::uint32_t> others = std::span(seconds).first(listed.size());
        const Bounds since = this->since(a, others);
        const Bounds along = this->along(a, others);
        Row& row = rows_[a];
        for (std::size_t k = 0; k < listed.size(); ++k) {
            Known& known = *listed[k];
            known.set_bound(since[k].after(known.bound()));
            known.search = all_.search_;
            const PatchBound bound = along[k].after(known.bound());
            if (is_apart(bound, a, known.second)) {
                look_at(std::span(row.pairs).subspan(known.begin, known.end - known.begin), bound,
                        near(a, known.second), found);
            } else {
                row.unknown.push_back(known.second);
            }
        }
    }

    // Whether a new list would fail at once is told by the motion of this search, as that of the
    // next is taken to be alike.
    void look_at_others(std::size_t a, Found& found) {
        Listed listed;
        const std::span<const std::uint32_t> unknown = rows_[a].unknown;
        for (std::size_t begin = 0; begin < unknown.size(); begin += kBatch) {
            const auto others = unknown.subspan(begin, std::min(kBatch, unknown.size() - begin));
            const Bounds along = this->along(a, others);
            const Bounds bounds = is_still_ ? since(a, others) : along;
            for (std::size_t k = 0; k < others.size(); ++k) {
                const std::uint32_t b = others[k];
                if (is_apart(bounds[k], a, b)) {
                    look_at(list(a, b, listed, found), along[k], near(a, b), found);
                } else {
                    look_at_all(a, b, found);
                }
            }
        }
        add(rows_[a], listed);
    }

    // Bounds for a patch and others, at most kBatch: since the last search, and along the paths.
    [[nodiscard]] Bounds since(std::size_t a, std::span<const std::uint32_t> others) const {
        Bounds bounds;
        all_.since_[K - 1].bound(a, all_.since_[L - 1], others, bounds);
        return bounds;
    }

    [[nodiscard]] Bounds along(std::size_t a, std::span<const std::uint32_t> others) const {
        Bounds bounds;
        if (is_still_) {
            bounds.fill({1, 0});
        } else {
            all_.ahead_[K - 1].bound(a, all_.ahead_[L - 1], others, bounds);
        }
        return bounds;
    }

    // Whether pairs of two patches that are in no list are apart.
    [[nodiscard]] bool is_apart(const PatchBound& bound, std::size_t a, std::uint32_t b) const {
        return bound.is_apart(all_.listed_distance_, near(a, b));
    }

    // The distance within which simplices of two patches count as near, m: with what vertices may
    // leave their paths by.
    [[nodiscard]] double near(std::size_t a, std::uint32_t b) const {
        return activation_distance_ + first_patches().inflation[a] + second_patches().inflation[b];
    }

    void look_at(std::span<const Candidate> pairs,
                 const PatchBound& bound,
                 double near,
                 Found& found) const {
        for (const Candidate& pair : pairs) {
            if (!bound.is_apart(static_cast<double>(pair.distance), near)
                && !do_boxes_stay_apart(pair, near)) {
                test_(pair.first, pair.second, found);
            }
        }
    }

    // Whether the boxes around the two simplices stay apart all along their paths.
    [[nodiscard]] bool do_boxes_stay_apart(const Candidate& pair, double near) const {
        return !is_still_
               && are_paths_apart<Dim, K, L>(gather<Dim, K>(first_, pair.first, paths_.from),
                                             gather<Dim, K>(first_, pair.first, paths_.to),
                                             gather<Dim, L>(second_, pair.second, paths_.from),
                                             gather<Dim, L>(second_, pair.second, paths_.to),
                                             near * near);
    }

    void look_at_all(std::size_t a, std::uint32_t b, Found& found) const {
        for_each_near<Dim, K>(PatchOnPaths<Dim>{first_patches(), a},
                              PatchOnPaths<Dim>{second_patches(), b}, is_still_, near(a, b),
                              [&](std::uint32_t i, std::uint32_t j) { test_(i, j, found); });
    }

    // Lists the pairs of two patches that are within the listed distance where paths start, with a
    // little more for rounding, and can be contacts; returns them, until the next are listed.
    std::span<const Candidate> list(std::size_t a,
                                    std::uint32_t b,
                                    Listed& listed,
                                    Found& found) const {
        const std::size_t before = listed.pairs.size();
        for_each_near<Dim, K>(PatchOnPaths<Dim>{first_patches(), a},
                              PatchOnPaths<Dim>{second_patches(), b}, true, listed_limit(),
                              [&](std::uint32_t i, std::uint32_t j) {
                                  Candidate pair{i, j};
                                  if (is_same_list() && j < i) {
                                      std::swap(pair.first, pair.second);
                                  }
                                  ++found.overlaps;
                                  add_if_near(pair, listed.pairs);
                              });
        listed.known.push_back({.second = b,
                                .search = all_.search_,
                                .begin = static_cast<std::uint32_t>(before),
                                .end = static_cast<std::uint32_t>(listed.pairs.size())});
        return std::span(listed.pairs).subspan(before);
    }

    [[nodiscard]] double listed_limit() const { return (1 + kRounding) * all_.listed_distance_; }

    void add_if_near(Candidate pair, std::vector<Candidate>& pairs) const {
        const double culled = (1 - kRounding) * all_.distance_;
        const PositionsView<Dim> rest = all_.rest_;
        const double distance =
            PairAt<Dim, K, L>(first_, second_, pair, paths_.from).distance_below(listed_limit());
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
    void add(Row& row, const Listed& listed) const {
        if (listed.known.empty()) {
            return;
        }
        std::vector<Known> known(row.known.size() + listed.known.size());
        auto end = known.begin();
        auto old = row.known.begin();
        const auto push_old = [&](std::uint32_t before) {
            for (; old != row.known.end() && old->second < before; ++old) {
                if (old->search == all_.search_) {
                    *end++ = *old;
                }
            }
        };
        const auto first = static_cast<std::uint32_t>(row.pairs.size());
        for (Known next : listed.known) {
            push_old(next.second);
            if (old != row.known.end() && old->second == next.second) {
                ++old;
            }
            next.begin += first;
            next.end += first;
            *end++ = next;
        }
        push_old(std::numeric_limits<std::uint32_t>::max());
        known.erase(end, known.end());
        row.known.swap(known);
        if (row.pairs.size() + listed.pairs.size() <= row.pairs.capacity()) {
            row.pairs.insert(row.pairs.end(), listed.pairs.begin(), listed.pairs.end());
        } else {
            pack(row, listed.pairs);
        }
    }

    // Packs the pairs of lists, old ones and those to be put behind them, without the pairs that
    // are in no list. Leaves some room, so that most new lists can be put behind the old ones.
    static void pack(Row& row, const std::vector<Candidate>& behind) {
        std::size_t count = 0;
        for (const Known& known : row.known) {
            count += known.end - known.begin;
        }
        std::vector<Candidate> pairs;
        pairs.reserve(count + count / 2);
        const std::size_t there = row.pairs.size();
        for (Known& known : row.known) {
            const Candidate* from = known.begin < there ? row.pairs.data() + known.begin
                                                        : behind.data() + (known.begin - there);
            const std::uint32_t size = known.end - known.begin;
            known.begin = static_cast<std::uint32_t>(pairs.size());
            known.end = known.begin + size;
            pairs.insert(pairs.end(), from, from + size);
        }
        row.pairs.swap(pairs);
    }

    SelfProximity& all_;
    const Simplices<K>& first_;
    const Simplices<L>& second_;
    std::vector<Row>& rows_;
    const Paths<Dim>& paths_;
    double activation_distance_;
    bool is_still_;
    Test test_;
    std::vector<Found> found_;
};

}  // namespace pent::contact
