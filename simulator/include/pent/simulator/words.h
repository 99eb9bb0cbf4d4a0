#pragma once

#include <array>
#include <string_view>

namespace pent::simulator {

/// The words of scenes for the values of enumerations.
template <typename Value>
struct Word {
    Value value;
    std::string_view word;
};

/// All values of an enumeration; its own order is that of messages.
template <typename Value>
inline constexpr std::array<Word<Value>, 0> kWords{};

}  // namespace pent::simulator
