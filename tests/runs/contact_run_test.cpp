#include "simulator/contact_scenes.h"
#include "support/temp_folder.h"

#include <pent/pent_file.h>
#include <pent/runs/run.h>

#include <gtest/gtest.h>

#include <fstream>
#include <iterator>
#include <map>
#include <nlohmann/json.hpp>
#include <sstream>

// What a run with contact writes.

namespace pent::runs {
namespace {

using namespace simulator;
namespace test = simulator::test;

namespace fs = std::filesystem;
using pent::test::TempFolder;

std::string read_text(const fs::path& path) {
    std::ifstream file(path, std::ios::binary);
    return {std::istreambuf_iterator<char>(file), std::istreambuf_iterator<char>()};
}

// Two cubes that fall on each other and on the floor, with all output of contact.
Scene falling_cubes(const TempFolder& folder) {
    write_mesh(folder / "cube.pent", test::cube<4>());
    Scene scene = test::two_cubes<4>(0.04);
    scene.gravity[1] = -9.8;
    scene.frames = 4;
    scene.steps_per_frame = 2;
    scene.output = {.vertex = {simulator::VertexQuantity::ContactForce}, .contact_pairs = true};
    scene.obstacles = {
        {.shape = HalfSpaceObstacle{.normal = Eigen::Vector4d::UnitY(), .offset = -0.01}}};
    for (Body& body : scene.bodies) {
        body.mesh = (folder / "cube.pent").string();
    }
    return scene;
}

TEST(RunWithContact, WritesForcesAndPairsThatAgree) {
    const TempFolder folder;
    const RunReport report = run(falling_cubes(folder), {.folder = folder / "run"});
    ASSERT_EQ(report.verdict, RunVerdict::Finished);
    std::ifstream table(folder / "run/contacts/000004.csv");
    std::string line;
    ASSERT_TRUE(std::getline(table, line));
    EXPECT_EQ(line, "kind,first,second,distance,fx,fy,fz,fw,v0,v1,v2,v3,v4,w0,w1,w2,w3,w4");
    std::map<std::string, std::int64_t> counts;
    std::map<std::string, Eigen::Vector4d> sums{{"a", Eigen::Vector4d::Zero()},
                                                {"b", Eigen::Vector4d::Zero()}};
    while (std::getline(table, line)) {
        std::istringstream row(line);
        std::vector<std::string> cells;
        for (std::string cell; std::getline(row, cell, ',');) {
            cells.push_back(cell);
        }
        ASSERT_EQ(std::count(line.begin(), line.end(), ','), 17) << line;
        const Eigen::Vector4d force(std::stod(cells[4]), std::stod(cells[5]), std::stod(cells[6]),
                                    std::stod(cells[7]));
        ++counts[cells[0]];
        sums.at(cells[1]) += force;
        if (cells[0] != "obstacle") {
            sums.at(cells[2]) -= force;
        }
    }
    const ContactSummary& contact = report.steps.back().contact;
    EXPECT_EQ(counts["point-facet"], contact.point_facet);
    EXPECT_EQ(counts["mixed"], contact.mixed);
    EXPECT_EQ(counts["obstacle"], contact.obstacle);
    EXPECT_GT(contact.mixed, 0);
    EXPECT_GT(contact.obstacle, 0);
    for (const auto& [body, sum] : sums) {
        const auto frame = read_frame<4>(folder / "run/frames" / (body + "_000004.pent"));
        const Eigen::Vector4d forces = frame.contact_forces.rowwise().sum();
        EXPECT_LT((forces - sum).norm(), 1e-9 * frame.contact_forces.cwiseAbs().sum());
        EXPECT_GT(sum.norm(), 0);
    }
}

TEST(RunWithContact, ReportsWhatTouchesAndWhatItCost) {
    const TempFolder folder;
    const RunReport report = run(falling_cubes(folder), {.folder = folder / "run"});
    const auto json = nlohmann::json::parse(read_text(folder / "run/report.json"));
    const auto& last = json.at("steps").back().at("contact");
    const ContactSummary& contact = report.steps.back().contact;
    EXPECT_EQ(last.at("mixed"), contact.mixed);
    EXPECT_EQ(last.at("deepest"), contact.deepest);
    EXPECT_EQ(last.at("smallest_distance"), contact.smallest_distance);
    EXPECT_GT(last.at("seconds"), 0);
    EXPECT_GT(json.at("size").at("contact_bytes"), 0);
    EXPECT_LT(contact.smallest_distance, 0.05);
}

TEST(RunWithContact, ResumesToTheSameBytes) {
    const TempFolder folder;
    const Scene scene = falling_cubes(folder);
    static_cast<void>(run(scene, {.folder = folder / "whole"}));
    int asked = 0;
    static_cast<void>(run(scene, {.folder = folder / "cut"},
                          {.should_stop = [&] { return ++asked > 5; }, .on_frame = nullptr}));
    const RunReport resumed = run(scene, {.folder = folder / "cut", .resume = true, .threads = 2});
    EXPECT_EQ(resumed.verdict, RunVerdict::Finished);
    EXPECT_EQ(resumed.steps.size(), 8U);
    for (const char* file : {"frames/a_000004.pent", "frames/b_000004.pent", "contacts/000003.csv",
                             "contacts/000004.csv"}) {
        EXPECT_EQ(read_text(folder / "whole" / file), read_text(folder / "cut" / file)) << file;
    }
}

TEST(RunWithoutOutput, WritesNoForcesAndNoTables) {
    const TempFolder folder;
    Scene scene = falling_cubes(folder);
    scene.output = {};
    scene.frames = 1;
    static_cast<void>(run(scene, {.folder = folder / "run"}));
    EXPECT_EQ(read_frame<4>(folder / "run/frames/a_000001.pent").contact_forces.cols(), 0);
    EXPECT_FALSE(fs::exists(folder / "run/contacts"));
}

}  // namespace
}  // namespace pent::runs
