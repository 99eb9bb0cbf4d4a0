#include "linear/stencil_assembly.h"

#include <pent/dimensions.h>

#include <algorithm>
#include <array>
#include <numeric>

namespace pent::simulator {

namespace {

// Rows are cut into at most this many chunks, as each has a table of all columns.
constexpr std::size_t kMaxChunks = 64;
constexpr std::size_t kMinRows = 32;

// A row of a stencil: that of one of its corners.
struct Incidence {
    std::uint32_t stencil = 0;
    std::uint32_t corner = 0;
};

// The rows of the matrix that stencils add to, ascending, and for each what adds to it, in the
// order of the stencils.
struct Incidences {
    std::vector<std::uint32_t> rows;
    std::vector<std::uint32_t> begin;  // rows.size() + 1 entries
    std::vector<Incidence> list;
};

Incidences list_by_rows(const DofMap& dofs, const std::vector<HessianStencil>& stencils) {
    std::vector<std::uint32_t> next(dofs.row_count() + std::size_t{1}, 0);
    const auto for_each = [&](const auto& visit) {
        for (std::uint32_t s = 0; s < stencils.size(); ++s) {
            for (std::int32_t i = 0; i < stencils[s].count; ++i) {
                const std::uint32_t vertex = stencils[s].vertices[i];
                if (vertex != kNoVertex && dofs.index_of(vertex) < dofs.row_count()) {
                    visit(dofs.dof_of(vertex), Incidence{s, static_cast<std::uint32_t>(i)});
                }
            }
        }
    };
    for_each([&](std::uint32_t row, const Incidence& /*at*/) { ++next[row + 1]; });
    Incidences incidences;
    for (std::uint32_t row = 0; row < dofs.row_count(); ++row) {
        if (next[row + 1] > 0) {
            incidences.rows.push_back(row);
            incidences.begin.push_back(next[row]);
        }
        next[row + 1] += next[row];
    }
    incidences.begin.push_back(next.back());
    incidences.list.resize(next.back());
    for_each([&](std::uint32_t row, const Incidence& at) { incidences.list[next[row]++] = at; });
    return incidences;
}

// Blocks of some rows that the fixed pattern has no place for.
template <int Dim, typename Scalar>
struct Leftover {
    std::vector<std::uint32_t> counts;  // one a row
    std::vector<std::uint32_t> columns;
    std::vector<Eigen::Matrix<Scalar, Dim, Dim>> blocks;
};

// Sums up one row after another: a sparse accumulator, whose slots are first the blocks of the
// fixed pattern, then those that it has no place for, as they turn up.
template <int Dim, typename Scalar>
class RowSum {
public:
    RowSum(const DofMap& dofs,
           const std::vector<HessianStencil>& stencils,
           const Positions<Dim>& displacement,
           BlockMatrix<Dim, Scalar>& matrix,
           BlockVector<Dim>& right)
        : dofs_(dofs),
          stencils_(stencils),
          displacement_(displacement),
          matrix_(matrix),
          right_(right),
          slots_(dofs.count(), 0) {}

    void add_row(std::uint32_t row,
                 const Incidence* begin,
                 const Incidence* end,
                 Leftover<Dim, Scalar>& leftover) {
        const BlockPattern& pattern = matrix_.pattern();
        const std::int64_t first = pattern.row_start[row];
        columns_.assign(pattern.columns.begin() + first,
                        pattern.columns.begin() + pattern.row_start[row + 1]);
        const std::size_t fixed = columns_.size();
        sums_.assign(fixed, Block::Zero());
        for (std::uint32_t slot = 0; slot < fixed; ++slot) {
            slots_[columns_[slot]] = slot + 1;
        }
        for (const Incidence* at = begin; at != end; ++at) {
            add(row, *at);
        }
        for (std::size_t slot = 0; slot < fixed; ++slot) {
            matrix_.add_to_block(first + static_cast<std::int64_t>(slot),
                                 sums_[slot].template cast<Scalar>());
        }
        take_leftover(fixed, leftover);
        for (const std::uint32_t column : columns_) {
            slots_[column] = 0;
        }
    }

private:
    using Block = Eigen::Matrix<double, Dim, Dim>;
    using Vectors = Eigen::Map<const Eigen::Matrix<double, Dim, Eigen::Dynamic>>;

