#include "pent/contact/friction.h"

#include "chunks.h"

#include <pent/dimensions.h>

#include <algorithm>
#include <cmath>

namespace pent::contact {

namespace {

constexpr std::size_t kChunk = 1024;

// How many secants a turn around of the slip leads to, and twice as many with every further turn:
// enough to come to rest, and few where the contact slides on after all.
constexpr int kPatience = 4;

// f1(y) / y, which is 2 / e at y = 0.
double force_over_slip(double y, double e) {
    return y < e ? (2 - y / e) / e : 1 / y;
}

double force_slope(double y, double e) {
    return y < e ? 2 * (1 - y / e) / e : 0;
}

// f0, 0 at 0.
double energy(double y, double e) {
    return y < e ? y * y / e * (1 - y / (3 * e)) : y - e / 3;
}

}  // namespace

double Friction::between(const Collider& first, const Collider& second) const {
    const auto of = [&](const Collider& one) {
        const std::vector<double>& own = one.is_obstacle() ? of_obstacles : of_bodies;
        return own.empty() ? coefficient : own[one.index];
    };
    const double a = of(first);
    const double b = of(second);
    return a == b ? a : std::sqrt(a * b);
}

template <int Dim>
FrictionResponse<Dim> friction_response(
    const Vector<Dim>& normal, double force, const Vector<Dim>& slip, double e, FrictionLaw law) {
    const Vector<Dim> u = slip - normal.dot(slip) * normal;
    const double y = u.norm();
    const double across = force * force_over_slip(y, e);
    FrictionResponse<Dim> response;
    response.energy = force * energy(y, e);
    response.gradient = across * u;
    response.hessian = -across * normal * normal.transpose();
    response.hessian.diagonal().array() += across;
    if (law == FrictionLaw::Energy && y > 0) {
        const double along = force * force_slope(y, e);
        response.hessian += (along - across) / (y * y) * u * u.transpose();
    }
    return response;
}

template <int Dim>
Vector<Dim> LaggedFriction<Dim>::weighted_sum(const Lagged& lagged, const Positions<Dim>& vectors) {
    Vector<Dim> sum = Vector<Dim>::Zero();
    for (int i = 0; i < lagged.count; ++i) {
        sum += lagged.weights[i] * vectors.col(lagged.vertices[i]);
    }
    return sum;
}

template <int Dim>
void LaggedFriction<Dim>::begin_step(
    const std::vector<Contact<Dim>>& contacts,
    const Positions<Dim>& positions,
    const Positions<Dim>* velocities,
    double h,
    const std::function<Vector<Dim>(const Contact<Dim>&)>& obstacle_displacement) {
    slip_ = friction_.slip_speed * h;
    is_linear_ = velocities != nullptr;
    lagged_ =
        collect<Lagged>(contacts.size(), kChunk, [&](std::size_t i, std::vector<Lagged>& list) {
            const Contact<Dim>& contact = contacts[i];
            const double coefficient = friction_.between(contact.first, contact.second);
            if (contact.slope == 0 || coefficient == 0) {
                return;
            }
            Lagged lagged;
            lagged.vertices = contact.vertices;
            lagged.weights = contact.weights;
            lagged.count = contact.count;
            lagged.normal = contact.direction;
            lagged.force = coefficient * std::abs(contact.slope);
            Vector<Dim> carried = Vector<Dim>::Zero();
            if (obstacle_displacement && contact.second.is_obstacle()) {
                carried = obstacle_displacement(contact);
            }
            lagged.start = weighted_sum(lagged, positions) + carried;
            lagged.resistance.setZero();
            if (velocities != nullptr) {
                lagged.resistance =
                    friction_response<Dim>(lagged.normal, lagged.force,
                                           h * weighted_sum(lagged, *velocities) - carried, slip_,
                                           FrictionLaw::Secant)
                        .hessian;
            }
            list.push_back(lagged);
        });
}

template <int Dim>
FrictionResponse<Dim> LaggedFriction<Dim>::respond(const Lagged& lagged,
                                                   const Vector<Dim>& slip,
                                                   FrictionLaw law) const {
    if (!is_linear_) {
        return friction_response<Dim>(lagged.normal, lagged.force, slip, slip_, law);
    }
    FrictionResponse<Dim> response;
    response.hessian = lagged.resistance;
    response.gradient = lagged.resistance * slip;
    response.energy = 0.5 * slip.dot(response.gradient);
    return response;
}

template <int Dim>
double LaggedFriction<Dim>::add_gradient(const Positions<Dim>& positions,
                                         Positions<Dim>& gradient) const {
    struct Part {
        double energy = 0;
        Vector<Dim> gradient;
    };
    const std::vector<Part> parts =
        collect<Part>(lagged_.size(), kChunk, [&](std::size_t i, std::vector<Part>& list) {
            const Vector<Dim> slip = weighted_sum(lagged_[i], positions) - lagged_[i].start;
            const FrictionResponse<Dim> response = respond(lagged_[i], slip, FrictionLaw::Energy);
            list.push_back({response.energy, response.gradient});
        });
    double energy = 0;
    for (std::size_t k = 0; k < parts.size(); ++k) {
        const Lagged& lagged = lagged_[k];
        energy += parts[k].energy;
        for (int i = 0; i < lagged.count; ++i) {
            gradient.col(lagged.vertices[i]) += lagged.weights[i] * parts[k].gradient;
        }
    }
    return energy;
}

template <int Dim>
StencilHessians<Dim> LaggedFriction<Dim>::hessians(const Positions<Dim>& positions) {
    StencilHessians<Dim> hessians;
    hessians.weighted.resize(lagged_.size());
    for_each_chunk(
        lagged_.size(), kChunk, [&](std::size_t /*chunk*/, std::size_t begin, std::size_t end) {
            for (std::size_t i = begin; i < end; ++i) {
                Lagged& lagged = lagged_[i];
                Vector<Dim> slip = weighted_sum(lagged, positions) - lagged.start;
                slip -= lagged.normal.dot(slip) * lagged.normal;
                if (slip.dot(lagged.slip) < 0) {
                    lagged.patience = std::max(kPatience, 2 * lagged.patience);
                    lagged.secants = lagged.patience;
                }
                lagged.slip = slip;
                const bool is_secant = lagged.secants > 0 && slip.norm() > 0.5 * slip_;
                lagged.secants = std::max(lagged.secants - 1, 0);
                const FrictionLaw law = is_secant ? FrictionLaw::Secant : FrictionLaw::Energy;
                hessians.weighted[i] = {lagged.vertices, lagged.count, lagged.weights,
                                        respond(lagged, slip, law).hessian};
            }
        });
    return hessians;
}

#define PENT_INSTANTIATE(Dim)                                                 \
    template FrictionResponse<Dim> friction_response<Dim>(                    \
        const Vector<Dim>&, double, const Vector<Dim>&, double, FrictionLaw); \
    template class LaggedFriction<Dim>;
PENT_FOR_EACH_DIMENSION(PENT_INSTANTIATE)
#undef PENT_INSTANTIATE

}  // namespace pent::contact
