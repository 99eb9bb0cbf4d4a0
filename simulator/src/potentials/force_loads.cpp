#include "potentials/force_loads.h"

#include "model/keyframes.h"
#include "model/part_selection.h"

#include <pent/dimensions.h>
#include <pent/simulator/placed_mesh.h>

#include <utility>

namespace pent::simulator {

template <int Dim>
ForceLoads<Dim>::ForceLoads(const Scene& scene, const Bodies<Dim>& bodies) {
    for (const Load& load : scene.loads) {
        if (load.force.isZero(0)) {
            continue;
        }
        VertexForces made;
        made.body = index_of(scene, load.body);
        made.keyframes = load.keyframes;
        made.vertices = select_vertices(bodies, made.body, load.select, place_and_name(load));
        double mass = 0;
        for (std::uint32_t& vertex : made.vertices) {
            vertex += static_cast<std::uint32_t>(bodies.first_vertex[made.body]);
            mass += bodies.masses[vertex];
        }
        made.forces.resize(Dim, static_cast<Eigen::Index>(made.vertices.size()));
        for (std::size_t i = 0; i < made.vertices.size(); ++i) {
            made.forces.col(static_cast<Eigen::Index>(i)) =
                bodies.masses[made.vertices[i]] / mass * load.force;
        }
        loads_.push_back(std::move(made));
    }
}

template <int Dim>
bool ForceLoads<Dim>::set_time(const TimeSpan& step) {
    bool has_changed = false;
    for (VertexForces& load : loads_) {
        const double factor = factor_at(load.keyframes, step.end);
        load.is_changing = factor != factor_at(load.keyframes, step.begin);
        has_changed = has_changed || factor != load.factor;
        load.factor = factor;
    }
    return has_changed;
}

template <int Dim>
void ForceLoads<Dim>::add_couplings(Couplings& couplings) const {
    for (const VertexForces& load : loads_) {
        if (load.is_changing) {
            couplings.driven.push_back(load.body);
        }
    }
}

template <int Dim>
double ForceLoads<Dim>::evaluate(const Positions<Dim>& x, Positions<Dim>& gradient) {
    energy_ = 0;
    for (const VertexForces& load : loads_) {
        for (std::size_t i = 0; i < load.vertices.size(); ++i) {
            const auto force = load.factor * load.forces.col(static_cast<Eigen::Index>(i));
            gradient.col(load.vertices[i]) -= force;
            energy_ -= force.dot(x.col(load.vertices[i]));
        }
    }
    for (Eigen::Index v = 0; v < of_host_.cols(); ++v) {
        gradient.col(v) -= of_host_.col(v);
        energy_ -= of_host_.col(v).dot(x.col(v));
    }
    return energy_;
}

#define PENT_INSTANTIATE(Dim) template class ForceLoads<Dim>;
PENT_FOR_EACH_DIMENSION(PENT_INSTANTIATE)
#undef PENT_INSTANTIATE

}  // namespace pent::simulator
