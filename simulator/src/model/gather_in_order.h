#pragma once

#include "linear/sharing.h"

#include <algorithm>
#include <array>
#include <cstddef>
#include <cstdint>
#include <vector>

namespace pent::simulator {

/// Rows of numbers of all ranks, sorted by their first numbers, then by their second ones, and so
/// on: they begin with what says where they belong.
template <std::size_t Width>
[[nodiscard]] std::vector<std::array<double, Width>> gather_in_order(
    const Ranks& ranks, const std::vector<std::array<double, Width>>& own) {
    const std::vector<std::int64_t> ones(static_cast<std::size_t>(ranks.count()), 1);
    const auto count = static_cast<double>(own.size() * Width);
    std::vector<std::int64_t> sizes;
    for (const double size : ranks.gather({&count, 1}, ones)) {
        sizes.push_back(static_cast<std::int64_t>(size));
    }
    const auto* numbers = own.empty() ? nullptr : own.front().data();
    const std::vector<double> flat = ranks.gather({numbers, own.size() * Width}, sizes);
    std::vector<std::array<double, Width>> all(flat.size() / Width);
    for (std::size_t i = 0; i < flat.size(); ++i) {
        all[i / Width][i % Width] = flat[i];
    }
    std::sort(all.begin(), all.end());
    return all;
}

}  // namespace pent::simulator
