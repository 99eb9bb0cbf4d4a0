#include "elements.h"

#include <pent/error.h>
#include <pent/simulator/energy.h>

#include <Eigen/LU>

#include <algorithm>
#include <array>
#include <limits>

namespace pent::simulator {

namespace {

constexpr int kChunkElements = 512;  // a multiple of kGroup
static_assert(kChunkElements % kGroup == 0);

template <int Dim>
using Corners = std::array<std::uint32_t, Dim + 1>;

// The corners of a cell by increasing unknown.
template <int Dim>
Corners<Dim> sorted_corners(const Simplices<Dim + 1>& cells,
                            Eigen::Index cell,
                            const Numbering& numbering) {
    Corners<Dim> corners;
    for (int a = 0; a <= Dim; ++a) {
        corners[static_cast<std::size_t>(a)] = cells(a, cell);
    }
    std::sort(corners.begin(), corners.end(), [&](std::uint32_t a, std::uint32_t b) {
        return numbering.unknown_of_vertex[a] < numbering.unknown_of_vertex[b];
    });
    return corners;
}

// Cells of a range with a free corner, by their lowest unknown, so that neighbors are close.
template <int Dim>
std::vector<Eigen::Index> elastic_cells(const Simplices<Dim + 1>& cells,
                                        const CellRange& range,
                                        const Numbering& numbering) {
    std::vector<std::pair<std::uint32_t, Eigen::Index>> keyed;
    for (Eigen::Index cell = range.begin; cell < range.end; ++cell) {
        const std::uint32_t lowest =
            numbering.unknown_of_vertex[sorted_corners<Dim>(cells, cell, numbering)[0]];
        if (lowest < numbering.free_count()) {
            keyed.emplace_back(lowest, cell);
        }
    }
    std::sort(keyed.begin(), keyed.end());
    std::vector<Eigen::Index> chosen;
    chosen.reserve(keyed.size());
    for (const auto& [lowest, cell] : keyed) {
        chosen.push_back(cell);
    }
    return chosen;
}

}  // namespace

template <int Dim>
Elements<Dim>::Elements(const Positions<Dim>& rest,
                        const Simplices<Dim + 1>& cells,
                        const std::vector<CellRange>& ranges,
                        const Numbering& numbering,
                        const BlockPattern& pattern)
    : free_unknowns_(numbering.free_count()) {
    if (pattern.blocks() > std::numeric_limits<std::int32_t>::max()) {
        throw Error("the mesh has " + std::to_string(pattern.blocks())
                    + " matrix blocks; at most 2147483647 can be simulated");
    }
    for (const CellRange& range : ranges) {
        const double scale = collapse_scale(range.material, Dim);
        const std::vector<Eigen::Index> chosen = elastic_cells<Dim>(cells, range, numbering);
        count_ += static_cast<std::int64_t>(chosen.size());
        for (std::size_t first = 0; first < chosen.size(); first += kChunkElements) {
            const std::size_t last = std::min(first + kChunkElements, chosen.size());
            const auto group =
                static_cast<std::int64_t>(rest_.size() / (std::size_t{Dim * Dim + 1} * kGroup));
            chunks_.push_back(
                {group, static_cast<int>(last - first), range.material, Dim * scale * scale});
            append(rest, cells,
                   {chosen.begin() + static_cast<std::ptrdiff_t>(first),
                    chosen.begin() + static_cast<std::ptrdiff_t>(last)},
                   numbering, pattern);
        }
    }
    coloring_ = color_chunks(
        static_cast<int>(chunks_.size()), rest.cols(), [&](int chunk, const auto& touch) {
            const Chunk& c = chunks_[static_cast<std::size_t>(chunk)];
            const int groups = (c.elements + kGroup - 1) / kGroup;
            const std::int64_t first = c.first_group * (Dim + 1) * kGroup;
            const std::int64_t last = first + std::int64_t{groups} * (Dim + 1) * kGroup;
            for (std::int64_t i = first; i < last; ++i) {
                touch(vertices_[static_cast<std::size_t>(i)]);
            }
        });
}

template <int Dim>
void Elements<Dim>::append(const Positions<Dim>& rest,
                           const Simplices<Dim + 1>& cells,
                           const std::vector<Eigen::Index>& chosen,
                           const Numbering& numbering,
                           const BlockPattern& pattern) {
    constexpr std::size_t kRestRows = Dim * Dim + 1;
    const std::size_t groups = (chosen.size() + kGroup - 1) / kGroup;
    for (std::size_t group = 0; group < groups; ++group) {
        const std::size_t rest_at = rest_.size();
        const std::size_t corners_at = vertices_.size();
        const std::size_t blocks_at = blocks_.size();
        rest_.resize(rest_at + kRestRows * kGroup);
        vertices_.resize(corners_at + (Dim + 1) * kGroup);
        unknowns_.resize(corners_at + (Dim + 1) * kGroup);
        blocks_.resize(blocks_at + kPairs<Dim> * kGroup, -1);
        for (std::size_t lane = 0; lane < kGroup; ++lane) {
            const std::size_t element = group * kGroup + lane;
            const bool is_padding = element >= chosen.size();
            const Eigen::Index cell = chosen[is_padding ? chosen.size() - 1 : element];
            const Corners<Dim> corners = sorted_corners<Dim>(cells, cell, numbering);
            Eigen::Matrix<double, Dim, Dim> Dm;
            for (int a = 0; a < Dim; ++a) {
                Dm.col(a) =
                    rest.col(corners[static_cast<std::size_t>(a) + 1]) - rest.col(corners[0]);
            }
            const Eigen::Matrix<double, Dim, Dim> inverse = Dm.inverse();
            for (int i = 0; i < Dim * Dim; ++i) {
                rest_[rest_at + static_cast<std::size_t>(i) * kGroup + lane] =
                    inverse(i / Dim, i % Dim);
            }
            rest_[rest_at + std::size_t{Dim * Dim} * kGroup + lane] =
                is_padding ? 0 : cell_volume<Dim>(rest, cells, cell);
            std::size_t pair = 0;
            for (std::size_t a = 0; a <= Dim; ++a) {
                const std::uint32_t row = numbering.unknown_of_vertex[corners[a]];
                vertices_[corners_at + a * kGroup + lane] = corners[a];
                unknowns_[corners_at + a * kGroup + lane] = row;
                for (std::size_t b = a; b <= Dim; ++b, ++pair) {
                    const std::uint32_t column = numbering.unknown_of_vertex[corners[b]];
                    if (column < numbering.free_count()) {
                        blocks_[blocks_at + pair * kGroup + lane] =
                            static_cast<std::int32_t>(pattern.find(row, column));
                    }
                }
            }
        }
    }
}

template <int Dim>
ElementRun Elements<Dim>::run(int chunk) const {
    const Chunk& c = chunks_[static_cast<std::size_t>(chunk)];
    return {.model = c.material.model,
            .mu = c.material.lame.mu,
            .lambda = c.material.lame.lambda,
            .collapse_norm = c.collapse_norm,
            .elements = c.elements,
            .rest = rest_.data() + c.first_group * (Dim * Dim + 1) * kGroup,
            .vertices = vertices_.data() + c.first_group * (Dim + 1) * kGroup,
            .unknowns = unknowns_.data() + c.first_group * (Dim + 1) * kGroup,
            .blocks = blocks_.data() + c.first_group * kPairs<Dim> * kGroup,
            .free_unknowns = free_unknowns_};
}

template <int Dim>
RunEnergy Elements<Dim>::add_forces(const Workers& workers,
                                    const Kernels<Dim>& kernels,
                                    const Positions<Dim>& positions,
                                    Positions<Dim>& forces) const {
    std::vector<RunEnergy> parts(chunks_.size());
    for (const std::vector<int>& color : coloring_.colors) {
        workers.for_each(static_cast<int>(color.size()), [&](int i) {
            const int chunk = color[static_cast<std::size_t>(i)];
            parts[static_cast<std::size_t>(chunk)] =
                kernels.forces(run(chunk), positions.data(), forces.data());
        });
    }
    RunEnergy total;
    for (const RunEnergy& part : parts) {
        total.energy += part.energy;
        total.inverted += part.inverted;
        total.collapsed += part.collapsed;
    }
    return total;
}

template <int Dim>
template <typename Scalar>
std::int64_t Elements<Dim>::add_hessian(const Workers& workers,
                                        const Kernels<Dim>& kernels,
                                        const Positions<Dim>& positions,
                                        double scale,
                                        Filter filter,
                                        const Positions<Dim>& held_shift,
                                        BlockMatrix<Dim, Scalar>& matrix,
                                        BlockVector<Dim>& right) const {
    const HessianTarget<Scalar> target{.values = matrix.values(),
                                       .scale = scale,
                                       .filter = filter,
                                       .held_shift = held_shift.data(),
                                       .right = right.data()};
    std::int64_t filtered = 0;
    for (const std::vector<int>& color : coloring_.colors) {
        filtered += workers.sum(static_cast<int>(color.size()), [&](int i) {
            const ElementRun elements = run(color[static_cast<std::size_t>(i)]);
            if constexpr (sizeof(Scalar) == sizeof(float)) {
                return kernels.hessian_float(elements, positions.data(), target);
            } else {
                return kernels.hessian_double(elements, positions.data(), target);
            }
        });
    }
    return filtered;
}

template <int Dim>
std::int64_t Elements<Dim>::bytes() const {
    return static_cast<std::int64_t>(rest_.size() * sizeof(double)
                                     + (vertices_.size() + unknowns_.size() + blocks_.size())
                                           * sizeof(std::uint32_t));
}

template class Elements<3>;
template class Elements<4>;
#define PENT_INSTANTIATE(Dim, Scalar)                                               \
    template std::int64_t Elements<Dim>::add_hessian<Scalar>(                       \
        const Workers&, const Kernels<Dim>&, const Positions<Dim>&, double, Filter, \
        const Positions<Dim>&, BlockMatrix<Dim, Scalar>&, BlockVector<Dim>&) const;
PENT_INSTANTIATE(3, float)
PENT_INSTANTIATE(3, double)
PENT_INSTANTIATE(4, float)
PENT_INSTANTIATE(4, double)
#undef PENT_INSTANTIATE

}  // namespace pent::simulator
