#include "ccd.h"

#include "apart.h"
#include "closest_point_search.h"

#include <pent/dimensions.h>

#include <algorithm>
#include <cmath>
#include <limits>

namespace pent::contact {

namespace {

// A bound on the advances, which the gap ends long before.
constexpr int kMaxAdvances = 10'000;

// Relative rounding of distances, with room to spare.
constexpr double kRounding = 1e-9;

// The time up to which two simplices stay `target` apart along u; 0 if they are not at the start.
// All pairs of corners do until then, so the hulls of the corners do. Pairs that move apart count,
// too: rounding in u may have them on the wrong sides where the gap is small.
template <int Dim, int K, int L>
double time_apart(const Vector<Dim>& u,
                  const Corners<Dim, K>& first,
                  const Corners<Dim, K>& first_motion,
                  const Corners<Dim, L>& second,
                  const Corners<Dim, L>& second_motion,
                  double target) {
    double time = std::numeric_limits<double>::infinity();
    for (int i = 0; i < K; ++i) {
        const double at = u.dot(first.col(i)) - target;
        const double speed = u.dot(first_motion.col(i));
        for (int j = 0; j < L; ++j) {
            const double closing = u.dot(second_motion.col(j)) - speed;
            const double room = at - u.dot(second.col(j));
            if (closing > 0) {
                time = std::min(time, room / closing);
            } else if (room < 0) {
                return 0;
            }
        }
    }
    return time;
}

template <int Dim>
bool is_free_side_convex(const ObstacleShape<Dim>& obstacle) {
    return std::visit([](const auto& shape) { return shape.kIsFreeSideConvex; }, obstacle);
}

}  // namespace

template <int Dim, int K, int L>
double safe_fraction(const Corners<Dim, K>& first,
                     const Corners<Dim, K>& first_motion,
                     const Corners<Dim, L>& second,
                     const Corners<Dim, L>& second_motion,
                     const Clearance& clearance,
                     double limit) {
    constexpr double kFar = std::numeric_limits<double>::infinity();
    // In coordinates of one corner, so that rounding is relative to the pair and not to where it
    // is.
    const Vector<Dim> origin = first.col(0);
    const Vector<Dim> drift = first_motion.col(0);
    const Corners<Dim, K> first_path = first_motion.colwise() - drift;
    const Corners<Dim, L> second_path = second_motion.colwise() - drift;
    Corners<Dim, K> a = first.colwise() - origin;
    Corners<Dim, L> b = second.colwise() - origin;
    const Corners<Dim, K> a_start = a;
    const Corners<Dim, L> b_start = b;
    // Paths that keep apart by what has to be left of any gap need no closest points.
    const double always = clearance.separation + kGapKept * clearance.distance;
    if (are_paths_apart<Dim, K, L>(a, a + first_path, b, b + second_path, always * always)) {
        return limit;
    }
    // Nor do those that, as far as the limit, keep apart by more than the gap at which a motion is
    // stopped: most pairs of a long motion that another pair stops early.
    const double felt = (clearance.separation + kGapReached * clearance.distance) * (1 + kRounding);
    if (limit < 1
        && are_paths_apart<Dim, K, L>(a, a + limit * first_path, b, b + limit * second_path,
                                      felt * felt)) {
        return limit;
    }
    double near_gap = 0;  // the gap at the start, or Clearance::distance if that is less
    double t = 0;
    for (int advance = 0; advance < kMaxAdvances; ++advance) {
        ClosestPointSearch<Dim, K, L> search(a, b, kFar);
        search.run();
        const double distance = std::sqrt(search.best().distance_squared);
        const double gap = distance - clearance.separation;
        if (advance == 0) {
            near_gap = std::min(gap, clearance.distance);
            if (!(near_gap > 0)) {
                return 0;
            }
        } else if (gap <= kGapReached * near_gap) {
            return t;
        }
        const Vector<Dim> u = search.best().difference / distance;
        const double time = time_apart<Dim, K, L>(u, a, first_path, b, second_path,
                                                  clearance.separation + kGapKept * near_gap);
        if (!(time > 0)) {
            return t;  // rounding: the separation along u is not what the distance says
        }
        t += time;
        if (!(t < limit)) {
            return limit;
        }
        a = a_start + t * first_path;
        b = b_start + t * second_path;
    }
    return t;  // GCOVR_EXCL_LINE: flat simplices part or meet in far fewer advances, but for
               // rounding
}

template <int Dim>
double safe_fraction(const ObstacleShape<Dim>& obstacle,
                     const Vector<Dim>& point,
                     const Vector<Dim>& motion,
                     const Clearance& clearance,
                     double limit) {
    const double start_gap = signed_distance<Dim>(obstacle, point).value - clearance.separation;
    if (!(start_gap > 0)) {
        return 0;
    }
    const double near_gap = std::min(start_gap, clearance.distance);
    const double kept = kGapKept * near_gap;
    const double speed = motion.norm();
    const bool is_concave = is_free_side_convex<Dim>(obstacle);
    const double end_gap =
        signed_distance<Dim>(obstacle, point + motion).value - clearance.separation;
    double gap = start_gap;
    double t = 0;
    for (int advance = 0; advance < kMaxAdvances; ++advance) {
        if (speed * (limit - t) <= gap - kept || (is_concave && end_gap >= kept)) {
            return limit;
        }
        double time = (gap - kept) / speed;
        if (is_concave) {  // above the chord to the end
            time = std::max(time, (gap - kept) / (gap - end_gap) * (1 - t));
        }
        t += time;
        if (!(t < limit)) {
            return limit;
        }
        gap = signed_distance<Dim>(obstacle, point + t * motion).value - clearance.separation;
        if (gap <= kGapReached * near_gap) {
            return t;
        }
    }
    return t;
}

#define PENT_INSTANTIATE_PAIR(Dim, K, L)                                                     \
    template double safe_fraction<Dim, K, L>(const Corners<Dim, K>&, const Corners<Dim, K>&, \
                                             const Corners<Dim, L>&, const Corners<Dim, L>&, \
                                             const Clearance&, double);
#define PENT_INSTANTIATE(Dim)                                                         \
    PENT_INSTANTIATE_PAIR(Dim, 1, Dim)                                                \
    PENT_INSTANTIATE_PAIR(Dim, 2, Dim - 1)                                            \
    template double safe_fraction<Dim>(const ObstacleShape<Dim>&, const Vector<Dim>&, \
                                       const Vector<Dim>&, const Clearance&, double);
PENT_FOR_EACH_DIMENSION(PENT_INSTANTIATE)
#undef PENT_INSTANTIATE
#undef PENT_INSTANTIATE_PAIR

}  // namespace pent::contact
