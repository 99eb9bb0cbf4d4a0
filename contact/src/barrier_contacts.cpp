#include "barrier_contacts.h"

#include "apart.h"
#include "passing_candidates.h"
#include "spanned_volume.h"

#include <pent/dimensions.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <functional>
#include <tuple>
#include <utility>

namespace pent::contact {

namespace {

constexpr std::size_t kChunk = 512;

// Found contacts are sorted in stretches of this many, which are then merged.
constexpr std::size_t kStretch = 4096;

// Stands in unused places of a contact's vertices.
constexpr std::uint32_t kNoVertex = 0xffffffff;

// The contact of one pair of simplices, and which pair: the list, and the places in it.
template <int Dim>
struct Found {
    Contact<Dim> contact;
    std::array<std::uint32_t, 3> pair;
};

template <int Dim>
using FoundLists = std::vector<std::vector<Found<Dim>>>;

// The order of contacts: by their faces, then by their pair. Contacts of the same faces that have
// no mollifier are one.
template <int Dim>
struct Key {
    std::uint32_t kind = 0;
    std::array<std::uint32_t, Dim + 1> vertices;
    std::array<std::uint32_t, 3> pair;
    const Found<Dim>* found = nullptr;

    Key() = default;  // to be filled
    explicit Key(const Found<Dim>& of)
        : kind((of.contact.mollifier.is_on() ? kMollified : 0U) + of.contact.first_count),
          vertices(of.contact.vertices),
          pair(of.pair),
          found(&of) {}

    bool operator<(const Key& other) const {
        return std::tie(kind, vertices, pair) < std::tie(other.kind, other.vertices, other.pair);
    }

