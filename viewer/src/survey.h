#pragma once

#include <pent/viewer/coloring.h>
#include <pent/viewer/run_folder.h>
#include <pent/viewer/section.h>

#include <Eigen/Geometry>

#include <functional>
#include <vector>

namespace pent::viewer {

/// What holds for all the chosen frames together, so that a movie has one camera and one color bar.
struct Survey {
    Eigen::AlignedBox3d box;  ///< Around all slices; empty if no hyperplane meets a body.
    ColorRange range;
    bool is_complete = true;  ///< False if it was ended early.
};

/// Slices every chosen frame once to see how far things reach.
///
/// @param on_surface  Called with every slice; may be empty.
/// @param go_on       Called after each frame; false ends it. May be empty.
template <int Dim>
[[nodiscard]] Survey survey(const RunFolder& run,
                            const std::vector<Body<Dim>>& bodies,
                            const std::vector<Section>& sections,
                            const std::vector<int>& frames,
                            ColorBy color,
                            const std::function<void(const Surface&)>& on_surface,
                            const std::function<bool()>& go_on);

/// The sections asked for; the middle is that of the first frame of the run.
template <int Dim>
[[nodiscard]] std::vector<Section> sections_at_start(const RunFolder& run,
                                                     const std::vector<Body<Dim>>& bodies,
                                                     const SectionOptions& options);

}  // namespace pent::viewer
