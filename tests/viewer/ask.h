#pragma once

#include <arpa/inet.h>
#include <array>
#include <netinet/in.h>
#include <string>
#include <string_view>
#include <sys/socket.h>
#include <unistd.h>

namespace pent::viewer::test {

/// A connection to a server on this machine.
class Client {
public:
    explicit Client(int port) : socket_(::socket(AF_INET, SOCK_STREAM, 0)) {
        sockaddr_in address{};
        address.sin_family = AF_INET;
        address.sin_port = htons(static_cast<std::uint16_t>(port));
        address.sin_addr.s_addr = htonl(INADDR_LOOPBACK);
        is_open_ =
            ::connect(socket_, reinterpret_cast<const sockaddr*>(&address), sizeof address) == 0;
    }
    ~Client() { ::close(socket_); }
    Client(const Client&) = delete;
    Client& operator=(const Client&) = delete;
    Client(Client&&) = delete;
    Client& operator=(Client&&) = delete;

    [[nodiscard]] bool is_open() const { return is_open_; }

    void send(std::string_view bytes) const {
        ::send(socket_, bytes.data(), bytes.size(), MSG_NOSIGNAL);
    }

    /// All that comes until the server closes.
    [[nodiscard]] std::string receive() const {
        std::string all;
        std::array<char, 65536> bytes{};
        for (;;) {
            const ssize_t got = ::recv(socket_, bytes.data(), bytes.size(), 0);
            if (got <= 0) {
                return all;
            }
            all.append(bytes.data(), static_cast<std::size_t>(got));
        }
    }

private:
    int socket_;
    bool is_open_ = false;
};

/// The whole answer to a GET.
[[nodiscard]] inline std::string ask(int port, const std::string& target) {
    const Client client(port);
    client.send("GET " + target + " HTTP/1.1\r\nHost: 127.0.0.1:" + std::to_string(port)
                + "\r\n\r\n");
    return client.receive();
}

}  // namespace pent::viewer::test
