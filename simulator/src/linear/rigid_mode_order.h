#pragma once

namespace pent::simulator {

/// The rigid-body modes of an aggregate: Dim translations, then for each plane p < q the linearized
/// rotation e_q x_p - e_p x_q about its centroid, x in units of its size so that all modes are of
/// the same order.
template <int Dim>
inline constexpr int kModes = Dim*(Dim + 1) / 2;

/// Calls visit(p, q, k) for each plane of two axes, p < q: the rotation of axis p to axis q is
/// rigid mode k, the translations being modes 0 to Dim - 1.
template <int Dim, typename Visit>
void for_each_plane(const Visit& visit) {
    int k = Dim;
#pragma GCC unroll 4
    for (int p = 0; p < Dim; ++p) {
#pragma GCC unroll 4
        for (int q = p + 1; q < Dim; ++q, ++k) {
            visit(p, q, k);
        }
    }
}

}  // namespace pent::simulator
