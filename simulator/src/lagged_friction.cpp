#include "lagged_friction.h"

namespace pent::simulator {

namespace {

template <int Dim>
contact::Vector<Dim> weighted_sum(const contact::FrictionContact<Dim>& contact,
                                  const Positions<Dim>& vectors) {
    contact::Vector<Dim> sum = contact::Vector<Dim>::Zero();
    for (int i = 0; i < contact.count; ++i) {
        sum += contact.weights[i] * vectors.col(contact.vertices[static_cast<std::size_t>(i)]);
    }
    return sum;
}

}  // namespace

template <int Dim>
void LaggedFriction<Dim>::begin_step(const std::vector<contact::Contact<Dim>>& pairs,
                                     const std::vector<contact::ObstacleContact<Dim>>& obstacles,
                                     const Positions<Dim>& positions,
                                     const Positions<Dim>* velocities,
                                     double h) {
    h_ = h;
    is_linear_ = velocities != nullptr;
    pairs_.clear();
    obstacles_.clear();
    for (const contact::Contact<Dim>& pair : pairs) {
        contact::FrictionContact<Dim> contact;
        contact.vertices = pair.vertices;
        contact.weights = pair.weights;
        add(contact, pair.response.gradient, positions, velocities, pairs_);
    }
    for (const contact::ObstacleContact<Dim>& obstacle : obstacles) {
        contact::FrictionContact<Dim> contact;
        contact.vertices.fill(obstacle.vertex);
        contact.weights = contact::Weights<Dim>::Unit(0);
        contact.count = 1;
        add(contact, obstacle.response.gradient, positions, velocities, obstacles_);
    }
}

template <int Dim>
void LaggedFriction<Dim>::add(contact::FrictionContact<Dim> contact,
                              const contact::Vector<Dim>& force,
                              const Positions<Dim>& positions,
                              const Positions<Dim>* velocities,
                              std::vector<Lagged>& list) const {
    const double size = force.norm();
    if (size == 0) {
        return;
    }
    contact.normal = force / size;
    contact.force = friction_.coefficient * size;
    Lagged lagged{contact, weighted_sum<Dim>(contact, positions), {}};
    lagged.resistance.setZero();
    if (velocities != nullptr) {
        lagged.resistance =
            contact::friction_response<Dim>(contact, h_ * weighted_sum<Dim>(contact, *velocities),
                                            friction_, h_, contact::FrictionLaw::Secant)
                .hessian;
    }
    list.push_back(lagged);
}

template <int Dim>
contact::Response<Dim> LaggedFriction<Dim>::respond(const Lagged& lagged,
                                                    const Positions<Dim>& positions) const {
    const contact::Vector<Dim> slip = weighted_sum<Dim>(lagged.contact, positions) - lagged.start;
    if (!is_linear_) {
        return contact::friction_response<Dim>(lagged.contact, slip, friction_, h_,
                                               contact::FrictionLaw::Energy);
    }
    contact::Response<Dim> response;
    response.hessian = lagged.resistance;
    response.gradient = lagged.resistance * slip;
    response.energy = 0.5 * slip.dot(response.gradient);
    return response;
}

template <int Dim>
FrictionState<Dim> LaggedFriction<Dim>::find(const Positions<Dim>& positions) const {
    FrictionState<Dim> state;
    for (const Lagged& lagged : pairs_) {
        contact::Contact<Dim> contact;
        contact.vertices = lagged.contact.vertices;
        contact.weights = lagged.contact.weights;
        contact.response = respond(lagged, positions);
        state.energy += contact.response.energy;
        state.pairs.push_back(contact);
    }
    for (const Lagged& lagged : obstacles_) {
        contact::ObstacleContact<Dim> contact;
        contact.vertex = lagged.contact.vertices[0];
        contact.response = respond(lagged, positions);
        state.energy += contact.response.energy;
        state.obstacles.push_back(contact);
    }
    return state;
}

template class LaggedFriction<3>;
template class LaggedFriction<4>;

}  // namespace pent::simulator
