#include <pent/range.h>
#include <pent/simulator/scene_checks.h>

#include <algorithm>
#include <cmath>
#include <string>
#include <string_view>
#include <variant>

namespace pent::simulator {

template <>
std::optional<Fault> fault_of(const BoxSelection& box) {
    if ((box.low.array() <= box.high.array()).all()) {
        return std::nullopt;
    }
    return Fault{"low", "\"low\" is above \"high\" along an axis; expected the lower corner"};
}

namespace {

// Nothing if the times of keyframes increase.
template <typename AnyKeyframe>
std::optional<Fault> fault_of_times(const std::vector<AnyKeyframe>& keyframes) {
    const auto is_late = [](const auto& a, const auto& b) { return a.time >= b.time; };
    if (std::adjacent_find(keyframes.begin(), keyframes.end(), is_late) == keyframes.end()) {
        return std::nullopt;
    }
    return Fault{"keyframes", "the times of \"keyframes\" must increase"};
}

}  // namespace

template <>
std::optional<Fault> fault_of(const Activation& activation) {
    for (const Keyframe& keyframe : activation.keyframes) {
        const double stretch = 1 + keyframe.factor * (activation.stretch - 1);
        if (!(stretch > 0)) {
            return Fault{"keyframes", "the keyframe of factor " + readable(keyframe.factor)
                                          + " makes fibers " + readable(stretch)
                                          + " times as long, which would turn cells inside out;"
                                            " expected more than 0: factors are of stretch - 1"};
        }
    }
    if (activation.fibers == Fibers::Distance && activation.away_from.empty()) {
        return Fault{"fibers",
                     "fibers = \"distance\" go with \"away_from\", a selection of vertices"};
    }
    return fault_of_times(activation.keyframes);
}

template <>
std::optional<Fault> fault_of(const Load& load) {
    if (load.force.isZero(0) && load.pressure == 0) {
        return Fault{"force", "a load needs a \"force\" or a \"pressure\" that is not zero"};
    }
    return fault_of_times(load.keyframes);
}

template <>
std::optional<Fault> fault_of(const Attachment& attachment) {
    if (attachment.target.empty()) {
        return std::nullopt;
    }
    if (attachment.target == attachment.body) {
        return Fault{"target", "\"target\" is the body itself; expected another one"};
    }
    constexpr const char* kReason =
        " is of points in space and does not go together with \"target\"; leave one of them out";
    if (attachment.point) {
        return Fault{"point", std::string("\"point\"") + kReason};
    }
    return attachment.motion.empty()
               ? std::nullopt
               : std::optional(Fault{"motion", std::string("\"motion\"") + kReason});
}

template <>
std::optional<Fault> fault_of(const Motion& motion) {
    if (motion.keyframes.empty()) {
        return std::nullopt;
    }
    const std::string_view rate = !motion.translate.isZero(0) ? "translate"
                                  : !motion.rotate.empty()    ? "rotate"
                                  : std::isfinite(motion.to)  ? "to"
                                                              : "";
    if (!rate.empty()) {
        return Fault{rate, "\"" + std::string(rate)
                               + "\" does not go together with \"keyframes\", which say where a"
                                 " motion goes and when; leave one of them out"};
    }
    if (motion.keyframes.front().time <= motion.from) {
        return Fault{"keyframes",
                     "the first of \"keyframes\" is at " + readable(motion.keyframes.front().time)
                         + " s; expected it behind the start of the motion, \"from\", at "
                         + readable(motion.from) + " s"};
    }
    return fault_of_times(motion.keyframes);
}

template <>
std::optional<Fault> fault_of(const Constraint& constraint) {
    for (const Motion& motion : constraint.motion) {
        if (!motion.keyframes.empty() && motion.keyframes.front().time <= constraint.from) {
            return Fault{"motion", "the first of \"keyframes\" is at "
                                       + readable(motion.keyframes.front().time)
                                       + " s, when nothing is held yet; expected it behind the"
                                         " \"from\" of the constraint, "
                                       + readable(constraint.from) + " s"};
        }
    }
    return std::nullopt;
}

template <>
std::optional<Fault> fault_of(const LayerSelection& layers) {
    if (layers.first <= layers.last) {
        return std::nullopt;
    }
    return Fault{"last", "\"last\" is before \"first\""};
}

}  // namespace pent::simulator
