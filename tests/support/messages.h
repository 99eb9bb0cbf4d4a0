#pragma once

#include <pent/error.h>

#include <gtest/gtest.h>

#include <string>

namespace pent::test {

/// Text of the Error that `action` throws; a test failure and "" when it throws none.
template <typename Action>
[[nodiscard]] std::string error_of(Action&& action) {
    try {
        action();
    } catch (const Error& error) {
        return error.what();
    }
    ADD_FAILURE() << "expected an Error";
    return "";
}

/// Expects that `text` contains every one of `parts`.
inline void expect_contains(const std::string& text, std::initializer_list<std::string> parts) {
    for (const std::string& part : parts) {
        EXPECT_NE(text.find(part), std::string::npos) << "no '" << part << "' in: " << text;
    }
}

}  // namespace pent::test
