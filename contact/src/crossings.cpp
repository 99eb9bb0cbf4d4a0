#include "pent/contact/crossings.h"

#include "fitted_tree.h"
#include "gather.h"

#include <pent/contact/near_pairs.h>

#include <Eigen/LU>

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>

namespace pent::contact {

namespace {

using Real = long double;

// Distances below this part of the largest coordinate count as touching: rounding is a thousandth of
// that.
constexpr double kRounding = 1e-12;

// Sign of a determinant, 0 where rounding may have decided it. The columns are differences of doubles,
// so their own rounding is within the bound too.
template <int Dim>
int sign_of(const Eigen::Matrix<Real, Dim, Dim>& columns) {
    constexpr Real kErrors = 64;
    Real size = 1;
    for (int i = 0; i < Dim; ++i) {
        size *= columns.col(i).norm();
    }
    const Real det = columns.determinant();
    if (std::abs(det) <= kErrors * std::numeric_limits<Real>::epsilon() * size) {
        return 0;
    }
    return det > 0 ? 1 : -1;
}

// Sign of the coefficient of point i in the affine dependency of Dim + 2 points.
template <int Dim>
int dependency_sign(const Eigen::Matrix<Real, Dim, Dim + 2>& points, int i) {
    const int origin = i == 0 ? 1 : 0;
    Eigen::Matrix<Real, Dim, Dim> columns;
    int count = 0;
    for (int k = 0; k < Dim + 2; ++k) {
        if (k != i && k != origin) {
            columns.col(count++) = points.col(k) - points.col(origin);
        }
    }
    return (i % 2 == 0 ? 1 : -1) * sign_of<Dim>(columns);
}

template <int Dim>
class Finder {
public:
    Finder(const std::vector<ContactBody<Dim>>& bodies,
           const std::vector<bool>& is_held,
           const PositionsView<Dim>& positions,
           double separation,
           std::size_t most)
        : bodies_(bodies),
          is_held_(is_held),
          positions_(positions),
          least_(separation + kRounding * positions.cwiseAbs().maxCoeff()),
          most_(most) {
        for (const ContactBody<Dim>& body : bodies) {
            trees_.emplace_back(make_trees(body.surface));
        }
    }

    void visit(std::size_t a, std::size_t b) {
        const Surface<Dim>& first = bodies_[a].surface;
        const Surface<Dim>& second = bodies_[b].surface;
        bodies_of_pair_ = {static_cast<std::int32_t>(a), static_cast<std::int32_t>(b)};
        add_crossing<2, Dim>(first.edges, trees_[a].edges, second.facets, trees_[b].facets);
        if constexpr (Dim > 3) {
            add_crossing<3, 3>(first.ridges, trees_[a].ridges, second.ridges, trees_[b].ridges);
        }
        add_touching<1, Dim>(first.vertices, trees_[a].vertices, second.facets, trees_[b].facets);
        add_touching<2, Dim - 1>(first.edges, trees_[a].edges, second.ridges, ridges(b));
        if (a == b) {
            return;
        }
        add_inside(first, trees_[a], second, trees_[b]);
        std::swap(bodies_of_pair_[0], bodies_of_pair_[1]);
        add_crossing<2, Dim>(second.edges, trees_[b].edges, first.facets, trees_[a].facets);
        add_touching<1, Dim>(second.vertices, trees_[b].vertices, first.facets, trees_[a].facets);
        if constexpr (Dim > 3) {
            add_touching<2, Dim - 1>(second.edges, trees_[b].edges, first.ridges, ridges(a));
        }
        add_inside(second, trees_[b], first, trees_[a]);
    }

    void visit_obstacle(std::int32_t index, const Obstacle<Dim>& obstacle) {
        for (std::size_t body = 0; body < bodies_.size(); ++body) {
            if (bodies_[body].is_kinematic) {
                continue;
            }
            bodies_of_pair_ = {static_cast<std::int32_t>(body), -1 - index};
            if (const auto* ball = std::get_if<Ball<Dim>>(&obstacle)) {
                add_at_ball(bodies_[body].surface, trees_[body].facets, *ball);
                continue;
            }
            const Simplices<1>& vertices = bodies_[body].surface.vertices;
            for (Eigen::Index i = 0; i < vertices.cols(); ++i) {
                const std::uint32_t vertex = vertices(0, i);
                const double distance = signed_distance<Dim>(obstacle, positions_.col(vertex));
                if (!is_held_[vertex] && distance <= least_) {
                    add(distance < 0 ? CrossingKind::Inside : CrossingKind::Touching, {vertex}, {},
                        distance);
                }
            }
        }
    }

