#include "run_program.h"
#include "support/kuhn_box.h"
#include "support/messages.h"
#include "support/temp_folder.h"

#include <pent/output_file.h>
#include <pent/pent_file.h>

#include <gtest/gtest.h>

#include <filesystem>
#include <nlohmann/json.hpp>
#include <string>

namespace pent {
namespace {

using test::expect_contains;
using test::expect_one_error_line;
using test::Outcome;
using test::run_program;
using test::text_of;

class PentConvert : public testing::Test {
protected:
    PentConvert() {
        write_mesh(folder_ / "box.pent", test::kuhn_box<4>({1, 1, 1, 1}, {1, 1, 1, 2}));
    }
    [[nodiscard]] std::string at(const std::string& name) const {
        return (folder_ / name).string();
    }
    [[nodiscard]] Outcome convert(const std::string& from,
                                  const std::string& to,
                                  const std::string& options = "") const {
        return run_program("pent-convert " + at(from) + " -o " + at(to) + " " + options);
    }

    // One line of an error with these words in it.
    void expect_refusal(const std::string& from,
                        const std::string& to,
                        std::initializer_list<std::string> words) const {
        const Outcome outcome = convert(from, to);
        EXPECT_EQ(outcome.exit_code, 1);
        expect_one_error_line(outcome, "pent-convert");
        expect_contains(outcome.err, words);
    }

