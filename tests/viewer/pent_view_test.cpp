#include "ask.h"
#include "runs.h"
#include "web_pages.h"

#include <gtest/gtest.h>

#include <apps/run_program.h>
#include <chrono>
#include <cstdlib>
#include <filesystem>
#include <string>
#include <support/messages.h>
#include <support/temp_folder.h>
#include <thread>

namespace pent::viewer {
namespace {

using pent::test::expect_contains;
using pent::test::expect_one_error_line;
using pent::test::Outcome;
using pent::test::run_program;
using pent::test::TempFolder;
using pent::test::text_of;

class PentView : public testing::Test {
protected:
    PentView() {
        test::write_run(folder_ / "run", "a", {0, 1, 2});
        page_ = " --page " + test::write_page(folder_.path()).string();
    }

    [[nodiscard]] std::string at(const std::string& name) const {
        return (folder_ / name).string();
    }

    TempFolder folder_;
    std::string page_;
};

// The port that the program says, as soon as it does.
int port_said_in(const std::filesystem::path& path) {
    for (int tries = 0; tries < 3000; ++tries) {  // half a minute, for a busy machine
        const std::string text = text_of(path);
        const std::size_t place = text.find("http://127.0.0.1:");
        if (place != std::string::npos && text.find('\n', place) != std::string::npos) {
            return std::atoi(text.c_str() + place + 17);  // NOLINT(cert-err34-c): 0 fails the test
        }
        std::this_thread::sleep_for(std::chrono::milliseconds(10));
    }
    return 0;
}

TEST_F(PentView, ShowsARunUntilCtrlC) {
    std::thread browser([&] {
        const int port = port_said_in(folder_ / "said");
        EXPECT_EQ(test::ask(port, "/run/run.json").rfind("HTTP/1.1 200 OK", 0), 0U);
        write_text(folder_ / "seen", "");
    });
    const std::string to_file = " sh -c 'exec \"$@\" > " + at("said") + "' sh";
    const Outcome outcome = run_program("pent-view " + at("run") + page_ + " --no-open",
                                        pent::test::interrupt_at(folder_ / "seen") + to_file);
    browser.join();
    EXPECT_EQ(outcome.exit_code, 0) << outcome.err;
    expect_contains(text_of(folder_ / "said"),
                    {"open http://127.0.0.1:", "/?run=run/", "finished"});
}

TEST_F(PentView, ExportsOnePageAndSaysItsSize) {
    const std::string out = at("page.html");
    const Outcome outcome = run_program("pent-view " + at("run") + page_ + " --export " + out
                                        + " --frames ::2 --json " + at("report.json"));
    EXPECT_EQ(outcome.exit_code, 0) << outcome.err;
    expect_contains(outcome.out, {"finished: 2 frames in " + out, " MB; positions are right to "});
    expect_contains(text_of(out), {"id=\"pent-frame-1\"", "\"frame\":2,"});
    expect_contains(text_of(at("report.json")), {"\"frames\": 2", "\"largest_error\""});
}

TEST_F(PentView, RefusesWhatItCannotDo) {
    const auto expect_refused = [&](const std::string& arguments, const std::string& part) {
        const Outcome outcome = run_program("pent-view " + arguments);
        EXPECT_EQ(outcome.exit_code, 1) << arguments;
        expect_one_error_line(outcome, "pent-view");
        expect_contains(outcome.err, {part});
    };
    expect_refused(at("none") + page_, "none: no such file or folder");
    expect_refused(at("run") + " --page " + at("none"), "build the page with scripts/web.sh");
    expect_refused(at("run") + page_ + " --frames 1", "--frames: found without --export");
    expect_refused(at("run") + page_ + " --limit 0.1 --export " + "/dev/null/no/folder.html",
                   "/dev/null/no: folder cannot be made");
    EXPECT_EQ(run_program("pent-view " + at("run") + " --port 70000").exit_code, 2);
}

}  // namespace
}  // namespace pent::viewer
