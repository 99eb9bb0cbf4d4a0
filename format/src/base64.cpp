#include <pent/base64.h>

#include <array>
#include <cstdint>
#include <utility>

namespace pent {

namespace {

constexpr std::string_view kDigits =
    "ABCDEFGHIJKLMNOPQRSTUVWXYZabcdefghijklmnopqrstuvwxyz0123456789+/";

}  // namespace

std::string to_base64(std::string_view bytes) {
    std::string text;
    text.reserve((bytes.size() + 2) / 3 * 4);
    for (std::size_t i = 0; i < bytes.size(); i += 3) {
        std::uint32_t group = 0;
        for (std::size_t k = 0; k < 3; ++k) {
            group = 256 * group
                    + (i + k < bytes.size() ? static_cast<unsigned char>(bytes[i + k]) : 0U);
        }
        for (std::size_t k = 0; k < 4; ++k) {
            text += i + k <= bytes.size() ? kDigits[group >> (18 - 6 * k) & 63U] : '=';
        }
    }
    return text;
}

std::optional<std::string> from_base64(std::string_view text) {
    if (text.size() % 4 != 0) {
        return std::nullopt;
    }
    std::string bytes;
    bytes.reserve(text.size() / 4 * 3);
    for (std::size_t i = 0; i < text.size(); i += 4) {
        std::uint32_t group = 0;
        std::size_t padding = 0;
        for (const char c : text.substr(i, 4)) {
            const auto digit = kDigits.find(c);
            const bool is_padding = c == '=' && i + 4 == text.size();
            if ((digit == std::string_view::npos && !is_padding) || (padding > 0 && !is_padding)) {
                return std::nullopt;
            }
            padding += is_padding ? 1 : 0;
            group = 64 * group + (is_padding ? 0U : static_cast<std::uint32_t>(digit));
        }
        if (padding > 2) {
            return std::nullopt;
        }
        for (std::size_t k = 0; k + padding < 3; ++k) {
            bytes += static_cast<char>(group >> (16 - 8 * k) & 255U);
        }
    }
    return bytes;
}

std::optional<std::string> from_base64_prefix(std::string_view text, std::size_t bytes) {
    std::string result;
    std::string group;
    for (const char c : text) {
        if (result.size() >= bytes) {
            break;
        }
        if (c == ' ' || c == '\t' || c == '\n' || c == '\r') {
            continue;
        }
        group += c;
        if (group.size() == 4) {
            const std::optional<std::string> three = from_base64(group);
            if (!three) {
                return std::nullopt;
            }
            result += *three;
            group.clear();
        }
    }
    return group.empty() ? std::optional(std::move(result)) : std::nullopt;
}

}  // namespace pent
