#include "record.h"

#include "support/messages.h"
#include "support/temp_folder.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <fstream>

namespace pent::study {
namespace {

TEST(Record, IsReadBackAsItWasWritten) {
    const pent::test::TempFolder folder;
    Record record{.scene = "a\n\"b\"",
                  .reference = "r",
                  .meshes = 7,
                  .threads = 5,
                  .verdict = UnitVerdict::Finished};
    record.wall_seconds = {0.1, 1.0 / 3, 2};
    record.machines = {{"n1", "A"}, {"n2", "B"}, {"n1", "A"}};
    record.errors.position = 0.01 / 3;
    record.errors.angular_momentum = {1, 2, 3, 4, 5, 6};
    record.errors.iterations = 1'000'000'000'000;
    write_record(folder / "r.json", record);
    const std::optional<Record> back = read_record(folder / "r.json");
    ASSERT_TRUE(back);
    EXPECT_EQ(back->scene, record.scene);
    EXPECT_EQ(back->meshes, record.meshes);
    EXPECT_EQ(back->threads, 5);
    EXPECT_EQ(back->wall_seconds, record.wall_seconds);
    EXPECT_EQ(back->machines, record.machines);
    EXPECT_EQ(back->errors.position, record.errors.position);
    EXPECT_EQ(back->errors.angular_momentum, record.errors.angular_momentum);
    EXPECT_EQ(back->errors.iterations, record.errors.iterations);
    EXPECT_DOUBLE_EQ(cost_of(*back, 10).seconds_per_frame, 1.0 / 30);
}

TEST(Record, MayNameFilesWhoseNamesAreNotUtf8) {
    const pent::test::TempFolder folder;
    write_record(folder / "r.json", {.message = "a\xff.pent: is damaged"});
    EXPECT_EQ(read_record(folder / "r.json")->message, "a\xef\xbf\xbd.pent: is damaged");
}

TEST(Record, IsNothingWhereThereIsNoFileAndAnErrorWhereThereIsAnother) {
    const pent::test::TempFolder folder;
    EXPECT_FALSE(read_record(folder / "none.json"));
    std::ofstream(folder / "bad.json") << "{\"verdict\": 3";
    pent::test::expect_contains(
        pent::test::error_of([&] { static_cast<void>(read_record(folder / "bad.json")); }),
        {"bad.json", "remove"});
}

TEST(Record, KeepsEveryVerdictAndRefusesAWordThatIsNone) {
    const pent::test::TempFolder folder;
    const auto path = folder / "r.json";
    for (const UnitVerdict verdict : simulator::values<UnitVerdict>()) {
        write_record(path, {.verdict = verdict});
        EXPECT_EQ(read_record(path)->verdict, verdict);
    }
    std::string text = read_text(path);
    const std::string last = R"("verdict": "stopped")";
    ASSERT_NE(text.find(last), std::string::npos) << text;
    std::ofstream(path) << text.replace(text.find(last), last.size(), R"("verdict": "finish")");
    pent::test::expect_contains(pent::test::error_of([&] { static_cast<void>(read_record(path)); }),
                                {"r.json", "unknown verdict \"finish\"", "remove"});
}

// Test vectors of the authors of FNV: nothing, "a", "foobar".
TEST(Fingerprint, IsFnv1aOfAllBytes) {
    const pent::test::TempFolder folder;
    const auto of = [&](const std::string& bytes) {
        std::ofstream(folder / "program", std::ios::binary) << bytes;
        return fingerprint(folder / "program");
    };
    EXPECT_EQ(of(""), "cbf29ce484222325");
    EXPECT_EQ(of("a"), "af63dc4c8601ec8c");
    EXPECT_EQ(of("foobar"), "85944171f73967e8");
}

TEST(StudyCsv, HasAsManyFieldsInEveryLineAsInItsHead) {
    StudyReport report;
    report.results.resize(2);
    report.results[0].settings = {{"dt", "1/30"}, {"filter", "none"}};
    report.results[1].settings = {{"dt", "1/60"}, {"filter", "none"}};
    const std::string csv = study_csv(report);
    EXPECT_EQ(std::ranges::count(csv, '\n'), 3);
    const std::string head = csv.substr(0, csv.find('\n'));
    EXPECT_EQ(std::ranges::count(csv, ','), 3 * std::ranges::count(head, ','));
    pent::test::expect_contains(csv, {"dt,filter,verdict", "1/30,none,", "1/60,none,"});
}

TEST(StudyCsv, HasAListInOneFieldAndItsQuotesTwice) {
    StudyReport report;
    report.results.resize(1);
    report.results[0].settings = {{"scene.gravity", "[0,1]"}, {"load.kind", "\"x\""}};
    pent::test::expect_contains(study_csv(report), {"\n\"[0,1]\",\"\"\"x\"\"\","});
}

}  // namespace
}  // namespace pent::study
