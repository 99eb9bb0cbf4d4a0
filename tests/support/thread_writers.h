#pragma once

#include <pent/error.h>
#include <pent/slab_writers.h>

#include <barrier>
#include <functional>
#include <string>
#include <thread>
#include <vector>

namespace pent::test {

/// What threads tell one another.
struct WriterTable {
    explicit WriterTable(int count)
        : numbers(static_cast<std::size_t>(count)),
          errors(static_cast<std::size_t>(count)),
          barrier(count) {}

    std::vector<double> numbers;
    std::vector<std::string> errors;
    std::barrier<> barrier;
};

/// One of several writers that are threads of this process.
class ThreadWriters final : public SlabWriters {
public:
    ThreadWriters(WriterTable& table, int place) : table_(&table), place_(place) {}

    [[nodiscard]] int place() const override { return place_; }

    [[nodiscard]] std::vector<double> list(double own) const override {
        table_->numbers[static_cast<std::size_t>(place_)] = own;
        table_->barrier.arrive_and_wait();
        std::vector<double> all = table_->numbers;
        table_->barrier.arrive_and_wait();
        return all;
    }

    void agree(const std::function<void()>& work) const override {
        std::string& error = table_->errors[static_cast<std::size_t>(place_)];
        error.clear();
        try {
            work();
        } catch (const Error& what) {
            error = what.what();
        }
        table_->barrier.arrive_and_wait();
        std::string first;
        for (const std::string& one : table_->errors) {
            first = first.empty() ? one : first;
        }
        table_->barrier.arrive_and_wait();
        if (!first.empty()) {
            throw Error(first);
        }
    }

private:
    WriterTable* table_;
    int place_;
};

/// What each of so many writers says: empty, or an error.
template <typename Work>
[[nodiscard]] std::vector<std::string> by_writers(int count, const Work& work) {
    WriterTable table(count);
    std::vector<std::string> said(static_cast<std::size_t>(count));
    std::vector<std::thread> threads;
    for (int place = 0; place < count; ++place) {
        threads.emplace_back([&, place] {
            try {
                work(ThreadWriters(table, place));
            } catch (const Error& error) {
                said[static_cast<std::size_t>(place)] = error.what();
            }
        });
    }
    for (std::thread& thread : threads) {
        thread.join();
    }
    return said;
}

}  // namespace pent::test
