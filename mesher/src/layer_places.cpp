#include "layer_places.h"

#include <pent/error.h>
#include <pent/formatted.h>

#include <algorithm>
#include <cmath>

namespace pent::mesher {

namespace {

constexpr double kMaxContrast = 1e6;  // of heights; beyond it cells are needles in any case
constexpr double kMaxSlabs = 1e6;

// How many slabs lie before the slice, so that both sides are filled to their ends. With X =
// growth^before and G = growth^slabs, (X - 1) / (G / X - 1) = slice / (1 - slice).
double slabs_before(int slabs, double growth, double slice) {
    if (slice == 0.5) {
        return slabs / 2.0;  // exactly
    }
    if (slice == 0 || slice == 1) {
        return slice * slabs;
    }
    const double ratio = slice / (1 - slice);
    const double G = std::pow(growth, slabs);
    const double X = (1 - ratio + std::sqrt((1 - ratio) * (1 - ratio) + 4 * ratio * G)) / 2;
    return std::log(X) / std::log(growth);
}

}  // namespace

std::vector<double> even_places(int slabs, double slice) {
    std::vector<double> places(slabs + 1);
    for (int l = 0; l <= slabs; ++l) {
        // Symmetric to the last bit about the middle.
        places[l] = slice == 0.5 ? static_cast<double>(2 * l - slabs) / (2 * slabs)
                                 : static_cast<double>(l) / slabs - slice;
    }
    return places;
}

std::vector<double> graded_places(int slabs, double growth, double slice) {
    if (growth == 1) {
        return even_places(slabs, slice);
    }
    const double farthest = slabs * std::max(slice, 1 - slice);
    if (std::log(growth) * farthest > std::log(kMaxContrast)) {
        throw Error(
            formatted("%d layers, each %g times as high as its neighbor: the highest would"
                      " be over a million times as high as the lowest; ask for fewer layers"
                      " or a grade nearer to 1",
                      slabs, growth));
    }
    const double before = slabs_before(slabs, growth, slice);
    const double behind = slabs - before;
    const auto height = [&](double u) { return std::pow(growth, u) - 1; };
    std::vector<double> places(slabs + 1);
    for (int l = 0; l <= slabs; ++l) {
        const double u = slice == 0.5 ? (2 * l - slabs) / 2.0 : l - before;
        places[l] = u < 0 ? -slice * (height(-u) / height(before))
                          : (1 - slice) * (height(u) / height(behind));
    }
    places.front() = -slice;
    places.back() = 1 - slice;
    return places;
}

int graded_slabs(double lowest, double growth, double slice) {
    const auto slabs_within = [&](double length) {
        return growth == 1 ? length / lowest
                           : std::log1p(length * (growth - 1) / lowest) / std::log(growth);
    };
    const double slabs = slabs_within(slice) + slabs_within(1 - slice);
    return static_cast<int>(std::clamp(std::round(slabs), 1.0, kMaxSlabs));
}

std::vector<double> listed_places(const std::vector<double>& heights, double slice) {
    double sum = 0;
    for (const double height : heights) {
        if (!(height > 0) || !std::isfinite(height)) {
            throw Error(formatted("a layer of height %g; expected finite numbers above 0", height));
        }
        sum += height;
    }
    if (heights.empty() || !std::isfinite(sum)) {
        throw Error("heights of layers that sum to infinity, or none; expected some that do not");
    }
    std::vector<double> outward = {0};
    for (const double height : heights) {
        outward.push_back(outward.back() + height / sum);
    }
    outward.back() = 1;
    std::vector<double> places;
    if (slice > 0) {
        for (std::size_t i = outward.size() - 1; i > 0; --i) {
            places.push_back(-slice * outward[i]);
        }
    }
    places.push_back(0);
    if (slice < 1) {
        for (std::size_t i = 1; i < outward.size(); ++i) {
            places.push_back((1 - slice) * outward[i]);
        }
    }
    return places;
}

}  // namespace pent::mesher
