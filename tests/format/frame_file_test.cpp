#include "support/kuhn_box.h"
#include "support/messages.h"
#include "support/temp_folder.h"

#include <pent/pent_file.h>
#include <pent/printable.h>

#include <gtest/gtest.h>

#include <cstring>
#include <fstream>
#include <limits>
#include <sstream>
#include <string>
#include <vector>

namespace pent {
namespace {

using test::error_of;
using test::expect_contains;

Frame<4> sample() {
    Frame<4> frame;
    frame.positions = Positions<4>::Random(4, 9);  // Eigen's generator has a fixed seed
    frame.velocities = Positions<4>::Random(4, 9);
    frame.contact_forces = Positions<4>::Random(4, 9);
    frame.fields = {{"energy_density", Eigen::MatrixXd::Random(1, 9)},
                    {"reaction", Eigen::MatrixXd::Random(4, 9)},
                    {"x_y", Eigen::MatrixXd::Random(1, 9)}};
    frame.mesh_name = "body.pent";
    frame.mesh_crc = 0x0badcafe;
    frame.frame = 123;
    frame.step = 1230;
    frame.time = 4.1;
    return frame;
}

TEST(FrameFile, RoundTripIsBitExact) {
    const test::TempFolder folder;
    for (const Encoding encoding : {Encoding::Binary, Encoding::Ascii}) {
        const Frame<4> frame = sample();
        write_frame(folder / "f.pent", frame, {.encoding = encoding});
        const Frame<4> read = read_frame<4>(folder / "f.pent");
        EXPECT_EQ(std::memcmp(read.positions.data(), frame.positions.data(), 9 * 32), 0);
        EXPECT_EQ(std::memcmp(read.velocities.data(), frame.velocities.data(), 9 * 32), 0);
        EXPECT_EQ(std::memcmp(read.contact_forces.data(), frame.contact_forces.data(), 9 * 32), 0);
        EXPECT_EQ(read.fields, frame.fields);
        EXPECT_EQ(read.mesh_name, frame.mesh_name);
        EXPECT_EQ(read.mesh_crc, frame.mesh_crc);
        EXPECT_EQ(read.frame, frame.frame);
        EXPECT_EQ(read.step, frame.step);
        EXPECT_EQ(read.time, frame.time);
        EXPECT_TRUE(read_info(folder / "f.pent").is_frame);
    }
}

TEST(FrameFile, HasTheNumberOfItsFrameInItsNameAndSortsByIt) {
    EXPECT_EQ(frame_file_name("octopus", 42), "octopus_000042.pent");
    EXPECT_LT(frame_file_name("a", 99), frame_file_name("a", 100));
}

TEST(FrameFile, NamesWhatIsWrongWithItsHeader) {
    const test::TempFolder folder;
    Frame<4> frame = sample();
    for (const std::string name : {"", "two words", "a\nb"}) {
        frame.mesh_name = name;
        expect_contains(error_of([&] { write_frame(folder / "f.pent", frame); }),
                        {"f.pent", "mesh name '" + name + "'", "without spaces"});
    }
    write_frame(folder / "f.pent", sample());
    expect_contains(error_of([&] { (void)read_frame<3>(folder / "f.pent"); }),
                    {"f.pent", "dimension 4", "expected 3"});
    std::ostringstream text;
    text << std::ifstream(folder / "f.pent", std::ios::binary).rdbuf();
    const auto message = [&](const std::string& from, const std::string& to) {
        std::string bytes = text.str();
        bytes.replace(bytes.find(from), from.size(), to);
        std::ofstream(folder / "f.pent", std::ios::binary) << bytes;
        return error_of([&] { (void)read_frame<4>(folder / "f.pent"); });
    };
    expect_contains(message("comment time 4.1", "comment time inf"), {"a finite time"});
    expect_contains(message("comment step 1230", "comment step many"), {"'comment step NUMBER'"});
}

TEST(FrameFile, VelocitiesAndContactForcesMayBeLeftOut) {
    const test::TempFolder folder;
    Frame<4> frame = sample();
    frame.velocities.resize(4, 0);
    write_frame(folder / "f.pent", frame);
    EXPECT_EQ(read_frame<4>(folder / "f.pent").velocities.cols(), 0);
    EXPECT_EQ(read_frame<4>(folder / "f.pent").contact_forces, frame.contact_forces);
    frame.contact_forces.resize(4, 0);
    write_frame(folder / "f.pent", frame);
    EXPECT_EQ(read_frame<4>(folder / "f.pent").contact_forces.cols(), 0);
}

TEST(FrameFile, RefusesVectorsThatAreNotOneAVertex) {
    const test::TempFolder folder;
    Frame<4> frame = sample();
    frame.contact_forces.setZero(4, 3);
    expect_contains(error_of([&] { write_frame(folder / "f.pent", frame); }),
                    {"f.pent", "3 contact forces", "none or 9"});
    frame.velocities.setZero(4, 10);
    expect_contains(error_of([&] { write_frame(folder / "f.pent", frame); }),
                    {"f.pent", "10 velocities", "none or 9"});
}

TEST(FrameFile, FindsAFieldByItsName) {
    const Frame<4> frame = sample();
    EXPECT_EQ(find_field(frame, "reaction"), &frame.fields[1]);
    EXPECT_EQ(find_field(frame, "velocity"), nullptr);
}

TEST(FrameFile, RefusesFieldsThatAreNotOneOrOneAnAxisAVertexOrNotFinite) {
    const test::TempFolder folder;
    Frame<4> frame = sample();
    frame.fields[1].values.resize(3, 9);
    frame.fields[1].values.setZero();
    expect_contains(error_of([&] { write_frame(folder / "f.pent", frame); }),
                    {"f.pent: reaction has 3 x 9 values, expected 1 or 4 x 9"});
    frame = sample();
    frame.fields[0].values(0, 5) = std::numeric_limits<double>::infinity();
    expect_contains(error_of([&] { write_frame(folder / "f.pent", frame); }),
                    {"vertex 5: energy_density is not finite"});
}

TEST(FrameFile, RefusesNamesThatRepeatOrHaveAMeaning) {
    const test::TempFolder folder;
    for (const auto& [name, what] : std::vector<std::pair<std::string, std::string>>{
             {"reaction_x", "another quantity has the property reaction_x"},
             {"vx", "the property vx has a meaning of its own"},
             {"energy density", "expected a name of letters"},
             {"energy\x01"
              "density",
              "expected a name of letters"},
             {std::string(100000, 'a'), "expected a name of letters"}}) {
        Frame<4> frame = sample();
        frame.fields.push_back({name, Eigen::MatrixXd::Zero(1, 9)});
        expect_contains(error_of([&] { write_frame(folder / "f.pent", frame); }),
                        {"f.pent: vertex quantity '" + printable(name) + "': " + what});
    }
    Frame<4> frame = sample();
    frame.fields.push_back({"column", Eigen::MatrixXd::Zero(1, 9)});
    write_frame(folder / "f.pent", frame);
    EXPECT_EQ(read_frame<4>(folder / "f.pent").fields, frame.fields);
}

TEST(FrameFile, IsNeverWrittenWithANumberThatIsNotFinite) {
    const test::TempFolder folder;
    Frame<4> frame = sample();
    frame.velocities(2, 3) = std::numeric_limits<double>::quiet_NaN();
    expect_contains(error_of([&] { write_frame(folder / "f.pent", frame); }),
                    {"f.pent", "vertex 3", "vz"});
    frame = sample();
    frame.contact_forces(3, 8) = std::numeric_limits<double>::infinity();
    expect_contains(error_of([&] { write_frame(folder / "f.pent", frame); }),
                    {"f.pent", "vertex 8", "fw"});
    EXPECT_TRUE(std::filesystem::is_empty(folder.path()));
}

TEST(FrameFile, IsNeverReadWithANumberThatIsNotFinite) {
    const test::TempFolder folder;
    const std::string header =
        "ply\nformat ascii 1.0\ncomment pent 1.0\ncomment dimension 2\n"
        "comment mesh m.pent 00000000\nelement vertex 2\nproperty double x\nproperty double y\n"
        "property double vx\nproperty double vy\nproperty double fx\nproperty double fy\n"
        "property double heat\nend_header\n0 0 0 0 0 0 0\n";
    const std::vector<std::string> names = {"x", "y", "vx", "vy", "fx", "fy", "heat"};
    for (std::size_t bad = 0; bad < names.size(); ++bad) {
        std::string row;
        for (std::size_t i = 0; i < names.size(); ++i) {
            row += i == bad ? "inf " : "1 ";
        }
        std::ofstream(folder / "f.pent") << header << row << "\n";
        expect_contains(error_of([&] { (void)read_frame<2>(folder / "f.pent"); }),
                        {"f.pent: vertex 1: " + names[bad] + " is ", "finite"});
    }
}

TEST(FrameFile, IsNotTakenForAMeshNorAMeshForAFrame) {
    const test::TempFolder folder;
    write_frame(folder / "f.pent", sample());
    write_mesh(folder / "m.pent", test::kuhn_box<4>({1, 1, 1, 1}, {1, 1, 1, 1}));
    expect_contains(error_of([&] { (void)read_mesh<4>(folder / "f.pent"); }),
                    {"f.pent", "a frame", "expected a mesh"});
    expect_contains(error_of([&] { (void)read_frame<4>(folder / "m.pent"); }),
                    {"m.pent", "expected a frame"});
}

TEST(FrameFile, NamesVelocitiesThatAreNotComplete) {
    const test::TempFolder folder;
    std::ofstream(folder / "f.pent")
        << "ply\nformat ascii 1.0\ncomment pent 1.0\ncomment dimension 2\n"
           "comment mesh m.pent 00000000\nelement vertex 1\nproperty double x\n"
           "property double y\nproperty double vx\nend_header\n0 0 0\n";
    expect_contains(error_of([&] { (void)read_frame<2>(folder / "f.pent"); }),
                    {"f.pent", "1 velocity properties", "none or all of 2"});
}

}  // namespace
}  // namespace pent
