#pragma once

#include <pent/error.h>
#include <pent/simulator/ranks.h>

#include <algorithm>
#include <barrier>
#include <exception>
#include <functional>
#include <memory>
#include <thread>
#include <vector>

namespace pent::simulator::test {

/// What ranks that are threads of one process share: each puts something on the table, all look at
/// it, and all take theirs away.
class Table {
public:
    explicit Table(int count) : places_(static_cast<std::size_t>(count)), barrier_(count) {}

    /// Calls look(what all have put there).
    template <typename Look>
    void meet(int rank, const void* own, const Look& look) {
        places_[static_cast<std::size_t>(rank)] = own;
        barrier_.arrive_and_wait();
        look(places_);
        barrier_.arrive_and_wait();
    }
    [[nodiscard]] int count() const { return static_cast<int>(places_.size()); }

private:
    std::vector<const void*> places_;
    std::barrier<> barrier_;
};

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

/// Runs work(rank) on so many ranks at the same time, and throws what rank 0 throws. An exception
/// on others alone would let the test hang: work must fail on all.
inline void on_ranks(int count, const std::function<void(std::shared_ptr<const Ranks>)>& work) {
    const auto table = std::make_shared<Table>(count);
    std::vector<std::exception_ptr> errors(static_cast<std::size_t>(count));
    std::vector<std::thread> threads;
    for (int rank = 0; rank < count; ++rank) {
        threads.emplace_back([&, rank] {
            try {
                work(std::make_shared<ThreadRank>(table, rank));
            } catch (...) {
                errors[static_cast<std::size_t>(rank)] = std::current_exception();
            }
        });
    }
    for (std::thread& thread : threads) {
        thread.join();
    }
    if (errors.front()) {
        std::rethrow_exception(errors.front());
    }
}

}  // namespace pent::simulator::test
