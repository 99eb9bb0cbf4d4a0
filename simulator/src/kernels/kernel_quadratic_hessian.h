#pragma once

#include "kernels/kernel_quadratic.h"

// Hessians of quadratic simplices with mean dilatation, an element a lane: at each point the blocks
// of a linear simplex, then sums over points and corners into blocks of pairs of nodes, see
// kernel_quadratic.h. The mean dilatation adds a matrix of rank one.

// NOLINTBEGIN(cppcoreguidelines-pro-type-member-init): see kernel_elements.h

namespace pent::simulator {
namespace {  // NOLINT(google-build-namespaces): see kernel_lanes.h

// Blocks of one node with the corners of a linear simplex.
template <typename Real, int Dim>
struct CornerBlocks {
    Tensor<Real, Dim> at[Dim + 1];
};

// The Hessians of a pack of elements, before the blocks of points are summed up into those of
// nodes.
template <typename Real, int Dim>
struct QuadraticHessian {
    BlockPack<Real, Dim> points[kQuadraticPoints<Dim>];  // of the linear simplex at each
    NodeVectors<Real, Dim> swelling;  // gradient of the mean dilatation by each node
    Real mean_stiffness;              // factor of swelling swelling^T
    bool has_mean;

    // Entry (i, j) of block (a, b) at a point.
    [[nodiscard]] Real entry(int point, int a, int b, int i, int j) const {
        const auto& blocks = points[point].at;
        const auto* lanes = a <= b ? blocks[pair_index<Dim>(a, b)][block_entry<Dim>(i, j)]
                                   : blocks[pair_index<Dim>(b, a)][block_entry<Dim>(j, i)];
        return load_lanes(lanes);
    }

