#pragma once

#include "kernels/kernel_elements.h"

// Hessians of linear simplices, an element a lane.

// NOLINTBEGIN(cppcoreguidelines-pro-type-member-init): see kernel_elements.h

namespace pent::simulator {
namespace {  // NOLINT(google-build-namespaces): see kernel_lanes.h

// One block of a pack of elements: [block_entry(row, column)][lane].
template <typename Real, int Dim>
using BlockLanes = typename Lanes<Real>::Number[Dim * Dim][Lanes<Real>::kCount];

// All blocks of one pack of elements.
template <typename Real, int Dim>
struct BlockPack {
    alignas(64) BlockLanes<Real, Dim> at[kPairs<Dim>];
};

// Place of the pair (a, b), a <= b, in the order (0,0) (0,1) .. (0,Dim) (1,1) ..
template <int Dim>
constexpr int pair_index(int a, int b) {
    return a * (Dim + 1) - a * (a - 1) / 2 + b - a;
}

// The filtered Hessian of an element in the frame of its singular vectors, see Spectrum. It is
// never formed as a Dim^2 x Dim^2 matrix: with beta_a = V^T b_a, b_a being the rest gradient of
// corner a, block (a, b) is U K U^T, where
//   K_ik = stretch_ik beta_ai beta_bk + swap_ik beta_ak beta_bi                 (i != k)
//   K_ii = stretch_ii beta_ai beta_bi + sum over j != i of keep_ij beta_aj beta_bj
// and keep = (flip + twist) / 2, swap = (flip - twist) / 2.
template <typename Real, int Dim>
struct RotatedHessian {
    Tensor<Real, Dim> U;
    Tensor<Real, Dim> stretch;
    Tensor<Real, Dim> keep;
    Tensor<Real, Dim> swap;
    Tensor<Real, Dim> beta;  // row a - 1: beta of corner a
    Real is_filtered;        // 1 in lanes that the filter changed, else 0
};

template <typename Real, int Dim>
RotatedHessian<Real, Dim> rotated_hessian(const Tensor<Real, Dim>& F,
                                          const Tensor<Real, Dim>& rest,
                                          const Moduli& moduli,
                                          Filter filter,
                                          const Real& mean_pressure) {
    using Number = typename Lanes<Real>::Number;
    SignedSvd<Real, Dim> svd;
    if (moduli.model == Model::Linear) {  // does not depend on F: any frame will do
        svd.U = identity<Real, Dim>();
        svd.turned_rest = rest;
        for (int i = 0; i < Dim; ++i) {
            svd.sigma[i] = Real(Number(1));
        }
    } else {
        svd = signed_svd(F, rest);
    }
    const Spectrum<Real, Dim> spectrum = spectrum_of(svd.sigma, moduli, mean_pressure);
    RotatedHessian<Real, Dim> hessian;
    hessian.U = svd.U;
    hessian.beta = svd.turned_rest;
    hessian.is_filtered = Real(Number(0));
    hessian.stretch = filtered(spectrum.stretch, filter, hessian.is_filtered);
    for (int i = 0; i < Dim; ++i) {
        for (int j = i + 1; j < Dim; ++j) {
            const Real flip = filtered(spectrum.flip[i][j], filter, hessian.is_filtered);
            const Real twist = filtered(spectrum.twist[i][j], filter, hessian.is_filtered);
            hessian.keep[i][j] = Real(Number(0.5)) * (twist + flip);
            hessian.keep[j][i] = hessian.keep[i][j];
            hessian.swap[i][j] = Real(Number(0.5)) * (flip - twist);
            hessian.swap[j][i] = hessian.swap[i][j];
        }
    }
    return hessian;
}

// Computes block (a, b) row by row and passes each entry to take(i, j, entry): so K stays in
// registers, and only what is needed is stored.
//
// @param IsSymmetric  The block of a corner with itself: take() gets its upper triangle only.
template <bool IsSymmetric, typename Real, int Dim, typename Take>
[[gnu::always_inline]] inline void hessian_block(const RotatedHessian<Real, Dim>& hessian,
                                                 const Real (&beta_a)[Dim],
                                                 const Real (&beta_b)[Dim],
                                                 const Take& take) {
    Tensor<Real, Dim> K;
    for (int i = 0; i < Dim; ++i) {
        Real sum = hessian.stretch[i][i] * (beta_a[i] * beta_b[i]);
        for (int j = 0; j < Dim; ++j) {
            if (j != i) {
                sum += hessian.keep[i][j] * (beta_a[j] * beta_b[j]);
                K[i][j] = hessian.stretch[i][j] * (beta_a[i] * beta_b[j])
                          + hessian.swap[i][j] * (beta_a[j] * beta_b[i]);
            }
        }
        K[i][i] = sum;
    }
#pragma GCC unroll 4
    for (int i = 0; i < Dim; ++i) {
        Real left[Dim];  // row i of U K
        for (int j = 0; j < Dim; ++j) {
            left[j] = hessian.U[i][0] * K[0][j];
            for (int k = 1; k < Dim; ++k) {
                left[j] += hessian.U[i][k] * K[k][j];
            }
        }
#pragma GCC unroll 4
        for (int j = IsSymmetric ? i : 0; j < Dim; ++j) {
            Real sum = left[0] * hessian.U[j][0];
            for (int k = 1; k < Dim; ++k) {
                sum += left[k] * hessian.U[j][k];
            }
            take(i, j, sum);
        }
    }
}

// Stores an entry of a block in the order of block_order.h; symmetric blocks are given their upper
// triangle, and are symmetric to the bit.
template <bool IsSymmetric, int Dim, typename Real>
[[gnu::always_inline]] inline void store_entry(const Real& entry,
                                               int i,
                                               int j,
                                               BlockLanes<Real, Dim>& block) {
    if (!IsSymmetric || i <= j) {
        Lanes<Real>::store(entry, block[block_entry<Dim>(i, j)]);
    }
    if (IsSymmetric && i < j) {
        Lanes<Real>::store(entry, block[block_entry<Dim>(j, i)]);
    }
}

template <typename Real, int Dim>
void store_block(const Tensor<Real, Dim>& block, bool is_symmetric, BlockLanes<Real, Dim>& stored) {
    for (int i = 0; i < Dim; ++i) {
        for (int j = 0; j < Dim; ++j) {
            if (is_symmetric) {
                store_entry<true, Dim>(block[i][j], i, j, stored);
            } else {
                store_entry<false, Dim>(block[i][j], i, j, stored);
            }
        }
    }
}

// The entry (i, j) of block (a, b) that has been stored, of either triangle.
template <typename Real, int Dim>
Real stored_entry(const BlockPack<Real, Dim>& pack, int a, int b, int i, int j) {
    return Lanes<Real>::load_stored(a <= b
                                        ? pack.at[pair_index<Dim>(a, b)][block_entry<Dim>(i, j)]
                                        : pack.at[pair_index<Dim>(b, a)][block_entry<Dim>(j, i)]);
}

// All pairs of corners. Rest gradients add up to zero, so the blocks of corner 0 follow from the
// others: K_0b = - sum over a >= 1 of K_ab.
template <typename Real, int Dim>
void hessian_blocks(const RotatedHessian<Real, Dim>& hessian,
                    const Real& scale,
                    BlockPack<Real, Dim>& pack) {
    for (int a = 1; a <= Dim; ++a) {
        Real beta_a[Dim];
        for (int i = 0; i < Dim; ++i) {
            beta_a[i] = scale * hessian.beta[a - 1][i];
        }
        auto& diagonal = pack.at[pair_index<Dim>(a, a)];
        hessian_block<true>(hessian, beta_a, hessian.beta.at[a - 1],
                            [&](int i, int j, const Real& entry) {
                                store_entry<true, Dim>(entry, i, j, diagonal);
                            });
        for (int b = a + 1; b <= Dim; ++b) {
            auto& block = pack.at[pair_index<Dim>(a, b)];
            hessian_block<false>(hessian, beta_a, hessian.beta.at[b - 1],
                                 [&](int i, int j, const Real& entry) {
                                     store_entry<false, Dim>(entry, i, j, block);
                                 });
        }
    }
    for (int i = 0; i < Dim; ++i) {
        for (int j = 0; j < Dim; ++j) {
            Real of_corner_0 = Real(typename Lanes<Real>::Number(0));
            for (int b = 1; b <= Dim; ++b) {
                Real sum = stored_entry(pack, 1, b, i, j);
                for (int a = 2; a <= Dim; ++a) {
                    sum += stored_entry(pack, a, b, i, j);
                }
                store_entry<false, Dim>(-sum, i, j, pack.at[pair_index<Dim>(0, b)]);
                of_corner_0 += sum;
            }
            store_entry<true, Dim>(of_corner_0, i, j, pack.at[0]);
        }
    }
}

// Adds the blocks of a pack to the matrix, element by element: consecutive elements share blocks,
// and adding to the same one twice in a row would wait for the first addition. With each a block of
// the next group is prefetched, as a matrix is too large for the caches.
template <int Dim, typename Real, typename Scalar>
void scatter_blocks(const BlockPack<Real, Dim>& pack,
                    const Group<Dim>& group,
                    const Group<Dim>& next,
                    int first_lane,
                    Scalar* values) {
    constexpr int kEntries = Dim * Dim;
    constexpr int kWidth = Lanes<Real>::kCount;
    const int lanes = group.elements - first_lane < kWidth ? group.elements - first_lane : kWidth;
    alignas(64) Scalar entries[kPairs<Dim>][kWidth][kEntries];
    for (int pair = 0; pair < kPairs<Dim>; ++pair) {
        transpose<kEntries, kWidth>(pack.at[pair], entries[pair]);
    }
    for (int l = 0; l < lanes; ++l) {
        for (int pair = 0; pair < kPairs<Dim>; ++pair) {
            const int place = pair * kGroup + first_lane + l;
            const std::int64_t soon = next.blocks[place] < 0 ? 0 : next.blocks[place];
            __builtin_prefetch(values + soon * kEntries, 1);
            const std::int32_t block = group.blocks[place];
            if (block >= 0) {
                add_to<kEntries, kWidth>(entries[pair][l], values + std::int64_t{block} * kEntries);
            }
        }
    }
}

// Moves the columns of held corners, whose displacement is known, to the right side. They are last
// among the corners, so that blocks (a, b), a < b, are all there are.
template <int Dim, typename Real, typename Scalar>
void scatter_held(const BlockPack<Real, Dim>& pack,
                  const Group<Dim>& group,
                  int first_lane,
                  const HessianTarget<Scalar>& target) {
    for (int l = 0; l < Lanes<Real>::kCount && first_lane + l < group.elements; ++l) {
        const int lane = first_lane + l;
        for (int b = 1; b <= Dim; ++b) {
            if (group.dof(b, lane) < group.dof_count) {
                continue;
            }
            const double* displacement = target.prescribed_displacement
                                         + std::int64_t{Dim} * group.vertices[b * kGroup + lane];
            for (int a = 0; a < b; ++a) {
                const std::uint32_t row = group.dof(a, lane);
                if (row >= group.dof_count) {
                    continue;
                }
                const auto& block = pack.at[pair_index<Dim>(a, b)];
                double* right = target.right + std::int64_t{Dim} * row;
                for (int i = 0; i < Dim; ++i) {
                    for (int j = 0; j < Dim; ++j) {
                        right[i] -=
                            static_cast<double>(block[block_entry<Dim>(i, j)][l]) * displacement[j];
                    }
                }
            }
        }
    }
}

// How many of the first `lanes` lanes are marked by 1.
template <typename Real>
int count_marked(const Real& marks, int lanes) {
    using Number = typename Lanes<Real>::Number;
    if (!Lanes<Real>::any(marks > Real(Number(0)))) {
        return 0;
    }
    int count = 0;
    for (int lane = 0; lane < lanes && lane < Lanes<Real>::kCount; ++lane) {
        count += Lanes<Real>::lane(marks, lane) > Number(0) ? 1 : 0;
    }
    return count;
}

template <int Dim, typename Real, typename Scalar>
std::int64_t add_hessian(const ElementRun& run,
                         const double* positions,
                         const HessianTarget<Scalar>& target) {
    using Number = typename Lanes<Real>::Number;
    constexpr int kWidth = Lanes<Real>::kCount;
    const Moduli moduli = moduli_of<Dim>(run);
    const int groups = (run.elements + kGroup - 1) / kGroup;
    const Real scale = Real(static_cast<Number>(target.scale));
    Edges<Dim> edges;
    BlockPack<Real, Dim> pack;
    std::int64_t filtered_elements = 0;
    for (int g = 0; g < groups; ++g) {
        const Group<Dim> group = group_at<Dim>(run, g);
        const Group<Dim> next = group_ahead<Dim>(run, g, 1);
        gather_edges<Dim, (kWidth > 1)>(group, ReadAhead<Dim, true>(run, g), positions, edges);
        bool has_held = false;
        for (int lane = 0; lane < group.elements; ++lane) {  // the last corner is held if any is
            has_held = has_held || group.dof(Dim, lane) >= group.dof_count;
        }
        for (int lane = 0; lane < group.elements; lane += kWidth) {
            const Tensor<Real, Dim> rest = load_rest<Real>(group, lane);
            const Real volume = Lanes<Real>::load(group.volume + lane);
            const Tensor<Real, Dim> F = deformation(edges, rest, lane);
            const RotatedHessian<Real, Dim> hessian =
                rotated_hessian(F, rest, moduli, target.filter, Real(Number(0)));
            filtered_elements += count_marked(hessian.is_filtered, group.elements - lane);
            hessian_blocks(hessian, scale * volume, pack);
            scatter_blocks(pack, group, next, lane, target.values);
            if (has_held && target.prescribed_displacement != nullptr) {
                scatter_held(pack, group, lane, target);
            }
        }
    }
    return filtered_elements;
}

}  // namespace
}  // namespace pent::simulator

// NOLINTEND(cppcoreguidelines-pro-type-member-init)
