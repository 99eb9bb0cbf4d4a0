#pragma once

#include "linear/block_matrix.h"
#include "linear/sharing.h"
#include "thread_ranks.h"

#include <algorithm>
#include <memory>
#include <numeric>
#include <vector>

namespace pent::simulator::test {

/// The rows that one rank has of a matrix whose dofs are shared out, each a column of its own.
struct CutMatrix {
    std::vector<std::uint32_t>
        dofs;  ///< Of each column, in the whole: its own, then those of others.
    std::vector<std::uint32_t> column_start = {0};
    BlockPattern pattern;
    std::unique_ptr<BlockMatrix<4, double>> A;
    Sharing sharing;
    Ghosts ghosts;
    std::unique_ptr<GhostExchange> exchange;

    /// @param owners  Of each dof.
    CutMatrix(const BlockMatrix<4, double>& whole,
              const std::vector<std::uint32_t>& owners,
              const std::shared_ptr<const Ranks>& ranks)
        : sharing(ranks, owners) {
        const auto rank = static_cast<std::uint32_t>(ranks->rank());
        dofs.resize(owners.size());
        std::iota(dofs.begin(), dofs.end(), 0U);
        std::stable_partition(dofs.begin(), dofs.end(),
                              [&](std::uint32_t dof) { return owners[dof] == rank; });
        for (std::uint32_t row = 0; row < sharing.own_count(0); ++row) {
            column_start.push_back(row + 1);
        }
        lay_out(whole.pattern());
        A = std::make_unique<BlockMatrix<4, double>>(pattern);
        for (std::uint32_t row = 0; row < pattern.rows(); ++row) {
            const std::uint32_t i = dofs[row];
            for (std::int64_t k = pattern.row_start[row]; k < pattern.row_start[row + 1]; ++k) {
                const std::uint32_t j = dofs[pattern.columns[static_cast<std::size_t>(k)]];
                const Eigen::Matrix4d block =
                    whole.block(whole.pattern().find(std::min(i, j), std::max(i, j)));
                A->set_block(k, i <= j ? block : Eigen::Matrix4d(block.transpose()));
            }
        }
        find_ghosts(owners);
        exchange = ranks->make_exchange(ghosts);
    }

    /// Own columns of a vector over all dofs, zero for others.
    [[nodiscard]] BlockVector<4> part(const BlockVector<4>& whole) const {
        BlockVector<4> own = BlockVector<4>::Zero(4, whole.cols());
        for (Eigen::Index column = 0; column < pattern.rows(); ++column) {
            own.col(column) = whole.col(dofs[static_cast<std::size_t>(column)]);
        }
        return own;
    }

private:
    void lay_out(const BlockPattern& whole) {
        std::vector<std::uint32_t> place(dofs.size());
        for (std::uint32_t column = 0; column < dofs.size(); ++column) {
            place[dofs[column]] = column;
        }
        const auto rows = static_cast<std::uint32_t>(column_start.back());
        std::vector<std::vector<std::uint32_t>> found(rows);
        for (std::uint32_t i = 0; i < dofs.size(); ++i) {
            for (std::int64_t k = whole.row_start[i]; k < whole.row_start[i + 1]; ++k) {
                const auto [row, column] =
                    std::minmax(place[i], place[whole.columns[static_cast<std::size_t>(k)]]);
                if (row < rows) {
                    found[row].push_back(column);
                }
            }
        }
        pattern.row_start.push_back(0);
        for (std::vector<std::uint32_t>& columns : found) {
            std::sort(columns.begin(), columns.end());
            pattern.columns.insert(pattern.columns.end(), columns.begin(), columns.end());
            pattern.row_start.push_back(static_cast<std::int64_t>(pattern.columns.size()));
        }
        pattern.is_cut.assign(rows, false);
        color_rows(pattern, static_cast<std::int64_t>(dofs.size()));
    }

    void find_ghosts(const std::vector<std::uint32_t>& owners) {
        std::vector<std::uint32_t> next(owners.size(), 0);  // of each rank
        std::vector<std::uint32_t> places;                  // of each dof, where it is at home
        for (const std::uint32_t owner : owners) {
            places.push_back(next[owner]++);
        }
        ghosts.own_columns = static_cast<std::uint32_t>(pattern.rows());
        ghosts.columns = ghost_columns(pattern);
        for (const std::uint32_t ghost : ghosts.columns) {
            ghosts.owners.push_back(owners[dofs[ghost]]);
            ghosts.places.push_back(places[dofs[ghost]]);
        }
    }
};

}  // namespace pent::simulator::test
