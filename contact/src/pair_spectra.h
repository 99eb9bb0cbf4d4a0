#pragma once

#include "spectra.h"

#include <pent/contact/contact_scene.h>
#include <pent/contact/filter.h>

namespace pent::contact {

/// Filtered Hessians of pairs whose weights move, with their mollifiers. Several are done at once:
/// what is added is there after finish().
template <int Dim>
class PairSpectra {
public:
    /// How many numbers the Hessian of a pair has at most.
    [[nodiscard]] static std::size_t most_numbers(const Contact<Dim>& contact, Filter filter);

    /// @param numbers  To write to, where the Hessians have their room.
    PairSpectra(Filter filter, double* numbers);

    /// @param hessian  Of the vertices that may move; its rank is set. It has to outlive finish().
    void add(const DistanceEnergy& energy,
             const Contact<Dim>& contact,
             const PositionsView<Dim>& positions,
             SpectralHessian<Dim>& hessian);
    void finish();

private:
    Spectra<Dim, 2 * Dim - 1> of_distances_;
    Spectra<Dim, Dim * Dim> mollified_;
};

}  // namespace pent::contact