    test::TempFolder folder_;
};

TEST_F(PentConvert, SaysWhatAFormatHasNoPlaceFor) {
    MeshFile<4> file = read_mesh<4>(folder_ / "box.pent");
    const Eigen::Index cells = file.mesh.cell_count();
    file.mesh.regions.assign(static_cast<std::size_t>(cells), 3);
    file.mesh.fibers = Positions<4>::Ones(4, cells);
    file.extras.vertex_fields = {{"heat", Eigen::MatrixXd::Zero(1, file.mesh.vertex_count())}};
    file.extras.cell_fields = {{"age", Eigen::MatrixXd::Zero(1, cells)}};
    file.extras.boundary = file.mesh.cells.topLeftCorner<4, 1>();
    file.extras.labels = {7};
    write_mesh<4>(folder_ / "rich.pent", file.mesh, {}, file.extras);
    EXPECT_EQ(convert("rich.pent", "a.pent").out.find("left out"), std::string::npos);
    EXPECT_EQ(convert("box.pent", "a.g4b").out.find("left out"), std::string::npos);
    expect_contains(convert("rich.pent", "a.g4b", "--json " + at("report.json")).out,
                    {"left out   regions, labels of the boundary, fibers, heat, age: G4MF has no"});
    EXPECT_EQ(nlohmann::json::parse(text_of(at("report.json"))).at("left_out"),
              "regions, labels of the boundary, fibers, heat, age");
    expect_contains(convert("rich.pent", "a.mesh").out,
                    {"left out   fibers, heat, age: MFEM mesh has no place"});
}

TEST_F(PentConvert, WritesIntoFoldersThatItMakes) {
    const Outcome made = convert("box.pent", "new/sub/box.g4b", "--json " + at("reports/a.json"));
    EXPECT_EQ(made.exit_code, 0) << made.err;
    EXPECT_TRUE(std::filesystem::exists(folder_ / "new/sub/box.g4b"));
    EXPECT_TRUE(std::filesystem::exists(folder_ / "reports/a.json"));
}

TEST_F(PentConvert, GoesFromABodyToItsBoundaryAndBack) {
    const Outcome there = convert("box.pent", "box.g4b", "--json " + at("report.json"));
    EXPECT_EQ(there.exit_code, 0) << there.err;
    expect_contains(there.out, {"body       16 vertices, 24 pentachora, 2 m^4", "finished: "});
    const auto report = nlohmann::json::parse(text_of(at("report.json")));
    EXPECT_EQ(report.at("cells"), 24);
    EXPECT_NEAR(report.at("hypervolume").get<double>(), 2, 1e-14);
    const Outcome back = convert("box.g4b", "again.pent");
    EXPECT_EQ(back.exit_code, 0) << back.err;
    expect_contains(back.out, {"boundary   16 points, 48 tetrahedra, closed, around 2 m^4"});
    EXPECT_NEAR(total_volume(read_mesh<4>(at("again.pent")).mesh), 2, 1e-14);
}

TEST_F(PentConvert, AddsFramesOfARunAsBlendShapes) {
    Frame<4> frame;
    frame.positions = 2 * read_mesh<4>(at("box.pent")).mesh.positions;
    frame.mesh_name = "box.pent";
    frame.mesh_crc = read_info(at("box.pent")).crc32c;
    frame.time = 0.25;
    write_frame<4>(at("box_000000.pent"), frame);
    frame.time = 0.5;
    write_frame<4>(at("box_000001.pent"), frame);
    const std::string frames = "--frames " + at("box_000000.pent") + " " + at("box_000001.pent");
    const Outcome outcome = convert("box.pent", "box.g4tf", frames);
    EXPECT_EQ(outcome.exit_code, 0) << outcome.err;
    expect_contains(outcome.out, {"frames     2, a blend shape each"});
    const auto shapes =
        nlohmann::json::parse(text_of(at("box.g4tf"))).at("meshes").at(0).at("blend").at("shapes");
    ASSERT_EQ(shapes.size(), 2U);
    EXPECT_EQ(shapes[0].at("name"), "box_000000 at 0.25 s");
    EXPECT_EQ(shapes[1].at("name"), "box_000001 at 0.5 s");
    // Of another mesh, or in a format without any.
    frame.mesh_crc ^= 1U;
    write_frame<4>(at("other_000000.pent"), frame);
    const Outcome other = convert("box.pent", "other.g4tf", "--frames " + at("other_000000.pent"));
    EXPECT_EQ(other.exit_code, 1);
    expect_contains(other.err, {"other_000000.pent: is a frame of another mesh"});
    // Each once, and never written over.
    EXPECT_EQ(convert("box.pent", "box.g4tf", frames + " " + at("box_000000.pent")).exit_code, 1);
    const std::string before = text_of(at("box_000000.pent"));
    for (const std::string& options : {frames + " --json " + at("box_000000.pent"), frames}) {
        const Outcome over = convert("box.pent", "box_000000.pent", options);
        EXPECT_EQ(over.exit_code, 1);
        expect_contains(over.err, {"box_000000.pent", "is the same file as --frames"});
        EXPECT_EQ(text_of(at("box_000000.pent")), before);
    }
    const Outcome report =
        convert("box.pent", "box.g4b", frames + " --json " + at("box_000000.pent"));
    expect_contains(report.err, {"box_000000.pent: --json is the same file as --frames"});
    EXPECT_EQ(text_of(at("box_000000.pent")), before);
    // By whatever name the mesh goes.
    std::filesystem::copy(at("box.pent"), at("BOX.PENT"));
    EXPECT_EQ(convert("BOX.PENT", "again.g4tf", frames).exit_code, 0);
    const Outcome none = convert("box.pent", "box.4do", frames);
    EXPECT_EQ(none.exit_code, 1);
    expect_contains(none.err, {"4DO has no frames; expected .g4tf or .g4b"});
}

TEST_F(PentConvert, MakesABodyOfABoundaryWithPointsThatNothingHas) {
    EXPECT_EQ(convert("box.pent", "box.4do").exit_code, 0);
    std::string text = text_of(at("box.4do"));
    write_text(at("more.4do"), text.insert(text.find("tformat"), "v 9 9 9 9\n"));
    const Outcome outcome = convert("more.4do", "more.pent");
    EXPECT_EQ(outcome.exit_code, 0) << outcome.err;
    expect_contains(outcome.out, {"boundary   16 points, 48 tetrahedra, closed"});
    EXPECT_EQ(read_info(at("more.pent")).vertices, 16U + 1);  // and the one that sees them all
}

TEST_F(PentConvert, RefusesInOneLineAndLeavesNothingBehind) {
    expect_refusal("box.pent", "box.fbx", {"box.fbx", "expected one of .pent"});
    expect_refusal("none.4do", "box.pent", {"none.4do: no such file"});
    expect_refusal("box.pent", "box.pent", {"is the same file as the input"});
    EXPECT_GT(read_mesh<4>(at("box.pent")).mesh.cell_count(), 0);
    EXPECT_EQ(convert("box.pent", "box.4do").exit_code, 0);
    std::string text = text_of(at("box.4do"));
    text.erase(text.rfind("t ", text.size() - 3));  // the last two
    write_text(at("open.4do"), text);
    const Outcome open = convert("open.4do", "open.off");
    EXPECT_EQ(open.exit_code, 0);
    expect_contains(open.out, {"not closed: "});
    expect_refusal("open.4do", "open.pent", {"is no closed surface"});
    EXPECT_FALSE(std::filesystem::exists(at("open.pent")));
}

}  // namespace
}  // namespace pent
