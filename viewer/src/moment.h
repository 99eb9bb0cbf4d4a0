#pragma once

#include <pent/pent_file.h>
#include <pent/viewer/coloring.h>
#include <pent/viewer/run_folder.h>
#include <pent/viewer/section.h>

#include <Eigen/Core>

#include <vector>

namespace pent::viewer {

/// All bodies of a run at one frame.
template <int Dim>
struct Moment {
    std::vector<Frame<Dim>> frames;       ///< One a body.
    std::vector<Eigen::VectorXd> values;  ///< One a body: the colored quantity at its vertices.
};

/// Throws an Error as load_frame does.
template <int Dim>
[[nodiscard]] Moment<Dim> load_moment(const RunFolder& run,
                                      const std::vector<Body<Dim>>& bodies,
                                      int frame,
                                      ColorBy color) {
    Moment<Dim> moment;
    for (const Body<Dim>& body : bodies) {
        moment.frames.push_back(load_frame<Dim>(run, body, frame));
        moment.values.push_back(vertex_values<Dim>(body, moment.frames.back(), color));
    }
    return moment;
}

}  // namespace pent::viewer
