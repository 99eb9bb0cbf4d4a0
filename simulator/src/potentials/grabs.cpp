#include "potentials/grabs.h"

#include "model/same_time.h"

#include <pent/dimensions.h>

#include <algorithm>
#include <cmath>

namespace pent::simulator {

namespace {

// The factor by which a pull of `force` newtons is weakened to be no harder than `most`.
double weakening(double force, double most) {
    return force > most ? most / force : 1;
}

// The material of a cell of a body's mesh, which may be on another rank.
template <int Dim>
const Material& material_of(const Bodies<Dim>& bodies, std::size_t body, std::int64_t cell) {
    const auto has_it = [&](const CellRange& range) {
        for (Eigen::Index own = range.begin; range.body == body && own < range.end; ++own) {
            if (bodies.mesh_cell(body, own) == cell) {
                return true;
            }
        }
        return false;
    };
    const auto here = std::find_if(bodies.ranges.begin(), bodies.ranges.end(), has_it);
    const auto places = bodies.sharing.list(static_cast<double>(here - bodies.ranges.begin()));
    const auto place = static_cast<std::size_t>(*std::min_element(places.begin(), places.end()));
    return bodies.ranges[place].material;
}

}  // namespace

template <int Dim>
void Grabs<Dim>::set(const std::vector<Holding>& holdings, double time) {
    holdings_ = holdings;
    start_ = time;
    rate_ = 0;
    pulls_.clear();
    for (const Holding& holding : holdings) {
        const BodyPoint<Dim>& point = holding.grab.point;
        const auto body = static_cast<std::size_t>(point.body);
        const auto first = static_cast<std::uint32_t>(bodies_->first_vertex[body]);
        Pull& pull = pulls_.emplace_back();
        for (int i = 0; i <= Dim; ++i) {
            pull.add(first + bodies_->meshes[body].cells(i, point.cell), point.weights[i]);
        }
        pull.law = {holding.grab.stiffness, holding.grab.damping};
        pull.anchor = holding.from;
    }
}

template <int Dim>
void Grabs<Dim>::arrive() {
    for (Holding& holding : holdings_) {
        holding.from = holding.grab.anchor;
    }
}

template <int Dim>
bool Grabs<Dim>::set_time(const TimeSpan& step) {
    bool has_changed = false;
    const double part = std::max(0.0, (step.end - start_) / dt_);
    for (std::size_t g = 0; g < pulls_.size(); ++g) {
        const auto& [id, grab, from] = holdings_[g];
        Pull& pull = pulls_[g];
        Vector<Dim> to = grab.anchor;
        if (!is_whole_step(part)) {
            to = from + part * (grab.anchor - from);
        }
        const bool was_weakened = pull.law.stiffness != grab.stiffness;
        has_changed =
            has_changed || to != pull.anchor || was_weakened || (rate_ > 0 && grab.damping > 0);
        pull.law = {grab.stiffness, grab.damping};
        pull.anchor = to;
        pull.velocity = (grab.anchor - from) / dt_;
    }
    rate_ = 0;
    return has_changed;
}

template <int Dim>
bool Grabs<Dim>::begin_step(const StepStart<Dim>& start) {
    bool has_changed = false;
    rate_ = start.rate;
    for (std::size_t g = 0; g < pulls_.size(); ++g) {
        const Grab<Dim>& grab = holdings_[g].grab;
        Pull& pull = pulls_[g];
        const Vector<Dim> stretch = pull.weighted_sum(start.positions) - pull.anchor;
        const Vector<Dim> speed = pull.weighted_sum(start.velocities) - pull.velocity;
        const Vector<Dim> force = grab.stiffness * stretch + grab.damping * speed;
        const double part = weakening(force.norm(), *grab.max_force);
        pull.law = {part * grab.stiffness, part * grab.damping};
        pull.begin_step(rate_, start.origin);
        has_changed = has_changed || part != 1 || grab.damping > 0;
    }
    return has_changed;
}

template <int Dim>
double Grabs<Dim>::evaluate(const Positions<Dim>& x, Positions<Dim>& gradient) {
    energy_ = 0;
    damping_energy_ = 0;
    for (std::size_t g = 0; g < pulls_.size(); ++g) {
        Pull& pull = pulls_[g];
        const double most = *holdings_[g].grab.max_force;
        const double stretch = (pull.weighted_sum(x) - pull.anchor).norm();
        if (rate_ == 0 && pull.law.stiffness * stretch > most) {
            pull.add_pull(most / stretch * (pull.weighted_sum(x) - pull.anchor), gradient);
            energy_ += most * stretch - 0.5 * most * most / pull.law.stiffness;
            continue;
        }
        const auto energy = pull.evaluate(pull.law, rate_, x, gradient);
        energy_ += energy.elastic;
        damping_energy_ += energy.damping;
    }
    return energy_ + damping_energy_;
}

template <int Dim>
void Grabs<Dim>::add_hessian(const Positions<Dim>& /*x*/,
                             double weight,
                             Filter /*filter*/,
                             NewtonSystem<Dim>& system) {
    if (pulls_.empty()) {
        return;
    }
    system.reserve_stencils(pulls_.size());
    for (Pull& pull : pulls_) {
        pull.hessian = (pull.law.stiffness + rate_ * pull.law.damping) * Matrix<Dim>::Identity();
        system.add_stencil(pull.stencil(weight, pull.hessian));
    }
}

template <int Dim>
std::vector<TermEnergy> Grabs<Dim>::energies() const {
    if (pulls_.empty()) {
        return {};
    }
    return {{.name = "grab", .energy = energy_},
            {.name = "grab damping", .energy = damping_energy_, .is_stored = false}};
}

template <int Dim>
void Grabs<Dim>::add_couplings(Couplings& couplings) const {
    for (const Holding& holding : holdings_) {
        if (holding.from != holding.grab.anchor) {
            couplings.driven.push_back(static_cast<std::size_t>(holding.grab.point.body));
        }
    }
}

template <int Dim>
double bearable_force(const Bodies<Dim>& bodies, const BodyPoint<Dim>& point) {
    const auto body = static_cast<std::size_t>(point.body);
    const Material& material = material_of(bodies, body, point.cell);
    double mass = 0;
    for (int i = 0; i <= Dim; ++i) {
        const std::uint32_t vertex = bodies.meshes[body].cells(i, point.cell);
        mass += std::abs(point.weights[i]) * bodies.masses[bodies.first_vertex[body] + vertex];
    }
    // Undoes the lumping: each cell gives each of its Dim + 1 corners an equal part of its mass.
    const double volume = (Dim + 1) * mass / material.density;
    return (2 * material.lame.mu + std::abs(material.lame.lambda))
           * std::pow(volume, (Dim - 1.0) / Dim);
}

#define PENT_INSTANTIATE(Dim)  \
    template class Grabs<Dim>; \
    template double bearable_force(const Bodies<Dim>&, const BodyPoint<Dim>&);
PENT_FOR_EACH_DIMENSION(PENT_INSTANTIATE)
#undef PENT_INSTANTIATE

}  // namespace pent::simulator
