#include "pair_search.h"

#include <algorithm>
#include <chrono>
#include <iterator>

namespace pent::contact {

namespace {

// Pairs kept for another evaluation, at most: 128 MB.
constexpr std::size_t kMostKept = 8'000'000;

double seconds_since(std::chrono::steady_clock::time_point start) {
    return std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count();
}

std::size_t count_pairs(const std::vector<BodyPair>& pairs) {
    std::size_t count = 0;
    for (const BodyPair& pair : pairs) {
        for (const NearPairs* list : pair.lists()) {
            count += list->pairs.size();
        }
    }
    return count;
}

// Of pairs found in two ways, each once.
NearPairs join(const NearPairs& a, const NearPairs& b) {
    NearPairs all;
    all.candidates = a.candidates + b.candidates;
    std::set_union(a.pairs.begin(), a.pairs.end(), b.pairs.begin(), b.pairs.end(),
                   std::back_inserter(all.pairs), [](const NearPair& x, const NearPair& y) {
                       return x.first != y.first ? x.first < y.first : x.second < y.second;
                   });
    return all;
}

}  // namespace

template <int Dim>
std::vector<BodyPair> PairSearch<Dim>::run(const PositionsView<Dim>& positions,
                                           ContactReport& report) {
    const auto start = std::chrono::steady_clock::now();
    const bool is_kept = is_kept_valid(positions);
    if (!is_kept || options_.self) {
        update_trees(positions, report);
        report.tree_seconds = seconds_since(start);
    }
    if (!is_kept) {
        search(positions, report);
    }
    std::vector<BodyPair> found;
    if (options_.margin > 0) {
        found = still_near(positions);
        drop_what_is_too_much();
    } else {
        std::swap(found, pairs_);
    }
    for (std::size_t body = 0; options_.self && body < bodies_.size(); ++body) {
        if (!bodies_[body].is_kinematic) {
            found.push_back(search_within(static_cast<int>(body), positions));
            report.candidates += found.back().candidates();
        }
    }
    std::stable_sort(found.begin(), found.end(), [](const BodyPair& a, const BodyPair& b) {
        return a.first != b.first ? a.first < b.first : a.second < b.second;
    });
    report.search_seconds = seconds_since(start) - report.tree_seconds;
    return found;
}

// Whether no vertex has moved by more than the margin since pairs were last searched.
template <int Dim>
bool PairSearch<Dim>::is_kept_valid(const PositionsView<Dim>& positions) const {
    return searched_at_.cols() > 0 && searched_at_.cols() == positions.cols()
           && (positions - searched_at_).colwise().squaredNorm().maxCoeff()
                  <= options_.margin * options_.margin;
}

template <int Dim>
void PairSearch<Dim>::drop_what_is_too_much() {
    if (count_pairs(pairs_) > kMostKept) {
        // GCOVR_EXCL_START: millions of pairs
        searched_at_.resize(Dim, 0);
        std::vector<BodyPair>().swap(pairs_);
        // GCOVR_EXCL_STOP
    }
}

template <int Dim>
bool PairSearch<Dim>::may_meet(std::size_t a, std::size_t b) const {
    return !(bodies_[a].is_kinematic && bodies_[b].is_kinematic)
           && overlap(trees_[a].vertices().root_box(), trees_[b].vertices().root_box());
}

// Brings the trees of all bodies that may be in contact up to date.
template <int Dim>
void PairSearch<Dim>::update_trees(const PositionsView<Dim>& positions, ContactReport& report) {
    const double margin = 0.5 * search_distance();
    if (bodies_.size() < 2 && !options_.self) {
        return;
    }
    for (std::size_t i = 0; i < bodies_.size(); ++i) {
        report.trees_built -= trees_[i].built();
        report.trees_refit -= trees_[i].refit();
        trees_[i].update_vertices(bodies_[i].surface, positions, margin);
    }
    std::vector<bool> is_needed(bodies_.size(), false);
    for (std::size_t a = 0; a < bodies_.size(); ++a) {
        is_needed[a] = is_needed[a] || (options_.self && !bodies_[a].is_kinematic);
        for (std::size_t b = a + 1; b < bodies_.size(); ++b) {
            if (may_meet(a, b)) {
                is_needed[a] = true;
                is_needed[b] = true;
            }
        }
    }
    for (std::size_t i = 0; i < bodies_.size(); ++i) {
        if (is_needed[i]) {
            trees_[i].update_faces(bodies_[i].surface, positions, margin);
        }
        report.trees_built += trees_[i].built();
        report.trees_refit += trees_[i].refit();
    }
}

// Pairs between bodies.
template <int Dim>
void PairSearch<Dim>::search(const PositionsView<Dim>& positions, ContactReport& report) {
    // With a margin any pair may get its closest points inside before the next search.
    const Closest closest = options_.margin > 0 ? Closest::Anywhere : Closest::Interior;
    pairs_.clear();
    for (std::size_t a = 0; a < bodies_.size(); ++a) {
        for (std::size_t b = a + 1; b < bodies_.size(); ++b) {
            if (!may_meet(a, b)) {
                continue;
            }
            const auto i = static_cast<int>(a);
            const auto j = static_cast<int>(b);
            BodyPair pair{.first = i, .second = j};
            pair.points_first = points_near(i, j, positions);
            pair.points_second = points_near(j, i, positions);
            pair.mixed_first = mixed_near(i, j, positions, closest);
            if constexpr (Dim > 3) {
                pair.mixed_second = mixed_near(j, i, positions, closest);
            }
            report.candidates += pair.candidates();
            pairs_.push_back(std::move(pair));
        }
    }
    if (options_.margin > 0) {
        searched_at_ = positions;
    }
}

template <int Dim>
BodyPair PairSearch<Dim>::search_within(int body, const PositionsView<Dim>& positions) {
    const Surface<Dim>& surface = bodies_[body].surface;
    const double eps = options_.distance;
    std::optional<TightPairs>& tight = tight_[static_cast<std::size_t>(body)];
    if (!tight) {
        tight = find_tight_pairs<Dim>(surface, rest_, eps);
    }
    BodyTrees<Dim>& trees = trees_[body];
    BodyPair pair{.first = body, .second = body};
    if (tight->rest_distance == 0) {
        pair.points_first = near_pairs<Dim, 1, Dim>(
            {surface.vertices, trees.vertices()}, {surface.facets, trees.facets()}, positions, eps);
        pair.mixed_first = near_pairs<Dim, 2, Dim - 1>({surface.edges, trees.edges()},
                                                       {surface.ridges, trees.ridges()}, positions,
                                                       eps, Closest::Interior);
        return pair;
    }
    trees.update_patches(surface, rest_, positions);
    pair.points_first = join(
        still_near_pairs<Dim, 1, Dim>(tight->points, surface.vertices, surface.facets, positions,
                                      eps),
        pairs_within<Dim, 1, Dim>(trees.patched_vertices(surface), trees.patched_facets(surface),
                                  positions, eps, tight->rest_distance, Closest::Anywhere));
    pair.mixed_first = join(
        still_near_pairs<Dim, 2, Dim - 1>(tight->mixed, surface.edges, surface.ridges, positions,
                                          eps, Closest::Interior),
        pairs_within<Dim, 2, Dim - 1>(trees.patched_edges(surface), trees.patched_ridges(surface),
                                      positions, eps, tight->rest_distance, Closest::Interior));
    return pair;
}

template <int Dim>
NearPairs PairSearch<Dim>::points_near(int a, int b, const PositionsView<Dim>& positions) const {
    return near_pairs<Dim, 1, Dim>({bodies_[a].surface.vertices, trees_[a].vertices()},
                                   {bodies_[b].surface.facets, trees_[b].facets()}, positions,
                                   search_distance());
}

template <int Dim>
NearPairs PairSearch<Dim>::mixed_near(int a,
                                      int b,
                                      const PositionsView<Dim>& positions,
                                      Closest closest) const {
    return near_pairs<Dim, 2, Dim - 1>({bodies_[a].surface.edges, trees_[a].edges()},
                                       {bodies_[b].surface.ridges, trees_[b].ridges()}, positions,
                                       search_distance(), closest);
}

// Of the pairs kept, those within the distance of contact now.
template <int Dim>
std::vector<BodyPair> PairSearch<Dim>::still_near(const PositionsView<Dim>& positions) const {
    const double eps = options_.distance;
    std::vector<BodyPair> result;
    for (const BodyPair& pair : pairs_) {
        const Surface<Dim>& a = bodies_[pair.first].surface;
        const Surface<Dim>& b = bodies_[pair.second].surface;
        result.push_back(
            {pair.first, pair.second,
             still_near_pairs<Dim, 1, Dim>(pair.points_first, a.vertices, b.facets, positions, eps),
             still_near_pairs<Dim, 1, Dim>(pair.points_second, b.vertices, a.facets, positions,
                                           eps),
             still_near_pairs<Dim, 2, Dim - 1>(pair.mixed_first, a.edges, b.ridges, positions, eps,
                                               Closest::Interior),
             still_near_pairs<Dim, 2, Dim - 1>(pair.mixed_second, b.edges, a.ridges, positions, eps,
                                               Closest::Interior)});
    }
    return result;
}

template <int Dim>
std::int64_t PairSearch<Dim>::bytes() const {
    std::int64_t sum = static_cast<std::int64_t>(count_pairs(pairs_) * sizeof(NearPair));
    for (const BodyTrees<Dim>& trees : trees_) {
        sum += trees.bytes();
    }
    for (const std::optional<TightPairs>& tight : tight_) {
        sum += tight ? tight->bytes() : 0;
    }
    return sum + static_cast<std::int64_t>(sizeof(double)) * searched_at_.size();
}

template class PairSearch<3>;
template class PairSearch<4>;

}  // namespace pent::contact
