#include "pent/viewer/section.h"

#include <pent/error.h>
#include <pent/formatted.h>
#include <pent/viewer/slice.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>
#include <set>

namespace pent::viewer {

namespace {

constexpr int kFewDigits = 4;
constexpr int kAllDigits = 17;  // of which two doubles have different ones

void check(const SectionOptions& options) {
    for (const double offset : options.offsets) {
        if (!std::isfinite(offset)) {
            throw Error("slices: found an offset that is not finite; expected a length in meters");
        }
    }
    if (options.normal && !options.rotations.empty()) {
        throw Error("slices: found both a normal and rotations; give one of them");
    }
    if (!options.last_angles.empty() && options.rotations.empty()) {
        throw Error("slices: found angles without a rotation that takes them");
    }
}

FramedHyperplane make_plane(const SectionOptions& options, double offset) {
    return options.normal ? hyperplane_across(*options.normal, offset)
                          : hyperplane_at(offset, options.rotations);
}

std::string axes_of(const PlaneRotation& rotation) {
    constexpr char kAxes[] = "xyzw";
    return {kAxes[rotation.from], kAxes[rotation.to]};
}

double degrees(double radians) {
    return radians * 180 / std::numbers::pi;
}

std::string span(double first, double last) {
    return short_number(first) + " to " + short_number(last);
}

std::string number_text(double value, int digits) {
    return formatted("%.*g", digits, value == 0 ? 0.0 : value);  // no "-0"
}

std::string label_of(const SectionOptions& options, const FramedHyperplane& plane, int digits) {
    if (options.normal) {
        std::string label = "(";
        for (int axis = 0; axis < 4; ++axis) {
            label += short_number(plane.frame(3, axis)) + (axis < 3 ? ", " : "");
        }
        return label + ") . p = " + number_text(plane.offset, digits);
    }
    std::string label = "w = " + number_text(plane.offset, digits);
    for (const PlaneRotation& rotation : options.rotations) {
        label += ", " + axes_of(rotation) + " " + number_text(degrees(rotation.radians), digits);
    }
    return label;
}

// @param digits  Of the numbers in labels.
std::vector<Section> sections_with(const std::vector<SectionOptions>& poses,
                                   const std::vector<double>& offsets,
                                   int digits) {
    std::vector<Section> sections;
    for (const SectionOptions& pose : poses) {
        for (const double offset : offsets) {
            const FramedHyperplane plane = make_plane(pose, offset);
            sections.push_back({plane, label_of(pose, plane, digits)});
        }
    }
    return sections;
}

std::size_t count_labels(const std::vector<Section>& sections) {
    std::set<std::string> labels;
    for (const Section& section : sections) {
        labels.insert(section.label);
    }
    return labels.size();
}

// The offset halfway between the lowest and the highest vertex along the normal, rounded to about a
// hundredth of what is between, to be readable.
double middle_offset(const SectionOptions& options, std::span<const Frame<4>> frames) {
    double low = std::numeric_limits<double>::infinity();
    double high = -low;
    for (const Frame<4>& frame : frames) {
        const Eigen::VectorXd heights = distances(frame.positions, make_plane(options, 0));
        low = std::min(low, heights.minCoeff());
        high = std::max(high, heights.maxCoeff());
    }
    const double middle = (low + high) / 2;
    if (!(high > low)) {
        return middle;
    }
    const double digit = std::pow(10.0, std::floor(std::log10(high - low)) - 2);
    return std::round(middle / digit) * digit;
}

}  // namespace

std::string short_number(double value) {
    return number_text(value, kFewDigits);
}

std::string span_label(const SectionOptions& options) {
    std::string label;
    if (options.offsets.size() > 1) {
        label = span(options.offsets.front(), options.offsets.back());
    }
    if (options.last_angles.size() > 1) {
        label += (label.empty() ? "" : ", ") + axes_of(options.rotations.back()) + " "
                 + span(degrees(options.last_angles.front()), degrees(options.last_angles.back()));
    }
    return label;
}

template <>
std::vector<Section> make_sections<4>(const SectionOptions& options,
                                      std::span<const Frame<4>> frames) {
    check(options);
    std::vector<SectionOptions> poses(std::max<std::size_t>(1, options.last_angles.size()),
                                      options);
    for (std::size_t i = 0; i < options.last_angles.size(); ++i) {
        poses[i].rotations.back().radians = options.last_angles[i];
    }
    std::vector<double> offsets = options.offsets;
    if (offsets.empty()) {
        offsets.push_back(middle_offset(poses.front(), frames));
    }
    std::vector<Section> sections = sections_with(poses, offsets, kAllDigits);
    const std::size_t different = count_labels(sections);  // some may be there twice
    int digits = kFewDigits;
    do {
        sections = sections_with(poses, offsets, digits++);
    } while (count_labels(sections) < different);
    return sections;
}

template <>
std::vector<Section> make_sections<3>(const SectionOptions& options,
                                      std::span<const Frame<3>> /*frames*/) {
    if (!options.is_default()) {
        throw Error(
            "slices: the bodies have dimension 3 and are shown whole; leave out the "
            "hyperplane");
    }
    return {Section()};
}

template <>
Surface take_section<4>(const Body<4>& body,
                        const Positions<4>& positions,
                        const Section& section) {
    return slice(body.boundary, positions, section.plane);
}

template <>
Surface take_section<3>(const Body<3>& body,
                        const Positions<3>& positions,
                        const Section& /*section*/) {
    return skin(body.boundary, positions);
}

template <>
ObstacleSlice take_section<4>(const ObstacleShape<4>& obstacle, const Section& section) {
    return slice(obstacle, section.plane);
}

template <>
ObstacleSlice take_section<3>(const ObstacleShape<3>& obstacle, const Section& /*section*/) {
    return whole(obstacle);
}

}  // namespace pent::viewer
