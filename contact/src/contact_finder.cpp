#include "body_trees.h"
#include "pair_contact.h"

#include <algorithm>
#include <array>
#include <cassert>
#include <chrono>
#include <sstream>
#include <tbb/parallel_for.h>

namespace pent::contact {

namespace {

// Contacts are computed in chunks of this many pairs or vertices.
constexpr std::size_t kChunk = 512;

// Pairs kept for another evaluation, at most: 128 MB.
constexpr std::size_t kMostKept = 8'000'000;

double seconds_since(std::chrono::steady_clock::time_point start) {
    return std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count();
}

// The pairs that two bodies (or one, with itself) may have in contact.
struct BodyPair {
    int first = 0;
    int second = 0;
    NearPairs points_first;   // vertices of the first, facets of the second
    NearPairs points_second;  // the other way round
    NearPairs mixed_first;    // edges of the first, ridges of the second
    NearPairs mixed_second;   // the other way round

    [[nodiscard]] std::array<NearPairs*, 4> lists() {
        return {&points_first, &points_second, &mixed_first, &mixed_second};
    }
};

// Appends add(i, contacts) of all i in [0, count), in their order.
template <int Dim, typename Add>
void append_chunks(std::size_t count, const Add& add, std::vector<Contact<Dim>>& contacts) {
    std::vector<std::vector<Contact<Dim>>> found((count + kChunk - 1) / kChunk);
    tbb::parallel_for(std::size_t{0}, found.size(), [&](std::size_t chunk) {
        const std::size_t end = std::min((chunk + 1) * kChunk, count);
        for (std::size_t i = chunk * kChunk; i < end; ++i) {
            add(i, found[chunk]);
        }
    });
    for (const auto& part : found) {
        contacts.insert(contacts.end(), part.begin(), part.end());
    }
}

// Where the pairs of each first simplex begin in an ascending list; count + 1 entries.
std::vector<std::size_t> starts_of(const NearPairs& pairs, std::size_t count) {
    std::vector<std::size_t> begin(count + 1, 0);
    for (const NearPair& pair : pairs.pairs) {
        ++begin[pair.first + 1];
    }
    for (std::size_t i = 1; i <= count; ++i) {
        begin[i] += begin[i - 1];
    }
    return begin;
}

}  // namespace

template <int Dim>
class ContactFinder<Dim>::State {
public:
    State(std::vector<ContactBody<Dim>> bodies,
          const PositionsView<Dim>& rest,
          const ContactOptions& options)
        : bodies_(std::move(bodies)), options_(options), trees_(bodies_.size()) {
        for (const ContactBody<Dim>& body : bodies_) {
            mean_edges_.push_back(mean_edge_length<Dim>(body.surface, rest));
        }
        if (options_.self) {
            rest_ = rest;
        }
    }

    Contacts<Dim> find(const PositionsView<Dim>& positions) {
        const auto start = std::chrono::steady_clock::now();
        Contacts<Dim> contacts;
        ContactReport& report = contacts.report;
        if (!is_kept_valid(positions)) {
            update_trees(positions);
            report.tree_seconds = seconds_since(start);
            search(positions, report);
        }
        // What was found within the distance and the margin, or just now within the distance.
        std::vector<BodyPair> narrowed;
        if (options_.margin > 0) {
            narrowed = still_near(positions);
        }
        const std::vector<BodyPair>& pairs = options_.margin > 0 ? narrowed : pairs_;
        report.search_seconds = seconds_since(start) - report.tree_seconds;
        update_normals(pairs, positions);
        for (const BodyPair& pair : pairs) {
            append(pair, positions, contacts.pairs);
        }
        keep_or_drop();
        sum_up(contacts);
        report.seconds = seconds_since(start);
        return contacts;
    }

    [[nodiscard]] std::vector<std::string> warnings() const {
        std::vector<std::string> lines;
        for (std::size_t i = 0; i < bodies_.size(); ++i) {
            if (2 * options_.distance > mean_edges_[i]) {
                std::ostringstream line;
                line << "contact distance " << options_.distance << " m is more than half of the "
                     << "mean surface edge of body '" << bodies_[i].name << "', " << mean_edges_[i]
                     << " m: expect very many contacts; a quarter of the edge is a good choice";
                lines.push_back(line.str());
            }
        }
        return lines;
    }

