#include "pair_contact.h"

#include "closest_point_search.h"
#include "gather.h"
#include "normals.h"
#include "spanned_volume.h"

#include <pent/dimensions.h>

#include <algorithm>
#include <cmath>
#include <limits>

namespace pent::contact {

namespace {

// Below this part of the activation distance, closest points touch: the direction between them is
// rounding, and that of the normals is taken.
constexpr double kTouching = 1e-6;

// A pair is in contact only if the line between its closest points meets both surfaces at an angle
// whose sine is above this, from the front or from the back.
constexpr double kMinView = 0.2;

// A mixed pair fades where its closest points come this near to a border, in barycentric weight:
// there a neighboring pair, or a vertex and a facet, takes over. Wide, so that its forces along the
// surfaces are small.
constexpr double kBorder = 0.25;

// It fades, too, below this sine of the angle between its edge and the plane of its ridge. Where
// the two are parallel the closest points jump, and near that they run along both as the pair
// turns; there the vertices of the faces beside them hold these apart.
constexpr double kParallel = 0.2;

// A pair within one body that looks crossed, but is no farther apart at rest than this many
// activation distances, is taken for the two sides of something thin.
constexpr double kThin = 3;

// From which sides two simplices face each other.
template <int Dim>
struct View {
    double side = 0;        // 1 apart, -1 crossed, 0 no contact
    double weight = 0;      // fades to 0 where one turns sideways
    Vector<Dim> direction;  // from the second to the first, unit length; out of both if crossed
};

template <int Dim, int K, int L>
View<Dim> view(const ClosestPoints<Dim, K, L>& points,
               const Vector<Dim>& first_normal,
               const Vector<Dim>& second_normal,
               double touching) {
    const double l = std::sqrt(points.distance_squared);
    Vector<Dim> from_second = points.difference / l;
    if (!(l > touching)) {
        from_second = (second_normal - first_normal).stableNormalized();
    }
    const double second_faces = from_second.dot(second_normal);
    const double first_faces = -from_second.dot(first_normal);
    View<Dim> result;
    const double least = std::min(std::abs(first_faces), std::abs(second_faces));
    if (second_faces * first_faces > 0 && least > kMinView) {
        result.side = second_faces > 0 ? 1 : -1;
        result.weight = std::min(1.0, (least - kMinView) / kMinView);
        result.direction = result.side * from_second;
    }
    return result;
}

// Unit normal at a point of a simplex between those at its corners.
template <int Dim, int Count>
Vector<Dim> normal_at(const Positions<Dim>& normals,
                      const Simplices<Count>& simplices,
                      Eigen::Index which,
                      const Eigen::Matrix<double, Count, 1>& weights) {
    return (gather<Dim, Count>(simplices, which, normals) * weights).stableNormalized();
}

template <int Dim, int K, int L>
bool is_culled(const PairSetting<Dim>& setting,
               const Simplices<K>& first,
               std::uint32_t i,
               const Simplices<L>& second,
               std::uint32_t j,
               double side) {
    const double least = (side < 0 ? kThin : 1) * setting.distance;
    const Corners<Dim, K> a = gather<Dim, K>(first, i, setting.rest);
    const Corners<Dim, L> b = gather<Dim, L>(second, j, setting.rest);
    return ClosestPointSearch<Dim, K, L>(a, b, least * least).run();
}

// How a mixed pair fades with the least of its barycentric weights: 1 within, 0 at a border, with a
// continuous slope.
template <int Dim, int K, int L>
double fade_of(const ClosestPoints<Dim, K, L>& points) {
    const double least = std::min(points.beta.minCoeff(), points.alpha.minCoeff());
    const double t = std::clamp(least / kBorder, 0.0, 1.0);
    return t * t * (3 - 2 * t);
}

// How it fades where it is nearly parallel: with the square of the sine at first, since the closest
// points move by one over it. 0 where one of the two has collapsed.
template <int Dim>
double fade_of_parallel(const Corners<Dim, 2>& edge, const Corners<Dim, Dim - 1>& ridge) {
    Stencil<Dim> points;
    points << edge, ridge;
    const Mollifier mollifier{kParallel * kParallel * spanned_squared<Dim, 2>(edge)
                              * spanned_squared<Dim, Dim - 1>(ridge)};
    return mollifier.is_on() ? mollifier.value(spanned_volume_squared<Dim>(points)) : 0;
}

template <int Dim, int K, int L>
Contact<Dim> make_contact(const PairSetting<Dim>& setting,
                          const ClosestPoints<Dim, K, L>& points,
                          const std::uint32_t* first,
                          const std::uint32_t* second) {
    Contact<Dim> contact;
    std::copy_n(first, K, contact.vertices.begin());
    std::copy_n(second, L, contact.vertices.begin() + K);
    contact.weights << points.beta, -points.alpha;
    contact.kind = K == 1 ? ContactKind::PointFacet : ContactKind::Mixed;
    contact.first = setting.first;
    contact.second = setting.second;
    contact.count = K + L;
    contact.first_count = K;
    contact.corner_count = K + L;
    return contact;
}

}  // namespace

template <int Dim>
std::optional<Contact<Dim>> solid_contact(const PairSetting<Dim>& setting,
                                          std::uint32_t vertex,
                                          const Simplices<Dim>& facets,
                                          std::uint32_t facet,
                                          bool is_inside) {
    const double eps = setting.distance;
    const Corners<Dim, 1> point = setting.positions.col(vertex);
    const Corners<Dim, Dim> corners = gather<Dim, Dim>(facets, facet, setting.positions);
    ClosestPointSearch<Dim, 1, Dim> search(point, corners, std::numeric_limits<double>::infinity());
    search.run();
    const double l = std::sqrt(search.best().distance_squared);
    if (!is_inside && l >= eps) {
        return {};
    }
    const double side = is_inside ? -1 : 1;
    Vector<Dim> direction = side * search.best().difference / l;
    if (!(l > kTouching * eps)) {
        direction = facet_normal<Dim>(corners).stableNormalized();
        if (direction.isZero()) {
            return {};  // on a facet that has collapsed: its neighbors have a direction
        }
    }
    Contact<Dim> contact =
        make_contact<Dim, 1, Dim>(setting, search.best(), &vertex, facets.col(facet).data());
    contact.distance = side * l;
    contact.direction = direction;
    return contact;
}

template <int Dim, int K, int L>
std::optional<Contact<Dim>> local_contact(const PairSetting<Dim>& setting,
                                          const Simplices<K>& first,
                                          std::uint32_t i,
                                          const Simplices<L>& second,
                                          std::uint32_t j) {
    const double eps = setting.distance;
    const Corners<Dim, K> a = gather<Dim, K>(first, i, setting.positions);
    const Corners<Dim, L> b = gather<Dim, L>(second, j, setting.positions);
    ClosestPointSearch<Dim, K, L> search(a, b, eps * eps);
    if (!(K == 1 ? search.run() : search.run_interior())) {
        return {};
    }
    const ClosestPoints<Dim, K, L>& points = search.best();
    const View<Dim> seen = view<Dim, K, L>(
        points, normal_at<Dim, K>(setting.normals, first, i, points.beta),
        normal_at<Dim, L>(setting.normals, second, j, points.alpha), kTouching * eps);
    double weight = seen.weight;
    if constexpr (K == 2) {
        weight *= fade_of<Dim, K, L>(points) * fade_of_parallel<Dim>(a, b);
    }
    if (weight == 0
        || (setting.first == setting.second
            && is_culled<Dim, K, L>(setting, first, i, second, j, seen.side))) {
        return {};
    }
    Contact<Dim> contact =
        make_contact<Dim, K, L>(setting, points, first.col(i).data(), second.col(j).data());
    contact.distance = seen.side * std::sqrt(points.distance_squared);
    contact.direction = seen.direction;
    contact.share = weight;
    contact.is_fading = true;
    return contact;
}

#define PENT_INSTANTIATE(Dim)                                                                   \
    template std::optional<Contact<Dim>> solid_contact<Dim>(                                    \
        const PairSetting<Dim>&, std::uint32_t, const Simplices<Dim>&, std::uint32_t, bool);    \
    template std::optional<Contact<Dim>> local_contact<Dim, 1, Dim>(                            \
        const PairSetting<Dim>&, const Simplices<1>&, std::uint32_t, const Simplices<Dim>&,     \
        std::uint32_t);                                                                         \
    template std::optional<Contact<Dim>> local_contact<Dim, 2, Dim - 1>(                        \
        const PairSetting<Dim>&, const Simplices<2>&, std::uint32_t, const Simplices<Dim - 1>&, \
        std::uint32_t);
PENT_FOR_EACH_DIMENSION(PENT_INSTANTIATE)
#undef PENT_INSTANTIATE

}  // namespace pent::contact