    [[nodiscard]] bool is_same_contact(const Key& other) const {
        return kind == other.kind && kind < kMollified && vertices == other.vertices;
    }

private:
    static constexpr std::uint32_t kMollified = 16;
};

// Merges stretches that are sorted, neighbors two by two, until there is one.
//
// @param starts  Where they begin.
template <typename Item>
void merge_stretches(std::vector<Item>& items, std::vector<std::size_t> starts) {
    while (starts.size() > 1) {
        const auto start = [&](std::size_t i) {
            const std::size_t place = i < starts.size() ? starts[i] : items.size();
            return items.begin() + static_cast<std::ptrdiff_t>(place);
        };
        std::vector<std::size_t> left((starts.size() + 1) / 2);
        parallel_for(left.size(), [&](std::size_t i) {
            left[i] = starts[2 * i];
            std::inplace_merge(start(2 * i), start(2 * i + 1), start(2 * i + 2));
        });
        starts = std::move(left);
    }
}

// Keys in ascending order.
//
// @param is_ascending  Whether each list is already.
template <int Dim>
std::vector<Key<Dim>> sorted_keys(const FoundLists<Dim>& lists, bool is_ascending) {
    std::vector<std::size_t> starts;
    std::size_t count = 0;
    for (const std::vector<Found<Dim>>& list : lists) {
        starts.push_back(count);
        count += list.size();
    }
    std::vector<Key<Dim>> keys(count);
    parallel_for(lists.size(), [&](std::size_t l) {
        std::transform(lists[l].begin(), lists[l].end(),
                       keys.begin() + static_cast<std::ptrdiff_t>(starts[l]),
                       [](const Found<Dim>& found) { return Key<Dim>(found); });
    });
    if (!is_ascending) {
        starts.clear();
        for (std::size_t begin = 0; begin < count; begin += kStretch) {
            starts.push_back(begin);
        }
        for_each_chunk(count, kStretch,
                       [&](std::size_t /*chunk*/, std::size_t begin, std::size_t end) {
                           std::sort(keys.begin() + static_cast<std::ptrdiff_t>(begin),
                                     keys.begin() + static_cast<std::ptrdiff_t>(end));
                       });
    }
    merge_stretches(keys, std::move(starts));
    return keys;
}

// One contact for all pairs with the same nearest faces, in ascending order. Their distances differ
// by rounding: that of the first pair counts, whatever order they were found in. What has been
// merged may be merged with more.
//
// @param is_ascending  Whether each list is already.
// @param pick          What is wanted of them: from a contact with its pair to a contact or both.
template <typename Item, int Dim, typename Pick>
std::vector<Item> merged(const FoundLists<Dim>& lists, bool is_ascending, const Pick& pick) {
    const std::vector<Key<Dim>> keys = sorted_keys<Dim>(lists, is_ascending);
    std::vector<std::size_t> starts;  // of keys of one contact
    for (std::size_t k = 0; k < keys.size(); ++k) {
        if (k == 0 || !keys[k].is_same_contact(keys[k - 1])) {
            starts.push_back(k);
        }
    }
    std::vector<Item> all(starts.size());
    starts.push_back(keys.size());
    for_each_chunk(all.size(), kChunk,
                   [&](std::size_t /*chunk*/, std::size_t begin, std::size_t end) {
                       for (std::size_t i = begin; i < end; ++i) {
                           Found<Dim> found = *keys[starts[i]].found;
                           for (std::size_t k = starts[i] + 1; k < starts[i + 1]; ++k) {
                               found.contact.multiplicity += keys[k].found->contact.multiplicity;
                           }
                           all[i] = pick(found);
                       }
                   });
    return all;
}

// One simplex of a pair, as a side of a contact.
struct Side {
    int collider = 0;
    const std::uint32_t* vertices = nullptr;
    const double* weights = nullptr;
    int count = 0;
    unsigned face = 0;  // Bit i: corner i spans the nearest face
};

// Adds the corners of a face by increasing vertex, since simplices have theirs in any order; those
// of a whole simplex as they come.
template <int Dim>
void add_corners(const Side& side, bool is_whole, double sign, Contact<Dim>& contact) {
    const int begin = contact.corner_count;
    for (int i = 0; i < side.count; ++i) {
        const bool is_active = (side.face >> i & 1U) != 0;
        if (!is_whole && !is_active) {
            continue;
        }
        int at = contact.corner_count++;
        contact.active |= static_cast<std::uint8_t>((is_active ? 1U : 0U) << at);
        for (; !is_whole && at > begin && contact.vertices[at - 1] > side.vertices[i]; --at) {
            contact.vertices[at] = contact.vertices[at - 1];
            contact.weights[at] = contact.weights[at - 1];
        }
        contact.vertices[at] = side.vertices[i];
        contact.weights[at] = sign * side.weights[i];
    }
}

std::uint32_t lowest_vertex(const Side& side) {
    std::uint32_t lowest = kNoVertex;
    for (int i = 0; i < side.count; ++i) {
        lowest = (side.face >> i & 1U) != 0 ? std::min(lowest, side.vertices[i]) : lowest;
    }
    return lowest;
}

// The contact of the nearest faces, or of whole simplices where they are nearly parallel. A core
// comes second. Of two bodies the face with the lower vertex comes first, so that the same faces
// are the same contact whatever pair they come from; of whole simplices the edge does.
template <int Dim>
Contact<Dim> make_contact(const Colliders<Dim>& colliders,
                          const Side& a,
                          const Side& b,
                          const Vector<Dim>& difference,
                          double threshold) {
    const bool is_whole = threshold > 0;
    const bool is_swapped =
        is_whole ? colliders.is_core(a.collider) : lowest_vertex(b) < lowest_vertex(a);
    const Side& first = is_swapped ? b : a;
    const Side& second = is_swapped ? a : b;
    Contact<Dim> contact;
    contact.vertices.fill(kNoVertex);
    add_corners<Dim>(first, is_whole, 1, contact);
    contact.first_count = contact.corner_count;
    add_corners<Dim>(second, is_whole, -1, contact);
    contact.count = colliders.is_core(second.collider) ? contact.first_count : contact.corner_count;
    contact.mollifier.threshold = threshold;
    const double length = difference.norm();
    contact.direction = (is_swapped ? -1 : 1) / length * difference;
    contact.radius = colliders.radius(first.collider) + colliders.radius(second.collider);
    contact.distance = length - contact.radius;
    contact.first = colliders.collider(first.collider);
    contact.second = colliders.collider(second.collider);
    const bool has_point =
        contact.first_count == 1 || contact.corner_count - contact.first_count == 1;
    contact.kind = has_point ? ContactKind::PointFacet : ContactKind::Mixed;
    return contact;
}

// The threshold c0 of the mollifier of a mixed pair, or 0 where it is not nearly parallel.
template <int Dim>
double parallel_threshold(const Corners<Dim, 2>& edge_at_rest,
                          const Corners<Dim, Dim - 1>& ridge_at_rest,
                          const Corners<Dim, 2>& edge,
                          const Corners<Dim, Dim - 1>& ridge) {
    const double threshold = kNearlyParallel * spanned_squared<Dim, 2>(edge_at_rest)
                             * spanned_squared<Dim, Dim - 1>(ridge_at_rest);
    Stencil<Dim> points;
    points << edge, ridge;
    return spanned_volume_squared<Dim>(points) < threshold ? threshold : 0;
}

// The contact of a candidate, if it is one.
template <int Dim, int K, int L>
std::optional<Contact<Dim>> contact_of(const Colliders<Dim>& colliders,
                                       const PositionsView<Dim>& positions,
                                       const std::array<int, 2>& which,
                                       const Candidate& pair,
                                       double activation_distance) {
    const Simplices<K>& first = colliders.surface(which[0]).template simplices<K>();
    const Simplices<L>& second = colliders.surface(which[1]).template simplices<L>();
    const Corners<Dim, K> a = gather<Dim, K>(first, pair.first, positions);
    const Corners<Dim, L> b = gather<Dim, L>(second, pair.second, positions);
    if (are_boxes_apart<Dim, K, L>(a, b, activation_distance * activation_distance)) {
        return {};
    }
    ClosestPointSearch<Dim, K, L> search(a, b, activation_distance * activation_distance);
    if (!search.run()
        || (colliders.template is_fixed<K>(first, pair.first)
            && colliders.template is_fixed<L>(second, pair.second))) {
        return {};
    }
    const ClosestPoints<Dim, K, L>& points = search.best();
    double threshold = 0;
    if constexpr (K == 2) {
        threshold =
            parallel_threshold<Dim>(gather<Dim, K>(first, pair.first, colliders.rest()),
                                    gather<Dim, L>(second, pair.second, colliders.rest()), a, b);
    }
    return make_contact<Dim>(
        colliders,
        {which[0], first.col(pair.first).data(), points.beta.data(), K, points.first_face},
        {which[1], second.col(pair.second).data(), points.alpha.data(), L, points.second_face},
        points.difference, threshold);
}

}  // namespace

template <int Dim>
BarrierContacts<Dim> find_barrier_contacts(const Colliders<Dim>& colliders,
                                           const Candidates<Dim>& candidates,
                                           const PositionsView<Dim>& positions) {
    const ContactOptions& options = colliders.scene().options;
    const PassingCandidates<Dim> passing(candidates, positions, positions,
                                         options.distance + options.separation);
    FoundLists<Dim> all = passing.template look_at_each<std::vector<Found<Dim>>>(
        [&]<int K, int L>(const ListPlace& place, const Candidate& pair,
                          std::vector<Found<Dim>>& found) {
            if (const auto contact = contact_of<Dim, K, L>(
                    colliders, positions, {place.first, place.second}, pair,
                    candidates.activation_distance(place.first, place.second))) {
                found.push_back({*contact, {place.list, pair.first, pair.second}});
            }
        });
    BarrierContacts<Dim> contacts;
    contacts.candidates = passing.count();
    const auto contact = [](const Found<Dim>& found) { return found.contact; };
    const SharedWork& shared = candidates.shared();
    if (!shared.is_shared()) {
        contacts.list = merged<Contact<Dim>, Dim>(all, false, contact);
        return contacts;
    }
    all = shared.lists(merged<Found<Dim>, Dim>(all, false, std::identity()));
    contacts.list = merged<Contact<Dim>, Dim>(all, true, contact);
    contacts.candidates = shared.sum(contacts.candidates);
    return contacts;
}

#define PENT_INSTANTIATE(Dim)                            \
    template BarrierContacts<Dim> find_barrier_contacts( \
        const Colliders<Dim>&, const Candidates<Dim>&, const PositionsView<Dim>&);
PENT_FOR_EACH_DIMENSION(PENT_INSTANTIATE)
#undef PENT_INSTANTIATE

}  // namespace pent::contact