    [[nodiscard]] const std::vector<ContactBody<Dim>>& bodies() const { return bodies_; }
    [[nodiscard]] const ContactOptions& options() const { return options_; }

private:
    [[nodiscard]] double search_distance() const { return options_.distance + 2 * options_.margin; }

    // Whether no vertex has moved by more than the margin since pairs were last searched.
    [[nodiscard]] bool is_kept_valid(const PositionsView<Dim>& positions) const {
        return searched_at_.cols() > 0 && searched_at_.cols() == positions.cols()
               && (positions - searched_at_).colwise().squaredNorm().maxCoeff()
                      <= options_.margin * options_.margin;
    }

    void keep_or_drop() {
        std::size_t kept = 0;
        for (BodyPair& pair : pairs_) {
            for (const NearPairs* list : pair.lists()) {
                kept += list->pairs.size();
            }
        }
        if (options_.margin == 0 || kept > kMostKept) {
            searched_at_.resize(Dim, 0);
            std::vector<BodyPair>().swap(pairs_);
        }
    }

    [[nodiscard]] bool may_meet(std::size_t a, std::size_t b) const {
        if (bodies_[a].is_kinematic && bodies_[b].is_kinematic) {
            return false;
        }
        return a == b ? options_.self
                      : overlap(trees_[a].vertices().root_box(), trees_[b].vertices().root_box());
    }

    // Finds which bodies may meet, and brings the trees of these up to date.
    void update_trees(const PositionsView<Dim>& positions) {
        const double margin = 0.5 * search_distance();
        pairs_.clear();
        if (bodies_.size() < 2 && !options_.self) {
            return;
        }
        for (std::size_t i = 0; i < bodies_.size(); ++i) {
            trees_[i].update_vertices(bodies_[i].surface, positions, margin);
        }
        std::vector<bool> is_needed(bodies_.size(), false);
        for (std::size_t a = 0; a < bodies_.size(); ++a) {
            for (std::size_t b = a; b < bodies_.size(); ++b) {
                if (may_meet(a, b)) {
                    pairs_.push_back({static_cast<int>(a), static_cast<int>(b), {}, {}, {}, {}});
                    is_needed[a] = true;
                    is_needed[b] = true;
                }
            }
        }
        for (std::size_t i = 0; i < bodies_.size(); ++i) {
            if (is_needed[i]) {
                trees_[i].update_faces(bodies_[i].surface, positions, margin);
            }
        }
    }

    void search(const PositionsView<Dim>& positions, ContactReport& report) {
        // With a margin any pair may get its closest points inside before the next search.
        const Closest closest = options_.margin > 0 ? Closest::Anywhere : Closest::Interior;
        for (BodyPair& pair : pairs_) {
            pair.points_first = points_near(pair.first, pair.second, positions);
            pair.mixed_first = mixed_near(pair.first, pair.second, positions, closest);
            if (pair.first != pair.second) {
                pair.points_second = points_near(pair.second, pair.first, positions);
                if constexpr (Dim > 3) {
                    pair.mixed_second = mixed_near(pair.second, pair.first, positions, closest);
                }
            }
            for (const NearPairs* list : pair.lists()) {
                report.candidates += list->candidates;
            }
        }
        searched_at_ = options_.margin > 0 ? Positions<Dim>(positions) : Positions<Dim>(Dim, 0);
    }

    [[nodiscard]] NearPairs points_near(int a, int b, const PositionsView<Dim>& positions) const {
        return near_pairs<Dim, 1, Dim>({bodies_[a].surface.vertices, trees_[a].vertices()},
                                       {bodies_[b].surface.facets, trees_[b].facets()}, positions,
                                       search_distance());
    }

    [[nodiscard]] NearPairs mixed_near(int a,
                                       int b,
                                       const PositionsView<Dim>& positions,
                                       Closest closest) const {
        return near_pairs<Dim, 2, Dim - 1>({bodies_[a].surface.edges, trees_[a].edges()},
                                           {bodies_[b].surface.ridges, trees_[b].ridges()},
                                           positions, search_distance(), closest);
    }

