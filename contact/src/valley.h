#pragma once

#include <pent/contact/contact.h>
#include <pent/contact/surface.h>

#include <cstddef>
#include <vector>

namespace pent::contact {

/// Shares a vertex among the facets that it lies in front of.
///
/// The least of its distances d_i from them has a kink where a valley makes another facet the
/// nearest one. Instead of it contact takes
///
///     d = min over shares p_i >= 0, sum p_i = 1, of   m - kappa (1 - |u|^2) / 2,
///     m = sum p_i d_i,   u = sum p_i u_i,   kappa = m (1 - m / eps),
///
/// with the directions u_i of the d_i. It is continuously differentiable and at most kappa / 2
/// below the least distance. A facet whose nearest point is not in front of the plane through that
/// of the nearest facet has no share, since d_1 <= d_i u_i . u_1 there: so flat and bulging
/// surfaces keep the least distance.
///
/// A facet whose contact has faded relative to that of the nearest one, to a part r of its energy,
/// counts as one that is as far away as that energy tells: its d_i above is eps - sqrt(r) (eps -
/// d_i). So it comes and goes continuously.
///
/// @param contacts   From `first` on those of one vertex outside, with the penalty: with each facet
///                   nearer than eps, the nearest first. Of these stay the ones that have a share:
///                   the first one as it is, or several that have the distance d and their part
///                   p_i of the share of the first, and weights and gains by which they add up to
///                   its gradient.
/// @param eps        Distance of contact, m.
template <int Dim>
void share_contacts(std::vector<Contact<Dim>>& contacts,
                    std::size_t first,
                    double eps,
                    const PositionsView<Dim>& positions);

}  // namespace pent::contact
