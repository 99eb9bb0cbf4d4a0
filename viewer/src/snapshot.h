#pragma once

#include <pent/obstacle.h>
#include <pent/pent_file.h>
#include <pent/viewer/coloring.h>
#include <pent/viewer/run_folder.h>
#include <pent/viewer/section.h>

#include <Eigen/Core>

#include <vector>

namespace pent::viewer {

/// All bodies and obstacles of a run at one frame.
template <int Dim>
struct Snapshot {
    int number = 0;                       ///< As files are numbered.
    std::vector<Frame<Dim>> frames;       ///< One a body.
    std::vector<Eigen::VectorXd> values;  ///< One a body: the colored quantity at its vertices.
    std::vector<ObstacleShape<Dim>> obstacles;
};

/// Throws an Error as load_frame and load_obstacles do.
template <int Dim>
[[nodiscard]] Snapshot<Dim> load_snapshot(const RunFolder& run,
                                          const std::vector<Body<Dim>>& bodies,
                                          int frame,
                                          const ColorBy& color) {
    Snapshot<Dim> snapshot;
    snapshot.number = frame;
    for (const Body<Dim>& body : bodies) {
        snapshot.frames.push_back(load_frame<Dim>(run, body, frame));
        snapshot.values.push_back(vertex_values<Dim>(body, snapshot.frames.back(), color));
    }
    snapshot.obstacles = load_obstacles<Dim>(run, frame);
    return snapshot;
}

}  // namespace pent::viewer
