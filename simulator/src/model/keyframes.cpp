#include "model/keyframes.h"

#include <algorithm>
#include <cstddef>

namespace pent::simulator {

namespace {

double rise(const Keyframe& a, const Keyframe& b) {
    return (b.factor - a.factor) / (b.time - a.time);
}

// The weighted harmonic mean of the rises on both sides, [fritsch1984] Eq. 5.
double slope_at(const std::vector<Keyframe>& keyframes, std::size_t i) {
    if (i == 0 || i + 1 == keyframes.size()) {
        return 0;
    }
    const double left = rise(keyframes[i - 1], keyframes[i]);
    const double right = rise(keyframes[i], keyframes[i + 1]);
    if (!(left * right > 0)) {
        return 0;
    }
    const double before = keyframes[i].time - keyframes[i - 1].time;
    const double behind = keyframes[i + 1].time - keyframes[i].time;
    const double share = (before + 2 * behind) / (3 * (before + behind));
    return left * right / (share * right + (1 - share) * left);
}

}  // namespace

double factor_at(const std::vector<Keyframe>& keyframes, double time) {
    if (keyframes.empty()) {
        return 1;
    }
    const auto next =
        std::upper_bound(keyframes.begin(), keyframes.end(), time,
                         [](double t, const Keyframe& keyframe) { return t < keyframe.time; });
    if (next == keyframes.begin()) {
        return keyframes.front().factor;
    }
    if (next == keyframes.end()) {
        return keyframes.back().factor;
    }
    const auto i = static_cast<std::size_t>(next - keyframes.begin());
    const Keyframe& a = keyframes[i - 1];
    const Keyframe& b = keyframes[i];
    const double width = b.time - a.time;
    const double s = (time - a.time) / width;
    const double blend = s * s * (3 - 2 * s);
    return a.factor + blend * (b.factor - a.factor)
           + width * s * (1 - s)
                 * ((1 - s) * slope_at(keyframes, i - 1) - s * slope_at(keyframes, i));
}

}  // namespace pent::simulator
