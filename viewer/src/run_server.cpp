#include "pent/viewer/run_server.h"

#include "http.h"
#include "run_site.h"

#include <pent/error.h>

#include <algorithm>
#include <arpa/inet.h>
#include <array>
#include <cerrno>
#include <chrono>
#include <netinet/in.h>
#include <poll.h>
#include <sys/socket.h>
#include <system_error>
#include <unistd.h>
#include <utility>
#include <vector>

namespace pent::viewer {

namespace {

using Clock = std::chrono::steady_clock;

constexpr std::size_t kMaxHeader = 16384;      // bytes of a request
constexpr std::size_t kMaxConnections = 64;    // at once; the oldest gives way
constexpr std::chrono::seconds kPatience(20);  // for a connection that does nothing
constexpr std::chrono::milliseconds kStopInterval(100);

class Descriptor {
public:
    explicit Descriptor(int number) : number_(number) {}
    ~Descriptor() {
        if (number_ >= 0) {
            ::close(number_);
        }
    }
    Descriptor(const Descriptor&) = delete;
    Descriptor& operator=(const Descriptor&) = delete;
    Descriptor(Descriptor&& other) noexcept : number_(std::exchange(other.number_, -1)) {}
    Descriptor& operator=(Descriptor&& other) noexcept {
        std::swap(number_, other.number_);
        return *this;
    }
    [[nodiscard]] int number() const { return number_; }

private:
    int number_;
};

// One request and its answer; then it is over.
struct Connection {
    Descriptor socket;
    Clock::time_point since = Clock::now();  // the last byte that went either way
    std::string request;
    std::string response;  // empty until the request is whole
    std::size_t sent = 0;
};

Descriptor listen_on(int port) {
    Descriptor listener(::socket(AF_INET, SOCK_STREAM | SOCK_NONBLOCK | SOCK_CLOEXEC, 0));
    sockaddr_in address{};
    address.sin_family = AF_INET;
    address.sin_port = htons(static_cast<std::uint16_t>(port));
    address.sin_addr.s_addr = htonl(INADDR_LOOPBACK);  // no other machine reaches it
    const int yes = 1;
    ::setsockopt(listener.number(), SOL_SOCKET, SO_REUSEADDR, &yes, sizeof yes);
    if (::bind(listener.number(), reinterpret_cast<const sockaddr*>(&address), sizeof address) != 0
        || ::listen(listener.number(), SOMAXCONN) != 0) {
        throw Error("port " + std::to_string(port)
                    + ": cannot be used: " + std::generic_category().message(errno)
                    + "; choose another with --port, or leave it out for any that is free");
    }
    return listener;
}

int port_of(const Descriptor& listener) {
    sockaddr_in address{};
    socklen_t size = sizeof address;
    ::getsockname(listener.number(), reinterpret_cast<sockaddr*>(&address), &size);
    return ntohs(address.sin_port);
}

bool should_wait(ssize_t result) {
    return result < 0 && (errno == EAGAIN || errno == EWOULDBLOCK || errno == EINTR);
}

}  // namespace

// All connections in one thread: they wait for one another only while a file is read.
class RunServer::Sockets {
public:
    Sockets(const std::filesystem::path& page, const std::filesystem::path& run, int port)
        : site_(page, run), listener_(listen_on(port)), port_(port_of(listener_)) {}

    [[nodiscard]] int port() const { return port_; }
    [[nodiscard]] std::string start() const { return site_.start(); }

    void serve(const std::function<bool()>& should_stop) {
        while (!should_stop()) {
            wait();
            accept_all();
            std::erase_if(connections_, [&](Connection& one) { return !advance(one); });
        }
    }

private:
    void wait() {
        std::vector<pollfd> waiting = {{listener_.number(), POLLIN, 0}};
        for (const Connection& one : connections_) {
            const bool is_reading = one.response.empty();
            waiting.push_back(
                {one.socket.number(), static_cast<std::int16_t>(is_reading ? POLLIN : POLLOUT), 0});
        }
        ::poll(waiting.data(), waiting.size(), static_cast<int>(kStopInterval.count()));
    }

    void accept_all() {
        for (;;) {
            const int number =
                ::accept4(listener_.number(), nullptr, nullptr, SOCK_NONBLOCK | SOCK_CLOEXEC);
            if (number < 0) {
                return;
            }
            if (connections_.size() >= kMaxConnections) {
                connections_.erase(connections_.begin());
            }
            connections_.push_back({Descriptor(number), Clock::now(), "", "", 0});
        }
    }

    // Reads or writes what can be; false when it is over.
    bool advance(Connection& one) {
        if (Clock::now() - one.since > kPatience) {
            return false;
        }
        if (one.response.empty() && !read_request(one)) {
            return false;
        }
        return one.response.empty() || write_response(one);
    }

    bool read_request(Connection& one) const {
        std::array<char, 4096> bytes{};
        for (;;) {
            const ssize_t got = ::recv(one.socket.number(), bytes.data(), bytes.size(), 0);
            if (got <= 0) {
                return should_wait(got);
            }
            one.since = Clock::now();
            one.request.append(bytes.data(), static_cast<std::size_t>(got));
            const std::size_t end = end_of_request(one.request);
            if (end != std::string::npos) {
                one.response = answer(std::string_view(one.request).substr(0, end));
                return true;
            }
            if (one.request.size() > kMaxHeader) {
                one.response = to_bytes(refusal(431, "the request is too long"));
                return true;
            }
        }
    }

    [[nodiscard]] std::string answer(std::string_view header) const {
        const std::optional<HttpRequest> request = parse_request(header);
        return to_bytes(request ? site_.answer(*request, port_)
                                : refusal(400, "the request is not understood"));
    }

    static bool write_response(Connection& one) {
        while (one.sent < one.response.size()) {
            const ssize_t written = ::send(one.socket.number(), one.response.data() + one.sent,
                                           one.response.size() - one.sent, MSG_NOSIGNAL);
            if (written <= 0) {
                return should_wait(written);
            }
            one.since = Clock::now();
            one.sent += static_cast<std::size_t>(written);
        }
        ::shutdown(one.socket.number(), SHUT_WR);
        return false;
    }

    RunSite site_;
    Descriptor listener_;
    int port_;
    std::vector<Connection> connections_;
};

RunServer::RunServer(const std::filesystem::path& page, const std::filesystem::path& run, int port)
    : sockets_(std::make_unique<Sockets>(page, run, port)) {}

RunServer::~RunServer() = default;

int RunServer::port() const {
    return sockets_->port();
}

std::string RunServer::address() const {
    return "http://127.0.0.1:" + std::to_string(port()) + sockets_->start();
}

void RunServer::serve(const std::function<bool()>& should_stop) {
    sockets_->serve(should_stop);
}

}  // namespace pent::viewer
