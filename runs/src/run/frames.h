#pragma once

#include <pent/pent_file.h>
#include <pent/runs/report.h>
#include <pent/simulator/output.h>
#include <pent/simulator/simulation.h>

#include <string>
#include <vector>

namespace pent::runs {

/// State of the vertices [first, last) of a body, with the quantities that are asked for.
template <int Dim>
[[nodiscard]] Frame<Dim> frame_slab(const simulator::Simulation<Dim>& simulation,
                                    const std::vector<simulator::VertexQuantity>& quantities,
                                    int body,
                                    Eigen::Index first,
                                    Eigen::Index last);

/// What the journal and report.json say of a frame that is about to be written.
template <int Dim>
[[nodiscard]] FrameReport frame_report(const simulator::Simulation<Dim>& simulation,
                                       const std::vector<std::string>& bodies,
                                       int frame);

}  // namespace pent::runs
