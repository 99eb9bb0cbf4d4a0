#pragma once

#include <algorithm>
#include <array>
#include <cassert>
#include <cstddef>
#include <optional>
#include <string_view>
#include <vector>

namespace pent::simulator {

/// The words of scenes for the values of enumerations.
template <typename Value>
struct Word {
    Value value;
    std::string_view word;
};

/// The words of all values of an enumeration, in the order of messages; given beside it.
template <typename Value>
inline constexpr std::array<Word<Value>, 0> kWords{};

/// All values of an enumeration.
template <typename Value>
[[nodiscard]] std::vector<Value> values() {
    std::vector<Value> all;
    for (const Word<Value>& word : kWords<Value>) {
        all.push_back(word.value);
    }
    return all;
}

/// The words of an enumeration.
template <typename Value>
[[nodiscard]] std::vector<std::string_view> words() {
    std::vector<std::string_view> all;
    for (const Word<Value>& word : kWords<Value>) {
        all.push_back(word.word);
    }
    return all;
}

/// The place of a value among them.
template <typename Value>
[[nodiscard]] std::size_t place_of(Value value) {
    const auto found = std::find_if(kWords<Value>.begin(), kWords<Value>.end(),
                                    [&](const Word<Value>& word) { return word.value == value; });
    assert(found != kWords<Value>.end());
    return static_cast<std::size_t>(found - kWords<Value>.begin());
}

/// The word for a value.
template <typename Value>
[[nodiscard]] std::string_view word_of(Value value) {
    return kWords<Value>[place_of(value)].word;
}

/// The value that has a word; nothing if none has.
template <typename Value>
[[nodiscard]] std::optional<Value> value_of(std::string_view word) {
    const auto found = std::find_if(kWords<Value>.begin(), kWords<Value>.end(),
                                    [&](const Word<Value>& one) { return one.word == word; });
    return found == kWords<Value>.end() ? std::nullopt : std::optional(found->value);
}

}  // namespace pent::simulator
