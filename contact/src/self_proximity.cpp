#include "self_proximity.h"

#include "boxes_around.h"
#include "self_proximity_search.h"

#include <pent/dimensions.h>

#include <algorithm>

namespace pent::contact {

namespace {

// Pairs are listed up to this many times the activation distance: the farther, the more a body may
// be bent before they have to be listed anew, and the longer the lists.
constexpr double kListed = 2;

// Lists go no farther than this part of the mean edge, but at least to this many times the
// activation distance, below which they are of no use.
constexpr double kMaxOfEdge = 0.6;
constexpr double kMinListed = 1.2;

// Room for the rounding of bounds to floats, relative.
constexpr double kRoundDown = 1 - 1e-6;
constexpr double kRoundUp = 1 + 1e-6;

}  // namespace

template <int Dim>
SelfProximity<Dim>::SelfProximity(const Surface<Dim>& surface,
                                  const Positions<Dim>& rest,
                                  double distance,
                                  bool is_rest_left_out,
                                  const SharedWork& shared)
    : surface_(surface),
      rest_(rest),
      distance_(distance),
      is_rest_left_out_(is_rest_left_out),
      shared_(shared),
      on_paths_(surface, rest) {
    const double of_edge = kMaxOfEdge * mean_edge_length<Dim>(surface, rest);
    listed_distance_ = std::clamp(of_edge, kMinListed * distance, kListed * distance);
    patches_[0] = Patches<Dim>(on_paths_.template of<1>().vertices, rest);
    patches_[1] = Patches<Dim>(on_paths_.template of<2>().vertices, rest);
    patches_[2] = Patches<Dim>(on_paths_.template of<3>().vertices, rest);
    if constexpr (Dim > 3) {
        patches_[Dim - 1] = Patches<Dim>(on_paths_.template of<Dim>().vertices, rest);
    }
    points_.resize(on_paths_.template of<1>().partition.size());
    mixed_.resize(on_paths_.template of<2>().partition.size());
}

template <int Dim>
PatchBound SelfProximity<Dim>::Known::bound() const {
    return {static_cast<double>(stretch), static_cast<double>(lack)};
}

template <int Dim>
void SelfProximity<Dim>::Known::set_bound(const PatchBound& bound) {
    stretch = static_cast<float>(bound.stretch * kRoundDown);
    lack = static_cast<float>(bound.lack * kRoundUp);
}

template <int Dim>
typename SelfProximity<Dim>::Places SelfProximity<Dim>::place(
    const PositionsView<Dim>& positions) const {
    Places places;
    for (std::size_t i = 0; i < places.size(); ++i) {
        places[i] = patches_[i].place(positions);
    }
    return places;
}

// Motions are measured between the starts of paths, where the body has been; where paths end it may
// never be.
template <int Dim>
void SelfProximity<Dim>::move(const Asked& asked) {
    fit_boxes<Dim>(surface_.vertices, asked.paths, 0.5 * asked.activation_distance, boxes_);
    on_paths_.fit(asked.paths, boxes_);
    ++search_;
    Places now = place(asked.paths.from);
    const Places end = asked.paths.is_still() ? Places() : place(asked.paths.to);
    for (std::size_t i = 0; i < now.size(); ++i) {
        since_[i] =
            PatchMotions<Dim>(patches_[i].motions(search_ == 1 ? now[i] : places_[i], now[i]));
        if (!asked.paths.is_still()) {
            ahead_[i] = PatchMotions<Dim>(patches_[i].motions(now[i], now[i], end[i]));
        }
    }
    places_ = std::move(now);
}

template <int Dim>
template <typename Points, typename Mixed>
void SelfProximity<Dim>::search(const Asked& asked, Points& points, Mixed& mixed) {
    if (points.look_at_lists() + mixed.look_at_lists() == 0) {
        return;
    }
    on_paths_.set_lanes(asked.paths);
    points.look_at_others();
    mixed.look_at_others();
}

template <int Dim>
CandidatePairs SelfProximity<Dim>::find(const PositionsView<Dim>& positions) {
    const Paths<Dim> paths{positions, positions};
    const Asked asked{paths, distance_};
    move(asked);
    const double squared = distance_ * distance_;
    Search<NearTest<Dim, 1, Dim>, 1, Dim> points(
        *this, {surface_.vertices, surface_.facets, points_}, asked,
        {surface_.vertices, surface_.facets, false, positions, squared, Closest::Anywhere});
    Search<NearTest<Dim, 2, Dim - 1>, 2, Dim - 1> mixed(
        *this, {surface_.edges, surface_.ridges, mixed_}, asked,
        {surface_.edges, surface_.ridges, Dim == 3, positions, squared, Closest::Interior});
    search(asked, points, mixed);
    return {.points_first = united(points.found()), .mixed_first = united(mixed.found())};
}

template <int Dim>
CandidatePairs SelfProximity<Dim>::find(const Paths<Dim>& paths,
                                        double activation_distance,
                                        double measured) {
    const Asked asked{paths, activation_distance};
    move(asked);
    Search<NearOnPaths<Dim, 1, Dim>, 1, Dim> points(
        *this, {surface_.vertices, surface_.facets, points_}, asked,
        {surface_.vertices, surface_.facets, false, paths, activation_distance, measured});
    Search<NearOnPaths<Dim, 2, Dim - 1>, 2, Dim - 1> mixed(
        *this, {surface_.edges, surface_.ridges, mixed_}, asked,
        {surface_.edges, surface_.ridges, Dim == 3, paths, activation_distance, measured});
    search(asked, points, mixed);
    return {.points_first = joined(points.found()), .mixed_first = joined(mixed.found())};
}

template <int Dim>
std::int64_t SelfProximity<Dim>::bytes() const {
    auto sum = on_paths_.bytes() + static_cast<std::int64_t>(boxes_.size() * sizeof(Box));
    for (std::size_t i = 0; i < patches_.size(); ++i) {
        sum += patches_[i].bytes() + places_[i].bytes() + since_[i].bytes() + ahead_[i].bytes();
    }
    for (const std::vector<Row>* rows : {&points_, &mixed_}) {
        for (const Row& row : *rows) {
            sum += static_cast<std::int64_t>(row.known.size() * sizeof(Known)
                                             + row.pairs.capacity() * sizeof(Candidate));
        }
    }
    return sum;
}

#define PENT_INSTANTIATE(Dim) template class SelfProximity<Dim>;
PENT_FOR_EACH_DIMENSION(PENT_INSTANTIATE)
#undef PENT_INSTANTIATE

}  // namespace pent::contact
