#pragma once

#include <pent/real_text.h>
#include <pent/text_reader.h>

#include <algorithm>
#include <array>
#include <bit>
#include <cstring>
#include <limits>
#include <string>
#include <string_view>
#include <system_error>
#include <type_traits>
#include <utility>

namespace pent::mesher {

/// How numbers stand in a file.
enum class Encoding { Text, LittleEndian, BigEndian };

/// A word as a number that need not be finite, as the place of a point is.
[[nodiscard]] inline double any_number(const TextReader& text,
                                       std::string_view word,
                                       std::string_view expected) {
    double value = 0;
    const auto [end, error] = real_from_chars(word.data(), word.data() + word.size(), value);
    const bool is_number = error == std::errc() && end == word.data() + word.size();
    return is_number ? value : text.number(word, expected);
}

/// Numbers one after the other: words of a text, over the ends of its lines, or bytes behind the
/// current line. Every error names the file and the place.
class NumberReader {
public:
    NumberReader(TextReader& text, Encoding encoding) : text_(text), encoding_(encoding) {}

    void set_encoding(Encoding encoding) { encoding_ = encoding; }
    [[nodiscard]] bool is_text() const { return encoding_ == Encoding::Text; }

    /// The next number, finite in a text; in bytes whatever a `T` can be.
    template <typename T>
    [[nodiscard]] double real(std::string_view expected) {
        if (is_text()) {
            return text_.number(text_.next_word(expected), expected);
        }
        return static_cast<double>(take<T>(expected));
    }

    /// The same of a quantity, which need not be finite in a text either.
    template <typename T>
    [[nodiscard]] double quantity(std::string_view expected) {
        return is_text() ? any_number(text_, text_.next_word(expected), expected)
                         : real<T>(expected);
    }

    /// The next whole number, a `T` where it is not text.
    template <typename T>
    [[nodiscard]] std::int64_t whole(std::string_view expected) {
        static_assert(std::is_integral_v<T>);
        if (is_text()) {
            return text_.integer(text_.next_word(expected), expected);
        }
        const T value = take<T>(expected);
        if (std::cmp_greater(value, std::numeric_limits<std::int64_t>::max())) {
            text_.fail("found " + std::to_string(value) + ", expected " + std::string(expected));
        }
        return static_cast<std::int64_t>(value);
    }

    /// The next whole number as a number of things, each of a byte or more.
    template <typename T>
    [[nodiscard]] std::int64_t count(std::string_view expected) {
        return text_.count(whole<T>(expected), expected);
    }

    /// Three finite numbers.
    template <typename T>
    [[nodiscard]] Eigen::Vector3d point() {
        Eigen::Vector3d point;
        for (double& coordinate : point) {
            coordinate = real<T>("a coordinate");
        }
        if (!point.allFinite()) {
            text_.fail("a coordinate is not finite");
        }
        return point;
    }

private:
    template <typename T>
    T take(std::string_view expected) {
        std::array<char, sizeof(T)> raw{};
        std::memcpy(raw.data(), text_.take_bytes(sizeof(T), expected).data(), sizeof(T));
        if (encoding_ == Encoding::BigEndian) {
            std::reverse(raw.begin(), raw.end());
        }
        return std::bit_cast<T>(raw);
    }

    static_assert(std::endian::native == std::endian::little);

    TextReader& text_;
    Encoding encoding_;
};

}  // namespace pent::mesher
