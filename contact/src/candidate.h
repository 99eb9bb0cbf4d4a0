#pragma once

#include <pent/contact/surface.h>

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <utility>
#include <vector>

// Lists of pairs that may come near each other, and the cull by distances that holds most of them
// back.

namespace pent::contact {

/// Two simplices, by their places in the lists of their surfaces.
struct Candidate {
    std::uint32_t first = 0;
    std::uint32_t second = 0;
    float distance = 0;  ///< m: where distances were measured they were this far apart, or farther.
};

[[nodiscard]] inline bool is_before(const Candidate& a, const Candidate& b) {
    return a.first != b.first ? a.first < b.first : a.second < b.second;
}

/// The float at or below a distance.
[[nodiscard]] inline float rounded_down(double distance) {
    return static_cast<float>(distance * (1 - 1e-7));
}

/// Candidates in any order, but with those first whose distance is known. All others have, as a
/// lower bound, the greatest distance that was measured.
struct CandidateList {
    std::vector<Candidate> pairs;
    std::size_t known_count = 0;
    std::int64_t overlaps = 0;  ///< Pairs looked at one by one: the work of the search.
};

/// The pairs of two colliders (or of one and itself) that can come near.
struct CandidatePairs {
    int first = 0;
    int second = 0;
    CandidateList points_first = {};   ///< Vertices of the first, facets of the second.
    CandidateList points_second = {};  ///< The other way round; none within one body.
    CandidateList mixed_first = {};    ///< Edges of the first, ridges of the second.
    CandidateList mixed_second = {};   ///< The other way round; in R^4 between two bodies.

    [[nodiscard]] bool is_self() const { return first == second; }
    [[nodiscard]] std::int64_t overlaps() const {
        return points_first.overlaps + points_second.overlaps + mixed_first.overlaps
               + mixed_second.overlaps;
    }
    [[nodiscard]] std::size_t size() const {
        return points_first.pairs.size() + points_second.pairs.size() + mixed_first.pairs.size()
               + mixed_second.pairs.size();
    }
};

/// A list, and the colliders that its first and its second simplices belong to.
struct ListOfTwo {
    const CandidateList& list;
    int first;
    int second;
};

/// How many lists CandidatePairs have.
inline constexpr std::uint32_t kLists = 4;

/// One of them, by its place: first those of vertices and facets.
[[nodiscard]] inline ListOfTwo list_at(const CandidatePairs& pairs, std::uint32_t place) {
    switch (place) {
        case 0:
            return {pairs.points_first, pairs.first, pairs.second};
        case 1:
            return {pairs.points_second, pairs.second, pairs.first};
        case 2:
            return {pairs.mixed_first, pairs.first, pairs.second};
        default:
            return {pairs.mixed_second, pairs.second, pairs.first};
    }
}

/// Calls visit<K, L>(list), K and L being the corners of the simplices of a list.
template <int Dim, typename Visit>
void visit_list(const CandidatePairs& pairs, std::uint32_t place, const Visit& visit) {
    const ListOfTwo list = list_at(pairs, place);
    if (place < 2) {
        visit.template operator()<1, Dim>(list);
    } else {
        visit.template operator()<2, Dim - 1>(list);
    }
}

/// How far vertices of two colliders get, at most, from where distances were measured, but for a
/// common shift, in m.
class Displacement {
public:
    float max = 0;  ///< Of all vertices.

    /// Without vertices.
    Displacement() = default;

    /// With a place for every vertex from the first to the last of some vertices, and of some
    /// others; both ascending.
    Displacement(const Simplices<1>& first, const Simplices<1>& second) {
        const auto [a, b] = first(0, 0) < second(0, 0) ? std::pair(span_of(first), span_of(second))
                                                       : std::pair(span_of(second), span_of(first));
        first_ = a.begin;
        if (a.end < b.begin) {
            second_ = b.begin;
            skipped_ = a.begin + (b.begin - a.end);
            of_vertex_.resize((a.end - a.begin) + (b.end - b.begin));
        } else {  // of one collider, or mixed with one another
            of_vertex_.resize(std::max(a.end, b.end) - a.begin);
        }
    }

    [[nodiscard]] float& operator[](std::uint32_t vertex) { return of_vertex_[place(vertex)]; }
    [[nodiscard]] float operator[](std::uint32_t vertex) const { return of_vertex_[place(vertex)]; }

    template <int Count>
    [[nodiscard]] float of(const Simplices<Count>& simplices, Eigen::Index i) const {
        float of_corner = 0;
        for (int corner = 0; corner < Count; ++corner) {
            of_corner = std::max(of_corner, (*this)[simplices(corner, i)]);
        }
        return of_corner;
    }

private:
    struct Span {
        std::uint32_t begin = 0;
        std::uint32_t end = 0;
    };
    static Span span_of(const Simplices<1>& vertices) {
        return {vertices(0, 0), vertices(0, vertices.cols() - 1) + 1};
    }

    // Each collider has its vertices one after the other; those between two of them have no place.
    [[nodiscard]] std::size_t place(std::uint32_t vertex) const {
        return vertex - (vertex < second_ ? first_ : skipped_);
    }

    std::vector<float> of_vertex_;
    std::uint32_t first_ = 0;
    std::uint32_t second_ = 0xffffffff;  // vertices from here on are in the second span
    std::uint32_t skipped_ = 0;          // vertices before it that have no place
};

/// Tells which candidates of a list may come within a distance, from how far apart they were and
/// how far their vertices have gone since: most are held back by comparing two numbers, without a
/// look at positions.
class DistanceCull {
public:
    /// List and displacement are kept by reference; the distance in m.
    DistanceCull(const CandidateList& list, const Displacement& displacement, double distance)
        : list_(list), displacement_(displacement), distance_(distance) {
        const std::size_t known = list.known_count;
        const bool is_done =
            known == list.pairs.size() || is_beyond(list.pairs[known], 2 * displacement.max);
        size_ = is_done ? known : list.pairs.size();
    }

    /// Candidates from this place on do not pass.
    [[nodiscard]] std::size_t size() const { return size_; }

    /// @param first, second  What the candidates are of.
    template <int K, int L>
    [[nodiscard]] bool passes(std::size_t place,
                              const Simplices<K>& first,
                              const Simplices<L>& second) const {
        const Candidate& pair = list_.pairs[place];
        return !is_beyond(pair, 2 * displacement_.max)
               && (displacement_.max == 0  // each vertex would tell the same
                   || !is_beyond(pair, displacement_.of<K>(first, pair.first)
                                           + displacement_.of<L>(second, pair.second)));
    }

private:
    [[nodiscard]] bool is_beyond(const Candidate& pair, float displacement) const {
        constexpr double kRoundUp = 1 + 1e-6;  // floats have been added
        return static_cast<double>(pair.distance)
               > (distance_ + static_cast<double>(displacement)) * kRoundUp;
    }

    const CandidateList& list_;
    const Displacement& displacement_;
    double distance_;
    std::size_t size_ = 0;
};

}  // namespace pent::contact
