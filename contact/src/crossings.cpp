#include "crossings.h"

#include "near_pairs.h"
#include "obstacle_contacts.h"
#include "simplex_crossing.h"
#include "surface_trees.h"

#include <pent/dimensions.h>

#include <algorithm>
#include <array>
#include <cmath>

namespace pent::contact {

namespace {

// Distances below this part of the largest coordinate count as touching: rounding is a thousandth
// of that.
constexpr double kRounding = 1e-12;

template <int Count>
std::vector<std::uint32_t> corners(const Simplices<Count>& simplices, Eigen::Index i) {
    return {simplices.col(i).data(), simplices.col(i).data() + Count};
}

template <int Dim>
std::vector<SurfaceTrees<Dim>> make_trees(const Colliders<Dim>& colliders,
                                          const PositionsView<Dim>& positions,
                                          double margin) {
    std::vector<SurfaceTrees<Dim>> trees(static_cast<std::size_t>(colliders.count()));
    std::vector<Box> boxes(static_cast<std::size_t>(positions.cols()));
    for (int i = 0; i < colliders.count(); ++i) {
        const Surface<Dim>& surface = colliders.surface(i);
        for (const std::uint32_t v : surface.vertices.reshaped()) {
            boxes[v] = box_around<Dim, 1>(positions.col(v), margin + colliders.radius(i));
        }
        trees[static_cast<std::size_t>(i)].update_vertices(surface, boxes);
        trees[static_cast<std::size_t>(i)].update_faces(surface, boxes);
    }
    return trees;
}

// Two colliders, in this order.
struct Two {
    int first = 0;
    int second = 0;
};

// Colliders, trees, the walk through them and the search for near pairs are those of all contact;
// the candidates are not. Crossings are pairs of other kinds, as edges that go through facets, and
// are asked for where a scene begins, changes or is restored, not in its steps. And this search is
// to be an independent witness that nothing crosses, which no fault in candidates, covers of paths
// or collision detection can mislead.
template <int Dim>
class CrossingSearch {
public:
    CrossingSearch(const Colliders<Dim>& colliders,
                   const PositionsView<Dim>& positions,
                   std::size_t most)
        : colliders_(colliders),
          positions_(positions),
          least_(colliders.scene().options.separation
                 + kRounding * (positions.size() == 0 ? 0 : positions.cwiseAbs().maxCoeff())),
          most_(most),
          trees_(make_trees<Dim>(colliders, positions, least_)) {}

    void add_between(int a, int b) {
        is_entered_ = false;
        add_through<2, Dim>({a, b});
        if constexpr (Dim > 3) {
            add_through<3, 3>({a, b});
        }
        add_touching<1, Dim>({a, b});
        add_touching<2, Dim - 1>({a, b});
        if (a == b) {
            return;
        }
        add_inside({a, b});
        add_through<2, Dim>({b, a});
        add_touching<1, Dim>({b, a});
        if constexpr (Dim > 3) {
            add_touching<2, Dim - 1>({b, a});
        }
        add_inside({b, a});
    }

    void add_at_surface(std::uint32_t obstacle, const std::vector<std::uint32_t>& vertices) {
        const ContactScene<Dim>& scene = colliders_.scene();
        for (const std::uint32_t vertex : vertices) {
            const double distance =
                signed_distance<Dim>(scene.obstacles[obstacle].shape, positions_.col(vertex)).value;
            if (distance <= least_ && found_.size() < most_) {
                found_.push_back({distance < 0 ? CrossingKind::Inside : CrossingKind::Touching,
                                  body_of<Dim>(scene, vertex),
                                  {Collider::Kind::Obstacle, obstacle},
                                  {vertex},
                                  {},
                                  distance});
            }
        }
    }

    std::vector<Crossing> take() { return std::move(found_); }

private:
    template <int Count>
    [[nodiscard]] const Simplices<Count>& simplices(int i) const {
        return colliders_.surface(i).template simplices<Count>();
    }
    template <int Count>
    [[nodiscard]] const BoxTree& tree(int i) const {
        return trees_[static_cast<std::size_t>(i)].template tree<Count>();
    }
    template <typename May>
    [[nodiscard]] static bool all(const std::vector<std::uint32_t>& first,
                                  const std::vector<std::uint32_t>& second,
                                  const May& may) {
        return std::all_of(first.begin(), first.end(), may)
               && std::all_of(second.begin(), second.end(), may);
    }