    std::vector<Crossing> take() { return std::move(found_); }

private:
    struct Trees {
        BoxTree vertices;
        BoxTree edges;
        BoxTree ridges;  // empty in R^3
        BoxTree facets;
    };

    [[nodiscard]] Trees make_trees(const Surface<Dim>& surface) const {
        Trees trees;
        trees.vertices = BoxTree(boxes_around<Dim, 1>(surface.vertices, positions_, least_));
        trees.edges = BoxTree(boxes_around<Dim, 2>(surface.edges, positions_, least_));
        trees.facets = BoxTree(boxes_around<Dim, Dim>(surface.facets, positions_, least_));
        if constexpr (Dim > 3) {
            trees.ridges = BoxTree(boxes_around<Dim, Dim - 1>(surface.ridges, positions_, least_));
        }
        return trees;
    }

    [[nodiscard]] const BoxTree& ridges(std::size_t body) const {
        return Dim > 3 ? trees_[body].ridges : trees_[body].edges;
    }

    template <int Count>
    static std::vector<std::uint32_t> corners(const Simplices<Count>& simplices, Eigen::Index i) {
        return {simplices.col(i).data(), simplices.col(i).data() + Count};
    }

    [[nodiscard]] bool are_held(const std::vector<std::uint32_t>& vertices) const {
        return std::all_of(vertices.begin(), vertices.end(),
                           [&](std::uint32_t vertex) { return is_held_[vertex]; });
    }

    void add(CrossingKind kind,
             std::vector<std::uint32_t> first,
             std::vector<std::uint32_t> second,
             double distance) {
        const bool may_be = kind == CrossingKind::Touching && bodies_of_pair_[1] >= 0
                            && are_held(first) && are_held(second);
        if (found_.size() < most_ && !may_be) {
            found_.push_back({kind, bodies_of_pair_[0], bodies_of_pair_[1], std::move(first),
                              std::move(second), distance});
        }
    }

    template <int K, int L>
    void add_crossing(const Simplices<K>& first,
                      const BoxTree& first_tree,
                      const Simplices<L>& second,
                      const BoxTree& second_tree) {
        struct Pair {
            std::uint32_t i;
            std::uint32_t j;
        };
        std::vector<Pair> pairs;
        const bool is_same_list = &first_tree == &second_tree;
        for (const BoxTree::Work& work : BoxTree::split(first_tree, second_tree, 1)) {
            BoxTree::for_each_overlap(
                first_tree, second_tree, work, [&](std::uint32_t i, std::uint32_t j) {
                    const auto a = corners<K>(first, i);
                    const auto b = corners<L>(second, j);
                    if (std::find_first_of(a.begin(), a.end(), b.begin(), b.end()) == a.end()
                        && is_crossing<Dim, K, L>(gather<Dim, K>(first, i, positions_),
                                                  gather<Dim, L>(second, j, positions_))) {
                        pairs.push_back({i, j});
                    }
                });
        }
        for (Pair& pair : pairs) {
            if (is_same_list && pair.j < pair.i) {
                std::swap(pair.i, pair.j);
            }
        }
        std::sort(pairs.begin(), pairs.end(),
                  [](const Pair& p, const Pair& q) { return p.i != q.i ? p.i < q.i : p.j < q.j; });
        for (const Pair& pair : pairs) {
            add(CrossingKind::Through, corners<K>(first, pair.i), corners<L>(second, pair.j), 0);
        }
    }

    template <int K, int L>
    void add_touching(const Simplices<K>& first,
                      const BoxTree& first_tree,
                      const Simplices<L>& second,
                      const BoxTree& second_tree) {
        const NearPairs near =
            near_pairs<Dim, K, L>({first, first_tree}, {second, second_tree}, positions_, least_);
        for (const NearPair& pair : near.pairs) {
            add(CrossingKind::Touching, corners<K>(first, pair.first),
                corners<L>(second, pair.second), std::sqrt(pair.distance_squared));
        }
    }

    void add_inside(const Surface<Dim>& surface,
                    const Trees& trees,
                    const Surface<Dim>& around,
                    const Trees& trees_around) {
        const std::vector<std::uint8_t> inside =
            vertices_inside<Dim>(surface, trees.vertices, around, trees_around.facets, positions_);
        for (std::size_t i = 0; i < inside.size(); ++i) {
            if (inside[i] != 0) {
                add(CrossingKind::Inside,
                    corners<1>(surface.vertices, static_cast<Eigen::Index>(i)), {}, 0);
            }
        }
    }

