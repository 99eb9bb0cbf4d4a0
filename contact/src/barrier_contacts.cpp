#include "apart.h"
#include "barrier_setting.h"
#include "closest_point_search.h"
#include "gather.h"

#include <pent/parallel.h>

#include <Eigen/LU>

#include <array>
#include <bit>
#include <cmath>
#include <numeric>

namespace pent::contact {

namespace {

constexpr std::size_t kChunk = 512;

// Mixed pairs spanning less than this part of the squared volume that they would span at rest if they
// were normal to each other are nearly parallel [li2020].
constexpr double kParallel = 1e-3;

// Squared volume of the box that the edges of a simplex span.
template <int Dim, int Count>
double spanned_squared(const Corners<Dim, Count>& corners) {
    const Eigen::Matrix<double, Dim, Count - 1> edges =
        corners.template rightCols<Count - 1>().colwise() - corners.col(0);
    return (edges.transpose() * edges).determinant();
}

// Contacts without a mollifier that are the same faces; the key is their corners.
template <int Dim>
bool is_before(const BarrierContact<Dim>& a, const BarrierContact<Dim>& b) {
    const bool a_plain = a.mollifier.threshold == 0;
    const bool b_plain = b.mollifier.threshold == 0;
    if (a_plain != b_plain) {
        return a_plain;
    }
    if (a.faces.first_count != b.faces.first_count) {
        return a.faces.first_count < b.faces.first_count;
    }
    return a.vertices != b.vertices ? a.vertices < b.vertices : a.first_body < b.first_body;
}

template <int Dim>
bool is_same(const BarrierContact<Dim>& a, const BarrierContact<Dim>& b) {
    return a.mollifier.threshold == 0 && b.mollifier.threshold == 0
           && a.faces.first_count == b.faces.first_count && a.vertices == b.vertices
           && a.first_body == b.first_body;
}

// The contact of one pair of simplices, and which pair: the list, and the places in it.
template <int Dim>
struct Found {
    BarrierContact<Dim> contact;
    std::array<std::uint32_t, 3> pair;
};

// One contact for all pairs with the same nearest faces, in ascending order. Their distances differ by
// rounding: that of the first pair counts, whatever order they were found in.
template <int Dim>
std::vector<BarrierContact<Dim>> merged(const std::vector<Found<Dim>>& found) {
    std::vector<std::uint32_t> order(found.size());
    std::iota(order.begin(), order.end(), 0U);
    std::sort(order.begin(), order.end(), [&](std::uint32_t a, std::uint32_t b) {
        return is_before<Dim>(found[a].contact, found[b].contact)
               || (!is_before<Dim>(found[b].contact, found[a].contact)
                   && found[a].pair < found[b].pair);
    });
    std::vector<BarrierContact<Dim>> kept;
    for (const std::uint32_t i : order) {
        if (!kept.empty() && is_same(kept.back(), found[i].contact)) {
            ++kept.back().multiplicity;
        } else {
            kept.push_back(found[i].contact);
        }
    }
    return kept;
}

template <int Dim>
class Search {
public:
    Search(const BarrierSetting<Dim>& setting, const PositionsView<Dim>& positions)
        : setting_(setting),
          positions_(positions),
          reach_(setting.options.distance + setting.options.separation),
          travel_(setting.candidates.travel(positions, positions)) {}

