#include "record/run_report.h"

#include "falling_bar.h"
#include "old_report.h"
#include "record/json_record.h"
#include "support/messages.h"

#include <pent/runs/run.h>

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <fstream>

namespace pent::runs {
namespace {

using pent::test::TempFolder;

class ReportFile : public testing::Test {
protected:
    ReportFile() : report_(run(test::falling_bar(folder_, 2), {.folder = folder_ / "run"})) {}

    RunReport read_with(const std::string& text) const {
        std::ofstream(folder_ / "report.json") << text;
        return read_report(folder_ / "report.json");
    }
    std::string error_with(const std::string& from, const std::string& to) const {
        std::string text = report_text(report_);
        text.replace(text.find(from), from.size(), to);
        return pent::test::error_of([&] { static_cast<void>(read_with(text)); });
    }

    TempFolder folder_;
    RunReport report_;
};

// Texts, counts, lists, words, and a distance that is infinite.
TEST_F(ReportFile, IsReadAsItWasWritten) {
    report_.message = "why";
    report_.warnings = {"one", "two"};
    report_.parts.push_back({.created_by = "b", .threads = 3, .isa = "c"});
    report_.parts.back().verdict = RunVerdict::Died;
    report_.steps[0].failure = "\"quoted\"";
    report_.steps[1].contact.smallest_distance = -0.25;
    report_.steps[1].energies.terms.push_back({"a new term", 1e-300});
    const RunReport again = read_with(report_text(report_));
    EXPECT_EQ(report_text(again), report_text(report_));
    EXPECT_EQ(again.steps[1].energies.of("a new term"), 1e-300);
    EXPECT_TRUE(std::isinf(again.steps[0].contact.smallest_distance));
    EXPECT_TRUE(again.steps[0].is_accepted);
    EXPECT_EQ(again.frames[2].non_rigid[0].body, "box");
    EXPECT_EQ(again.bodies[0].non_rigid_max,
              std::max(report_.frames[1].non_rigid[0].value, report_.frames[2].non_rigid[0].value));
}

// It is written entry by entry: the same bytes as from all of it at once.
TEST_F(ReportFile, IsTheTextOfItsRecord) {
    const auto expect_same = [&] {
        EXPECT_EQ(report_text(report_),
                  write_record(report_).dump(1, ' ', false, Json::error_handler_t::replace) + "\n");
    };
    expect_same();
    report_.message = "two\nlines of \"a\xff.pent\"";
    report_.warnings = {"one", "{\n}"};
    report_.parts.push_back({.created_by = "b", .threads = 3, .isa = "c"});
    report_.steps[0].constraints.resize(2);
    expect_same();
    report_.frames.resize(1);
    report_.steps.clear();
    expect_same();
    report_.frames.clear();
    report_.bodies.clear();
    expect_same();
}

TEST_F(ReportFile, OfVersion010IsRead) {
    const RunReport old = read_with(test::report_text_of_version_010(report_));
    ASSERT_EQ(old.steps.size(), report_.steps.size());
    for (std::size_t i = 0; i < old.steps.size(); ++i) {
        for (const char* name : {"elastic", "gravity"}) {
            EXPECT_EQ(old.steps[i].energies.of(name), report_.steps[i].energies.of(name));
        }
        EXPECT_EQ(old.steps[i].energies.kinetic, report_.steps[i].energies.kinetic);
    }
    ASSERT_EQ(old.parts.size(), 1U);
    EXPECT_EQ(old.parts[0].verdict, RunVerdict::Finished);
    EXPECT_EQ(old.parts[0].last_frame, 2);
    EXPECT_EQ(old.parts[0].seconds, old.seconds);
}

// What is used by a line search but cannot be had back is no energy of a report.
TEST_F(ReportFile, HasTheEnergiesThatAreStored) {
    report_.steps[0].energies.terms.push_back({"friction", 1, false});
    const RunReport again = read_with(report_text(report_));
    EXPECT_EQ(again.steps[0].energies.of("friction"), 0);
    EXPECT_EQ(again.steps[0].energies.terms.size() + 1, report_.steps[0].energies.terms.size());
}

TEST_F(ReportFile, IsRefusedWithItsNameWhereItIsNotOne) {
    pent::test::expect_contains(error_with("\"substeps\"", "\"steps\""),
                                {"report.json: not the report of a run", "substeps"});
    for (const char* wrong : {"-1", "1.5", "\"1\"", "null"}) {
        EXPECT_NE(error_with("\"substeps\": 1", std::string("\"substeps\": ") + wrong), "")
            << wrong;
    }
    pent::test::expect_contains(error_with("\"substeps\": 1", "\"substeps\": 4294967303"),
                                {"the number 4294967303 is too large"});
    pent::test::expect_contains(error_with("\"finished\"", "\"fine\""), {"\"fine\""});
    pent::test::expect_contains(error_with("{", "["), {"report.json: not the report of a run"});
}

// However long it takes to write, a run has nearly all of the time; people see it grow, if they
// can.
TEST(ReportPause, LeavesTheTimeToTheRun) {
    for (const double seconds : {0.0, 1e-3, 0.05, 0.2, 3.0, 60.0}) {
        const double pause = report_pause(seconds);
        EXPECT_LE(seconds, 0.0100001 * (seconds + pause));
        EXPECT_GE(pause, 10);
        EXPECT_LE(pause, std::max(10.0, 100 * seconds));
    }
}

}  // namespace
}  // namespace pent::runs
