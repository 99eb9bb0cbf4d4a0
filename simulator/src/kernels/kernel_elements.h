#pragma once

#include "kernels/kernel_laws.h"
#include "kernels/kernel_transpose.h"
#include "kernels/kernels.h"
#include "kernels/quadratic_rule.h"

// Groups of elements and their gradients, in lanes.

// Tensors of lanes are filled entry by entry right after they are declared; zeroing them first
// would cost as much as using them. NOLINTBEGIN(cppcoreguidelines-pro-type-member-init)

namespace pent::simulator {
namespace {  // NOLINT(google-build-namespaces): see kernel_lanes.h

// One group as the kernels read it: [row][lane].
template <int Dim>
struct Group {
    const double* rest;
    const double* volume;
    const std::uint32_t* vertices;
    const std::uint32_t* dofs;  // one a vertex
    const std::int32_t* blocks;
    int corners;   // of every element
    int elements;  // lanes in use
    std::uint32_t dof_count;

    // Of a corner of an element, dof_count or more where it is held.
    [[nodiscard]] std::uint32_t dof(int corner, int lane) const {
        return dofs[vertices[corner * kGroup + lane]];
    }
};

template <int Dim>
Group<Dim> group_at(const ElementRun& run, int group) {
    const std::int64_t first = std::int64_t{group} * kGroup;
    const std::int64_t gradient_rows = run.kind == ElementKind::Quadratic
                                           ? kQuadraticRestRows<Dim> - 1
                                           : std::int64_t{Dim} * (run.corners - 1);
    const std::int64_t pairs = std::int64_t{run.corners} * (run.corners + 1) / 2;
    const double* rest = run.rest + first * (gradient_rows + 1);
    const int left = run.elements - group * kGroup;
    return {rest,
            rest + gradient_rows * kGroup,
            run.vertices + first * run.corners,
            run.dofs,
            run.blocks + first * pairs,
            run.corners,
            left < kGroup ? left : kGroup,
            run.dof_count};
}

// Edges x_a - x_0 of every element of a group: [axis][a - 1][lane], subtracted in double.
template <int Dim>
struct Edges {
    alignas(64) double at[Dim][Dim][kGroup];
};

template <int Dim>
void gather_edges(const Group<Dim>& group, const double* positions, Edges<Dim>& edges) {
    for (int lane = 0; lane < kGroup; ++lane) {
        const double* origin = positions + std::int64_t{Dim} * group.vertices[lane];
        for (int a = 0; a < Dim; ++a) {
            const double* corner =
                positions + std::int64_t{Dim} * group.vertices[(a + 1) * kGroup + lane];
            for (int axis = 0; axis < Dim; ++axis) {
                edges.at[axis][a][lane] = corner[axis] - origin[axis];
            }
        }
    }
}

template <typename Real, int Dim>
Tensor<Real, Dim> load_rest(const Group<Dim>& group, int lane) {
    Tensor<Real, Dim> rest;
    for (int i = 0; i < Dim; ++i) {
        for (int j = 0; j < Dim; ++j) {
            rest[i][j] = Lanes<Real>::load(group.rest + std::int64_t{i * Dim + j} * kGroup + lane);
        }
    }
    return rest;
}

// F = Ds Dm^-1.
template <typename Real, int Dim>
Tensor<Real, Dim> deformation(const Edges<Dim>& edges, const Tensor<Real, Dim>& rest, int lane) {
    Tensor<Real, Dim> F;
    for (int i = 0; i < Dim; ++i) {
        Real edge[Dim];
        for (int a = 0; a < Dim; ++a) {
            edge[a] = Lanes<Real>::load(edges.at[i][a] + lane);
        }
        for (int j = 0; j < Dim; ++j) {
            Real sum = edge[0] * rest[0][j];
            for (int a = 1; a < Dim; ++a) {
                sum += edge[a] * rest[a][j];
            }
            F[i][j] = sum;
        }
    }
    return F;
}

// Energies of a group and what tells inverted and collapsed elements: [lane].
struct GroupEnergies {
    alignas(64) double energy[kGroup];
    alignas(64) double det[kGroup];
    alignas(64) double norm[kGroup];

    template <typename Real, int Dim>
    void store(const Stress<Real, Dim>& stress, const Real& volume, int lane) {
        Lanes<Real>::store(volume * stress.energy, energy + lane);
        Lanes<Real>::store(stress.det, det + lane);
        Lanes<Real>::store(stress.norm, norm + lane);
    }

    void add_to(RunEnergy& total, int elements, double collapse_norm) const {
        for (int lane = 0; lane < elements; ++lane) {
            total.energy += energy[lane];
            total.inverted += det[lane] > 0 ? 0 : 1;
            total.collapsed += norm[lane] < collapse_norm ? 1 : 0;
        }
    }
};

template <int Dim, typename Real>
RunEnergy add_gradient(const ElementRun& run, const double* positions, double* gradient) {
    constexpr int kWidth = Lanes<Real>::kCount;
    const Moduli moduli = moduli_of<Dim>(run);
    const int groups = (run.elements + kGroup - 1) / kGroup;
    RunEnergy total;
    Edges<Dim> edges;
    alignas(64) double corner[Dim + 1][Dim][kGroup];
    GroupEnergies energies;
    for (int g = 0; g < groups; ++g) {
        const Group<Dim> group = group_at<Dim>(run, g);
        gather_edges(group, positions, edges);
        for (int lane = 0; lane < kGroup; lane += kWidth) {
            const Tensor<Real, Dim> rest = load_rest<Real>(group, lane);
            const Real volume = Lanes<Real>::load(group.volume + lane);
            const Stress<Real, Dim> stress = stress_of(deformation(edges, rest, lane), moduli);
            for (int i = 0; i < Dim; ++i) {
                Real rest_of_corners = Real(0.0);
                for (int a = 0; a < Dim; ++a) {
                    Real sum = stress.P[i][0] * rest[a][0];
                    for (int j = 1; j < Dim; ++j) {
                        sum += stress.P[i][j] * rest[a][j];
                    }
                    const Real pull = volume * sum;
                    rest_of_corners += pull;
                    Lanes<Real>::store(pull, corner[a + 1][i] + lane);
                }
                Lanes<Real>::store(-rest_of_corners, corner[0][i] + lane);
            }
            energies.store(stress, volume, lane);
        }
        energies.add_to(total, group.elements, run.collapse_norm);
        for (int lane = 0; lane < group.elements; ++lane) {
            for (int a = 0; a <= Dim; ++a) {
                double* sum = gradient + std::int64_t{Dim} * group.vertices[a * kGroup + lane];
                for (int i = 0; i < Dim; ++i) {
                    sum[i] += corner[a][i][lane];
                }
            }
        }
    }
    return total;
}

}  // namespace
}  // namespace pent::simulator

// NOLINTEND(cppcoreguidelines-pro-type-member-init)
