#pragma once

#include <pent/pent_file.h>
#include <pent/viewer/hyperplane.h>
#include <pent/viewer/obstacle_slice.h>
#include <pent/viewer/run_folder.h>
#include <pent/viewer/surface.h>

#include <Eigen/Core>

#include <optional>
#include <span>
#include <string>
#include <vector>

namespace pent::viewer {

/// Which hyperplanes to look at. Three-dimensional bodies are seen whole and take none of this.
struct SectionOptions {
    /// m; empty: one about through the middle of the bodies.
    std::vector<double> offsets;
    /// Not with rotations.
    std::optional<Eigen::Vector4d> normal;
    /// Applied to the bodies about the origin, in this order.
    std::vector<PlaneRotation> rotations;
    /// Angles the last rotation takes one after the other, radians; empty: its own.
    std::vector<double> last_angles;

    [[nodiscard]] bool is_default() const {
        return offsets.empty() && !normal.has_value() && rotations.empty();
    }
};

/// A hyperplane with the words to tell it by.
struct Section {
    FramedHyperplane plane;
    std::string label;  ///< As "w = 0.25", with as many digits as it takes to tell it from the
                        ///< others; empty in three dimensions.
};

/// The hyperplanes asked for; at least one.
///
/// @param frames  Of all bodies at one moment, to find the middle.
/// Throws an Error for a normal without direction or together with rotations, an offset that is not
/// finite, and for any option in three dimensions.
template <int Dim>
[[nodiscard]] std::vector<Section> make_sections(const SectionOptions& options,
                                                 std::span<const Frame<Dim>> frames);

/// What tells the hyperplanes apart, from the first to the last: "-0.1 to 0.3" for offsets, "xw 0
/// to 90" for angles, or both. Empty for a single one.
[[nodiscard]] std::string span_label(const SectionOptions& options);

/// What is seen of a body: its slice, or in three dimensions all of its surface.
template <int Dim>
[[nodiscard]] Surface take_section(const Body<Dim>& body,
                                   const Positions<Dim>& positions,
                                   const Section& section);

/// What is seen of an obstacle: its slice, or in three dimensions all of it.
template <int Dim>
[[nodiscard]] ObstacleSlice take_section(const ObstacleShape<Dim>& obstacle,
                                         const Section& section);

/// A number in few digits, as in captions: "0.25", "-3", "1.2e-05".
[[nodiscard]] std::string short_number(double value);

}  // namespace pent::viewer
