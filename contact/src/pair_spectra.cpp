#include "pair_spectra.h"

#include "contact_energy.h"
#include "distance_hessian.h"
#include "spanned_volume.h"

#include <pent/dimensions.h>

namespace pent::contact {

namespace {

template <int Dim>
int most_of_distance(Filter filter) {
    return filter == Filter::Clamp ? Dim : 2 * Dim - 1;
}

// The Hessian of a contact with its mollifier at c, a squared volume, where that is not 1.
template <int Dim>
StencilMatrix<Dim> mollified_hessian(const DistanceEnergy& energy,
                                     const Contact<Dim>& contact,
                                     const Stencil<Dim>& points,
                                     double c) {
    const double value = energy.value(contact.distance);
    const double slope = energy.slope(contact.distance);
    const double curvature = energy.curvature(contact.distance);
    const Mollifier& mollifier = contact.mollifier;
    const StencilVector<Dim> by_distance = slope * outer<Dim>(contact.weights, contact.direction);
    const StencilVector<Dim> by_volume =
        spanned_volume_squared_gradient<Dim>(points, contact.first_count);
    StencilMatrix<Dim> hessian =
        mollifier.value(c) * distance_hessian<Dim>(points, contact, slope, curvature).matrix();
    hessian += mollifier.slope(c) * value
               * spanned_volume_squared_hessian<Dim>(points, contact.first_count);
    hessian += mollifier.curvature(c) * value * by_volume * by_volume.transpose();
    hessian += mollifier.slope(c)
               * (by_distance * by_volume.transpose() + by_volume * by_distance.transpose());
    return hessian;
}

}  // namespace

template <int Dim>
std::size_t PairSpectra<Dim>::most_numbers(const Contact<Dim>& contact, Filter filter) {
    const int most = contact.mollifier.is_on() ? Dim * Dim : most_of_distance<Dim>(filter);
    return static_cast<std::size_t>(most * (1 + Dim * contact.count));
}

template <int Dim>
PairSpectra<Dim>::PairSpectra(Filter filter, double* numbers)
    : of_distances_(filter, most_of_distance<Dim>(filter), numbers),
      mollified_(filter, Dim * Dim, numbers) {}

template <int Dim>
void PairSpectra<Dim>::add(const DistanceEnergy& energy,
                           const Contact<Dim>& contact,
                           const PositionsView<Dim>& positions,
                           SpectralHessian<Dim>& hessian) {
    const Stencil<Dim> points = corners_of<Dim>(contact, positions);
    const Mollifier& mollifier = contact.mollifier;
    const double c =
        mollifier.is_on() ? spanned_volume_squared<Dim>(points, contact.first_count) : 0;
    if (c < mollifier.threshold) {
        mollified_.add(
            without_translations<Dim>(mollified_hessian<Dim>(energy, contact, points, c)), hessian);
    } else {
        of_distances_.add(distance_hessian<Dim>(points, contact, energy.slope(contact.distance),
                                                energy.curvature(contact.distance)),
                          hessian);
    }
}

template <int Dim>
void PairSpectra<Dim>::finish() {
    of_distances_.finish();
    mollified_.finish();
}

#define PENT_INSTANTIATE(Dim) template class PairSpectra<Dim>;
PENT_FOR_EACH_DIMENSION(PENT_INSTANTIATE)
#undef PENT_INSTANTIATE

}  // namespace pent::contact
