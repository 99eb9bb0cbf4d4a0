#include "model/keyframes.h"

namespace pent::simulator {

namespace {

double rise(const CurvePoint& a, const CurvePoint& b) {
    return (b.value - a.value) / (b.time - a.time);
}

}  // namespace

double detail::smooth_slope(const CurvePoint& before,
                            const CurvePoint& here,
                            const CurvePoint& behind) {
    const double left = rise(before, here);
    const double right = rise(here, behind);
    if (!(left * right > 0)) {
        return 0;
    }
    const double width = here.time - before.time;
    const double next_width = behind.time - here.time;
    const double share = (width + 2 * next_width) / (3 * (width + next_width));
    return left * right / (share * right + (1 - share) * left);
}

CurveState detail::cubic_at(
    const CurvePoint& a, const CurvePoint& b, double slope_a, double slope_b, double time) {
    const double width = b.time - a.time;
    const double s = (time - a.time) / width;
    const double blend = s * s * (3 - 2 * s);
    const double climb = b.value - a.value;
    return {a.value + blend * climb + width * s * (1 - s) * ((1 - s) * slope_a - s * slope_b),
            6 * s * (1 - s) * climb / width + (1 - s) * (1 - 3 * s) * slope_a
                + s * (3 * s - 2) * slope_b};
}

double factor_at(const std::vector<Keyframe>& keyframes, double time) {
    const auto point = [&](std::size_t i) {
        return CurvePoint{keyframes[i].time, keyframes[i].factor};
    };
    return keyframes.empty() ? 1 : curve_at(keyframes.size(), point, time).value;
}

}  // namespace pent::simulator
