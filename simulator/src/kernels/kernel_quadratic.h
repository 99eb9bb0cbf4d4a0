#pragma once

#include "kernels/kernel_smoothed.h"

// Energies and forces of quadratic simplices with mean dilatation, an element a lane.
//
// At each of its points a quadratic simplex deforms as a linear simplex does, see QuadraticRule. So
// a point has the stress, forces and Hessian blocks of a linear simplex, and those of its corners
// are distributed to the nodes by the same factors as positions.
//
// To avoid volumetric locking a part of lambda acts on the mean dilatation only [nagtegaal1974]:
// with theta the measure of volume that is squared in an energy, see Dilatation, W is
//     V (sum over points q of share_q Psi(F_q; mu, lambda) + mean_lambda / 2 mean^2),
//     mean = sum over q of share_q theta(F_q).

// Tensors of lanes are filled entry by entry right after they are declared; zeroing them first
// would cost as much as using them. NOLINTBEGIN(cppcoreguidelines-pro-type-member-init)

namespace pent::simulator {
namespace {  // NOLINT(google-build-namespaces): see kernel_lanes.h

// Positions of the nodes relative to the first node of their element: [node][axis][lane].
template <int Dim>
struct GroupNodes {
    alignas(64) double at[kQuadraticNodes<Dim>][Dim][kGroup];
};

template <int Dim, bool IsVectorized>
void gather_nodes(const Group<Dim>& group,
                  const ReadAhead<Dim>& ahead,
                  const double* positions,
                  GroupNodes<Dim>& nodes) {
    for (int node = 0; node < kQuadraticNodes<Dim>; ++node) {
        gather_edge<Dim, IsVectorized>(group, node, positions, nodes.at[node]);
        ahead.bring(node);
    }
}

// y_a - y_0 of the linear simplex at a point.
template <int Dim>
void edges_at(const GroupNodes<Dim>& nodes, int point, Edges<Dim>& edges) {
    for (int axis = 0; axis < Dim; ++axis) {
        double corners[Dim + 1][kGroup] = {};
        for (int a = 0; a <= Dim; ++a) {
            for (int b = 0; b <= Dim; ++b) {
                const double share = kQuadraticRule<Dim>.share[point][a][b];
                const auto& node = nodes.at[kQuadraticRule<Dim>.node[a][b]][axis];
                for (int lane = 0; lane < kGroup; ++lane) {
                    corners[a][lane] += share * node[lane];
                }
            }
            for (int lane = 0; a > 0 && lane < kGroup; ++lane) {
                edges.at[a - 1][axis][lane] = corners[a][lane] - corners[0][lane];
            }
        }
    }
}

// A point of every element of a group, as a group of linear simplices; `volume` is its share.
template <int Dim>
Group<Dim> point_of(const Group<Dim>& group, int point) {
    Group<Dim> at = group;
    at.rest = group.rest + std::int64_t{point} * (Dim * Dim + 1) * kGroup;
    at.volume = at.rest + std::int64_t{Dim} * Dim * kGroup;
    return at;
}

template <typename Real, int Dim>
struct Dilatation {
    Real value;
    Tensor<Real, Dim> slope;  // by F
};

// The measure of volume of an energy: J - 1, tr E or tr e. Not called for arap, which has none.
template <typename Real, int Dim>
Dilatation<Real, Dim> dilatation_of(const Tensor<Real, Dim>& F, Model model) {
    using Number = typename Lanes<Real>::Number;
    if (model == Model::StableNeoHookean || model == Model::MooneyRivlin) {
        const Cofactor<Real, Dim> C = cofactor(F);
        return {C.det - Real(Number(1)), C.matrix};
    }
    if (model == Model::StVenantKirchhoff) {
        return {Real(Number(0.5)) * (norm_squared(F) - Real(Number(Dim))), F};
    }
    Dilatation<Real, Dim> trace{Real(Number(-Dim)), identity<Real, Dim>()};
    for (int i = 0; i < Dim; ++i) {
        trace.value += F[i][i];
    }
    return trace;
}

// A pack of elements at all of their points.
template <typename Real, int Dim>
struct PointStates {
    Tensor<Real, Dim> F[kQuadraticPoints<Dim>];
    Tensor<Real, Dim> rest[kQuadraticPoints<Dim>];
    Real share[kQuadraticPoints<Dim>];
    Real mean;  // dilatation
};

template <typename Real, int Dim>
void deform_points(const Group<Dim>& group,
                   const Edges<Dim> (&edges)[kQuadraticPoints<Dim>],
                   const ElementRun& run,
                   int lane,
                   PointStates<Real, Dim>& states) {
    states.mean = Real(typename Lanes<Real>::Number(0));
    for (int q = 0; q < kQuadraticPoints<Dim>; ++q) {
        const Group<Dim> point = point_of(group, q);
        states.rest[q] = load_rest<Real>(point, lane);
        states.share[q] = Lanes<Real>::load(point.volume + lane);
        states.F[q] = deformation(edges[q], states.rest[q], lane);
        if (run.mean_lambda > 0) {
            states.mean += states.share[q] * dilatation_of(states.F[q], run.material.model).value;
        }
    }
}

// A vector for each node, as a force.
template <typename Real, int Dim>
struct NodeVectors {
    Vector<Real, Dim> at[kQuadraticNodes<Dim>];

