#include "linear/aggregates.h"

#include <Eigen/Core>

#include <algorithm>
#include <cmath>
#include <map>

namespace pent::simulator {

namespace {

constexpr double kAggregateSize = 550;
// The dense coarse matrix of 10 modes for each aggregate is factored in every step and read in
// every iteration. Beyond this number of aggregates it grows as the root of the number of unknowns,
// so that it stays a sixth of the matrix of the mesh.
constexpr double kManyAggregates = 100;

// Most unknowns of an aggregate; halving leaves pieces of half of that or more.
std::size_t most_unknowns(std::size_t unknowns) {
    const double count = static_cast<double>(unknowns);
    const double aggregates =
        kManyAggregates * std::sqrt(std::max(1.0, count / (kManyAggregates * kAggregateSize)));
    return static_cast<std::size_t>(std::max(kAggregateSize, 2 * count / aggregates));
}

template <int Dim>
void bisect(const Positions<Dim>& rest,
            std::size_t most,
            std::vector<std::uint32_t> unknowns,
            std::vector<std::vector<std::uint32_t>>& pieces) {
    if (unknowns.size() <= most) {
        std::sort(unknowns.begin(), unknowns.end());
        pieces.push_back(std::move(unknowns));
        return;
    }
    Eigen::Matrix<double, Dim, 1> low = rest.col(unknowns[0]);
    Eigen::Matrix<double, Dim, 1> high = low;
    for (const std::uint32_t unknown : unknowns) {
        low = low.cwiseMin(rest.col(unknown));
        high = high.cwiseMax(rest.col(unknown));
    }
    Eigen::Index axis = 0;
    (high - low).maxCoeff(&axis);
    const auto middle = unknowns.begin() + static_cast<std::ptrdiff_t>(unknowns.size() / 2);
    std::nth_element(unknowns.begin(), middle, unknowns.end(),
                     [&](std::uint32_t a, std::uint32_t b) {
                         return std::pair(rest(axis, a), a) < std::pair(rest(axis, b), b);
                     });
    bisect(rest, most, {unknowns.begin(), middle}, pieces);
    bisect(rest, most, {middle, unknowns.end()}, pieces);
}

}  // namespace

template <int Dim>
Aggregates make_aggregates(const Positions<Dim>& rest, const std::vector<std::uint32_t>& bodies) {
    std::map<std::uint32_t, std::vector<std::uint32_t>> of_body;
    for (std::uint32_t unknown = 0; unknown < bodies.size(); ++unknown) {
        of_body[bodies[unknown]].push_back(unknown);
    }
    const std::size_t most = most_unknowns(bodies.size());
    Aggregates aggregates;
    for (auto& [body, unknowns] : of_body) {
        bisect(rest, most, std::move(unknowns), aggregates.members);
    }
    aggregates.of_unknown.resize(bodies.size());
    for (std::uint32_t piece = 0; piece < aggregates.members.size(); ++piece) {
        for (const std::uint32_t unknown : aggregates.members[piece]) {
            aggregates.of_unknown[unknown] = piece;
        }
    }
    return aggregates;
}

template Aggregates make_aggregates<3>(const Positions<3>&, const std::vector<std::uint32_t>&);
template Aggregates make_aggregates<4>(const Positions<4>&, const std::vector<std::uint32_t>&);

}  // namespace pent::simulator
