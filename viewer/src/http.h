#pragma once

#include <optional>
#include <string>
#include <string_view>

namespace pent::viewer {

/// What a browser asks for.
struct HttpRequest {
    std::string method;  ///< "GET".
    std::string path;    ///< Decoded, without what follows "?"; begins with "/".
    std::string host;    ///< As the header Host has it; empty if it is not there.
};

struct HttpResponse {
    int status = 200;
    std::string type = "text/plain; charset=utf-8";
    std::string headers;  ///< More lines, each ended by CR LF.
    std::string body;
};

/// Where the header of a request ends, behind its empty line; npos while there is more to come.
[[nodiscard]] std::string_view::size_type end_of_request(std::string_view bytes);

/// Understands the header of a request; nothing if it is none [rfc9112].
[[nodiscard]] std::optional<HttpRequest> parse_request(std::string_view header);

/// The bytes to send. The connection is to be closed behind them.
[[nodiscard]] std::string to_bytes(const HttpResponse& response);

/// A short answer in words, for what cannot be served.
[[nodiscard]] HttpResponse refusal(int status, const std::string& words);

/// Every byte of a text as JSON in quotes, safe within a script of a page as well.
[[nodiscard]] std::string json_string(std::string_view text);

/// A text as part of an address: %20 for a blank.
[[nodiscard]] std::string percent_encoded(std::string_view text);

}  // namespace pent::viewer