    void add_at_ball(const Surface<Dim>& surface, const BoxTree& facets, const Ball<Dim>& ball) {
        const Corners<Dim, 1> center = ball.center;
        std::vector<std::uint32_t> near;
        facets.for_each_overlap(box_around<Dim, 1>(center, ball.radius + least_),
                                [&](std::uint32_t facet) { near.push_back(facet); });
        std::sort(near.begin(), near.end());
        for (const std::uint32_t facet : near) {
            const double most = ball.radius + least_;
            const double squared = distance_squared_within<Dim, 1, Dim>(
                center, gather<Dim, Dim>(surface.facets, facet, positions_), most * most);
            if (squared < most * most && !are_held(corners<Dim>(surface.facets, facet))) {
                const double distance = std::sqrt(squared) - ball.radius;
                add(distance < 0 ? CrossingKind::Through : CrossingKind::Touching,
                    corners<Dim>(surface.facets, facet), {}, std::max(distance, 0.0));
            }
        }
    }

    const std::vector<ContactBody<Dim>>& bodies_;
    const std::vector<bool>& is_held_;
    const PositionsView<Dim>& positions_;
    double least_;
    std::size_t most_;
    std::vector<Trees> trees_;
    std::array<std::int32_t, 2> bodies_of_pair_{};
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

template <int Dim, int K, int L>
bool is_crossing(const Corners<Dim, K>& first, const Corners<Dim, L>& second) {
    static_assert(K + L == Dim + 2);
    Eigen::Matrix<Real, Dim, Dim + 2> points;
    points << first.template cast<Real>(), second.template cast<Real>();
    const int side = dependency_sign<Dim>(points, 0);
    for (int i = 1; i < K; ++i) {
        if (side == 0 || dependency_sign<Dim>(points, i) != side) {
            return false;
        }
    }
    for (int j = K; j < K + L; ++j) {
        if (dependency_sign<Dim>(points, j) != -side) {
            return false;
        }
    }
    return true;
}

template <int Dim>
std::vector<Crossing> find_crossings(const std::vector<ContactBody<Dim>>& bodies,
                                     const std::vector<Obstacle<Dim>>& obstacles,
                                     const std::vector<bool>& is_held,
                                     const PositionsView<Dim>& positions,
                                     double separation,
                                     bool self,
                                     std::size_t most) {
    Finder<Dim> finder(bodies, is_held, positions, separation, most);
    for (std::size_t a = 0; a < bodies.size(); ++a) {
        for (std::size_t b = self ? a : a + 1; b < bodies.size(); ++b) {
            finder.visit(a, b);
        }
    }
    for (std::size_t o = 0; o < obstacles.size(); ++o) {
        finder.visit_obstacle(static_cast<std::int32_t>(o), obstacles[o]);
    }
    return finder.take();
}

template <int Dim>
std::string describe(const Crossing& crossing, const std::vector<ContactBody<Dim>>& bodies) {
    const std::string first = name_of<Dim>(crossing.first, bodies[crossing.first_body]);
    const std::string how = crossing.kind == CrossingKind::Through    ? " goes through "
                            : crossing.kind == CrossingKind::Touching ? " touches "
                                                                      : " is inside ";
    if (crossing.second_body < 0) {
        return first + how + "obstacle " + std::to_string(-1 - crossing.second_body);
    }
    const ContactBody<Dim>& second = bodies[crossing.second_body];
    return first + how
           + (crossing.second.empty() ? "'" + second.name + "'"
                                      : name_of<Dim>(crossing.second, second));
}

#define PENT_INSTANTIATE(Dim)                                                                  \
    template std::vector<Crossing> find_crossings<Dim>(                                        \
        const std::vector<ContactBody<Dim>>&, const std::vector<Obstacle<Dim>>&,               \
        const std::vector<bool>&, const PositionsView<Dim>&, double, bool, std::size_t);       \
    template std::string describe<Dim>(const Crossing&, const std::vector<ContactBody<Dim>>&); \
    template bool is_crossing<Dim, 2, Dim>(const Corners<Dim, 2>&, const Corners<Dim, Dim>&);
PENT_INSTANTIATE(3)
PENT_INSTANTIATE(4)
#undef PENT_INSTANTIATE
template bool is_crossing<4, 3, 3>(const Corners<4, 3>&, const Corners<4, 3>&);

}  // namespace pent::contact
