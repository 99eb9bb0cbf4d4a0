#include "ask.h"
#include "runs.h"
#include "web_pages.h"

#include <pent/viewer/run_server.h>

#include <gtest/gtest.h>

#include <atomic>
#include <filesystem>
#include <fstream>
#include <iterator>
#include <memory>
#include <string>
#include <support/messages.h>
#include <support/temp_folder.h>
#include <thread>
#include <vector>

namespace pent::viewer {
namespace {

namespace fs = std::filesystem;
using pent::test::TempFolder;
using test::ask;
using test::Client;

class ARunServer : public testing::Test {
protected:
    ARunServer() {
        test::write_run(folder_ / "run", "a", {0, 1});
        server_ = std::make_unique<RunServer>(test::write_page(folder_.path()), folder_ / "run", 0);
        thread_ = std::thread([this] { server_->serve([this] { return should_stop_.load(); }); });
    }

    ~ARunServer() override {
        should_stop_ = true;
        thread_.join();
    }

    [[nodiscard]] int port() const { return server_->port(); }

    TempFolder folder_;
    std::unique_ptr<RunServer> server_;
    std::atomic<bool> should_stop_ = false;
    std::thread thread_;
};

std::string body_of(const std::string& answer) {
    return answer.substr(std::min(answer.find("\r\n\r\n"), answer.size() - 4) + 4);
}

TEST_F(ARunServer, GivesFilesByteForByte) {
    EXPECT_EQ(server_->address(), "http://127.0.0.1:" + std::to_string(port()) + "/?run=run/");
    EXPECT_EQ(ask(port(), "/?run=run/").rfind("HTTP/1.1 200 OK\r\n", 0), 0U);
    const fs::path path = folder_ / "run" / "frames" / "a_000001.pent";
    std::ifstream file(path, std::ios::binary);
    const std::string expected(std::istreambuf_iterator<char>(file), {});
    EXPECT_EQ(body_of(ask(port(), "/run/frames/a_000001.pent")), expected);
    EXPECT_EQ(ask(port(), "/run/frames/../../secret").rfind("HTTP/1.1 404", 0), 0U);
}

TEST_F(ARunServer, GivesFilesLargerThanWhatASocketTakesAtOnce) {
    const std::string large(20'000'000, 'x');
    write_text(folder_ / "run" / "meshes" / "large.pent", large);
    EXPECT_EQ(body_of(ask(port(), "/run/meshes/large.pent")), large);
}

TEST_F(ARunServer, DoesNotWaitForThoseWhoSayNothing) {
    std::vector<std::unique_ptr<Client>> silent;
    for (int i = 0; i < 100; ++i) {
        silent.push_back(std::make_unique<Client>(port()));
    }
    silent.back()->send("GET / HTT");
    EXPECT_EQ(ask(port(), "/").rfind("HTTP/1.1 200", 0), 0U);
}

TEST_F(ARunServer, RefusesWhatIsNoRequest) {
    const Client client(port());
    client.send("\x16\x03\x01 hello\r\n\r\n");
    EXPECT_EQ(client.receive().rfind("HTTP/1.1 400", 0), 0U);
    const Client endless(port());
    endless.send("GET / HTTP/1.1\r\nX: " + std::string(20000, 'x'));
    EXPECT_EQ(endless.receive().rfind("HTTP/1.1 431", 0), 0U);
}

TEST_F(ARunServer, SaysThatAPortIsTaken) {
    const std::string error =
        pent::test::error_of([&] { RunServer(folder_ / "index.html", folder_ / "run", port()); });
    pent::test::expect_contains(error, {"port " + std::to_string(port()) + ": cannot be used",
                                        "choose another with --port"});
}

}  // namespace
}  // namespace pent::viewer
