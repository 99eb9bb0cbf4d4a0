#pragma once

#include <pent/error.h>

#include <cstdint>
#include <cstring>
#include <map>
#include <span>
#include <string>
#include <type_traits>
#include <vector>

namespace pent::runs {

/// State that a simulation carries from step to step beside positions and velocities, as arrays of
/// numbers under names: what a checkpoint holds, to the bit.
class StateBlocks {
public:
    [[nodiscard]] bool is_empty() const { return blocks_.empty(); }
    [[nodiscard]] bool has(const std::string& name) const { return blocks_.count(name) != 0; }

    /// Adds an array, or puts it in place of the one that has this name.
    template <typename Value>
    void put(const std::string& name, std::span<const Value> values) {
        static_assert(std::is_arithmetic_v<Value>);
        std::string bytes(values.size_bytes(), '\0');
        if (!values.empty()) {
            std::memcpy(bytes.data(), values.data(), bytes.size());
        }
        blocks_[name] = std::move(bytes);
    }

    /// The array of this name. Throws an Error unless it is there and has `count` values.
    template <typename Value>
    [[nodiscard]] std::vector<Value> get(const std::string& name, std::size_t count) const {
        static_assert(std::is_arithmetic_v<Value>);
        const auto found = blocks_.find(name);
        if (found == blocks_.end() || found->second.size() != count * sizeof(Value)) {
            throw Error("the state \"" + name + "\" "
                        + (found == blocks_.end() ? "is missing" : "has another size")
                        + "; expected " + std::to_string(count) + " numbers");
        }
        std::vector<Value> values(count);
        if (count > 0) {
            std::memcpy(values.data(), found->second.data(), found->second.size());
        }
        return values;
    }

    /// All blocks by name, as bytes.
    [[nodiscard]] const std::map<std::string, std::string>& all() const { return blocks_; }
    void put_bytes(const std::string& name, std::string bytes) { blocks_[name] = std::move(bytes); }

    bool operator==(const StateBlocks&) const = default;

private:
    std::map<std::string, std::string> blocks_;
};

}  // namespace pent::runs
