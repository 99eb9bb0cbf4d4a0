#pragma once

#include "support/meeting_table.h"

#include <pent/error.h>
#include <pent/simulator/ranks.h>

#include <algorithm>
#include <functional>
#include <memory>
#include <vector>

namespace pent::simulator::test {

using Table = pent::test::MeetingTable;

class TableExchange final : public GhostExchange {
public:
    TableExchange(Table& table, int rank, Ghosts ghosts)
        : table_(&table), rank_(rank), ghosts_(std::move(ghosts)) {}

    void update(double* values, int rows) override {
        table_->meet(rank_, values, [&](const std::vector<const void*>& all) {
            for (std::size_t i = 0; i < ghosts_.columns.size(); ++i) {
                const auto* from = static_cast<const double*>(all[ghosts_.owners[i]]);
                std::copy_n(from + std::ptrdiff_t{rows} * ghosts_.places[i], rows,
                            values + std::ptrdiff_t{rows} * ghosts_.columns[i]);
            }
        });
    }

private:
    Table* table_;
    int rank_;
    Ghosts ghosts_;
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
        const SpreadMatrix& /*matrix*/) const override {
        throw Error("what is tested on threads is small");
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
