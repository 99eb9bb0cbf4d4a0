#include "fill_target.h"

#include <pent/error.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <optional>
#include <string>
#include <utility>

namespace pent::mesher {

namespace {

// One filling: logarithms of the edge length and of the number of tetrahedra over the wanted one.
struct Trial {
    double length = 0;
    double excess = 0;
};

// The length at which a line through two trials gives the wanted number; with one trial, the number
// is taken to go with the third power.
double next_length(const Trial& last, const std::optional<Trial>& before) {
    double slope = -3;
    if (before && last.length != before->length) {
        slope = (last.excess - before->excess) / (last.length - before->length);
        slope = std::clamp(slope, -8.0, -1.0);
    }
    return last.length - last.excess / slope;
}

}  // namespace

TargetFilling fill_to_target(const std::function<Tetrahedra(double)>& fill,
                             double wanted,
                             double start) {
    constexpr int kMaxFillings = 20;
    constexpr double kClose = 0.02;
    double too_short = -std::numeric_limits<double>::infinity();
    double too_long = std::numeric_limits<double>::infinity();
    std::optional<Trial> before;
    double length = std::log(start);
    double nearest = std::numeric_limits<double>::infinity();
    for (int i = 1; i <= kMaxFillings; ++i) {
        Tetrahedra tetrahedra = fill(std::exp(length));
        const auto count = static_cast<double>(tetrahedra.mesh.cell_count());
        if (std::abs(count - wanted) <= kClose * wanted) {
            return {std::move(tetrahedra), std::exp(length), i};
        }
        if (std::abs(count - wanted) < std::abs(nearest - wanted)) {
            nearest = count;
        }
        const Trial last{length, std::log(count / wanted)};
        (last.excess > 0 ? too_short : too_long) = length;
        length = next_length(last, before);
        if (!(length > too_short && length < too_long)) {
            length = (too_short + too_long) / 2;
        }
        before = last;
    }
    throw Error("no filling with " + std::to_string(std::llround(wanted))
                + " tetrahedra was found, the nearest has " + std::to_string(std::llround(nearest))
                + "; ask for another number");
}

}  // namespace pent::mesher