    [[nodiscard]] std::vector<BodyPair> still_near(const PositionsView<Dim>& positions) const {
        const double eps = options_.distance;
        std::vector<BodyPair> result;
        for (const BodyPair& pair : pairs_) {
            const Surface<Dim>& a = bodies_[pair.first].surface;
            const Surface<Dim>& b = bodies_[pair.second].surface;
            result.push_back(
                {pair.first, pair.second,
                 still_near_pairs<Dim, 1, Dim>(pair.points_first, a.vertices, b.facets, positions,
                                               eps),
                 still_near_pairs<Dim, 1, Dim>(pair.points_second, b.vertices, a.facets, positions,
                                               eps),
                 still_near_pairs<Dim, 2, Dim - 1>(pair.mixed_first, a.edges, b.ridges, positions,
                                                   eps, Closest::Interior),
                 still_near_pairs<Dim, 2, Dim - 1>(pair.mixed_second, b.edges, a.ridges, positions,
                                                   eps, Closest::Interior)});
        }
        return result;
    }

    // Normals at the vertices of bodies that have pairs judged by normals.
    void update_normals(const std::vector<BodyPair>& pairs, const PositionsView<Dim>& positions) {
        std::vector<bool> is_needed(bodies_.size(), false);
        for (const BodyPair& pair : pairs) {
            const bool has_local =
                !pair.mixed_first.pairs.empty() || !pair.mixed_second.pairs.empty()
                || (pair.first == pair.second && !pair.points_first.pairs.empty());
            if (has_local) {
                is_needed[pair.first] = true;
                is_needed[pair.second] = true;
            }
        }
        for (std::size_t i = 0; i < bodies_.size(); ++i) {
            if (!is_needed[i]) {
                continue;
            }
            normals_.resize(Dim, positions.cols());
            const Surface<Dim>& surface = bodies_[i].surface;
            const Positions<Dim> normals = vertex_normals<Dim>(surface, positions);
            for (Eigen::Index k = 0; k < normals.cols(); ++k) {
                normals_.col(surface.vertices(0, k)) = normals.col(k);
            }
        }
    }

    void append(const BodyPair& pair,
                const PositionsView<Dim>& positions,
                std::vector<Contact<Dim>>& contacts) const {
        const PairSetting<Dim> setting{positions, rest_,      normals_,
                                       options_,  pair.first, pair.second};
        const PairSetting<Dim> swapped{positions, rest_,       normals_,
                                       options_,  pair.second, pair.first};
        if (setting.is_self()) {
            append_self_points(setting, pair.points_first, contacts);
        } else {
            append_solid(setting, pair.points_first, contacts);
            append_solid(swapped, pair.points_second, contacts);
        }
        append_mixed(setting, pair.mixed_first, contacts);
        append_mixed(swapped, pair.mixed_second, contacts);
    }

    void append_mixed(const PairSetting<Dim>& setting,
                      const NearPairs& near,
                      std::vector<Contact<Dim>>& contacts) const {
        const auto& edges = bodies_[setting.first_body].surface.edges;
        const auto& ridges = bodies_[setting.second_body].surface.ridges;
        append_chunks<Dim>(
            near.pairs.size(),
            [&](std::size_t k, std::vector<Contact<Dim>>& found) {
                const NearPair& pair = near.pairs[k];
                if (const auto contact = local_contact<Dim, 2, Dim - 1>(setting, edges, pair.first,
                                                                        ridges, pair.second)) {
                    found.push_back(*contact);
                }
            },
            contacts);
    }

    // One contact a vertex: with the nearest facet that is not culled.
    void append_self_points(const PairSetting<Dim>& setting,
                            const NearPairs& near,
                            std::vector<Contact<Dim>>& contacts) const {
        const Surface<Dim>& surface = bodies_[setting.first_body].surface;
        const auto begin = starts_of(near, surface.vertices.cols());
        append_chunks<Dim>(
            surface.vertices.cols(),
            [&](std::size_t i, std::vector<Contact<Dim>>& found) {
                std::optional<Contact<Dim>> nearest;
                for (std::size_t k = begin[i]; k < begin[i + 1]; ++k) {
                    const auto contact =
                        local_contact<Dim, 1, Dim>(setting, surface.vertices, near.pairs[k].first,
                                                   surface.facets, near.pairs[k].second);
                    if (contact
                        && (!nearest
                            || std::abs(contact->distance) < std::abs(nearest->distance))) {
                        nearest = contact;
                    }
                }
                if (nearest) {
                    found.push_back(*nearest);
                }
            },
            contacts);
    }

