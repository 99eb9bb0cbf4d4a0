#include "portable_chars.h"

#include <pent/real_text.h>

#include <gtest/gtest.h>

#include <bit>
#include <clocale>
#include <cmath>
#include <cstdint>
#include <limits>
#include <random>
#include <string>
#include <string_view>
#include <vector>

namespace pent {
namespace {

template <typename Real>
std::string text_of(Real value) {
    char text[32];
    const auto result = real_to_chars(text, text + sizeof text, value);
    EXPECT_EQ(result.ec, std::errc());
    return {text, result.ptr};
}

template <typename Real>
std::string portable_text_of(Real value) {
    char text[32];
    const auto result = portable_to_chars(text, text + sizeof text, value);
    EXPECT_EQ(result.ec, std::errc());
    return {text, result.ptr};
}

// The number, how many characters it took, and how that went.
template <typename Real>
struct Reading {
    Real value = 7;
    std::ptrdiff_t length = 0;
    std::errc error{};

    bool operator==(const Reading& other) const {
        return length == other.length && error == other.error
               && (value == other.value || (std::isnan(value) && std::isnan(other.value)))
               && std::signbit(value) == std::signbit(other.value);
    }
};

template <typename Real>
Reading<Real> read(std::string_view text) {
    Reading<Real> reading;
    const auto result = real_from_chars(text.data(), text.data() + text.size(), reading.value);
    reading.length = result.ptr - text.data();
    reading.error = result.ec;
    return reading;
}

template <typename Real>
Reading<Real> read_portably(std::string_view text) {
    Reading<Real> reading;
    const auto result = portable_from_chars(text.data(), text.data() + text.size(), reading.value);
    reading.length = result.ptr - text.data();
    reading.error = result.ec;
    return reading;
}

// Powers of two and their neighbors, where the distance of numbers changes; ends of the range;
// decimals; any bits.
template <typename Real, typename Bits>
std::vector<Real> numbers() {
    using Limits = std::numeric_limits<Real>;
    std::vector<Real> all = {0,
                             Limits::denorm_min(),
                             Limits::min(),
                             Limits::max(),
                             Limits::infinity(),
                             static_cast<Real>(0.1),
                             static_cast<Real>(0.3),
                             static_cast<Real>(1e5),
                             static_cast<Real>(1e21),
                             static_cast<Real>(1e22),
                             static_cast<Real>(1e23),
                             static_cast<Real>(123456),
                             static_cast<Real>(1234567),
                             static_cast<Real>(9007199254740993.0)};
    for (int power = Limits::min_exponent - Limits::digits; power < Limits::max_exponent; ++power) {
        const Real two = std::ldexp(Real(1), power);
        all.insert(all.end(), {two, std::nextafter(two, Real(0)), std::nextafter(two, 2 * two)});
    }
    std::mt19937_64 random(5);
    for (int i = 0; i < 3000; ++i) {
        const Real any = std::bit_cast<Real>(static_cast<Bits>(random()));
        all.push_back(std::isnan(any) ? Real(1) : any);
        all.push_back(static_cast<Real>(static_cast<std::int64_t>(random() % 2000001) - 1000000)
                      / static_cast<Real>(1000));
    }
    return all;
}

template <typename Real, typename Bits>
void expect_all_survive() {
    for (const Real value : numbers<Real, Bits>()) {
        for (const Real signed_value : {value, -value}) {
            const std::string text = text_of(signed_value);
            EXPECT_LE(text.size(), 24U);
            const Reading<Real> expected{
                signed_value, static_cast<std::ptrdiff_t>(text.size()), {}};
            EXPECT_EQ(read<Real>(text), expected) << text;
            EXPECT_EQ(portable_text_of(signed_value), text);
            EXPECT_EQ(read_portably<Real>(text), expected) << text;
        }
    }
}

TEST(RealText, ReadsBackAsTheSameNumberAndIsTheSameWithoutTheCppLibrary) {
    expect_all_survive<double, std::uint64_t>();
    expect_all_survive<float, std::uint32_t>();
}

TEST(RealText, IsAsShortAsCanBe) {
    EXPECT_EQ(portable_text_of(0.1), "0.1");
    EXPECT_EQ(portable_text_of(0.1F), "0.1");
    EXPECT_EQ(portable_text_of(-0.0), "-0");
    EXPECT_EQ(portable_text_of(100000.0), "1e+05");
    EXPECT_EQ(portable_text_of(123456.0), "123456");
    EXPECT_EQ(portable_text_of(1e-5), "1e-05");
    EXPECT_EQ(portable_text_of(5e-324), "5e-324");
    EXPECT_EQ(portable_text_of(std::ldexp(1.0, -44)), "5.684341886080802e-14");
    EXPECT_EQ(portable_text_of(1.7976931348623157e308), "1.7976931348623157e+308");
}

TEST(RealText, SaysWhenThereIsNoRoom) {
    char text[3];
    EXPECT_EQ(portable_to_chars(text, text + 3, 0.25).ec, std::errc::value_too_large);
    EXPECT_EQ(real_to_chars(text, text + 3, 0.25).ec, std::errc::value_too_large);
}

TEST(RealText, IsReadAsTheCppLibraryDoes) {
    for (const char* text : {"",
                             "-",
                             ".",
                             "-.",
                             "e5",
                             "+1",
                             " 1",
                             "1",
                             "-1",
                             "1.",
                             ".5",
                             "-.5e1",
                             "1e",
                             "1e+",
                             "1e-",
                             "1e5x",
                             "1E5",
                             "1.5.2",
                             "0x10",
                             "inf",
                             "-INF",
                             "infinit",
                             "Infinity",
                             "nan",
                             "-nan",
                             "nano",
                             "1e400",
                             "-1e400",
                             "1e-400",
                             "0e999",
                             "0.0e-99",
                             "00012",
                             "1,5",
                             "12345678901234567890",
                             "2.2250738585072011e-308",
                             "4.9e-324",
                             "2e-324",
                             "1e39",
                             "1e-46",
                             "--1",
                             "1e99999999999"}) {
        EXPECT_EQ(read_portably<double>(text), read<double>(text)) << '"' << text << '"';
        EXPECT_EQ(read_portably<float>(text), read<float>(text)) << '"' << text << '"';
    }
    EXPECT_EQ(read_portably<double>("1e400").error, std::errc::result_out_of_range);
    EXPECT_EQ(read_portably<double>("x").error, std::errc::invalid_argument);
    EXPECT_EQ(read_portably<double>("2.5 3").value, 2.5);
}

TEST(RealText, HasAPointInEveryLocale) {
    const std::string before = std::setlocale(LC_ALL, nullptr);
    bool is_set = false;
    for (const char* name : {"de_DE.UTF-8", "fr_FR.UTF-8", "de_DE.utf8"}) {
        is_set = is_set || std::setlocale(LC_ALL, name) != nullptr;
    }
    EXPECT_EQ(read_portably<double>("2.5").value, 2.5);
    EXPECT_EQ(portable_text_of(2.5), "2.5");
    EXPECT_EQ(portable_text_of(2.5e-30), "2.5e-30");
    std::setlocale(LC_ALL, before.c_str());
    if (!is_set) {
        GTEST_SKIP() << "no locale with a decimal comma is installed";
    }
}

}  // namespace
}  // namespace pent
