#include "pent/contact/penalty.h"

#include "filter.h"

#include <algorithm>
#include <cmath>

namespace pent::contact {

namespace {

bool is_fading(double d, const Penalty& penalty) {
    return penalty.reach == Reach::Fading && d < 0;
}

bool is_out_of_reach(double d, const Penalty& penalty) {
    return d >= penalty.distance || (penalty.reach == Reach::Fading && d <= -penalty.distance);
}

}  // namespace

double penalty_energy(double signed_distance, const Penalty& penalty) {
    const double d = signed_distance;
    const double eps = penalty.distance;
    if (is_out_of_reach(d, penalty)) {
        return 0;
    }
    if (is_fading(d, penalty)) {
        return penalty.stiffness * (eps * eps - 2 * eps * d + d * d + 4 * d * d * d / (3 * eps));
    }
    return penalty.stiffness * (d - eps) * (d - eps);
}

double penalty_slope(double signed_distance, const Penalty& penalty) {
    const double d = signed_distance;
    const double eps = penalty.distance;
    if (is_out_of_reach(d, penalty)) {
        return 0;
    }
    if (is_fading(d, penalty)) {
        return -2 * penalty.stiffness * (eps + d) * (eps - 2 * d) / eps;
    }
    return 2 * penalty.stiffness * (d - eps);
}

double penalty_curvature(double signed_distance, const Penalty& penalty) {
    const double d = signed_distance;
    if (is_out_of_reach(d, penalty)) {
        return 0;
    }
    if (is_fading(d, penalty)) {
        return 2 * penalty.stiffness * (1 + 4 * d / penalty.distance);
    }
    return 2 * penalty.stiffness;
}

template <int Dim>
Response<Dim> pair_response(double signed_distance,
                            const Vector<Dim>& direction,
                            const Penalty& penalty,
                            double weight,
                            Filter filter) {
    const double slope = weight * penalty_slope(signed_distance, penalty);
    const double curvature = weight * penalty_curvature(signed_distance, penalty);
    double sideways = signed_distance == 0 ? 0 : slope / signed_distance;
    if (filter != Filter::None) {
        const double most = std::abs(curvature);
        sideways = std::clamp(sideways, -most, most);
    }
    const double along = filtered(curvature, filter);
    sideways = filtered(sideways, filter);
    Response<Dim> response;
    response.energy = weight * penalty_energy(signed_distance, penalty);
    response.gradient = slope * direction;
    response.hessian = (along - sideways) * direction * direction.transpose();
    response.hessian.diagonal().array() += sideways;
    return response;
}

template Response<3> pair_response(double, const Vector<3>&, const Penalty&, double, Filter);
template Response<4> pair_response(double, const Vector<4>&, const Penalty&, double, Filter);

}  // namespace pent::contact