    void add(std::uint32_t row, const Incidence& at) {
        const HessianStencil& stencil = stencils_[at.stencil];
        using Map = Eigen::Map<const Block, Eigen::Unaligned, Eigen::OuterStride<>>;
        const auto corner = static_cast<std::int32_t>(at.corner);
        if (stencil.weights != nullptr) {
            const Block weighted = (stencil.scale * stencil.weights[corner])
                                   * Map(stencil.numbers, Eigen::OuterStride<>(stencil.stride));
            add_blocks(row, stencil,
                       [&](std::int32_t j) -> Block { return stencil.weights[j] * weighted; });
        } else if (stencil.rank > 0) {
            const Vectors of_row = vectors_of(stencil, corner);
            for (std::int32_t k = 0; k < stencil.rank; ++k) {
                scaled_.col(k) = (stencil.scale * stencil.numbers[k]) * of_row.col(k);
            }
            add_blocks(row, stencil, [&](std::int32_t j) -> Block {
                const Vectors of_column = vectors_of(stencil, j);
                Block sum = Block::Zero();
                for (std::int32_t k = 0; k < stencil.rank; ++k) {
                    sum += scaled_.col(k) * of_column.col(k).transpose();
                }
                return sum;
            });
        } else {
            add_blocks(row, stencil, [&](std::int32_t j) -> Block {
                const double* first = stencil.numbers + std::ptrdiff_t{Dim} * j * stencil.stride
                                      + std::ptrdiff_t{Dim} * corner;
                return stencil.scale * Map(first, Eigen::OuterStride<>(stencil.stride));
            });
        }
    }

    [[nodiscard]] static Vectors vectors_of(const HessianStencil& stencil, std::int32_t corner) {
        const double* const first = stencil.numbers + stencil.rank;
        return {first + std::ptrdiff_t{Dim} * stencil.rank * corner, Dim, stencil.rank};
    }

    // Adds the blocks block(j) of a row with all corners j; those below the diagonal are not
    // computed.
    template <typename BlockOf>
    void add_blocks(std::uint32_t row, const HessianStencil& stencil, const BlockOf& block) {
        for (std::int32_t j = 0; j < stencil.count; ++j) {
            const std::uint32_t vertex = stencil.vertices[j];
            if (vertex == kNoVertex) {
                continue;
            }
            if (!dofs_.has_dof(vertex)) {
                right_.col(row) -= block(j) * displacement_.col(vertex);
                continue;
            }
            const std::uint32_t column = dofs_.dof_of(vertex);
            if (column >= row) {
                sums_[slot_of(column)] += block(j);
            }
        }
    }

    std::size_t slot_of(std::uint32_t column) {
        if (slots_[column] == 0) {
            columns_.push_back(column);
            sums_.push_back(Block::Zero());
            slots_[column] = static_cast<std::uint32_t>(columns_.size());
        }
        return slots_[column] - 1;
    }

    void take_leftover(std::size_t fixed, Leftover<Dim, Scalar>& leftover) {
        order_.resize(columns_.size() - fixed);
        std::iota(order_.begin(), order_.end(), fixed);
        std::sort(order_.begin(), order_.end(),
                  [&](std::size_t a, std::size_t b) { return columns_[a] < columns_[b]; });
        leftover.counts.push_back(static_cast<std::uint32_t>(order_.size()));
        for (const std::size_t slot : order_) {
            leftover.columns.push_back(columns_[slot]);
            leftover.blocks.push_back(sums_[slot].template cast<Scalar>());
        }
    }

