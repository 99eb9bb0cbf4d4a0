#pragma once

#include <CLI/CLI.hpp>
#include <cstdint>
#include <string>
#include <vector>

namespace pent::apps {

/// What the value of an option has to be. Another one is refused with what was found and what was
/// expected, as in `--layers: found "2.5"; expected a whole number from 1 to 64`.

/// A whole number from `low` to `high`.
[[nodiscard]] CLI::Validator whole_number(std::int64_t low, std::int64_t high);

/// A number from `low` to `high`.
[[nodiscard]] CLI::Validator number(double low, double high);

/// A finite number above 0.
[[nodiscard]] CLI::Validator positive_number();

/// A finite number of at least 0.
[[nodiscard]] CLI::Validator nonnegative_number();

/// One of two words or more, in small letters or large ones. For transform(), out of which it comes
/// as it is written here; check() would leave it as it was given.
[[nodiscard]] CLI::Validator one_of(const std::vector<std::string>& words);

}  // namespace pent::apps
