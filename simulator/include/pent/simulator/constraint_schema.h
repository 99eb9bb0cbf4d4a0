#pragma once

#include <pent/simulator/field.h>
#include <pent/simulator/scene.h>

#include <cstdint>
#include <limits>

/// The keys of constraints and attachments: part of scene_schema.h.
namespace pent::simulator {

template <PartOf<BallSelection> Part, typename Visit>
void fields(Part& ball, const Visit& visit) {
    visit(key("center", "m").required(), ball.center);
    visit(key("radius", "m", "", kPositive).required(), ball.radius);
}

template <PartOf<BoxSelection> Part, typename Visit>
void fields(Part& box, const Visit& visit) {
    visit(key("low", "m").required(), box.low);
    visit(key("high", "m").required(), box.high);
}

template <PartOf<HalfSpaceSelection> Part, typename Visit>
void fields(Part& half_space, const Visit& visit) {
    visit(key("normal").direction().required(), half_space.normal);
    visit(key("offset", "m"), half_space.offset);
}

template <PartOf<LayerSelection> Part, typename Visit>
void fields(Part& layers, const Visit& visit) {
    constexpr Range kAll{.low = 0, .high = std::numeric_limits<std::uint32_t>::max()};
    visit(key("first", "", "", kAll).required(), layers.first);
    visit(key("last", "", "", kAll).otherwise(layers.first).default_is("`first`"), layers.last);
}

/// Its key stands where those of the others have a table: { region = 3 }.
template <PartOf<RegionSelection> Part, typename Visit>
void fields(Part& region, const Visit& visit) {
    visit(key("region", "", "", whole(0, 65535)).required(), region.region);
}

template <PartOf<EverythingSelection> Part, typename Visit>
void fields(Part& /*everything*/, const Visit& /*visit*/) {}

/// What files call the kinds, in the order of Selection; the last is a text.
inline constexpr std::string_view kSelectionNames[] = {"ball",   "box",    "half_space",
                                                       "layers", "region", "everything"};

/// In place of motions: there is none.
inline constexpr std::string_view kFixed = "fixed";

template <PartOf<MotionKeyframe> Part, typename Visit>
void fields(Part& keyframe, const Visit& visit) {
    visit(key("time", "s", "", kNotNegative).required(), keyframe.time);
    visit(key("translate", "m"), keyframe.translate);
    visit(key("rotate"), keyframe.rotate);
    visit(key("velocity", "m/s").may_be_missing().default_is("smooth"), keyframe.velocity);
    visit(key("spin").may_be_missing().default_is("smooth"), keyframe.spin);
}

template <PartOf<Motion> Part, typename Visit>
void fields(Part& motion, const Visit& visit) {
    visit(key("translate", "m/s"), motion.translate);
    visit(key("rotate", "", "two planes at once make a double rotation"), motion.rotate);
    visit(key("keyframes", "",
              "in place of both: where it has taken the vertices by a time, m and degrees"),
          motion.keyframes);
    visit(key("about", "m", "what it turns about; is carried along by `translate`")
              .may_be_missing()
              .default_is("mean of the selected vertices, or center of the obstacle, at `from`"),
          motion.about);
    visit(key("from", "s", "at rest before", kNotNegative), motion.from);
    visit(
        key("to", "s", "above `from`; held after", Range{.low = motion.from, .low_included = false})
            .may_be_missing()
            .default_is("forever"),
        motion.to);
}

template <PartOf<Constraint> Part, typename Visit>
void fields(Part& constraint, const Visit& visit) {
    visit(key("body", "", "its name").required(), constraint.body);
    visit(key("select", "",
              "`\"everything\"`, one of the tables below, or a list of them (their union)")
              .required(),
          constraint.select);
    visit(key("motion", "",
              "`\"fixed\"`, a table as below, or a list of them: each goes on from where those "
              "before it have the vertices"),
          constraint.motion);
    visit(key("from", "s", "free in steps that begin before", kNotNegative), constraint.from);
    visit(key("to", "s", "above `from`; free from there on",
              Range{.low = constraint.from, .low_included = false})
              .may_be_missing()
              .default_is("forever"),
          constraint.to);
}

template <PartOf<Attachment> Part, typename Visit>
void fields(Part& attachment, const Visit& visit) {
    visit(key("body", "", "its name").required(), attachment.body);
    visit(key("select", "", "as of a constraint").required(), attachment.select);
    visit(key("target", "", "another body; each selected vertex is tied to its nearest point")
              .may_be_missing()
              .default_is("points in space"),
          attachment.target);
    visit(key("point", "m", "one point in space for all selected vertices")
              .may_be_missing()
              .default_is("where each of them is"),
          attachment.point);
    visit(key("motion", "", "of points in space, as of a constraint"), attachment.motion);
    visit(key("offset", "", "see below"), attachment.offset);
    visit(key("max_distance", "m", "of a selected vertex from `target`", kPositive),
          attachment.max_distance);
    visit(key("stiffness", "N/m for each selected vertex", "", kPositive), attachment.stiffness);
    visit(key("damping", "N s/m for each selected vertex", "", kNotNegative), attachment.damping);
    visit(key("from", "s", "not there in steps that begin before", kNotNegative), attachment.from);
    visit(key("to", "s", "above `from`; gone from there on",
              Range{.low = attachment.from, .low_included = false})
              .may_be_missing()
              .default_is("forever"),
          attachment.to);
    visit(key("break_force", "N for each selected vertex", "a spring that pulls harder is gone",
              kPositive)
              .may_be_missing()
              .default_is("none"),
          attachment.break_force);
    visit(key("contact", "", "whether `[contact]` is between the two bodies all the same"),
          attachment.contact);
}

}  // namespace pent::simulator