    static Real load_lanes(const typename Lanes<Real>::Number* from) {
        Real value;
        __builtin_memcpy(&value, from, sizeof(Real));
        return value;
    }
};

// Returns how many elements the filter has changed.
template <typename Real, int Dim>
int differentiate_points(const PointStates<Real, Dim>& states,
                         const ElementRun& run,
                         Filter filter,
                         const Real& stiffness,
                         int lanes,
                         QuadraticHessian<Real, Dim>& hessian) {
    using Number = typename Lanes<Real>::Number;
    const Moduli moduli = moduli_of<Dim>(run);
    const Real mean_lambda = Real(static_cast<Number>(run.mean_lambda));
    const Real pressure = mean_lambda * states.mean;
    Real is_filtered = Real(Number(0));
    hessian.has_mean = run.mean_lambda > 0;
    hessian.mean_stiffness = mean_lambda * stiffness;
    hessian.swelling = {};
    for (int q = 0; q < kQuadraticPoints<Dim>; ++q) {
        const RotatedHessian<Real, Dim> rotated =
            rotated_hessian(states.F[q], states.rest[q], moduli, filter, pressure);
        is_filtered = Lanes<Real>::max(is_filtered, rotated.is_filtered);
        hessian_blocks(rotated, stiffness * states.share[q], hessian.points[q]);
        if (hessian.has_mean) {
            Tensor<Real, Dim> slope = dilatation_of(states.F[q], run.material.model).slope;
            for (int i = 0; i < Dim; ++i) {
                for (int j = 0; j < Dim; ++j) {
                    slope[i][j] *= states.share[q];
                }
            }
            hessian.swelling.add(q, slope, states.rest[q]);
        }
    }
    return count_marked(is_filtered, lanes);
}

// The rows of one node, with corners of the linear simplices as columns: [point][corner], and their
// sum over points.
template <typename Real, int Dim>
struct NodeRows {
    CornerBlocks<Real, Dim> at[kQuadraticPoints<Dim>];
    CornerBlocks<Real, Dim> sum;
};

// @param a, b  The node is between them, see QuadraticRule.
template <typename Real, int Dim>
void rows_of_node(const QuadraticHessian<Real, Dim>& hessian,
                  int a,
                  int b,
                  NodeRows<Real, Dim>& rows) {
    using Vectors = NodeVectors<Real, Dim>;
    for (int q = 0; q < kQuadraticPoints<Dim>; ++q) {
        const Real of_a = Vectors::number(kQuadraticRule<Dim>.share[q][a][b]);
        const Real of_b = Vectors::number(kQuadraticRule<Dim>.share[q][b][a]);
        for (int c = 0; c <= Dim; ++c) {
            for (int i = 0; i < Dim; ++i) {
                for (int j = 0; j < Dim; ++j) {
                    Real value = of_a * hessian.entry(q, a, c, i, j);
                    if (a != b) {
                        value += of_b * hessian.entry(q, b, c, i, j);
                    }
                    rows.at[q].at[c][i][j] = value;
                    rows.sum.at[c][i][j] = q == 0 ? value : rows.sum.at[c][i][j] + value;
                }
            }
        }
    }
}

// The block of the node of `rows` with the node between c and d. QuadraticRule::share is the same
// at all points but the one near the corner, so that the sum over points, times that, and a
// correction at one point will do.
template <typename Real, int Dim>
Tensor<Real, Dim> block_of_nodes(const NodeRows<Real, Dim>& rows, int c, int d) {
    using Vectors = NodeVectors<Real, Dim>;
    constexpr double kStep = 4 * (QuadraticPoint<Dim>::kNear - QuadraticPoint<Dim>::kFar);
    const Real far = Vectors::number(4 * QuadraticPoint<Dim>::kFar - (c == d ? 1 : 0));
    const Real step = Vectors::number(kStep);
    Tensor<Real, Dim> block;
    for (int i = 0; i < Dim; ++i) {
        for (int j = 0; j < Dim; ++j) {
            Real all = rows.sum.at[c][i][j];
            Real near = rows.at[d].at[c][i][j];
            if (c != d) {
                all += rows.sum.at[d][i][j];
                near += rows.at[c].at[d][i][j];
            }
            block[i][j] = far * all + step * near;
        }
    }
    return block;
}

// Adds a block of one element to the matrix, which stores it or its transpose.
template <int Dim, int Width, typename Scalar>
void scatter_block(const Scalar (&entries)[Dim * Dim], std::int32_t place, Scalar* values) {
    if (place >= 0) {
        add_to<Dim * Dim, Width>(entries, values + std::int64_t{place} * Dim * Dim);
        return;
    }
    Scalar turned[Dim * Dim];
    for (int i = 0; i < Dim; ++i) {
        for (int j = 0; j < Dim; ++j) {
            turned[block_entry<Dim>(j, i)] = entries[block_entry<Dim>(i, j)];
        }
    }
    add_to<Dim * Dim, Width>(turned, values + std::int64_t{kTurnedBlock - place} * Dim * Dim);
}

// Where one of two nodes is held: its known displacement, times the block, goes to the right side
// of the other.
template <int Dim, typename Scalar>
void scatter_held_block(const Scalar (&entries)[Dim * Dim],
                        const Group<Dim>& group,
                        int lane,
                        int row,
                        int column,
                        const HessianTarget<Scalar>& target) {
    const bool is_turned = group.dof(row, lane) >= group.dof_count;
    const int known = is_turned ? row : column;
    const std::uint32_t dof = group.dof(is_turned ? column : row, lane);
    if (target.prescribed_displacement == nullptr || dof >= group.dof_count) {
        return;
    }
    const double* displacement =
        target.prescribed_displacement + std::int64_t{Dim} * group.vertices[known * kGroup + lane];
    double* right = target.right + std::int64_t{Dim} * dof;
    for (int i = 0; i < Dim; ++i) {
        for (int j = 0; j < Dim; ++j) {
            const Scalar value =
                entries[is_turned ? block_entry<Dim>(j, i) : block_entry<Dim>(i, j)];
            right[i] -= static_cast<double>(value) * displacement[j];
        }
    }
}

// Sums the blocks of a pack of elements over their points, node by node, and adds them to the
// matrix.
template <int Dim, typename Real, typename Scalar>
void scatter_quadratic(const QuadraticHessian<Real, Dim>& hessian,
                       const Group<Dim>& group,
                       int first_lane,
                       const HessianTarget<Scalar>& target) {
    constexpr int kWidth = Lanes<Real>::kCount;
    constexpr const QuadraticRule<Dim>& kRule = kQuadraticRule<Dim>;
    const int lanes = group.elements - first_lane < kWidth ? group.elements - first_lane : kWidth;
    BlockTile<Real, Scalar, Dim> tile;
    NodeRows<Real, Dim> rows;
    for (int n = 0; n < kQuadraticNodes<Dim>; ++n) {
        rows_of_node(hessian, kRule.first[n], kRule.second[n], rows);
        for (int m = n; m < kQuadraticNodes<Dim>; ++m) {
            Tensor<Real, Dim> block = block_of_nodes(rows, kRule.first[m], kRule.second[m]);
            for (int i = 0; hessian.has_mean && i < Dim; ++i) {
                for (int j = 0; j < Dim; ++j) {
                    block[i][j] += hessian.mean_stiffness * hessian.swelling.at[n].at[i]
                                   * hessian.swelling.at[m].at[j];
                }
            }
            store_block(block, m == n, tile.packed);
            transpose<Dim * Dim, kWidth>(tile.packed, tile.entries[0]);
            const std::int32_t* places =
                row_of_blocks(group, n) + std::int64_t{m - n} * kGroup + first_lane;
            for (int l = 0; l < lanes; ++l) {
                if (places[l] != kNoBlock) {
                    scatter_block<Dim, kWidth>(tile.entries[0][l], places[l], target.values);
                } else {
                    scatter_held_block(tile.entries[0][l], group, first_lane + l, n, m, target);
                }
            }
        }
    }
}

template <int Dim, typename Real, typename Scalar>
std::int64_t add_quadratic_hessian(const ElementRun& run,
                                   const double* positions,
                                   const HessianTarget<Scalar>& target) {
    using Number = typename Lanes<Real>::Number;
    constexpr int kWidth = Lanes<Real>::kCount;
    const int groups = (run.elements + kGroup - 1) / kGroup;
    const Real scale = Real(static_cast<Number>(target.scale));
    GroupNodes<Dim> nodes;
    Edges<Dim> edges[kQuadraticPoints<Dim>];
    PointStates<Real, Dim> states;
    QuadraticHessian<Real, Dim> hessian;
    std::int64_t filtered_elements = 0;
    for (int g = 0; g < groups; ++g) {
        const Group<Dim> group = group_at<Dim>(run, g);
        gather_nodes<Dim, (kWidth > 1)>(group, ReadAhead<Dim>(run, g), positions, nodes);
        for (int q = 0; q < kQuadraticPoints<Dim>; ++q) {
            edges_at(nodes, q, edges[q]);
        }
        for (int lane = 0; lane < group.elements; lane += kWidth) {
            deform_points(group, edges, run, lane, states);
            const Real volume = Lanes<Real>::load(group.volume + lane);
            filtered_elements += differentiate_points(states, run, target.filter, scale * volume,
                                                      group.elements - lane, hessian);
            scatter_quadratic<Dim>(hessian, group, lane, target);
        }
    }
    return filtered_elements;
}

}  // namespace
}  // namespace pent::simulator

// NOLINTEND(cppcoreguidelines-pro-type-member-init)
