#pragma once

#include <pent/real_text.h>

#include <cmath>
#include <cstddef>
#include <cstdint>
#include <cstdio>
#include <initializer_list>
#include <random>

namespace pent::scene_fuzz {

/// Draws that are the same everywhere: the generator is specified by the standard, its
/// distributions are not.
class Random {
public:
    explicit Random(std::uint64_t seed) : engine_(seed) {}

    /// In [0, 1).
    double share() { return std::ldexp(static_cast<double>(engine_() >> 11), -53); }

    [[nodiscard]] bool chance(double probability) { return share() < probability; }

    /// In 0 .. count - 1.
    std::size_t below(std::size_t count) {
        return static_cast<std::size_t>(share() * static_cast<double>(count));
    }

    /// In low .. high.
    int whole(int low, int high) {
        return low + static_cast<int>(below(static_cast<std::size_t>(high - low + 1)));
    }

    /// In [low, high], of three digits: scenes are read by people.
    double number(double low, double high) { return short_of(low + share() * (high - low)); }

    /// The same, every order of magnitude as likely as the other; low > 0.
    double magnitude(double low, double high) {
        return short_of(low * std::exp(share() * std::log(high / low)));
    }

    template <typename Value>
    Value pick(std::initializer_list<Value> values) {
        return values.begin()[below(values.size())];
    }

    /// The number with its first three digits alone.
    static double short_of(double value) {
        char digits[32];
        const int length = std::snprintf(digits, sizeof digits, "%.3g", value);
        double result = 0;
        static_cast<void>(real_from_chars(digits, digits + length, result));
        return result;
    }

private:
    std::mt19937_64 engine_;
};

}  // namespace pent::scene_fuzz