    // Adds what may not be: fixed vertices alone may touch, and some of them meet obstacles.
    void add(CrossingKind kind,
             const Two& two,
             std::vector<std::uint32_t> first,
             std::vector<std::uint32_t> second,
             double distance) {
        const bool has_core = colliders_.is_core(two.first) || colliders_.is_core(two.second);
        const auto is_fixed = [&](std::uint32_t vertex) { return colliders_.is_fixed(vertex); };
        const auto may_enter = [&](std::uint32_t vertex) {
            return colliders_.may_enter_obstacles(vertex);
        };
        const bool may_be = has_core
                                ? all(first, second, may_enter)
                                : kind == CrossingKind::Touching && all(first, second, is_fixed);
        is_entered_ = is_entered_ || (has_core && may_be);
        if (may_be || found_.size() >= most_) {
            return;
        }
        Crossing crossing{kind,
                          colliders_.collider(two.first),
                          colliders_.collider(two.second),
                          std::move(first),
                          std::move(second),
                          distance};
        if (colliders_.is_core(two.first)) {
            std::swap(crossing.first, crossing.second);
            std::swap(crossing.first_corners, crossing.second_corners);
        }
        if (has_core) {
            crossing.second_corners.clear();
        }
        found_.push_back(std::move(crossing));
    }

    template <int K, int L>
    void add_through(const Two& two) {
        const Simplices<K>& first = simplices<K>(two.first);
        const Simplices<L>& second = simplices<L>(two.second);
        const bool is_same_list = &tree<K>(two.first) == &tree<L>(two.second);
        const CandidateList pairs = sorted(joined(walk_overlaps<CandidateList>(
            tree<K>(two.first), tree<L>(two.second),
            [&](std::uint32_t i, std::uint32_t j, CandidateList& found) {
                if (share_a_vertex<K, L>(first, i, second, j)
                    || !is_crossing<Dim, K, L>(gather<Dim, K>(first, i, positions_),
                                               gather<Dim, L>(second, j, positions_))) {
                    return;
                }
                if (is_same_list && j < i) {
                    std::swap(i, j);
                }
                found.pairs.push_back({i, j, 0});
            })));
        for (const Candidate& pair : pairs.pairs) {
            add(CrossingKind::Through, two, corners<K>(first, pair.first),
                corners<L>(second, pair.second), 0);
        }
    }

    template <int K, int L>
    void add_touching(const Two& two) {
        const Simplices<K>& first = simplices<K>(two.first);
        const Simplices<L>& second = simplices<L>(two.second);
        const double radius = colliders_.radius(two.first) + colliders_.radius(two.second);
        const double limit = radius + least_;
        const CandidateList near = near_pairs<Dim, K, L>(
            {first, tree<K>(two.first)}, {second, tree<L>(two.second)}, positions_, limit);
        for (const Candidate& pair : near.pairs) {
            const Corners<Dim, K> a = gather<Dim, K>(first, pair.first, positions_);
            const Corners<Dim, L> b = gather<Dim, L>(second, pair.second, positions_);
            ClosestPointSearch<Dim, K, L> search(a, b, limit * limit);
            search.run();
            const double distance = std::sqrt(search.best().distance_squared) - radius;
            add(distance < 0 ? CrossingKind::Through : CrossingKind::Touching, two,
                corners<K>(first, pair.first), corners<L>(second, pair.second),
                std::max(distance, 0.0));
        }
    }