    BarrierContacts<Dim> run() {
        setting_.for_each_list([this](const auto& list, const auto& first, const auto& second,
                                      const std::array<int, 2>& bodies) {
            this->append(list, first, second, bodies);
            ++lists_;
        });
        append_obstacles();
        contacts_.pairs = merged(found_);
        sum_up();
        return std::move(contacts_);
    }

private:
    // The contact of a pair whose closest points are known: of its nearest faces, the one with the lower
    // vertex first, so that the same faces are the same contact whatever pair they come from.
    template <int K, int L>
    BarrierContact<Dim> make_contact(const ClosestPoints<Dim, K, L>& points,
                                     const std::uint32_t* first,
                                     const std::uint32_t* second,
                                     const std::array<int, 2>& bodies) const {
        BarrierContact<Dim> contact;
        NearestFaces<Dim>& faces = contact.faces;
        faces.distance = std::sqrt(points.distance_squared);
        faces.weights.setZero();
        contact.vertices.fill(kFixedPoint);
        const auto add = [&](std::uint32_t vertex, double weight) {
            faces.active |= static_cast<std::uint8_t>(1U << faces.count);
            faces.weights[faces.count] = weight;
            contact.vertices[faces.count++] = vertex;
        };
        const auto add_first = [&](double sign) {
            for (int i = 0; i < K; ++i) {
                if ((points.first_face >> i & 1) != 0) {
                    add(first[i], sign * points.beta[i]);
                }
            }
        };
        const auto add_second = [&](double sign) {
            for (int j = 0; j < L; ++j) {
                if ((points.second_face >> j & 1) != 0) {
                    add(second[j], sign * points.alpha[j]);
                }
            }
        };
        const bool is_swapped = bodies[0] >= 0
                                && second[std::countr_zero(points.second_face)]
                                       < first[std::countr_zero(points.first_face)];
        if (is_swapped) {
            add_second(1);
            faces.first_count = faces.count;
            add_first(-1);
        } else {
            add_first(1);
            faces.first_count = faces.count;
            add_second(-1);
        }
        faces.direction = (is_swapped ? -1 : 1) / faces.distance * points.difference;
        contact.first_body = bodies[is_swapped ? 1 : 0];
        contact.second_body = bodies[is_swapped ? 0 : 1];
        contact.separation = setting_.options.separation;
        return contact;
    }

    // The same with all corners, for a pair that is nearly parallel.
    template <int K, int L>
    BarrierContact<Dim> make_mollified(const ClosestPoints<Dim, K, L>& points,
                                       const std::uint32_t* first,
                                       const std::uint32_t* second,
                                       const std::array<int, 2>& bodies,
                                       double threshold) const {
        BarrierContact<Dim> contact;
        contact.first_body = bodies[0];
        contact.second_body = bodies[1];
        contact.separation = setting_.options.separation;
        contact.mollifier.threshold = threshold;
        contact.faces = nearest_faces<Dim, K, L>(points);
        std::copy_n(first, K, contact.vertices.begin());
        std::copy_n(second, L, contact.vertices.begin() + K);
        return contact;
    }

    // c0 of a mixed pair, or 0 where it is not nearly parallel.
    template <int K, int L>
    [[nodiscard]] double parallel_threshold(const Simplices<K>& first,
                                            std::uint32_t i,
                                            const Simplices<L>& second,
                                            std::uint32_t j,
                                            const Corners<Dim, K>& a,
                                            const Corners<Dim, L>& b) const {
        const double threshold =
            kParallel * spanned_squared<Dim, K>(gather<Dim, K>(first, i, setting_.rest))
            * spanned_squared<Dim, L>(gather<Dim, L>(second, j, setting_.rest));
        Stencil<Dim> points;
        points << a, b;
        return spanned_volume_squared<Dim>(points) < threshold ? threshold : 0;
    }

    template <int K, int L>
    void append(const CandidateList& list,
                const Simplices<K>& first,
                const Simplices<L>& second,
                const std::array<int, 2>& bodies) {
        const Sieve<K, L> sieve(list, first, second, travel_, reach_);
        std::vector<std::vector<Found<Dim>>> found((sieve.size() + kChunk - 1) / kChunk);
        parallel_for(found.size(), [&](std::size_t chunk) {
            const std::size_t end = std::min((chunk + 1) * kChunk, sieve.size());
            for (std::size_t k = chunk * kChunk; k < end; ++k) {
                if (!sieve.passes(k)) {
                    continue;
                }
                const std::uint32_t i = list.pairs[k].first;
                const std::uint32_t j = list.pairs[k].second;
                const Corners<Dim, K> a = gather<Dim, K>(first, i, positions_);
                const Corners<Dim, L> b = gather<Dim, L>(second, j, positions_);
                if (are_boxes_apart<Dim, K, L>(a, b, reach_ * reach_)) {
                    continue;
                }
                ClosestPointSearch<Dim, K, L> search(a, b, reach_ * reach_);
                if (!search.run()
                    || (setting_.candidates.template is_held<K>(first, i)
                        && setting_.candidates.template is_held<L>(second, j))) {
                    continue;
                }
                const std::uint32_t* of_first = first.col(i).data();
                const std::uint32_t* of_second = second.col(j).data();
                double threshold = 0;
                if constexpr (K == 2) {
                    threshold = parallel_threshold<K, L>(first, i, second, j, a, b);
                }
                found[chunk].push_back(
                    {threshold > 0 ? make_mollified<K, L>(search.best(), of_first, of_second,
                                                          bodies, threshold)
                                   : make_contact<K, L>(search.best(), of_first, of_second, bodies),
                     {lists_, i, j}});
            }
        });
        for (const auto& part : found) {
            found_.insert(found_.end(), part.begin(), part.end());
        }
        contacts_.report.candidates += static_cast<std::int64_t>(sieve.size());
    }

