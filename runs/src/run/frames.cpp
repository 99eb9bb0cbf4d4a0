#include "run/frames.h"

#include <pent/simulator/rigid_fit.h>
#include <pent/simulator/words.h>

#include <string>

namespace pent::runs {

using simulator::VertexQuantity;

template <int Dim>
Frame<Dim> frame_slab(const simulator::Simulation<Dim>& simulation,
                      const std::vector<VertexQuantity>& quantities,
                      int body,
                      Eigen::Index first,
                      Eigen::Index last) {
    const Eigen::Index count = last - first;
    Frame<Dim> slab;
    slab.positions = simulation.positions(body).middleCols(first, count);
    slab.velocities = simulation.velocities(body).middleCols(first, count);
    for (const VertexQuantity quantity : quantities) {
        const Eigen::MatrixXd values = simulation.vertex_values(quantity, body);
        if (quantity == VertexQuantity::ContactForce) {  // has columns of its own
            slab.contact_forces = values.middleCols(first, count);
        } else {
            slab.fields.push_back(
                {std::string(simulator::word_of(quantity)), values.middleCols(first, count)});
        }
    }
    slab.step = simulation.step_count();
    slab.time = simulation.time();
    return slab;
}

template <int Dim>
FrameReport frame_report(const simulator::Simulation<Dim>& simulation,
                         const std::vector<std::string>& bodies,
                         int frame) {
    FrameReport report;
    report.frame = frame;
    report.step = simulation.step_count();
    report.time = simulation.time();
    for (int body = 0; body < simulation.body_count(); ++body) {
        report.non_rigid.push_back(
            {bodies[static_cast<std::size_t>(body)],
             simulator::non_rigid<Dim>(simulation.mesh(body).positions, simulation.positions(body),
                                       simulation.masses(body))});
    }
    return report;
}

#define PENT_INSTANTIATE(Dim)                                                             \
    template Frame<Dim> frame_slab(const simulator::Simulation<Dim>&,                     \
                                   const std::vector<VertexQuantity>&, int, Eigen::Index, \
                                   Eigen::Index);                                         \
    template FrameReport frame_report(const simulator::Simulation<Dim>&,                  \
                                      const std::vector<std::string>&, int);
PENT_INSTANTIATE(3)
PENT_INSTANTIATE(4)
#undef PENT_INSTANTIATE

}  // namespace pent::runs
