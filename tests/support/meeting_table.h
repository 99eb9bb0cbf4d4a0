#pragma once

#include <barrier>
#include <exception>
#include <functional>
#include <thread>
#include <vector>

namespace pent::test {

/// What processes that are threads of this one share: each puts something on the table, all look
/// at it, and all take theirs away.
class MeetingTable {
public:
    explicit MeetingTable(int count) : places_(static_cast<std::size_t>(count)), barrier_(count) {}

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

/// Runs work(0), work(1), ... at the same time, and throws what work(0) throws. An exception of
/// others alone would let the test hang: work must fail for all.
inline void at_a_table(int count, const std::function<void(int)>& work) {
    std::vector<std::exception_ptr> errors(static_cast<std::size_t>(count));
    std::vector<std::thread> threads;
    for (int rank = 0; rank < count; ++rank) {
        threads.emplace_back([&, rank] {
            try {
                work(rank);
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

}  // namespace pent::test