    const DofMap& dofs_;
    const std::vector<HessianStencil>& stencils_;
    const Positions<Dim>& displacement_;
    BlockMatrix<Dim, Scalar>& matrix_;
    BlockVector<Dim>& right_;
    std::vector<std::uint32_t> slots_;    // by column: its slot + 1, or 0 for none
    std::vector<std::uint32_t> columns_;  // of each slot
    std::vector<Block> sums_;             // of each slot
    Eigen::Matrix<double, Dim, Dim * Dim> scaled_;
    std::vector<std::size_t> order_;
};

// Joins the leftovers of all chunks of rows into one matrix.
template <int Dim, typename Scalar>
std::unique_ptr<CouplingMatrix<Dim, Scalar>> join(const DofMap& dofs,
                                                  const std::vector<std::uint32_t>& rows,
                                                  const std::vector<Leftover<Dim, Scalar>>& parts) {
    std::vector<std::uint32_t> counts(dofs.row_count(), 0);
    std::size_t at = 0;
    std::size_t total = 0;
    for (const auto& part : parts) {
        for (const std::uint32_t count : part.counts) {
            counts[rows[at++]] = count;
            total += count;
        }
    }
    if (total == 0) {
        return nullptr;
    }
    BlockPattern pattern;
    pattern.columns.reserve(total + counts.size());
    pattern.row_start.reserve(counts.size() + 1);
    pattern.row_start.push_back(0);
    auto part = parts.begin();
    std::size_t next = 0;
    for (std::uint32_t row = 0; row < counts.size(); ++row) {
        pattern.columns.push_back(row);  // zeros: a pattern has all diagonal blocks
        for (std::uint32_t k = 0; k < counts[row]; ++k) {
            while (next == part->columns.size()) {
                ++part;
                next = 0;
            }
            pattern.columns.push_back(part->columns[next++]);
        }
        pattern.row_start.push_back(static_cast<std::int64_t>(pattern.columns.size()));
    }
    color_rows(pattern, dofs.count());
    auto coupling = std::make_unique<CouplingMatrix<Dim, Scalar>>(std::move(pattern));
    part = parts.begin();
    next = 0;
    for (std::uint32_t row = 0; row < counts.size(); ++row) {
        for (std::uint32_t k = 1; k <= counts[row]; ++k) {
            while (next == part->blocks.size()) {
                ++part;
                next = 0;
            }
            coupling->matrix.set_block(coupling->pattern.row_start[row] + k, part->blocks[next++]);
        }
    }
    return coupling;
}

}  // namespace

template <int Dim, typename Scalar>
std::unique_ptr<CouplingMatrix<Dim, Scalar>> assemble_stencils(
    const Workers& workers,
    const DofMap& dofs,
    const std::vector<HessianStencil>& stencils,
    const Positions<Dim>& displacement,
    BlockMatrix<Dim, Scalar>& matrix,
    BlockVector<Dim>& right) {
    if (stencils.empty()) {
        return nullptr;
    }
    const Incidences incidences = list_by_rows(dofs, stencils);
    const std::size_t rows = incidences.rows.size();
    const std::size_t size = std::max(kMinRows, (rows + kMaxChunks - 1) / kMaxChunks);
    std::vector<Leftover<Dim, Scalar>> parts((rows + size - 1) / size);
    workers.for_each(static_cast<int>(parts.size()), [&](int chunk) {
        RowSum<Dim, Scalar> sum(dofs, stencils, displacement, matrix, right);
        const std::size_t begin = static_cast<std::size_t>(chunk) * size;
        for (std::size_t i = begin; i < std::min(begin + size, rows); ++i) {
            sum.add_row(incidences.rows[i], incidences.list.data() + incidences.begin[i],
                        incidences.list.data() + incidences.begin[i + 1],
                        parts[static_cast<std::size_t>(chunk)]);
        }
    });
    return join<Dim, Scalar>(dofs, incidences.rows, parts);
}

#define PENT_INSTANTIATE(Dim, Scalar)                                                             \
    template std::unique_ptr<CouplingMatrix<Dim, Scalar>> assemble_stencils<Dim, Scalar>(         \
        const Workers&, const DofMap&, const std::vector<HessianStencil>&, const Positions<Dim>&, \
        BlockMatrix<Dim, Scalar>&, BlockVector<Dim>&);
PENT_FOR_EACH_DIMENSION(PENT_INSTANTIATE, float)
PENT_FOR_EACH_DIMENSION(PENT_INSTANTIATE, double)
#undef PENT_INSTANTIATE

}  // namespace pent::simulator