    // Vertices of the first that are inside the second; of an obstacle one is enough.
    void add_inside(const Two& two) {
        const Surface<Dim>& surface = colliders_.surface(two.first);
        const std::vector<std::uint8_t> inside =
            vertices_inside<Dim>(surface, tree<1>(two.first), colliders_.surface(two.second),
                                 tree<Dim>(two.second), positions_);
        for (std::size_t i = 0; i < inside.size(); ++i) {
            if (inside[i] == 0) {
                continue;
            }
            if (colliders_.is_core(two.first)) {
                add_swallowed(two);
                return;
            }
            add(CrossingKind::Inside, two,
                corners<1>(surface.vertices, static_cast<Eigen::Index>(i)), {}, 0);
        }
    }

    // An obstacle inside a body whose surface it does not touch.
    void add_swallowed(const Two& two) {
        const Collider body = colliders_.collider(two.second);
        const Collider obstacle = colliders_.collider(two.first);
        const bool is_known = std::any_of(found_.begin(), found_.end(), [&](const Crossing& c) {
            return c.first == body && c.second == obstacle;
        });
        if (!is_known && !is_entered_ && found_.size() < most_) {
            found_.push_back({CrossingKind::Inside, body, obstacle, {}, {}, 0});
        }
    }

    const Colliders<Dim>& colliders_;
    const PositionsView<Dim>& positions_;
    double least_;
    std::size_t most_;
    std::vector<SurfaceTrees<Dim>> trees_;
    bool is_entered_ = false;  // whether what may has entered an obstacle, of the two looked at
    std::vector<Crossing> found_;
};

const char* simplex_name(std::size_t corners) {
    constexpr std::array<const char*, 4> kNames{"vertex", "edge", "triangle", "tetrahedron"};
    return kNames.at(corners - 1);
}

template <int Dim>
std::string name_of(const std::vector<std::uint32_t>& corners, const ContactBody<Dim>& body) {
    const std::uint32_t first = body.surface.first_vertex;
    std::string name = simplex_name(corners.size());
    for (std::size_t i = 0; i < corners.size(); ++i) {
        name += (i == 0 ? " " : "-") + std::to_string(corners[i] - first);
    }
    return name + " of '" + body.name + "'";
}

}  // namespace

template <int Dim>
std::vector<Crossing> find_crossings(const Colliders<Dim>& colliders,
                                     const std::vector<std::uint32_t>& vertices,
                                     const PositionsView<Dim>& positions,
                                     std::size_t most) {
    CrossingSearch<Dim> search(colliders, positions, most);
    for (int a = 0; a < colliders.count(); ++a) {
        for (int b = a; b < colliders.count(); ++b) {
            if (colliders.can_meet(a, b)) {
                search.add_between(a, b);
            }
        }
    }
    for (std::uint32_t o = 0; o < colliders.scene().obstacles.size(); ++o) {
        if (meets_vertices(colliders, o)) {
            search.add_at_surface(o, vertices);
        }
    }
    return search.take();
}

template <int Dim>
std::string describe(const Crossing& crossing, const ContactScene<Dim>& scene) {
    const ContactBody<Dim>& body = scene.bodies[crossing.first.index];
    const std::string obstacle = "obstacle " + std::to_string(crossing.second.index + 1);
    if (crossing.first_corners.empty()) {
        return obstacle + " is inside '" + body.name + "'";
    }
    const std::string first = name_of<Dim>(crossing.first_corners, body);
    const std::string how = crossing.kind == CrossingKind::Through    ? " goes through "
                            : crossing.kind == CrossingKind::Touching ? " touches "
                                                                      : " is inside ";
    if (crossing.second.is_obstacle()) {
        return first + how + obstacle;
    }
    const ContactBody<Dim>& second = scene.bodies[crossing.second.index];
    return first + how
           + (crossing.second_corners.empty() ? "'" + second.name + "'"
                                              : name_of<Dim>(crossing.second_corners, second));
}

#define PENT_INSTANTIATE(Dim)                                                              \
    template std::vector<Crossing> find_crossings(const Colliders<Dim>&,                   \
                                                  const std::vector<std::uint32_t>&,       \
                                                  const PositionsView<Dim>&, std::size_t); \
    template std::string describe(const Crossing&, const ContactScene<Dim>&);
PENT_FOR_EACH_DIMENSION(PENT_INSTANTIATE)
#undef PENT_INSTANTIATE

}  // namespace pent::contact
