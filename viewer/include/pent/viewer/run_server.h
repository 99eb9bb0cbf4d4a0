#pragma once

#include <filesystem>
#include <functional>
#include <memory>
#include <string>

namespace pent::viewer {

/// Shows a run in browsers of this machine: a small HTTP server on 127.0.0.1 that gives out the
/// page of web/ and the files of one run, and nothing else. Requests that do not name this machine
/// as their host are refused, and only GET is understood. A run may grow while it is served.
class RunServer {
public:
    /// Begins to listen.
    ///
    /// @param page  index.html as scripts/web.sh builds it.
    /// @param run   A run folder, a .pent mesh, or a model of other programs (.g4b, .g4tf).
    /// @param port  1..65535; 0 for any that is free.
    /// Throws an Error if the page or the run cannot be read, or the port is taken.
    RunServer(const std::filesystem::path& page, const std::filesystem::path& run, int port);
    ~RunServer();
    RunServer(const RunServer&) = delete;
    RunServer& operator=(const RunServer&) = delete;
    RunServer(RunServer&&) = delete;
    RunServer& operator=(RunServer&&) = delete;

    [[nodiscard]] int port() const;

    /// What to open: "http://127.0.0.1:40123/?run=octopus/".
    [[nodiscard]] std::string address() const;

    /// Answers requests until `should_stop`, which is asked ten times a second, says so.
    void serve(const std::function<bool()>& should_stop);

private:
    class Sockets;
    std::unique_ptr<Sockets> sockets_;
};

}  // namespace pent::viewer