    // One contact a vertex that is inside the second body, or near it.
    void append_solid(const PairSetting<Dim>& setting,
                      const NearPairs& near,
                      std::vector<Contact<Dim>>& contacts) const {
        const Surface<Dim>& surface = bodies_[setting.first_body].surface;
        const Surface<Dim>& around = bodies_[setting.second_body].surface;
        const BoxTree& facets = trees_[setting.second_body].facets();
        const std::vector<std::uint8_t> is_inside = vertices_inside<Dim>(
            surface, trees_[setting.first_body].vertices(), around, facets, setting.positions);
        const auto begin = starts_of(near, surface.vertices.cols());
        append_chunks<Dim>(
            surface.vertices.cols(),
            [&](std::size_t i, std::vector<Contact<Dim>>& found) {
                const std::uint32_t vertex = surface.vertices(0, static_cast<Eigen::Index>(i));
                NearPair nearest;
                if (begin[i] < begin[i + 1]) {
                    nearest = *std::min_element(near.pairs.begin() + begin[i],
                                                near.pairs.begin() + begin[i + 1],
                                                [](const NearPair& a, const NearPair& b) {
                                                    return a.distance_squared < b.distance_squared;
                                                });
                } else if (is_inside[i] != 0) {
                    nearest = nearest_facet<Dim>(around, facets, setting.positions,
                                                 setting.positions.col(vertex));
                } else {
                    return;
                }
                if (const auto contact = solid_contact<Dim>(setting, vertex, around.facets,
                                                            nearest.second, is_inside[i] != 0)) {
                    found.push_back(*contact);
                }
            },
            contacts);
    }

    static void sum_up(Contacts<Dim>& contacts) {
        ContactReport& report = contacts.report;
        for (const Contact<Dim>& contact : contacts.pairs) {
            const bool is_point = contact.kind == ContactKind::PointFacet;
            ++(is_point ? report.point_facet : report.mixed);
            report.self += contact.first_body == contact.second_body ? 1 : 0;
            report.energy += contact.response.energy;
            report.smallest_distance = std::min(report.smallest_distance, contact.distance);
            if (is_point) {
                report.deepest = std::max(report.deepest, -contact.distance);
            }
        }
    }

    std::vector<ContactBody<Dim>> bodies_;
    ContactOptions options_;
    std::vector<double> mean_edges_;
    std::vector<BodyTrees<Dim>> trees_;
    Positions<Dim> rest_;          // empty without self-contact
    Positions<Dim> normals_;       // columns of bodies that needed them last
    std::vector<BodyPair> pairs_;  // found within the distance and the margin
    Positions<Dim> searched_at_;   // where; empty if pairs_ are of no further use
};

template <int Dim>
ContactFinder<Dim>::ContactFinder(std::vector<ContactBody<Dim>> bodies,
                                  const PositionsView<Dim>& rest,
                                  const ContactOptions& options) {
    check(options, "contact");
    state_ = std::make_unique<State>(std::move(bodies), rest, options);
}

template <int Dim>
ContactFinder<Dim>::~ContactFinder() = default;
template <int Dim>
ContactFinder<Dim>::ContactFinder(ContactFinder&&) noexcept = default;
template <int Dim>
ContactFinder<Dim>& ContactFinder<Dim>::operator=(ContactFinder&&) noexcept = default;

template <int Dim>
Contacts<Dim> ContactFinder<Dim>::find(const PositionsView<Dim>& positions) {
    return state_->find(positions);
}

template <int Dim>
std::vector<std::string> ContactFinder<Dim>::warnings() const {
    return state_->warnings();
}

template <int Dim>
const std::vector<ContactBody<Dim>>& ContactFinder<Dim>::bodies() const {
    return state_->bodies();
}

template <int Dim>
const ContactOptions& ContactFinder<Dim>::options() const {
    return state_->options();
}

template class ContactFinder<3>;
template class ContactFinder<4>;

}  // namespace pent::contact
