#pragma once

#include <pent/simulator/ranks.h>
#include <pent/slab_writers.h>

#include <algorithm>
#include <cstdint>
#include <functional>
#include <string>
#include <utility>
#include <vector>

namespace pent::runs {

/// What the processes of a run do together, and what rank 0 does for all; of a program on its own
/// nothing but the work itself.
class RunRanks final : public SlabWriters {
public:
    /// @param ranks  Null for none; must outlive this.
    explicit RunRanks(const simulator::Ranks* ranks) : ranks_(ranks) {}

    /// Whether this process writes files and tells of what it does.
    [[nodiscard]] bool is_writer() const { return ranks_ == nullptr || ranks_->rank() == 0; }

    /// 0 for a program on its own.
    [[nodiscard]] int count() const { return ranks_ == nullptr ? 0 : ranks_->count(); }

    /// Those that write the same files; null for a program on its own.
    [[nodiscard]] const SlabWriters* writers() const { return ranks_ == nullptr ? nullptr : this; }

    [[nodiscard]] int place() const override { return ranks_ == nullptr ? 0 : ranks_->rank(); }

    [[nodiscard]] std::vector<double> list(double own) const override {
        const std::vector<std::int64_t> ones(
            static_cast<std::size_t>(ranks_ == nullptr ? 1 : ranks_->count()), 1);
        return ranks_ == nullptr ? std::vector<double>{own} : ranks_->gather({&own, 1}, ones);
    }

    /// The numbers of all, those of the first in front.
    [[nodiscard]] std::vector<double> gather(const std::vector<double>& own) const {
        if (ranks_ == nullptr) {
            return own;
        }
        std::vector<std::int64_t> sizes;
        for (const double size : list(static_cast<double>(own.size()))) {
            sizes.push_back(static_cast<std::int64_t>(size));
        }
        return ranks_->gather(own, sizes);
    }

    /// Throws an Error on all unless they give the same checksum, see simulator::refuse_others().
    void refuse_others(std::uint32_t checksum,
                       const std::string& what,
                       const std::string& advice) const {
        simulator::refuse_others(ranks_, checksum, what, advice);
    }

    /// Work that all do and that may fail on one; then it fails on all.
    void agree(const std::function<void()>& work) const override { simulator::agree(ranks_, work); }

    /// Which of so many things in a row are to be written by this process.
    [[nodiscard]] std::pair<Eigen::Index, Eigen::Index> slab_of(Eigen::Index count) const {
        const Eigen::Index writers = std::max(1, this->count());
        return {count * place() / writers, count * (place() + 1) / writers};
    }

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
