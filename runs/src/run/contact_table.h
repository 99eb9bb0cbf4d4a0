#pragma once

#include "simulator_names.h"

#include <string>
#include <vector>

namespace pent::runs {

/// Everything in contact now as comma-separated values, a line each behind one of names:
///
///     kind,first,second,distance,fx,fy,fz,fw,v0,v1,v2,v3,v4,w0,w1,w2,w3,w4
///
/// `kind` is point-facet, mixed or obstacle; `first` and `second` are bodies, the second of an
/// obstacle its number in the scene, from 0. `distance` is signed, m; fx.. is the force on the
/// first body, N. The points of contact are sums of vertices v with weights w: those of the first
/// body have positive weights, those of the second negative ones. Vertices are counted in their
/// body, and are empty where there are none. In R^3 fw, v4 and w4 are left out.
template <int Dim>
[[nodiscard]] std::string contact_table(const Simulation<Dim>& simulation,
                                        const std::vector<std::string>& bodies);

}  // namespace pent::runs
