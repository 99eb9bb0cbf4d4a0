#include "runs.h"
#include "web_pages.h"

#include <pent/formatted.h>
#include <pent/geometry.h>
#include <pent/obstacles_file.h>
#include <pent/viewer/attributes.h>
#include <pent/viewer/coloring.h>
#include <pent/viewer/export_page.h>

#include <gtest/gtest.h>

#include <fstream>
#include <iterator>
#include <string>
#include <support/messages.h>
#include <support/temp_folder.h>

namespace pent::viewer {
namespace {

namespace fs = std::filesystem;
using pent::test::error_of;
using pent::test::expect_contains;
using pent::test::TempFolder;

const OnProgress kGoOn = [](std::string_view, std::int64_t, std::int64_t) { return true; };

std::string text_of(const fs::path& path) {
    std::ifstream file(path, std::ios::binary);
    return {std::istreambuf_iterator<char>(file), {}};
}

// What stands in <script ... id="ID">...</script>.
std::string element(const std::string& page, const std::string& id) {
    const std::size_t at = page.find(" id=\"" + id + "\">");
    if (at == std::string::npos) {
        return "";
    }
    const std::size_t begin = page.find('>', at) + 1;
    return page.substr(begin, page.find('<', begin) - begin);
}

std::string decoded(const std::string& base64) {
    const std::string digits = "ABCDEFGHIJKLMNOPQRSTUVWXYZabcdefghijklmnopqrstuvwxyz0123456789+/";
    std::string bytes;
    for (std::size_t i = 0; i + 4 <= base64.size(); i += 4) {
        std::uint32_t three = 0;
        for (std::size_t k = 0; k < 4; ++k) {
            const char c = base64[i + k];
            three = three << 6 | (c == '=' ? 0U : static_cast<std::uint32_t>(digits.find(c)));
        }
        for (std::size_t k = 0; k < 3 && base64[i + k + 1] != '='; ++k) {
            bytes += static_cast<char>(three >> (16 - 8 * k) & 255);
        }
    }
    return bytes;
}

class AnExportedPage : public testing::Test {
protected:
    AnExportedPage() { test::write_run(folder_ / "twist", "a<b", {0, 1, 2}); }

    [[nodiscard]] ExportReport make(const fs::path& input, ExportOptions options) const {
        const RunFolder run = open_run(input);
        if (options.frames.empty()) {
            options.frames = run.frames;
        }
        options.page = test::write_page(folder_.path());
        return export_page(run, folder_ / "out.html", options, kGoOn);
    }

