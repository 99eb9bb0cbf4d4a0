#include "penalty_contacts.h"

#include "near_pairs.h"
#include "normals.h"
#include "pair_contact.h"
#include "valley.h"

#include <pent/dimensions.h>

#include <algorithm>
#include <cmath>

namespace pent::contact {

namespace {

// Contacts are computed in chunks of this many pairs or vertices.
constexpr std::size_t kChunk = 128;

// A vertex near a facet, by their places.
struct NearPoint {
    std::uint32_t vertex = 0;
    std::uint32_t facet = 0;
    double distance_squared = 0;
};

// The candidates that are near now, ascending.
struct NearNow {
    const CandidatePairs* bodies = nullptr;
    std::vector<NearPoint> points_first;
    std::vector<NearPoint> points_second;
    std::vector<Candidate> mixed_first;
    std::vector<Candidate> mixed_second;
};

// What penalties are found from: positions, candidates, normals.
template <int Dim>
struct Setting {
    const Colliders<Dim>& colliders;
    const Candidates<Dim>& candidates;
    const PositionsView<Dim>& positions;
    Positions<Dim> normals;  // of vertices of bodies that are judged by them

    [[nodiscard]] const SharedWork& shared() const { return candidates.shared(); }
    [[nodiscard]] double distance() const { return colliders.scene().options.distance; }
    [[nodiscard]] const Surface<Dim>& surface(int body) const { return colliders.surface(body); }
    [[nodiscard]] PairSetting<Dim> of(int first, int second) const {
        return {positions,  colliders.rest(),          normals,
                distance(), colliders.collider(first), colliders.collider(second)};
    }
};

template <int Dim>
std::vector<NearPoint> near_points(const Setting<Dim>& setting,
                                   const CandidateList& list,
                                   const Displacement& displacement,
                                   const Simplices<1>& vertices,
                                   const Simplices<Dim>& facets) {
    const double limit = setting.distance() * setting.distance();
    const DistanceCull cull(list, displacement, setting.distance());
    std::vector<NearPoint> near =
        collect<NearPoint>(cull.size(), kChunk, [&](std::size_t k, std::vector<NearPoint>& found) {
            if (!cull.passes(k, vertices, facets)) {
                return;
            }
            const auto& [i, j, measured] = list.pairs[k];
            const Corners<Dim, 1> point = gather<Dim, 1>(vertices, i, setting.positions);
            const Corners<Dim, Dim> corners = gather<Dim, Dim>(facets, j, setting.positions);
            ClosestPointSearch<Dim, 1, Dim> search(point, corners, limit);
            if (search.run()) {
                found.push_back({i, j, search.best().distance_squared});
            }
        });
    near = setting.shared().all(std::move(near));
    std::sort(near.begin(), near.end(), [](const NearPoint& a, const NearPoint& b) {
        return a.vertex != b.vertex ? a.vertex < b.vertex : a.facet < b.facet;
    });
    return near;
}

template <int Dim>
std::vector<Candidate> near_mixed(const Setting<Dim>& setting,
                                  const CandidateList& list,
                                  const Displacement& displacement,
                                  const Simplices<2>& edges,
                                  const Simplices<Dim - 1>& ridges,
                                  bool is_exact) {
    if (is_exact) {
        CandidateList all = list;
        all.pairs = setting.shared().all(std::move(all.pairs));
        return sorted(std::move(all)).pairs;
    }
    const double limit = setting.distance() * setting.distance();
    const DistanceCull cull(list, displacement, setting.distance());
    std::vector<Candidate> near =
        collect<Candidate>(cull.size(), kChunk, [&](std::size_t k, std::vector<Candidate>& found) {
            if (!cull.passes(k, edges, ridges)) {
                return;
            }
            const Corners<Dim, 2> a = gather<Dim, 2>(edges, list.pairs[k].first, setting.positions);
            const Corners<Dim, Dim - 1> b =
                gather<Dim, Dim - 1>(ridges, list.pairs[k].second, setting.positions);
            ClosestPointSearch<Dim, 2, Dim - 1> search(a, b, limit);
            if (search.run_interior()) {
                found.push_back(list.pairs[k]);
            }
        });
    near = setting.shared().all(std::move(near));
    std::sort(near.begin(), near.end(), is_before);
    return near;
}

template <int Dim>
NearNow near_now(const Setting<Dim>& setting,
                 const CandidatePairs& pairs,
                 const Displacement& gone) {
    const Surface<Dim>& a = setting.surface(pairs.first);
    const Surface<Dim>& b = setting.surface(pairs.second);
    // Within a body what was near at rest is among them, which has not been looked at.
    const bool is_exact = setting.candidates.is_exact() && !pairs.is_self();
    return {&pairs, near_points<Dim>(setting, pairs.points_first, gone, a.vertices, b.facets),
            near_points<Dim>(setting, pairs.points_second, gone, b.vertices, a.facets),
            near_mixed<Dim>(setting, pairs.mixed_first, gone, a.edges, b.ridges, is_exact),
            near_mixed<Dim>(setting, pairs.mixed_second, gone, b.edges, a.ridges, is_exact)};
}

// Computes normals of bodies that have pairs judged by them.
template <int Dim>
void find_normals(const std::vector<NearNow>& all, Setting<Dim>& setting) {
    std::vector<bool> is_judged(static_cast<std::size_t>(setting.colliders.count()), false);
    for (const NearNow& near : all) {
        if (!near.mixed_first.empty() || !near.mixed_second.empty()
            || (near.bodies->is_self() && !near.points_first.empty())) {
            is_judged[static_cast<std::size_t>(near.bodies->first)] = true;
            is_judged[static_cast<std::size_t>(near.bodies->second)] = true;
        }
    }
    for (int body = 0; body < setting.colliders.count(); ++body) {
        if (!is_judged[static_cast<std::size_t>(body)]) {
            continue;
        }
        setting.normals.resize(Dim, setting.positions.cols());
        const Surface<Dim>& surface = setting.surface(body);
        const Positions<Dim> normals = vertex_normals<Dim>(surface, setting.positions);
        for (Eigen::Index k = 0; k < normals.cols(); ++k) {
            setting.normals.col(surface.vertices(0, k)) = normals.col(k);
        }
    }
}

// Where the pairs of each vertex begin in an ascending list; count + 1 entries.
std::vector<std::size_t> starts_of(const std::vector<NearPoint>& points, std::size_t count) {
    std::vector<std::size_t> begin(count + 1, 0);
    for (const NearPoint& point : points) {
        ++begin[point.vertex + 1];
    }
    for (std::size_t i = 1; i <= count; ++i) {
        begin[i] += begin[i - 1];
    }
    return begin;
}

template <int Dim>
void append(std::vector<Contact<Dim>> found, std::vector<Contact<Dim>>& contacts) {
    contacts.insert(contacts.end(), found.begin(), found.end());
}

template <int Dim>
std::vector<Contact<Dim>> mixed_contacts(const Setting<Dim>& setting,
                                         int first,
                                         int second,
                                         const std::vector<Candidate>& near) {
    const Simplices<2>& edges = setting.surface(first).edges;
    const Simplices<Dim - 1>& ridges = setting.surface(second).ridges;
    const PairSetting<Dim> pair_setting = setting.of(first, second);
    return setting.shared().template collect<Contact<Dim>>(
        near.size(), kChunk, [&](std::size_t k, std::vector<Contact<Dim>>& found) {
            if (const auto contact = local_contact<Dim, 2, Dim - 1>(
                    pair_setting, edges, near[k].first, ridges, near[k].second)) {
                found.push_back(*contact);
            }
        });
}

// Within a body: one contact a vertex, with the nearest facet that is not culled, shared with
// others where the vertex is in front of a valley.
template <int Dim>
std::vector<Contact<Dim>> self_contacts(const Setting<Dim>& setting,
                                        int body,
                                        const std::vector<NearPoint>& near) {
    const Surface<Dim>& surface = setting.surface(body);
    const auto vertices = static_cast<std::size_t>(surface.vertices.cols());
    const auto begin = starts_of(near, vertices);
    const PairSetting<Dim> pair_setting = setting.of(body, body);
    return setting.shared().template collect<Contact<Dim>>(
        vertices, kChunk, [&](std::size_t i, std::vector<Contact<Dim>>& found) {
            const std::size_t first_found = found.size();
            for (std::size_t k = begin[i]; k < begin[i + 1]; ++k) {
                if (const auto contact =
                        local_contact<Dim, 1, Dim>(pair_setting, surface.vertices, near[k].vertex,
                                                   surface.facets, near[k].facet)) {
                    found.push_back(*contact);
                }
            }
            if (found.size() == first_found) {
                return;
            }
            const auto first = found.begin() + static_cast<std::ptrdiff_t>(first_found);
            const auto is_nearer = [](const Contact<Dim>& a, const Contact<Dim>& b) {
                return std::abs(a.distance) < std::abs(b.distance);
            };
            const auto nearest = std::min_element(first, found.end(), is_nearer);
            std::rotate(first, nearest, nearest + 1);
            if (first->distance < 0) {
                found.erase(first + 1, found.end());
                return;
            }
            found.erase(std::remove_if(first, found.end(),
                                       [](const Contact<Dim>& c) { return c.distance < 0; }),
                        found.end());
            share_contacts<Dim>(found, first_found, setting.distance(), setting.positions);
        });
}

// One contact for each vertex that is inside the second body, or near it, shared among facets where
// it lies in a valley.
template <int Dim>
std::vector<Contact<Dim>> solid_contacts(const Setting<Dim>& setting,
                                         int first,
                                         int second,
                                         const std::vector<NearPoint>& near) {
    const Surface<Dim>& surface = setting.surface(first);
    const Surface<Dim>& around = setting.surface(second);
    const BoxTree& facets = setting.candidates.trees(second).template tree<Dim>();
    const std::vector<std::uint8_t> is_inside =
        vertices_inside<Dim>(surface, setting.candidates.trees(first).template tree<1>(), around,
                             facets, setting.positions, setting.shared());
    const auto begin = starts_of(near, is_inside.size());
    const PairSetting<Dim> pair_setting = setting.of(first, second);
    return setting.shared().template collect<Contact<Dim>>(
        is_inside.size(), kChunk, [&](std::size_t i, std::vector<Contact<Dim>>& found) {
            const std::uint32_t vertex = surface.vertices(0, static_cast<Eigen::Index>(i));
            std::uint32_t facet = 0;
            if (begin[i] < begin[i + 1]) {
                facet = std::min_element(near.begin() + static_cast<std::ptrdiff_t>(begin[i]),
                                         near.begin() + static_cast<std::ptrdiff_t>(begin[i + 1]),
                                         [](const NearPoint& a, const NearPoint& b) {
                                             return a.distance_squared < b.distance_squared;
                                         })
                            ->facet;
            } else if (is_inside[i] != 0) {
                facet = nearest_facet<Dim>(around, facets, setting.positions,
                                           setting.positions.col(vertex));
            } else {
                return;
            }
            const std::size_t first_found = found.size();
            const auto add = [&](std::uint32_t other) {
                if (const auto contact = solid_contact<Dim>(pair_setting, vertex, around.facets,
                                                            other, is_inside[i] != 0)) {
                    found.push_back(*contact);
                }
            };
            add(facet);
            if (is_inside[i] != 0 || found.size() == first_found) {
                return;
            }
            for (std::size_t k = begin[i]; k < begin[i + 1]; ++k) {
                if (near[k].facet != facet) {
                    add(near[k].facet);
                }
            }
            share_contacts<Dim>(found, first_found, setting.distance(), setting.positions);
        });
}

}  // namespace

template <int Dim>
std::vector<Contact<Dim>> find_penalty_contacts(const Colliders<Dim>& colliders,
                                                const Candidates<Dim>& candidates,
                                                const PositionsView<Dim>& positions) {
    Setting<Dim> setting{colliders, candidates, positions, Positions<Dim>()};
    std::vector<NearNow> all;
    const std::vector<Displacement> gone = candidates.displacements(positions, positions);
    for (std::size_t m = 0; m < gone.size(); ++m) {  // one by one: a team gathers in this order
        all.push_back(near_now<Dim>(setting, candidates.meetings()[m].pairs, gone[m]));
    }
    find_normals<Dim>(all, setting);
    std::vector<Contact<Dim>> contacts;
    for (const NearNow& near : all) {
        const int a = near.bodies->first;
        const int b = near.bodies->second;
        if (near.bodies->is_self()) {
            append<Dim>(self_contacts<Dim>(setting, a, near.points_first), contacts);
        } else {
            append<Dim>(solid_contacts<Dim>(setting, a, b, near.points_first), contacts);
            append<Dim>(solid_contacts<Dim>(setting, b, a, near.points_second), contacts);
        }
        append<Dim>(mixed_contacts<Dim>(setting, a, b, near.mixed_first), contacts);
        append<Dim>(mixed_contacts<Dim>(setting, b, a, near.mixed_second), contacts);
    }
    return contacts;
}

#define PENT_INSTANTIATE(Dim)                                 \
    template std::vector<Contact<Dim>> find_penalty_contacts( \
        const Colliders<Dim>&, const Candidates<Dim>&, const PositionsView<Dim>&);
PENT_FOR_EACH_DIMENSION(PENT_INSTANTIATE)
#undef PENT_INSTANTIATE

}  // namespace pent::contact
