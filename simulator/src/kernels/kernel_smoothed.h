#pragma once

#include "kernels/kernel_hessian.h"

// Forces and Hessians of elements with any number of corners, an element a lane: the domains of
// smoothing.h. As they have many corners, a group goes through them one by one.

// Tensors of lanes are filled entry by entry right after they are declared; zeroing them first
// would cost as much as using them. NOLINTBEGIN(cppcoreguidelines-pro-type-member-init)

namespace pent::simulator {
namespace {  // NOLINT(google-build-namespaces): see kernel_lanes.h

template <typename Real>
inline constexpr int kPacks = kGroup / Lanes<Real>::kCount;

template <typename Real, int Dim>
struct Vector {
    Real at[Dim];
};

// The rest gradient of a corner other than the first.
template <typename Real, int Dim>
Vector<Real, Dim> load_gradient(const Group<Dim>& group, int corner, int lane) {
    const double* rows = group.rest + std::int64_t{corner - 1} * Dim * kGroup + lane;
    Vector<Real, Dim> gradient;
    for (int j = 0; j < Dim; ++j) {
        gradient.at[j] = Lanes<Real>::load(rows + std::int64_t{j} * kGroup);
    }
    return gradient;
}

// A tensor for every element of a group.
template <typename Real, int Dim>
struct GroupTensor {
    Tensor<Real, Dim> of_pack[kPacks<Real>];
};

// F = sum over corners a > 0 of (x_a - x_0) g_a^T.
template <typename Real, int Dim>
void deform_group(const Group<Dim>& group,
                  const ReadAhead<Dim>& ahead,
                  const double* positions,
                  GroupTensor<Real, Dim>& F) {
    using Number = typename Lanes<Real>::Number;
    for (Tensor<Real, Dim>& tensor : F.of_pack) {
        for (int i = 0; i < Dim; ++i) {
            for (int j = 0; j < Dim; ++j) {
                tensor[i][j] = Real(Number(0));
            }
        }
    }
    alignas(64) double edge[Dim][kGroup];
    ahead.bring(0);
    for (int a = 1; a < group.corners; ++a) {
        gather_edge<Dim, (Lanes<Real>::kCount > 1)>(group, a, positions, edge);
        ahead.bring(a);
        for (int pack = 0; pack < kPacks<Real>; ++pack) {
            const int lane = pack * Lanes<Real>::kCount;
            const Vector<Real, Dim> gradient = load_gradient<Real>(group, a, lane);
            for (int i = 0; i < Dim; ++i) {
                const Real along = Lanes<Real>::load(edge[i] + lane);
                for (int j = 0; j < Dim; ++j) {
                    F.of_pack[pack][i][j] += along * gradient.at[j];
                }
            }
        }
    }
}

// Adds part[axis][lane] to one corner of every element.
template <int Dim, bool IsVectorized>
void add_to_corner(const Group<Dim>& group,
                   int corner,
                   const double (&part)[Dim][kGroup],
                   double* gradient) {
    using Tile = VertexTile<Dim, IsVectorized>;
    for (int lane = 0; lane < group.elements; lane += Tile::kCount) {
        Tile parts;
        parts.load(part, lane);
        for (int k = 0; k < Tile::kCount && lane + k < group.elements; ++k) {
            const std::int64_t vertex = group.vertices[corner * kGroup + lane + k];
            add_to_vertex(parts.at[k], gradient + Dim * vertex);
        }
    }
}

// Adds P g_a to every corner; `pull` is P times the volume.
template <typename Real, int Dim>
void scatter_pull(const Group<Dim>& group, const GroupTensor<Real, Dim>& pull, double* gradient) {
    constexpr bool kIsVectorized = Lanes<Real>::kCount > 1;
    alignas(64) double part[Dim][kGroup];
    alignas(64) double first[Dim][kGroup] = {};
    for (int a = 1; a < group.corners; ++a) {
        for (int pack = 0; pack < kPacks<Real>; ++pack) {
            const int lane = pack * Lanes<Real>::kCount;
            const Vector<Real, Dim> rest = load_gradient<Real>(group, a, lane);
            for (int i = 0; i < Dim; ++i) {
                Real sum = pull.of_pack[pack][i][0] * rest.at[0];
                for (int j = 1; j < Dim; ++j) {
                    sum += pull.of_pack[pack][i][j] * rest.at[j];
                }
                Lanes<Real>::store(sum, part[i] + lane);
                Lanes<Real>::store(Lanes<Real>::load(first[i] + lane) - sum, first[i] + lane);
            }
        }
        add_to_corner<Dim, kIsVectorized>(group, a, part, gradient);
    }
    add_to_corner<Dim, kIsVectorized>(group, 0, first, gradient);
}

template <int Dim, typename Real>
RunEnergy add_smoothed_gradient(const ElementRun& run, const double* positions, double* gradient) {
    const Moduli moduli = moduli_of<Dim>(run);
    const int groups = (run.elements + kGroup - 1) / kGroup;
    RunEnergy total;
    GroupTensor<Real, Dim> F;
    GroupTensor<Real, Dim> pull;
    GroupEnergies energies;
    for (int g = 0; g < groups; ++g) {
        const Group<Dim> group = group_at<Dim>(run, g);
        deform_group(group, ReadAhead<Dim>(run, g), positions, F);
        for (int pack = 0; pack < kPacks<Real>; ++pack) {
            const int lane = pack * Lanes<Real>::kCount;
            const Real volume = Lanes<Real>::load(group.volume + lane);
            const Stress<Real, Dim> stress = stress_of(F.of_pack[pack], moduli);
            for (int i = 0; i < Dim; ++i) {
                for (int j = 0; j < Dim; ++j) {
                    pull.of_pack[pack][i][j] = volume * stress.P[i][j];
                }
            }
            energies.store(stress, volume, lane);
        }
        scatter_pull(group, pull, gradient);
        energies.add_to(total, group.elements, run.collapse_norm);
    }
    return total;
}

// Second derivatives of the energy by F: at[l][m][i][j] = d^2 / dF_il dF_jm for l <= m; those for
// l > m are their transposes.
template <typename Real, int Dim>
struct EnergyHessian {
    Tensor<Real, Dim> at[Dim][Dim];
};

template <typename Real, int Dim>
EnergyHessian<Real, Dim> energy_hessian(const RotatedHessian<Real, Dim>& hessian,
                                        const Real& scale) {
    EnergyHessian<Real, Dim> result;
    for (int l = 0; l < Dim; ++l) {
        Real beta[Dim];
        for (int i = 0; i < Dim; ++i) {
            beta[i] = scale * hessian.beta[l][i];
        }
        for (int m = l; m < Dim; ++m) {
            hessian_block<false>(
                hessian, beta, hessian.beta.at[m],
                [&](int i, int j, const Real& entry) { result.at[l][m][i][j] = entry; });
        }
    }
    return result;
}

// The Hessian contracted with the gradient of corner a, so that block (a, b) is the sum over m of
// at[m] g_bm.
template <typename Real, int Dim>
struct CornerHessian {
    Tensor<Real, Dim> at[Dim];
};

template <typename Real, int Dim>
CornerHessian<Real, Dim> corner_hessian(const EnergyHessian<Real, Dim>& hessian,
                                        const Vector<Real, Dim>& gradient) {
    CornerHessian<Real, Dim> result;
    for (int m = 0; m < Dim; ++m) {
        for (int i = 0; i < Dim; ++i) {
            for (int j = 0; j < Dim; ++j) {
                Real sum = gradient.at[0] * hessian.at[0][m][i][j];
                for (int l = 1; l < Dim; ++l) {
                    sum = Lanes<Real>::multiply_add(
                        gradient.at[l], l <= m ? hessian.at[l][m][i][j] : hessian.at[m][l][j][i],
                        sum);
                }
                result.at[m][i][j] = sum;
            }
        }
    }
    return result;
}

// Blocks of a corner `row` with corners `first`, `first` + 1 ..: `packed` has one in lanes,
// `entries` all of them element by element.
template <typename Real, typename Scalar, int Dim>
struct BlockTile {
    static constexpr int kMaxBlocks = 8;
    int row = 0;
    int first = 0;
    int count = 0;
    alignas(64) typename Lanes<Real>::Number packed[Dim * Dim][Lanes<Real>::kCount];
    alignas(64) Scalar entries[kMaxBlocks][Lanes<Real>::kCount][Dim * Dim];
};

// Prefetches the matrix blocks of one corner while those of the one before are computed.
template <int Dim, typename Scalar>
[[gnu::always_inline]] inline void prefetch_row(
    const Group<Dim>& group, int a, int lane, int lanes, const Scalar* values) {
    const std::int32_t* blocks = row_of_blocks(group, a) + lane;
    for (int b = a; b < group.corners; ++b, blocks += kGroup) {
        for (int l = 0; l < lanes; ++l) {
            const std::int64_t block = blocks[l] < 0 ? 0 : blocks[l];
            __builtin_prefetch(values + block * Dim * Dim, 1);
        }
    }
}

// Adds the blocks of a pack of elements to the matrix, and those of held corners, times their known
// displacement, to the right side.
template <int Dim, typename Real, typename Scalar>
void scatter_tile(const BlockTile<Real, Scalar, Dim>& tile,
                  const Group<Dim>& group,
                  int first_lane,
                  const HessianTarget<Scalar>& target) {
    constexpr int kEntries = Dim * Dim;
    constexpr int kWidth = Lanes<Real>::kCount;
    const std::int32_t* blocks =
        row_of_blocks(group, tile.row) + std::int64_t{tile.first - tile.row} * kGroup;
    for (int l = 0; l < kWidth && first_lane + l < group.elements; ++l) {
        const int lane = first_lane + l;
        for (int k = 0; k < tile.count; ++k) {
            const std::int32_t block = blocks[k * kGroup + lane];
            if (block >= 0) {
                add_to<kEntries, kWidth>(tile.entries[k][l],
                                         target.values + std::int64_t{block} * kEntries);
                continue;
            }
            const std::uint32_t row = group.dof(tile.row, lane);
            const int column = tile.first + k;
            if (target.prescribed_displacement == nullptr || row >= group.dof_count
                || group.dof(column, lane) < group.dof_count) {
                continue;
            }
            const double* displacement =
                target.prescribed_displacement
                + std::int64_t{Dim} * group.vertices[column * kGroup + lane];
            double* right = target.right + std::int64_t{Dim} * row;
            for (int i = 0; i < Dim; ++i) {
                for (int j = 0; j < Dim; ++j) {
                    right[i] -= static_cast<double>(tile.entries[k][l][block_entry<Dim>(i, j)])
                                * displacement[j];
                }
            }
        }
    }
}

// The rest gradient of the first corner, as those of all corners add up to zero.
template <typename Real, int Dim>
Vector<Real, Dim> first_gradient(const Group<Dim>& group, int lane) {
    using Number = typename Lanes<Real>::Number;
    Vector<Real, Dim> first;
    for (int j = 0; j < Dim; ++j) {
        first.at[j] = Real(Number(0));
    }
    for (int a = 1; a < group.corners; ++a) {
        const Vector<Real, Dim> gradient = load_gradient<Real>(group, a, lane);
        for (int j = 0; j < Dim; ++j) {
            first.at[j] -= gradient.at[j];
        }
    }
    return first;
}

template <int Dim, typename Real, typename Scalar>
void add_pack_hessian(const EnergyHessian<Real, Dim>& hessian,
                      const Group<Dim>& group,
                      int lane,
                      const HessianTarget<Scalar>& target) {
    using Tile = BlockTile<Real, Scalar, Dim>;
    Tile tile;
    const Vector<Real, Dim> first = first_gradient<Real>(group, lane);
    for (int a = 0; a < group.corners; ++a) {
        tile.row = a;
        if (a + 1 < group.corners) {
            prefetch_row(group, a + 1, lane, Lanes<Real>::kCount, target.values);
        }
        const CornerHessian<Real, Dim> row =
            corner_hessian(hessian, a == 0 ? first : load_gradient<Real>(group, a, lane));
        for (int b = a; b < group.corners; b += Tile::kMaxBlocks) {
            tile.first = b;
            tile.count =
                group.corners - b < Tile::kMaxBlocks ? group.corners - b : Tile::kMaxBlocks;
            for (int k = 0; k < tile.count; ++k) {
                const Vector<Real, Dim> gradient =
                    b + k == 0 ? first : load_gradient<Real>(group, b + k, lane);
                Tensor<Real, Dim> block;
                for (int i = 0; i < Dim; ++i) {
                    for (int j = 0; j < Dim; ++j) {
                        Real sum = row.at[0][i][j] * gradient.at[0];
                        for (int m = 1; m < Dim; ++m) {
                            sum += row.at[m][i][j] * gradient.at[m];
                        }
                        block[i][j] = sum;
                    }
                }
                store_block(block, b + k == a, tile.packed);
                transpose<Dim * Dim, Lanes<Real>::kCount>(tile.packed, tile.entries[k]);
            }
            scatter_tile(tile, group, lane, target);
        }
    }
}

template <int Dim, typename Real, typename Scalar>
std::int64_t add_smoothed_hessian(const ElementRun& run,
                                  const double* positions,
                                  const HessianTarget<Scalar>& target) {
    using Number = typename Lanes<Real>::Number;
    constexpr int kWidth = Lanes<Real>::kCount;
    const Moduli moduli = moduli_of<Dim>(run);
    const int groups = (run.elements + kGroup - 1) / kGroup;
    const Real scale = Real(static_cast<Number>(target.scale));
    GroupTensor<Real, Dim> F;
    std::int64_t filtered_elements = 0;
    for (int g = 0; g < groups; ++g) {
        const Group<Dim> group = group_at<Dim>(run, g);
        deform_group(group, ReadAhead<Dim>(run, g), positions, F);
        for (int lane = 0; lane < group.elements; lane += kWidth) {
            prefetch_row(group, 0, lane, kWidth, target.values);
            const Real volume = Lanes<Real>::load(group.volume + lane);
            const RotatedHessian<Real, Dim> rotated =
                rotated_hessian(F.of_pack[lane / kWidth], identity<Real, Dim>(), moduli,
                                target.filter, Real(Number(0)));
            filtered_elements += count_marked(rotated.is_filtered, group.elements - lane);
            const EnergyHessian<Real, Dim> hessian = energy_hessian(rotated, scale * volume);
            add_pack_hessian(hessian, group, lane, target);
        }
    }
    return filtered_elements;
}

}  // namespace
}  // namespace pent::simulator

// NOLINTEND(cppcoreguidelines-pro-type-member-init)
