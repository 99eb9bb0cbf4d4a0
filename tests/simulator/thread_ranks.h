#pragma once

#include "support/meeting_table.h"

#include <pent/simulator/ranks.h>

#include <Eigen/Cholesky>

#include <algorithm>
#include <functional>
#include <memory>
#include <numeric>
#include <utility>
#include <vector>

namespace pent::simulator::test {

using Table = pent::test::MeetingTable;

class TableExchange final : public GhostExchange {
public:
    TableExchange(Table& table, int rank, Ghosts ghosts)
        : table_(&table), rank_(rank), ghosts_(std::move(ghosts)) {}

    void update(double* values, int rows) override { copy(values, rows); }
    void update(float* values, int rows) override { copy(values, rows); }

private:
    template <typename Number>
    void copy(Number* values, int rows) {
        table_->meet(rank_, values, [&](const std::vector<const void*>& all) {
            for (std::size_t i = 0; i < ghosts_.columns.size(); ++i) {
                const auto* from = static_cast<const Number*>(all[ghosts_.owners[i]]);
                std::copy_n(from + std::ptrdiff_t{rows} * ghosts_.places[i], rows,
                            values + std::ptrdiff_t{rows} * ghosts_.columns[i]);
            }
        });
    }

    Table* table_;
    int rank_;
    Ghosts ghosts_;
};

/// Every rank has all of a matrix, and its dense factors.
class DenseSolver final : public SpreadSolver {
public:
    DenseSolver(std::unique_ptr<Ranks> ranks, const SpreadMatrix& matrix)
        : ranks_(std::move(ranks)), first_(matrix.first_row * matrix.block_size) {
        const Eigen::Index size = matrix.block_size;
        const auto rows = static_cast<double>(size * matrix.rows());
        const std::vector<double> all = ranks_->gather(
            {&rows, 1}, std::vector<std::int64_t>(static_cast<std::size_t>(ranks_->count()), 1));
        sizes_.assign(all.begin(), all.end());
        const auto total = std::accumulate(sizes_.begin(), sizes_.end(), Eigen::Index{0});
        // It is symmetric: rows of this rank are columns, which lie one behind the other.
        Eigen::MatrixXd own = Eigen::MatrixXd::Zero(total, size * matrix.rows());
        for (std::size_t row = 0; row + 1 < matrix.row_start.size(); ++row) {
            for (auto k = static_cast<std::size_t>(matrix.row_start[row]);
                 k < static_cast<std::size_t>(matrix.row_start[row + 1]); ++k) {
                own.block(size * matrix.columns[k], size * static_cast<Eigen::Index>(row), size,
                          size) =
                    Eigen::Map<const Eigen::MatrixXd>(
                        matrix.values.data() + k * static_cast<std::size_t>(size * size), size,
                        size);
            }
        }
        std::vector<std::int64_t> lengths;
        for (const std::int64_t numbers : sizes_) {
            lengths.push_back(numbers * total);
        }
        const std::vector<double> whole =
            ranks_->gather({own.data(), static_cast<std::size_t>(own.size())}, lengths);
        factors_.compute(Eigen::Map<const Eigen::MatrixXd>(whole.data(), total, total));
    }

    [[nodiscard]] Eigen::VectorXd solve(const Eigen::VectorXd& r) override {
        const std::vector<double> all =
            ranks_->gather({r.data(), static_cast<std::size_t>(r.size())}, sizes_);
        return factors_
            .solve(Eigen::Map<const Eigen::VectorXd>(all.data(),
                                                     static_cast<Eigen::Index>(all.size())))
            .segment(first_, r.size());
    }

private:
    std::unique_ptr<Ranks> ranks_;
    std::vector<std::int64_t> sizes_;  // numbers of each rank
    Eigen::Index first_;               // of this rank
    Eigen::LLT<Eigen::MatrixXd> factors_;
};

/// One of several ranks that are threads of this process.
class ThreadRank final : public Ranks {
public:
    ThreadRank(std::shared_ptr<Table> table, int rank) : table_(std::move(table)), rank_(rank) {}

    [[nodiscard]] int count() const override { return table_->count(); }
    [[nodiscard]] int rank() const override { return rank_; }
    [[nodiscard]] std::vector<double> gather(std::span<const double> own,
                                             std::span<const std::int64_t> sizes) const override {
        std::vector<double> all;
        table_->meet(rank_, own.data(), [&](const std::vector<const void*>& parts) {
            for (std::size_t i = 0; i < parts.size(); ++i) {
                const auto* part = static_cast<const double*>(parts[i]);
                all.insert(all.end(), part, part + sizes[i]);
            }
        });
        return all;
    }
    [[nodiscard]] std::unique_ptr<GhostExchange> make_exchange(
        const Ghosts& ghosts) const override {
        return std::make_unique<TableExchange>(*table_, rank_, ghosts);
    }
    [[nodiscard]] std::unique_ptr<SpreadSolver> make_solver(
        const SpreadMatrix& matrix) const override {
        return std::make_unique<DenseSolver>(std::make_unique<ThreadRank>(table_, rank_), matrix);
    }
    [[nodiscard]] RankTraffic take_traffic() const override { return {}; }

private:
    std::shared_ptr<Table> table_;
    int rank_;
};

/// Runs work(rank) on so many ranks at the same time.
inline void on_ranks(int count, const std::function<void(std::shared_ptr<const Ranks>)>& work) {
    const auto table = std::make_shared<Table>(count);
    pent::test::at_a_table(count,
                           [&](int rank) { work(std::make_shared<ThreadRank>(table, rank)); });
}

}  // namespace pent::simulator::test
