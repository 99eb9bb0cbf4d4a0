#include "pair_contact.h"
#include "pair_search.h"

#include <pent/parallel.h>

#include <algorithm>
#include <chrono>
#include <sstream>

namespace pent::contact {

namespace {

// Contacts are computed in chunks of this many pairs or vertices.
constexpr std::size_t kChunk = 512;

// Appends add(i, contacts) of all i in [0, count), in their order.
template <int Dim, typename Add>
void append_chunks(std::size_t count, const Add& add, std::vector<Contact<Dim>>& contacts) {
    std::vector<std::vector<Contact<Dim>>> found((count + kChunk - 1) / kChunk);
    parallel_for(found.size(), [&](std::size_t chunk) {
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
        : bodies_(std::move(bodies)), options_(options), search_(bodies_, rest_, options_) {
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
        const std::vector<BodyPair> pairs = search_.run(positions, contacts.report);
        update_normals(judged_by_normals(pairs), positions);
        for (const BodyPair& pair : pairs) {
            append(pair, positions, contacts.pairs);
        }
        sum_up(contacts);
        contacts.report.seconds =
            std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count();
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

    [[nodiscard]] const ContactOptions& options() const { return options_; }
    [[nodiscard]] std::int64_t bytes() const {
        std::int64_t sum = search_.bytes();
        for (const ContactBody<Dim>& body : bodies_) {
            sum += body.surface.bytes();
        }
        return sum + static_cast<std::int64_t>(sizeof(double)) * (rest_.size() + normals_.size());
    }

private:
    // Bodies that have pairs judged by normals.
    [[nodiscard]] std::vector<bool> judged_by_normals(const std::vector<BodyPair>& pairs) const {
        std::vector<bool> is_judged(bodies_.size(), false);
        for (const BodyPair& pair : pairs) {
            const bool has_self_points =
                pair.first == pair.second && !pair.points_first.pairs.empty();
            if (has_self_points || !pair.mixed_first.pairs.empty()
                || !pair.mixed_second.pairs.empty()) {
                is_judged[pair.first] = true;
                is_judged[pair.second] = true;
            }
        }
        return is_judged;
    }

    void update_normals(const std::vector<bool>& is_needed, const PositionsView<Dim>& positions) {
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
        const BoxTree& facets = search_.trees(setting.second_body).facets();
        const std::vector<std::uint8_t> is_inside =
            vertices_inside<Dim>(surface, search_.trees(setting.first_body).vertices(), around,
                                 facets, setting.positions);
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
    PairSearch<Dim> search_;
    Positions<Dim> rest_;     // empty without self-contact
    Positions<Dim> normals_;  // columns of bodies that needed them last
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
std::int64_t ContactFinder<Dim>::bytes() const {
    return state_->bytes();
}

template <int Dim>
const ContactOptions& ContactFinder<Dim>::options() const {
    return state_->options();
}

template class ContactFinder<3>;
template class ContactFinder<4>;

}  // namespace pent::contact
