// The colors of quantities, by the viewer; a library that was built without it says so.

#include "handles.h"

#ifdef PENT_HAS_VIEWER
#include <pent/viewer/color.h>
#include <pent/viewer/coloring.h>

#include <algorithm>
#include <cmath>
#endif

using namespace pent;
using namespace pent::plugin;

#ifdef PENT_HAS_VIEWER

namespace {

Eigen::Matrix3Xf body_colors(const Eigen::VectorXd& numbers) {
    Eigen::Matrix3Xf colors(3, numbers.size());
    for (Eigen::Index i = 0; i < numbers.size(); ++i) {
        if (!(numbers[i] >= 0 && numbers[i] <= 1e9)) {
            throw Error("values: found no number of a body; expected them from 0 on");
        }
        colors.col(i) = viewer::body_color(static_cast<std::size_t>(std::lround(numbers[i])));
    }
    return colors;
}

}  // namespace

const float* pent_colors(
    const char* quantity, const double* values, int64_t count, double low, double high) {
    return guarded<const float*>(nullptr, [&] {
        static thread_local Eigen::Matrix3Xf colors;
        require(quantity, "quantity");
        if (count < 0) {
            throw Error("count is " + std::to_string(count) + "; expected 0 or more");
        }
        const viewer::ColorBy by = viewer::coloring_of(quantity);
        const Eigen::VectorXd given = array<1>(values, count, "values").transpose();
        if (!given.allFinite() || !std::isfinite(high - low)) {
            throw Error("values, low, high and what lies between must be finite");
        }
        colors = by == viewer::ColorBy::Body
                     ? body_colors(given)
                     : viewer::surface_colors(given, by, {.low = low, .high = high}, 0);
        static const float none = 0;
        return count == 0 ? &none : static_cast<const float*>(colors.data());
    });
}

#else

const float* pent_colors(const char* /*quantity*/,
                         const double* /*values*/,
                         int64_t /*count*/,
                         double /*low*/,
                         double /*high*/) {
    return guarded<const float*>(nullptr, []() -> const float* {
        throw Error("this library was built without the viewer (PENT_BUILD_VIEWER), which colors");
    });
}

#endif
