#pragma once

#include <pent/simulator/ranks.h>

#include <functional>
#include <string>

namespace pent::runs {

/// What the processes of a run do together, and what rank 0 does for all; of a program on its own
/// nothing but the work itself.
class RunRanks {
public:
    /// @param ranks  Null for none; must outlive this.
    explicit RunRanks(const simulator::Ranks* ranks) : ranks_(ranks) {}

    /// Whether this process writes files and tells of what it does.
    [[nodiscard]] bool is_writer() const { return ranks_ == nullptr || ranks_->rank() == 0; }

    /// 0 for a program on its own.
    [[nodiscard]] int count() const { return ranks_ == nullptr ? 0 : ranks_->count(); }

    /// Work that all do and that may fail on one; then it fails on all.
    void agree(const std::function<void()>& work) const { simulator::agree(ranks_, work); }

    /// Work of the writer alone. What goes wrong there goes wrong on all.
    void write(const std::function<void()>& work) const {
        agree([&] {
            if (is_writer()) {
                work();
            }
        });
    }

    /// Whether it is so on any.
    [[nodiscard]] bool any(bool is_so) const {
        return ranks_ == nullptr ? is_so : simulator::any(*ranks_, is_so);
    }

    /// What to say of a run that others have begun.
    [[nodiscard]] std::string change_text(int ranks_before) const {
        const auto by = [](int ranks) {
            return ranks == 0 ? std::string("one process alone") : std::to_string(ranks) + " ranks";
        };
        return "it was run by " + by(ranks_before) + " and goes on by " + by(count())
               + ": last digits will differ from what it would have been";
    }

private:
    const simulator::Ranks* ranks_;
};

}  // namespace pent::runs
