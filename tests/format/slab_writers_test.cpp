#include "support/file_bytes.h"
#include "support/temp_folder.h"
#include "support/thread_writers.h"

#include <pent/crc32c.h>
#include <pent/error.h>
#include <pent/pent_file.h>

#include <gtest/gtest.h>

#include <limits>
#include <random>

namespace pent {
namespace {

using test::by_writers;
using test::bytes_of;

Frame<4> random_frame(Eigen::Index vertices) {
    std::srand(5);
    Frame<4> frame;
    frame.positions = Positions<4>::Random(4, vertices);
    frame.velocities = Positions<4>::Random(4, vertices);
    frame.contact_forces = Positions<4>::Random(4, vertices);
    frame.fields = {{"energy_density", Eigen::MatrixXd::Random(1, vertices)},
                    {"reaction", Eigen::MatrixXd::Random(4, vertices)}};
    frame.mesh_name = "a.pent";
    frame.mesh_crc = 0xfedcba98U;
    frame.frame = 7;
    frame.step = 70;
    frame.time = 0.7;
    return frame;
}

// Vertices [first, last) of a frame.
Frame<4> part_of(const Frame<4>& whole, Eigen::Index first, Eigen::Index last) {
    Frame<4> part = whole;
    part.positions = whole.positions.middleCols(first, last - first);
    part.velocities = whole.velocities.middleCols(first, last - first);
    part.contact_forces = whole.contact_forces.middleCols(first, last - first);
    for (VertexField& field : part.fields) {
        field.values = Eigen::MatrixXd(field.values.middleCols(first, last - first));
    }
    return part;
}

TEST(Crc32cJoined, IsThatOfBothTogetherForEveryLength) {
    std::mt19937 random(11);
    std::string bytes(70000, ' ');
    for (char& byte : bytes) {
        byte = static_cast<char>(random() & 255U);
    }
    for (const std::size_t all : {0U, 1U, 2U, 9U, 64U, 1000U, 65537U, 70000U}) {
        const std::uint32_t whole = crc32c(bytes.data(), all);
        for (const std::size_t part : {std::size_t{0}, std::size_t{1}, all / 3, all / 2, all}) {
            const std::size_t first = std::min(part, all);
            EXPECT_EQ(crc32c_joined(crc32c(bytes.data(), first),
                                    crc32c(bytes.data() + first, all - first), all - first),
                      whole)
                << first << " of " << all;
        }
    }
}

// With slabs of other sizes, and with none for some writers.
TEST(SlabWriters, WriteTheFileThatOneAloneWrites) {
    const test::TempFolder folder;
    for (const Eigen::Index vertices : {1, 2, 5, 1000}) {
        const Frame<4> whole = random_frame(vertices);
        write_frame(folder / "alone.pent", whole, {.created_by = "test"});
        for (const int count : {1, 2, 3, 7}) {
            const std::filesystem::path path = folder / "together.pent";
            const auto said = by_writers(count, [&](const test::ThreadWriters& writers) {
                const Eigen::Index first =
                    vertices * writers.place() * writers.place() / (Eigen::Index{count} * count);
                const Eigen::Index last = vertices * (writers.place() + 1) * (writers.place() + 1)
                                          / (Eigen::Index{count} * count);
                write_frame(path, part_of(whole, first, last),
                            {.created_by = "test", .writers = &writers});
            });
            EXPECT_EQ(said, std::vector<std::string>(static_cast<std::size_t>(count)));
            EXPECT_EQ(bytes_of(path), bytes_of(folder / "alone.pent")) << vertices << " " << count;
            std::filesystem::remove(path);
        }
    }
}

TEST(SlabWriters, FailTogetherAndLeaveNothing) {
    const test::TempFolder folder;
    Frame<4> whole = random_frame(30);
    whole.velocities(2, 25) = std::numeric_limits<double>::quiet_NaN();
    const auto write = [&](const std::filesystem::path& path) {
        return by_writers(3, [&](const test::ThreadWriters& writers) {
            write_frame(path, part_of(whole, 10 * writers.place(), 10 * (writers.place() + 1)),
                        {.writers = &writers});
        });
    };
    for (const std::string& said : write(folder / "a.pent")) {
        EXPECT_NE(said.find("a.pent: vertex 25: vz is"), std::string::npos) << said;
    }
    whole.velocities(2, 25) = 0;
    whole.fields[0].values(0, 15) = std::numeric_limits<double>::infinity();
    for (const std::string& said : write(folder / "a.pent")) {
        EXPECT_NE(said.find("vertex 15: energy_density is not finite"), std::string::npos) << said;
    }
    whole.fields[0].values(0, 15) = 0;
    for (const std::string& said : write(folder / "nowhere" / "a.pent")) {
        EXPECT_NE(said.find("cannot be written"), std::string::npos) << said;
    }
    EXPECT_TRUE(std::filesystem::is_empty(folder.path()));
}

}  // namespace
}  // namespace pent
