#include "http.h"

#include <gtest/gtest.h>

#include <random>
#include <string>

namespace pent::viewer {
namespace {

TEST(HttpRequest, IsUnderstoodWithItsPathDecodedAndItsHostInLowerCase) {
    const auto request = parse_request(
        "GET /my%20run/run.json?x=%zz HTTP/1.1\r\nAccept: */*\r\nhOsT:  LocalHost:80 \r\n\r\n");
    ASSERT_TRUE(request.has_value());
    EXPECT_EQ(request->method, "GET");
    EXPECT_EQ(request->path, "/my run/run.json");
    EXPECT_EQ(request->host, "localhost:80");
}

TEST(HttpRequest, IsRefusedWhereItIsNone) {
    for (const std::string text :
         {"", "\r\n\r\n", "GET", "GET /", "GET  HTTP/1.1\r\n", "GET x HTTP/1.1\r\n",
          "GET / FTP/1.1\r\n", "GET /% HTTP/1.1\r\n", "GET /%4 HTTP/1.1\r\n",
          "GET /%00 HTTP/1.1\r\n", "GET /a b HTTP/1.1\r\n", "GET http://a/ HTTP/1.1\r\n",
          "GET / HTTP/1.1\r\nHost: a\r\nHost: b\r\n\r\n"}) {
        EXPECT_FALSE(parse_request(text).has_value()) << text;
    }
}

TEST(HttpRequest, OfAnyBytesIsTakenOrRefused) {
    std::mt19937 random(7);  // NOLINT(cert-msc51-cpp): the same tries every time
    const std::string whole = "GET /run/meshes/a.pent HTTP/1.1\r\nHost: 127.0.0.1:80\r\n\r\n";
    for (int i = 0; i < 20000; ++i) {
        std::string text = whole.substr(0, random() % (whole.size() + 1));
        for (std::size_t k = random() % 4; k > 0 && !text.empty(); --k) {
            text[random() % text.size()] = static_cast<char>(random());
        }
        const auto request = parse_request(text);
        EXPECT_TRUE(!request || request->path.front() == '/');
    }
}

TEST(HttpRequest, EndsBehindItsEmptyLine) {
    EXPECT_EQ(end_of_request("GET / HTTP/1.1\r\n"), std::string::npos);
    EXPECT_EQ(end_of_request("a\r\n\r\nb"), 5U);
}

TEST(HttpResponse, SaysItsLengthAndThatItIsTheLastOfItsConnection) {
    const std::string bytes = to_bytes(refusal(404, "gone"));
    EXPECT_EQ(bytes.rfind("HTTP/1.1 404 Not Found\r\n", 0), 0U);
    EXPECT_NE(bytes.find("\r\nContent-Length: 5\r\n"), std::string::npos);
    EXPECT_NE(bytes.find("\r\nConnection: close\r\n"), std::string::npos);
    EXPECT_EQ(bytes.substr(bytes.find("\r\n\r\n")), "\r\n\r\ngone\n");
}

TEST(JsonString, IsSafeInAPage) {
    EXPECT_EQ(json_string("a\"b\\c\n</script>"), "\"a\\u0022b\\u005cc\\u000a\\u003c/script>\"");
}

TEST(PercentEncoding, ComesBackAsItWas) {
    const std::string name = "a b/ü%?#&.pent";
    const auto request = parse_request("GET /" + percent_encoded(name) + " HTTP/1.1\r\n\r\n");
    ASSERT_TRUE(request.has_value());
    EXPECT_EQ(request->path, "/" + name);
}

}  // namespace
}  // namespace pent::viewer
