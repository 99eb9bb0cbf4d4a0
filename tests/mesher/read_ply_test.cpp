#include "shapes.h"
#include "support/messages.h"
#include "support/temp_folder.h"

#include <pent/mesher/surface.h>

#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cstring>
#include <limits>
#include <string>

namespace pent::mesher {
namespace {

SurfaceFile read_bytes(const std::string& bytes) {
    const test::TempFolder folder;
    test::write_file(folder / "a.ply", bytes);
    return read_surface(folder / "a.ply");
}

std::string message_for(const std::string& bytes) {
    return test::error_of([&] { static_cast<void>(read_bytes(bytes)); });
}

template <typename T>
std::string raw(T value, bool is_big) {
    std::string bytes(sizeof value, '\0');
    std::memcpy(bytes.data(), &value, sizeof value);
    if (is_big) {
        std::reverse(bytes.begin(), bytes.end());
    }
    return bytes;
}

// The corner of the unit cube in a binary file: numbers of type T, called `type`, for coordinates,
// lengths and corners; properties and an element that are none of ours in between.
template <typename T>
std::string corner_of(const std::string& type, bool is_big) {
    std::string file = std::string("ply\nformat binary_") + (is_big ? "big" : "little")
                       + "_endian 1.0\ncomment made by a test\nobj_info none\nelement nothing 7\n"
                         "element vertex 4\n";
    for (const std::string name : {"x", "nx", "y", "z"}) {
        file.append("property ").append(type).append(" ").append(name).append("\n");
    }
    // Lengths of lists are whole numbers of any type, also of float.
    file += "element face 4\nproperty list " + type + " " + type
            + " vertex_index\nproperty list uchar double texture\nproperty " + type
            + " flags\nend_header\n";
    const auto put = [&](int value) { file += raw(static_cast<T>(value), is_big); };
    for (int point = 0; point < 4; ++point) {
        put(point == 1 ? 1 : 0);
        put(9);
        put(point == 2 ? 1 : 0);
        put(point == 3 ? 1 : 0);
    }
    for (const std::array<int, 3>& face :
         {std::array{0, 2, 1}, std::array{0, 1, 3}, std::array{1, 2, 3}, std::array{0, 3, 2}}) {
        put(3);
        for (const int corner : face) {
            put(corner);
        }
        file += '\2';
        file += raw(0.5, is_big) + raw(0.25, is_big);
        put(5);
    }
    return file;
}

template <typename T>
void expect_corner(const std::string& type) {
    for (const bool is_big : {false, true}) {
        SCOPED_TRACE(type + (is_big ? ", big end first" : ", little end first"));
        const SurfaceFile file = read_bytes(corner_of<T>(type, is_big));
        EXPECT_EQ(file.surface.point_count(), 4);
        EXPECT_DOUBLE_EQ(enclosed_volume(file.surface), 1.0 / 6);
    }
}

TEST(ReadPly, ReadsEveryTypeOfNumberInEitherByteOrder) {
    expect_corner<std::int8_t>("char");
    expect_corner<std::uint8_t>("uchar");
    expect_corner<std::int16_t>("int16");
    expect_corner<std::uint16_t>("ushort");
    expect_corner<std::int32_t>("int");
    expect_corner<std::uint32_t>("uint32");
    expect_corner<float>("float");
    expect_corner<double>("float64");
}

TEST(ReadPly, NamesWhereABinaryFileEnds) {
    const std::string whole = corner_of<float>("float", false);
    const std::size_t body = whole.find("end_header\n") + 11;
    for (std::size_t length = body; length < whole.size(); length += 3) {
        test::expect_contains(message_for(whole.substr(0, length)),
                              {"a.ply: byte ", ": the file ends here"});
    }
}

const std::string kHeader =
    "ply\nformat ascii 1.0\nelement vertex 3\nproperty float x\nproperty float y\n"
    "property float z\nelement face 1\nproperty list uchar int vertex_indices\nend_header\n";
const std::string kPoints = "0 0 0\n1 0 0\n0 1 0\n";

std::string replaced(std::string text, const std::string& from, const std::string& to) {
    return text.replace(text.find(from), from.size(), to);
}

TEST(ReadPly, NamesTheLineOfAHeaderThatIsWrong) {
    const auto header = [&](const std::string& from, const std::string& to) {
        return message_for(replaced(kHeader, from, to));
    };
    test::expect_contains(header("ply", "plx"), {"a.ply: line 1", "no \"ply\" at the start"});
    test::expect_contains(header("ascii", "utf8"), {"a.ply: line 2", "format \"utf8\""});
    test::expect_contains(header("property float x", "property half x"),
                          {"a.ply: line 4", "type \"half\"", "expected one of PLY's"});
    test::expect_contains(header("element vertex 3\n", ""),
                          {"a.ply: line 3", "a property before the first element"});
    test::expect_contains(header("property float y", "proprety float y"),
                          {"a.ply: line 5", "\"proprety\"", "expected element, property"});
    test::expect_contains(header("end_header\n", ""), {"a.ply", "the file ends within the header"});
}

TEST(ReadPly, NeedsXAndYOfVertices) {
    const std::string whole = kHeader + kPoints + "3 0 1 2\n";
    for (const std::string name : {"x", "y"}) {
        test::expect_contains(
            message_for(replaced(whole, "property float " + name, "property float other")),
            {"a.ply: line 9: the header gives element vertex no property " + name,
             "expected x, y and z"});
    }
    EXPECT_EQ(read_bytes(replaced(whole, "property float z", "property float nz")).surface.points,
              read_bytes(whole).surface.points);
}

// MeshLab writes quality as it comes, which may be no number, and texture as lists.
TEST(ReadPly, PassesOverWhatNothingIsMadeOf) {
    const std::string whole = kHeader + kPoints + "3 0 1 2\n";
    std::string rich =
        replaced(whole, "property float z\n",
                 "property list uchar int tags\nproperty float quality\n"
                 "property float z\nproperty float zs\nproperty float w\nproperty float ~\n");
    rich = replaced(rich, "int vertex_indices\n",
                    "int vertex_indices\nproperty list uchar float uv\nproperty float q\n");
    rich = replaced(rich, kPoints + "3 0 1 2\n",
                    "0 0 2 7 -9 nan 0 5 6 7\n1 0 0 -inf 0 5 6 7\n0 1 1 nan 1e999 0 5 6 7\n"
                    "3 0 1 2 2 nan 1 inf\n");
    // Only faces are surfaces, and rows without a property are none, whatever their number.
    rich = replaced(rich, "end_header\n",
                    "element patch 2\nproperty list uchar int vertex_indices\nelement none 20\n"
                    "end_header\n")
           + "3 0 2 1\n1 0\n";
    const SurfaceFile plain = read_bytes(whole);
    const SurfaceFile found = read_bytes(rich);
    EXPECT_EQ(found.surface.points, plain.surface.points);
    EXPECT_EQ(found.surface.triangles, plain.surface.triangles);
    test::expect_contains(message_for(replaced(rich, "0 0 2 7 -9 nan 0", "0 0 2 7 -9 0 nan")),
                          {"a.ply: line 20: found \"nan\", expected a value, a finite number"});
}

TEST(ReadPly, CountsEdgesAndRefusesStrips) {
    const std::string whole = kHeader + kPoints + "3 0 1 2\n";
    const std::string edge = "element edge 2\nproperty int vertex1\nproperty int vertex2\n";
    const SurfaceFile file =
        read_bytes(replaced(whole, "end_header", edge + "end_header") + "0 1\n1 2\n");
    EXPECT_EQ(file.left_out, "2 lines");
    EXPECT_EQ(file.surface.triangle_count(), 1);
    const std::string strips = "element tristrips 1\nproperty list int int vertex_indices\n";
    test::expect_contains(message_for(replaced(whole, "end_header", strips + "end_header")),
                          {"a.ply: line ", "triangles in strips; expected faces"});
}

TEST(ReadPly, NamesValuesThatAreWrong) {
    const std::string whole = kHeader + kPoints + "3 0 1 2\n";
    EXPECT_EQ(read_bytes(whole).surface.triangle_count(), 1);
    test::expect_contains(message_for(kHeader + kPoints + "3 0 1 3\n"),
                          {"a.ply: line 13", "a corner 3", "a whole number below 3"});
    test::expect_contains(message_for(kHeader + kPoints + "3 0 1 0.5\n"), {"a corner 0.5"});
    test::expect_contains(message_for(kHeader + kPoints + "-1\n"), {"a list of length -1"});
    test::expect_contains(message_for(kHeader + kPoints + "2 0 1\n"),
                          {"a face with 2 corners", "expected 3 or more"});
    test::expect_contains(message_for(kHeader + kPoints + "1 0\n"),
                          {"a face with 1 corner;", "expected 3 or more"});
    std::string infinite = corner_of<float>("float", false);
    infinite.replace(infinite.find("end_header\n") + 11, 4,
                     raw(std::numeric_limits<float>::infinity(), false));
    test::expect_contains(message_for(infinite),
                          {"byte " + std::to_string(infinite.find("end_header\n") + 11 + 16),
                           "vertex 0", "not finite"});
}

}  // namespace
}  // namespace pent::mesher