    TempFolder folder_;
};

TEST_F(AnExportedPage, HoldsEveryPositionToWithinHalfAStep) {
    const ExportReport report = make(folder_ / "twist", {});
    ASSERT_TRUE(report.is_complete);
    const std::string page = text_of(folder_ / "out.html");
    EXPECT_EQ(report.bytes, static_cast<std::int64_t>(page.size()));
    EXPECT_EQ(page.find("<!-- run -->"), std::string::npos);
    expect_contains(element(page, "pent-run"),
                    {"\"version\":2", "\"title\":\"twist\"", "\"name\":\"a\\u003cb\"",
                     "\"dimension\":4", "\"fields\":[]", "{\"frame\":2,\"time\":0.2"});
    const RunFolder run = open_run(folder_ / "twist");
    const auto bodies = load_bodies<4>(run);
    Eigen::AlignedBox4d box;
    for (const int frame : run.frames) {
        const Positions<4> positions = load_frame<4>(run, bodies[0], frame).positions;
        for (const auto& point : positions.colwise()) {
            box.extend(point);
        }
    }
    // The mesh has a vertex in its middle that the boundary does not have.
    const Eigen::Index shell = bodies[0].mesh.vertex_count() - 1;
    for (const int frame : run.frames) {
        const std::string bytes = decoded(element(page, "pent-frame-" + std::to_string(frame)));
        ASSERT_EQ(bytes.size(), static_cast<std::size_t>(shell) * (8 + 2));
        const Positions<4> expected = load_frame<4>(run, bodies[0], frame).positions;
        Eigen::Index vertex = 0;
        for (Eigen::Index v = 0; v < shell; ++v, ++vertex) {
            if (bodies[0].boundary.vertex_begin[vertex]
                == bodies[0].boundary.vertex_begin[vertex + 1]) {
                ++vertex;
            }
            for (int axis = 0; axis < 4; ++axis) {
                const std::size_t at = 2 * static_cast<std::size_t>(4 * v + axis);
                const int step = static_cast<unsigned char>(bytes[at])
                                 + 256 * static_cast<unsigned char>(bytes[at + 1]);
                const double value = box.min()[axis] + box.sizes()[axis] * step / 65535;
                // Beside half a step the rounding of the sum.
                EXPECT_NEAR(value, expected(axis, vertex), report.largest_error * (1 + 1e-9));
            }
        }
    }
}

TEST_F(AnExportedPage, OfAMeshHasOneFrameWithoutSpeed) {
    const ExportReport report = make(folder_ / "twist" / "meshes" / "a<b.pent", {});
    EXPECT_TRUE(report.is_complete);
    expect_contains(element(text_of(folder_ / "out.html"), "pent-run"),
                    {"\"quantities\":[],\"fields\":[]", "\"frames\":[{\"frame\":0,\"time\":0}]"});
}

// Those of frames in every frame, those of meshes once: each to half a step of the range of all
// frames and bodies.
TEST_F(AnExportedPage, HoldsFieldsThatAllBodiesHave) {
    const fs::path at = folder_ / "fields";
    make_folder(at / "meshes");
    make_folder(at / "frames");
    const SimplexMesh<4> mesh = test::jittered_box({2, 2, 2, 2}, 5);
    for (const std::string body : {"a", "b"}) {
        const double offset = body == "a" ? -3 : 5;
        MeshExtras<4> extras;
        extras.vertex_fields = {{"only_" + body, mesh.positions}};
        extras.cell_fields = {
            {"phase", Eigen::RowVectorXd::LinSpaced(mesh.cell_count(), 0, 1).array() + offset}};
        const std::uint32_t crc = write_mesh<4>(at / "meshes" / (body + ".pent"), mesh, {}, extras);
        for (const int number : {0, 1}) {
            Frame<4> frame;
            frame.positions = mesh.positions;
            frame.fields = {{"heat", mesh.positions.row(3).array() * (1 + number) + offset},
                            {"reaction", mesh.positions * (2 - number)}};
            frame.mesh_name = body + ".pent";
            frame.mesh_crc = crc;
            frame.frame = static_cast<std::uint64_t>(number);
            write_frame<4>(at / "frames" / frame_file_name(body, number), frame);
        }
    }
    ASSERT_TRUE(make(at, {}).is_complete);
    const std::string page = text_of(folder_ / "out.html");
    const RunFolder run = open_run(at);
    const auto bodies = load_bodies<4>(run);
    const auto values = [&](std::size_t body, int frame, const std::string& name) {
        return vertex_values<4>(bodies[body], load_frame<4>(run, bodies[body], frame),
                                coloring_of(name));
    };
    const auto shell = static_cast<std::size_t>(bodies[0].mesh.vertex_count() - 1);
    const auto expect_bytes = [&](const std::string& bytes, std::size_t from, std::size_t body,
                                  int frame, const std::string& name) {
        ColorRange range = {1e9, -1e9};
        for (const std::size_t b : {0U, 1U}) {
            for (const int f : {0, 1}) {
                const Eigen::VectorXd all = values(b, f, name);
                range = joined(range, {all.minCoeff(), all.maxCoeff()});
            }
        }
        const Eigen::VectorXd expected = values(body, frame, name);
        Eigen::Index vertex = 0;
        for (std::size_t v = 0; v < shell; ++v, ++vertex) {
            if (bodies[0].boundary.vertex_begin[vertex]
                == bodies[0].boundary.vertex_begin[vertex + 1]) {
                ++vertex;
            }
            const double size = range.high - range.low;
            const double found =
                range.low + size * static_cast<unsigned char>(bytes.at(from + v)) / 255;
            EXPECT_NEAR(found, expected[vertex], size / 509) << name << " " << v;
        }
    };
    // Strain, reaction and heat; bodies one after the other, positions in front.
    for (const int frame : {0, 1}) {
        const std::string bytes = decoded(element(page, "pent-frame-" + std::to_string(frame)));
        ASSERT_EQ(bytes.size(), 2 * shell * (8 + 3));
        for (const std::size_t body : {0U, 1U}) {
            const std::size_t begin = body * shell * 11 + shell * 8;
            expect_bytes(bytes, begin + shell, body, frame, "reaction");
            expect_bytes(bytes, begin + 2 * shell, body, frame, "heat");
        }
    }
    const std::string once = decoded(element(page, "pent-fields"));
    ASSERT_EQ(once.size(), 2 * shell);
    expect_bytes(once, 0, 0, 0, "phase");
    expect_bytes(once, shell, 1, 0, "phase");
    const std::string said = element(page, "pent-run");
    EXPECT_EQ(said.find("only_"), std::string::npos);
    EXPECT_LT(said.find("\"strain\""), said.find("\"reaction\""));
    EXPECT_LT(said.find("\"reaction\""), said.find("\"heat\""));
    EXPECT_LT(said.find("\"fields\":[{\"name\":\"phase\""), said.size());
}

// Of numbers beyond those of floats, and of vectors whose squares are beyond all numbers.
TEST_F(AnExportedPage, HasEndsThatAreNumbers) {
    const SimplexMesh<4> mesh = test::jittered_box({2, 2, 2, 2}, 5);
    MeshExtras<4> extras;
    const Eigen::RowVectorXd x = mesh.positions.row(0) / mesh.positions.row(0).maxCoeff();
    extras.vertex_fields = {{"all", 1.7e308 * x.cwiseMax(0.0).cwiseMin(1.0)},
                            {"flow", 1e200 * mesh.positions}};
    extras.vertex_fields[0].values(0, 0) = -1.7e308;
    write_mesh<4>(folder_ / "far.pent", mesh, {}, extras);
    ASSERT_TRUE(make(folder_ / "far.pent", {}).is_complete);
    const std::string page = text_of(folder_ / "out.html");
    const std::string said = element(page, "pent-run");
    expect_contains(said, {"{\"name\":\"all\",\"low\":-1.7e+308,\"high\":1.7e+308}",
                           "{\"name\":\"flow\",\"low\":"});
    EXPECT_EQ(said.find("inf"), std::string::npos);
    EXPECT_EQ(said.find("nan"), std::string::npos);
    const std::string bytes = decoded(element(page, "pent-fields"));
    Eigen::Index last = 0;
    x.maxCoeff(&last);
    EXPECT_EQ(static_cast<unsigned char>(bytes.at(0)), 0);
    const auto inside = static_cast<std::size_t>(last > mesh.vertex_count() / 2 ? last - 1 : last);
    EXPECT_EQ(static_cast<unsigned char>(bytes.at(inside)), 255);
}

TEST_F(AnExportedPage, HoldsObstaclesOfEveryFrameAndOnceWhereNoneMoves) {
    const fs::path run = folder_ / "twist";
    const auto obstacles = [&] {
        (void)make(run, {});
        const std::string text = element(text_of(folder_ / "out.html"), "pent-run");
        const std::size_t at = text.find("\"obstacles\":[");
        return text.substr(at == std::string::npos ? text.size() : at);
    };
    const auto ball = [](double x) {
        return std::vector<ObstacleShape<4>>{Ball<4>{Eigen::Vector4d(x, 0, 0, 0), 0.5}};
    };
    EXPECT_EQ(obstacles(), "\"obstacles\":[]}");
    write_obstacles<4>(run / "obstacles.json", ball(0));
    EXPECT_EQ(obstacles(), "\"obstacles\":[" + obstacles_text<4>(ball(0)) + "]}");
    fs::remove(run / "obstacles.json");
    make_folder(run / "obstacles");
    std::string expected;
    for (const int frame : {0, 1, 2}) {
        write_obstacles<4>(run / "obstacles" / ("00000" + std::to_string(frame) + ".json"),
                           ball(frame));
        expected += (frame == 0 ? "" : ",") + obstacles_text<4>(ball(frame));
    }
    EXPECT_EQ(obstacles(), "\"obstacles\":[" + expected + "]}");
    write_text(run / "obstacles" / "000001.json", "{}");
    expect_contains(error_of([&] { (void)make(run, {}); }), {"000001.json", "is not the list"});
}

TEST_F(AnExportedPage, ThatWouldBeTooLargeIsRefusedWithWhatWouldFit) {
    ExportOptions options;
    options.most_bytes = 8'000;
    expect_contains(error_of([&] { (void)make(folder_ / "twist", options); }),
                    {"out.html: would have ", " MB, expected at most 0.0; ", "raise --limit"});
    EXPECT_FALSE(fs::exists(folder_ / "out.html"));
}

// Of boxes that move there is more to tell than of a body.
TEST_F(AnExportedPage, HasAtMostTheSizeAskedForWithManyObstaclesToo) {
    const RunFolder run = open_run(folder_ / "twist");
    make_folder(folder_ / "twist/obstacles");
    const auto make_at_most = [&](std::int64_t bytes) {
        ExportOptions options;
        options.most_bytes = bytes;
        return make(folder_ / "twist", options).bytes;
    };
    for (const int frame : run.frames) {
        const Cuboid<4> box{Eigen::Vector4d::Constant(frame / 3.0), Eigen::Vector4d::Ones(),
                            plane_rotation<4>(0, 3, 0.1 * (frame + 1))};
        write_obstacles<4>(folder_ / "twist/obstacles" / formatted("%06d.json", frame),
                           std::vector<ObstacleShape<4>>(50, box));
    }
    const std::int64_t bytes = make_at_most(64'000'000);
    EXPECT_THROW((void)make_at_most(bytes - 1), Error);
    EXPECT_EQ(make_at_most(bytes * 5 / 4), bytes);
}

TEST_F(AnExportedPage, ThatIsStoppedIsNotThere) {
    const RunFolder run = open_run(folder_ / "twist");
    const ExportOptions options{test::write_page(folder_.path()), run.frames, 64'000'000};
    for (const std::string stop_at : {"looked at frame", "wrote frame"}) {
        const ExportReport report = export_page(
            run, folder_ / "out.html", options,
            [&](std::string_view what, std::int64_t, std::int64_t) { return what != stop_at; });
        EXPECT_FALSE(report.is_complete);
        EXPECT_FALSE(fs::exists(folder_ / "out.html"));
    }
}

TEST_F(AnExportedPage, HasTheSameBytesEachTime) {
    (void)make(folder_ / "twist", {});
    const std::string once = text_of(folder_ / "out.html");
    (void)make(folder_ / "twist", {});
    EXPECT_EQ(text_of(folder_ / "out.html"), once);
}

}  // namespace
}  // namespace pent::viewer
