#pragma once

#include <pent/simulator/activation.h>
#include <pent/simulator/field.h>
#include <pent/simulator/load.h>

/// The keys of what drives bodies, loads and activations: part of scene_schema.h.
namespace pent::simulator {

template <PartOf<Keyframe> Part, typename Visit>
void fields(Part& keyframe, const Visit& visit) {
    visit(key("time", "s", "", kNotNegative).required(), keyframe.time);
    visit(key("factor").required(), keyframe.factor);
}

template <PartOf<Load> Part, typename Visit>
void fields(Part& load, const Visit& visit) {
    visit(key("body", "", "its name").required(), load.body);
    visit(key("select", "", "as of a constraint").required(), load.select);
    visit(key("force", "N", "of all selected vertices together; of constant direction")
              .may_be_missing(),
          load.force);
    visit(key("pressure", "N/m^(n-1)",
              "on the facets of the boundary of which every vertex is selected, against their "
              "outward normals as they are now; below 0 it pulls"),
          load.pressure);
    visit(key("keyframes", "",
              "what both are multiplied by: a smooth curve through these, constant before and "
              "behind them"),
          load.keyframes);
}

template <PartOf<Activation> Part, typename Visit>
void fields(Part& activation, const Visit& visit) {
    // Asked when the key comes up: a reader has read those before it by then.
    const auto has_fibers = [&] { return activation.fibers != Fibers::None; };
    const auto has_distance = [&] { return activation.fibers == Fibers::Distance; };
    const auto has_pulses = [&] { return activation.signal == Signal::Pulses; };
    const auto has_periods = [&] { return has_pulses() || activation.signal == Signal::Sine; };
    constexpr std::string_view kDirected = "fibers = \"constant\", \"mesh\" or \"distance\"";
    constexpr std::string_view kPeriodic = "signal = \"sine\" or \"pulses\"";
    visit(key("body", "", "its name").required(), activation.body);
    visit(key("select", "", "as of `body.region`: of cells").required(), activation.select);
    visit(key("stretch", "", "length of the fully active fiber over that at rest", kPositive)
              .required(),
          activation.stretch);
    visit(key("fibers", "", "which way they run; none: it grows in all directions"),
          activation.fibers);
    visit(key("direction", "", "of the fibers, at t = 0")
              .direction()
              .required()
              .only_with(activation.fibers == Fibers::Constant, "fibers = \"constant\""),
          activation.direction);
    visit(key("away_from", "", "vertices, as of a constraint, from which the distance counts")
              .required()
              .only_with(has_distance(), "fibers = \"distance\""),
          activation.away_from);
    visit(key("preserves_volume", "", "whether it gets thicker as it gets shorter")
              .only_with(has_fibers(), kDirected),
          activation.preserves_volume);
    visit(key("signal", "", "how much of it is there"), activation.signal);
    visit(key("frequency", "Hz", "", kPositive).only_with(has_periods(), kPeriodic),
          activation.frequency);
    visit(key("phase", "", "periods that the signal is ahead").only_with(has_periods(), kPeriodic),
          activation.phase);
    visit(key("duty", "", "part of a period in which the pulse is there",
              Range{.low = 0, .low_included = false, .high = 1, .high_included = false})
              .only_with(has_pulses(), "signal = \"pulses\""),
          activation.duty);
    visit(key("wave", "1/m", "periods that the signal is later for each m along an axis")
              .may_be_missing()
              .only_with(has_periods(), kPeriodic),
          activation.wave);
    visit(key("distance_wave", "1/m", "the same for each m of distance")
              .only_with(has_periods() && has_distance(),
                         "fibers = \"distance\" and a periodic signal"),
          activation.distance_wave);
    visit(key("keyframes", "", "what the signal is multiplied by, as of a load"),
          activation.keyframes);
}

}  // namespace pent::simulator
