#pragma once

#include <pent/mesher/make_body.h>

#include <chrono>
#include <functional>
#include <string>
#include <utility>
#include <vector>

namespace pent::mesher {

/// Runs the stages of the work: says that one begins, and notes how long it took.
class StageClock {
public:
    explicit StageClock(std::function<void(const std::string&)> on_stage)
        : on_stage_(std::move(on_stage)) {}

    template <typename Work>
    auto time(const char* name, Work work) {
        if (on_stage_) {
            on_stage_(name);
        }
        const auto start = std::chrono::steady_clock::now();
        auto result = work();
        const std::chrono::duration<double> seconds = std::chrono::steady_clock::now() - start;
        stages_.push_back({name, seconds.count()});
        return result;
    }

    [[nodiscard]] const std::vector<Stage>& stages() const { return stages_; }

private:
    std::function<void(const std::string&)> on_stage_;
    std::vector<Stage> stages_;
};

}  // namespace pent::mesher
