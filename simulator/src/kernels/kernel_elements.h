#pragma once

#include "kernels/kernel_laws.h"
#include "kernels/kernel_vertices.h"
#include "kernels/kernels.h"
#include "kernels/quadratic_rule.h"

// Groups of elements, and energies and gradients of linear simplices, an element a lane.

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

    // The dof of a corner of an element; dof_count or more where it is held.
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

// The group `by` further on in a run, or its last one.
template <int Dim>
Group<Dim> group_ahead(const ElementRun& run, int group, int by) {
    const int last = (run.elements - 1) / kGroup;
    return group_at<Dim>(run, group + by < last ? group + by : last);
}

// Matrix blocks of corner a with itself and with all corners after it.
template <int Dim>
const std::int32_t* row_of_blocks(const Group<Dim>& group, int a) {
    return group.blocks + std::int64_t{a * group.corners - a * (a - 1) / 2} * kGroup;
}

// Prefetches the data of the group two ahead, a share of it with each corner of the current group.
// Hardware prefetchers stop at the end of a page, and a page holds only some 25 elements; and
// prefetching a whole group at once would stall, as only so many reads can be in flight. What
// only prefetches has to be inlined: g++ removes calls of functions without effects that it knows.
//
// @tparam WithPlaces  Whether `blocks` will be read, too.
template <int Dim, bool WithPlaces = false>
class ReadAhead {
public:
    ReadAhead(const ElementRun& run, int group)
        : group_(group_ahead<Dim>(run, group, 2)),
          rest_share_((group_.volume + kGroup - group_.rest + kLine * group_.corners - 1)
                      / (kLine * group_.corners) * kLine) {}

    [[gnu::always_inline]] void bring(int corner) const {
        const double* rest = group_.rest + corner * rest_share_;
        const double* share_end = rest + rest_share_;
        const double* group_end = group_.volume + kGroup;
        for (const double* end = share_end < group_end ? share_end : group_end; rest < end;
             rest += kLine) {
            __builtin_prefetch(rest);
        }
        __builtin_prefetch(group_.vertices + corner * kGroup);
        for (int pair = 0; WithPlaces && pair < group_.corners - corner; ++pair) {
            __builtin_prefetch(row_of_blocks(group_, corner) + pair * kGroup);
        }
    }

private:
    static constexpr int kLine = 64 / sizeof(double);

    Group<Dim> group_;
    std::int64_t rest_share_;  // numbers of `rest` to prefetch with each corner
};

// x_a - x_0 of every element of a group, to[axis][lane]: subtracted in double, as positions may be
// large beside edges, even where all that follows is in float.
template <int Dim, bool IsVectorized>
void gather_edge(const Group<Dim>& group,
                 int corner,
                 const double* positions,
                 double (&to)[Dim][kGroup]) {
    using Tile = VertexTile<Dim, IsVectorized>;
    using Vertex = typename Tile::Vertex;
    for (int lane = 0; lane < kGroup; lane += Tile::kCount) {
        Tile edges;
        for (int k = 0; k < Tile::kCount; ++k) {
            const std::uint32_t* vertices = group.vertices + lane + k;
            edges.at[k] = loaded<Vertex>(positions + std::int64_t{Dim} * vertices[corner * kGroup])
                          - loaded<Vertex>(positions + std::int64_t{Dim} * vertices[0]);
        }
        edges.store(to, lane);
    }
}

// All edges from corner 0: [a - 1][axis][lane].
template <int Dim>
struct Edges {
    alignas(64) double at[Dim][Dim][kGroup];
};

template <int Dim, bool IsVectorized, typename Ahead>
void gather_edges(const Group<Dim>& group,
                  const Ahead& ahead,
                  const double* positions,
                  Edges<Dim>& edges) {
    ahead.bring(0);
    for (int a = 1; a <= Dim; ++a) {
        gather_edge<Dim, IsVectorized>(group, a, positions, edges.at[a - 1]);
        ahead.bring(a);
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
            edge[a] = Lanes<Real>::load(edges.at[a][i] + lane);
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

// Energies of a group, and what inverted and collapsed elements are told by: [lane].
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

template <typename Vertex>
void add_to_vertex(const Vertex& part, double* sum) {
    store(loaded<Vertex>(sum) + part, sum);
}

// Adds part[corner][axis][lane] to the gradient, all corners of one element before the next one:
// see scatter_blocks().
template <int Dim, bool IsVectorized>
void add_to_corners(const Group<Dim>& group,
                    const double (&part)[Dim + 1][Dim][kGroup],
                    double* gradient) {
    using Tile = VertexTile<Dim, IsVectorized>;
    for (int lane = 0; lane < group.elements; lane += Tile::kCount) {
        Tile corners[Dim + 1];
        for (int a = 0; a <= Dim; ++a) {
            corners[a].load(part[a], lane);
        }
        for (int k = 0; k < Tile::kCount && lane + k < group.elements; ++k) {
            for (int a = 0; a <= Dim; ++a) {
                const std::int64_t vertex = group.vertices[a * kGroup + lane + k];
                add_to_vertex(corners[a].at[k], gradient + Dim * vertex);
            }
        }
    }
}

// The gradient at a corner is volume * P g, g being its rest gradient: a row of Dm^-1, and for
// corner 0 minus the sum of the others.
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
        gather_edges<Dim, (kWidth > 1)>(group, ReadAhead<Dim>(run, g), positions, edges);
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
        add_to_corners<Dim, (kWidth > 1)>(group, corner, gradient);
    }
    return total;
}

}  // namespace
}  // namespace pent::simulator

// NOLINTEND(cppcoreguidelines-pro-type-member-init)