    void append_obstacles() {
        for (std::size_t o = 0; o < setting_.obstacles.size(); ++o) {
            if (const auto* ball = std::get_if<Ball<Dim>>(&setting_.obstacles[o])) {
                append_ball(static_cast<std::int32_t>(o), *ball);
                continue;
            }
            setting_.for_each_free_vertex([&](std::int32_t /*body*/, std::uint32_t vertex) {
                const double distance =
                    signed_distance<Dim>(setting_.obstacles[o], positions_.col(vertex));
                if (distance < reach_) {
                    contacts_.vertices.push_back({vertex, static_cast<std::int32_t>(o), distance});
                }
            });
        }
    }

    void append_ball(std::int32_t obstacle, const Ball<Dim>& ball) {
        const double separation = ball.radius + setting_.options.separation;
        const double reach = ball.radius + reach_;
        const Corners<Dim, 1> center = ball.center;
        setting_.for_each_facet_near(ball, [&](std::int32_t body, std::uint32_t facet) {
            const Simplices<Dim>& facets = setting_.bodies[body].surface.facets;
            const Corners<Dim, Dim> corners = gather<Dim, Dim>(facets, facet, positions_);
            ClosestPointSearch<Dim, 1, Dim> search(center, corners, reach * reach);
            if (!search.run()) {
                return;
            }
            BarrierContact<Dim> contact = make_contact<1, Dim>(
                search.best(), &kFixedPoint, facets.col(facet).data(), {-1 - obstacle, body});
            contact.separation = separation;
            found_.push_back({contact, {lists_, static_cast<std::uint32_t>(obstacle), facet}});
        });
    }

    void sum_up() {
        BarrierReport& report = contacts_.report;
        for (const BarrierContact<Dim>& contact : contacts_.pairs) {
            report.smallest_gap =
                std::min(report.smallest_gap, contact.faces.distance - contact.separation);
            report.mollified += contact.mollifier.threshold > 0 ? 1 : 0;
        }
        for (const VertexContact& contact : contacts_.vertices) {
            report.smallest_gap =
                std::min(report.smallest_gap, contact.distance - setting_.options.separation);
        }
        report.contacts =
            static_cast<std::int64_t>(contacts_.pairs.size() + contacts_.vertices.size());
    }

    const BarrierSetting<Dim>& setting_;
    const PositionsView<Dim>& positions_;
    double reach_;
    Travel travel_;
    std::uint32_t lists_ = 0;  // that have been looked at
    std::vector<Found<Dim>> found_;
    BarrierContacts<Dim> contacts_;
};

}  // namespace

template <int Dim>
BarrierContacts<Dim> find_barrier_contacts(const BarrierSetting<Dim>& setting,
                                           const PositionsView<Dim>& positions) {
    return Search<Dim>(setting, positions).run();
}

template BarrierContacts<3> find_barrier_contacts(const BarrierSetting<3>&,
                                                  const PositionsView<3>&);
template BarrierContacts<4> find_barrier_contacts(const BarrierSetting<4>&,
                                                  const PositionsView<4>&);

}  // namespace pent::contact
