#include "portable_chars.h"

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <cstdio>
#include <cstdlib>
#include <cstring>
#include <limits>
#include <locale.h>  // NOLINT(modernize-deprecated-headers): newlocale() is of POSIX
#include <string>

namespace pent {

namespace {

// Reads a text that has a number's form, with the point that files have, whatever the host's
// locale.
template <typename Real>
Real value_of(const char* text) {
    static const locale_t plain = ::newlocale(LC_ALL_MASK, "C", nullptr);
    if constexpr (sizeof(Real) == sizeof(float)) {
        return ::strtof_l(text, nullptr, plain);
    } else {
        return ::strtod_l(text, nullptr, plain);
    }
}

// A positive number: digits, the first of which stands before the point, times a power of ten.
struct Decimal {
    std::string digits;
    int exponent = 0;
};

// The decimal of `count` digits that is nearest to the value. Nothing but digits is taken from what
// printf() writes, as the point in it is that of the locale.
Decimal rounded(double value, int count) {
    char text[40];
    std::snprintf(text, sizeof text, "%.*e", count - 1, value);
    Decimal decimal;
    const char* at = text;
    for (; *at != 'e'; ++at) {
        if (*at >= '0' && *at <= '9') {
            decimal.digits += *at;
        }
    }
    decimal.exponent = std::atoi(at + 1);
    return decimal;
}

template <typename Real>
bool reads_back(const Decimal& decimal, Real value) {
    const int exponent = decimal.exponent - static_cast<int>(decimal.digits.size()) + 1;
    return value_of<Real>((decimal.digits + "e" + std::to_string(exponent)).c_str()) == value;
}

// The next decimal of as many digits.
Decimal next(Decimal decimal) {
    auto digit = decimal.digits.rbegin();
    while (digit != decimal.digits.rend() && *digit == '9') {
        *digit++ = '0';
    }
    if (digit != decimal.digits.rend()) {
        ++*digit;
    } else {
        decimal.digits.insert(0, "1");
        decimal.digits.pop_back();
        ++decimal.exponent;
    }
    return decimal;
}

// The fewest digits that read back as the value, and of those the nearest.
template <typename Real>
Decimal shortest(Real value) {
    // A decimal of at most so many digits survives being read into a normal number, so a shorter
    // one comes out here with zeros behind it, which are cut off. Subnormal numbers have less
    // precision and are tried from one digit on.
    constexpr int kSafe = std::numeric_limits<Real>::digits10;
    const int least = value < std::numeric_limits<Real>::min() ? 1 : kSafe;
    for (int count = least;; ++count) {
        Decimal decimal = rounded(static_cast<double>(value), count);
        // Below a power of two numbers are half as far apart: where the nearest decimal is below,
        // and too far, the one above may still do.
        for (const Decimal& candidate : {decimal, next(decimal)}) {
            if (reads_back(candidate, value)) {
                decimal = candidate;
                decimal.digits.erase(decimal.digits.find_last_not_of('0') + 1);
                return decimal;
            }
        }
    }
}

std::string scientific(const Decimal& decimal) {
    std::string text = decimal.digits.substr(0, 1);
    if (decimal.digits.size() > 1) {
        text += "." + decimal.digits.substr(1);
    }
    const std::string power = std::to_string(std::abs(decimal.exponent));
    return text + (decimal.exponent < 0 ? "e-" : "e+") + (power.size() < 2 ? "0" : "") + power;
}

// Whole numbers have all their digits, not zeros in place of those that reading back does not need.
template <typename Real>
std::string fixed(const Decimal& decimal, Real value) {
    const int count = static_cast<int>(decimal.digits.size());
    if (decimal.exponent >= count - 1) {
        char text[400];
        std::snprintf(text, sizeof text, "%.0f", static_cast<double>(value));
        return text;
    }
    if (decimal.exponent >= 0) {
        const auto whole = static_cast<std::size_t>(decimal.exponent) + 1;
        return decimal.digits.substr(0, whole) + "." + decimal.digits.substr(whole);
    }
    return "0." + std::string(static_cast<std::size_t>(-decimal.exponent) - 1, '0')
           + decimal.digits;
}

template <typename Real>
std::string text_of(Real value) {
    if (std::isnan(value)) {
        return "nan";
    }
    if (std::isinf(value)) {
        return "inf";
    }
    if (value == 0) {
        return "0";
    }
    const Decimal decimal = shortest(value);
    const std::string short_form = scientific(decimal);
    const std::string long_form = fixed(decimal, value);
    return long_form.size() <= short_form.size() ? long_form : short_form;
}

bool is_digit(const char* at, const char* last) {
    return at != last && *at >= '0' && *at <= '9';
}

const char* skip_digits(const char* at, const char* last) {
    while (is_digit(at, last)) {
        ++at;
    }
    return at;
}

// Behind the word if it is there, in small letters or capitals; else `at`.
const char* skip_word(const char* at, const char* last, const char* word) {
    const char* end = at;
    for (; *word != '\0'; ++word, ++end) {
        if (end == last || (*end | 0x20) != *word) {
            return at;
        }
    }
    return end;
}

const char* skip_name(const char* at, const char* last) {
    const char* end = skip_word(at, last, "infinity");
    end = end != at ? end : skip_word(at, last, "inf");
    return end != at ? end : skip_word(at, last, "nan");
}

// Where the digits, the point and the exponent of a number end; `at` if there is none.
const char* skip_number(const char* at, const char* last) {
    const char* const whole = skip_digits(at, last);
    const char* end = whole;
    if (end != last && *end == '.') {
        end = skip_digits(end + 1, last);
    }
    if (end == at || (whole == at && end == at + 1)) {
        return at;
    }
    if (end != last && (*end | 0x20) == 'e') {
        const char* power = end + 1;
        if (power != last && (*power == '+' || *power == '-')) {
            ++power;
        }
        if (is_digit(power, last)) {
            end = skip_digits(power, last);
        }
    }
    return end;
}

}  // namespace

template <typename Real>
std::to_chars_result portable_to_chars(char* first, char* last, Real value) {
    const std::string text = (std::signbit(value) ? "-" : "") + text_of(std::abs(value));
    if (last - first < static_cast<std::ptrdiff_t>(text.size())) {
        return {last, std::errc::value_too_large};
    }
    return {std::copy(text.begin(), text.end(), first), std::errc()};
}

template <typename Real>
std::from_chars_result portable_from_chars(const char* first, const char* last, Real& value) {
    const char* const begin = first != last && *first == '-' ? first + 1 : first;
    const char* const named = skip_name(begin, last);
    const char* const end = named != begin ? named : skip_number(begin, last);
    if (end == begin) {
        return {first, std::errc::invalid_argument};
    }
    const std::string text(first, end);
    const Real found = value_of<Real>(text.c_str());
    if (named == begin) {
        const bool is_zero = text.find_first_of("123456789") >= text.find_first_of("eE");
        if (std::isinf(found) || (found == 0 && !is_zero)) {
            return {end, std::errc::result_out_of_range};
        }
    }
    value = found;
    return {end, std::errc()};
}

template std::to_chars_result portable_to_chars(char*, char*, float);
template std::to_chars_result portable_to_chars(char*, char*, double);
template std::from_chars_result portable_from_chars(const char*, const char*, float&);
template std::from_chars_result portable_from_chars(const char*, const char*, double&);

}  // namespace pent