    NodeVectors() {
        for (Vector<Real, Dim>& node : at) {
            for (int i = 0; i < Dim; ++i) {
                node.at[i] = Real(typename Lanes<Real>::Number(0));
            }
        }
    }

    // Adds P times the rest gradient of every node at a point.
    void add(int point, const Tensor<Real, Dim>& P, const Tensor<Real, Dim>& rest) {
        for (int i = 0; i < Dim; ++i) {
            Real corner[Dim + 1];
            corner[0] = Real(typename Lanes<Real>::Number(0));
            for (int a = 1; a <= Dim; ++a) {
                corner[a] = P[i][0] * rest[a - 1][0];
                for (int j = 1; j < Dim; ++j) {
                    corner[a] += P[i][j] * rest[a - 1][j];
                }
                corner[0] -= corner[a];
            }
            for (int a = 0; a <= Dim; ++a) {
                for (int b = 0; b <= Dim; ++b) {
                    at[kQuadraticRule<Dim>.node[a][b]].at[i] +=
                        number(kQuadraticRule<Dim>.share[point][a][b]) * corner[a];
                }
            }
        }
    }

    static Real number(double value) {
        return Real(static_cast<typename Lanes<Real>::Number>(value));
    }
};

// Energy and forces of a pack of elements; det and norm are the least of all points.
template <typename Real, int Dim>
void pull_nodes(const PointStates<Real, Dim>& states,
                const ElementRun& run,
                const Real& volume,
                Stress<Real, Dim>& worst,
                NodeVectors<Real, Dim>& pull) {
    using L = Lanes<Real>;
    const Moduli moduli = moduli_of<Dim>(run);
    const Real pressure = Real(run.mean_lambda) * states.mean;
    worst.energy = Real(0.5) * pressure * states.mean;
    for (int q = 0; q < kQuadraticPoints<Dim>; ++q) {
        Stress<Real, Dim> stress = stress_of(states.F[q], moduli);
        if (run.mean_lambda > 0) {
            const Dilatation<Real, Dim> dilatation = dilatation_of(states.F[q], run.material.model);
            for (int i = 0; i < Dim; ++i) {
                for (int j = 0; j < Dim; ++j) {
                    stress.P[i][j] += pressure * dilatation.slope[i][j];
                }
            }
        }
        const Real weight = volume * states.share[q];
        for (int i = 0; i < Dim; ++i) {
            for (int j = 0; j < Dim; ++j) {
                stress.P[i][j] *= weight;
            }
        }
        pull.add(q, stress.P, states.rest[q]);
        worst.energy += states.share[q] * stress.energy;
        worst.det = q == 0 ? stress.det : -L::max(-worst.det, -stress.det);
        worst.norm = q == 0 ? stress.norm : -L::max(-worst.norm, -stress.norm);
    }
}

template <int Dim, typename Real>
RunEnergy add_quadratic_gradient(const ElementRun& run, const double* positions, double* gradient) {
    constexpr bool kIsVectorized = Lanes<Real>::kCount > 1;
    const int groups = (run.elements + kGroup - 1) / kGroup;
    RunEnergy total;
    GroupNodes<Dim> nodes;
    Edges<Dim> edges[kQuadraticPoints<Dim>];
    GroupEnergies energies;
    for (int g = 0; g < groups; ++g) {
        const Group<Dim> group = group_at<Dim>(run, g);
        gather_nodes<Dim, kIsVectorized>(group, ReadAhead<Dim>(run, g), positions, nodes);
        for (int q = 0; q < kQuadraticPoints<Dim>; ++q) {
            edges_at(nodes, q, edges[q]);
        }
        // Positions are not needed any more: the forces take their place.
        for (int lane = 0; lane < kGroup; lane += Lanes<Real>::kCount) {
            const Real volume = Lanes<Real>::load(group.volume + lane);
            PointStates<Real, Dim> states;
            deform_points(group, edges, run, lane, states);
            NodeVectors<Real, Dim> pull;
            Stress<Real, Dim> worst;
            pull_nodes(states, run, volume, worst, pull);
            energies.store(worst, volume, lane);
            for (int node = 0; node < kQuadraticNodes<Dim>; ++node) {
                for (int i = 0; i < Dim; ++i) {
                    Lanes<Real>::store(pull.at[node].at[i], nodes.at[node][i] + lane);
                }
            }
        }
        energies.add_to(total, group.elements, run.collapse_norm);
        for (int node = 0; node < kQuadraticNodes<Dim>; ++node) {
            add_to_corner<Dim, kIsVectorized>(group, node, nodes.at[node], gradient);
        }
    }
    return total;
}

}  // namespace
}  // namespace pent::simulator

// NOLINTEND(cppcoreguidelines-pro-type-member-init)
