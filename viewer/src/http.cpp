#include "http.h"

#include <pent/formatted.h>

#include <algorithm>
#include <cctype>

namespace pent::viewer {

namespace {

constexpr std::string_view kLineEnd = "\r\n";

std::string lower(std::string_view text) {
    std::string result(text);
    std::ranges::transform(result, result.begin(),
                           [](unsigned char c) { return static_cast<char>(std::tolower(c)); });
    return result;
}

std::string_view trimmed(std::string_view text) {
    const std::size_t begin = std::min(text.find_first_not_of(" \t"), text.size());
    const std::size_t end = text.find_last_not_of(" \t");
    return end == std::string_view::npos ? "" : text.substr(begin, end + 1 - begin);
}

int hex_digit(char c) {
    constexpr std::string_view kDigits = "0123456789abcdef";
    const std::size_t digit = kDigits.find(static_cast<char>(std::tolower(c)));
    return digit == std::string_view::npos ? -1 : static_cast<int>(digit);
}

// Nothing where a % is not followed by two digits, or stands for a zero byte.
std::optional<std::string> decoded(std::string_view text) {
    std::string result;
    for (std::size_t i = 0; i < text.size(); ++i) {
        if (text[i] != '%') {
            result += text[i];
            continue;
        }
        const int high = i + 2 < text.size() ? hex_digit(text[i + 1]) : -1;
        const int low = i + 2 < text.size() ? hex_digit(text[i + 2]) : -1;
        if (high < 0 || low < 0 || high + low == 0) {
            return std::nullopt;
        }
        result += static_cast<char>(16 * high + low);
        i += 2;
    }
    return result;
}

std::string_view reason(int status) {
    switch (status) {
        case 200:
            return "OK";
        case 302:
            return "Found";
        case 400:
            return "Bad Request";
        case 403:
            return "Forbidden";
        case 405:
            return "Method Not Allowed";
        case 431:
            return "Request Header Fields Too Large";
        default:
            return "Not Found";
    }
}

}  // namespace

std::string_view::size_type end_of_request(std::string_view bytes) {
    const std::size_t end = bytes.find("\r\n\r\n");
    return end == std::string_view::npos ? end : end + 4;
}

std::optional<HttpRequest> parse_request(std::string_view header) {
    const std::size_t line_end = std::min(header.find(kLineEnd), header.size());
    const std::string_view line = header.substr(0, line_end);
    const std::size_t first = line.find(' ');
    const std::size_t last = line.rfind(' ');
    if (first == std::string_view::npos || first == 0 || last <= first + 1
        || line.substr(last + 1, 7) != "HTTP/1." || line[first + 1] != '/') {
        return std::nullopt;
    }
    const std::string_view target = line.substr(first + 1, last - first - 1);
    const std::optional<std::string> path = decoded(target.substr(0, target.find('?')));
    if (!path || target.find(' ') != std::string_view::npos) {
        return std::nullopt;
    }
    HttpRequest request{std::string(line.substr(0, first)), *path, ""};
    for (std::size_t at = line_end + 2; at < header.size();) {
        const std::size_t end = std::min(header.find(kLineEnd, at), header.size());
        const std::string_view field = header.substr(at, end - at);
        const std::size_t colon = field.find(':');
        if (colon != std::string_view::npos && lower(field.substr(0, colon)) == "host") {
            if (!request.host.empty()) {
                return std::nullopt;
            }
            request.host = lower(trimmed(field.substr(colon + 1)));
        }
        at = end + 2;
    }
    return request;
}

std::string to_bytes(const HttpResponse& response) {
    std::string bytes = "HTTP/1.1 " + std::to_string(response.status) + " ";
    bytes += reason(response.status);
    bytes += "\r\nContent-Type: " + response.type
             + "\r\nContent-Length: " + std::to_string(response.body.size())
             + "\r\nCache-Control: no-cache\r\nX-Content-Type-Options: nosniff"
               "\r\nCross-Origin-Resource-Policy: same-origin\r\nConnection: close\r\n";
    return bytes + response.headers + "\r\n" + response.body;
}

HttpResponse refusal(int status, const std::string& words) {
    HttpResponse response;
    response.status = status;
    response.body = words + "\n";
    return response;
}

std::string json_string(std::string_view text) {
    std::string result = "\"";
    for (const char c : text) {
        const auto byte = static_cast<unsigned char>(c);
        if (byte < ' ' || c == '"' || c == '\\' || c == '<' || byte == 0x7f) {
            result += formatted("\\u%04x", static_cast<unsigned>(byte));
        } else {
            result += c;
        }
    }
    return result + "\"";
}

std::string percent_encoded(std::string_view text) {
    std::string result;
    for (const char c : text) {
        const auto byte = static_cast<unsigned char>(c);
        if (std::isalnum(byte) != 0 || std::string_view("-._~").find(c) != std::string_view::npos) {
            result += c;
        } else {
            result += formatted("%%%02X", static_cast<unsigned>(byte));
        }
    }
    return result;
}

}  // namespace pent::viewer
