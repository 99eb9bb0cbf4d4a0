#include "pent/contact/friction.h"

#include <cmath>

namespace pent::contact {

namespace {

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

template <int Dim>
Response<Dim> friction_response(const FrictionContact<Dim>& contact,
                                const Vector<Dim>& slip,
                                const Friction& friction,
                                double h,
                                FrictionLaw law) {
    const double e = friction.slip_speed * h;
    const Vector<Dim> u = slip - contact.normal.dot(slip) * contact.normal;
    const double y = u.norm();
    const double across = contact.force * force_over_slip(y, e);
    Response<Dim> response;
    response.energy = contact.force * energy(y, e);
    response.gradient = across * u;
    response.hessian = -across * contact.normal * contact.normal.transpose();
    response.hessian.diagonal().array() += across;
    if (law == FrictionLaw::Energy && y > 0) {
        const double along = contact.force * force_slope(y, e);
        response.hessian += (along - across) / (y * y) * u * u.transpose();
    }
    return response;
}

template Response<3> friction_response<3>(
    const FrictionContact<3>&, const Vector<3>&, const Friction&, double, FrictionLaw);
template Response<4> friction_response<4>(
    const FrictionContact<4>&, const Vector<4>&, const Friction&, double, FrictionLaw);

}  // namespace pent::contact
