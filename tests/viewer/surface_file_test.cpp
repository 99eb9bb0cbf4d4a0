#include "pent/viewer/surface_file.h"

#include "meshes.h"
#include "support/file_bytes.h"

#include <pent/error.h>
#include <pent/viewer/image.h>
#include <pent/viewer/slice.h>

#include <gtest/gtest.h>

#include <cstring>
#include <png.h>
#include <sstream>
#include <string>
#include <support/temp_folder.h>

namespace pent::viewer {
namespace {

using pent::test::bytes_of;
using pent::test::TempFolder;

template <typename Value>
Value take(const std::string& bytes, std::size_t& at) {
    Value value;
    std::memcpy(&value, bytes.data() + at, sizeof value);
    at += sizeof value;
    return value;
}

Surface some_slice() {
    const SimplexMesh<4> mesh = test::jittered_box({2, 2, 2, 2}, 3);
    return slice(make_boundary(mesh, "box"), mesh.positions, hyperplane_at(0.4));
}

TEST(WriteSurface, PlyReadsBackToTheBit) {
    const TempFolder folder;
    const Surface surface = some_slice();
    SurfaceExtras extras;
    extras.scalars.push_back(  // beyond floats, too
        {"w", Eigen::VectorXd::LinSpaced(surface.vertex_count(), -1e60, 1)});
    extras.colors.setConstant(3, surface.vertex_count(), 1.0F);
    extras.comment = "a test";
    write_surface(folder / "a.ply", surface, SurfaceFormat::Ply, extras);

    const std::string bytes = bytes_of(folder / "a.ply");
    const std::string end = "end_header\n";
    std::size_t at = bytes.find(end) + end.size();
    const std::string header = bytes.substr(0, at);
    EXPECT_EQ(header,
              "ply\nformat binary_little_endian 1.0\ncomment a test\nelement vertex " +
                  std::to_string(surface.vertex_count()) +
                  "\nproperty double x\nproperty double y\nproperty double z\nproperty double w\n"
                  "property uchar red\nproperty uchar green\nproperty uchar blue\nelement face " +
                  std::to_string(surface.triangle_count()) +
                  "\nproperty list uchar uint vertex_indices\nend_header\n");
    for (Eigen::Index v = 0; v < surface.vertex_count(); ++v) {
        for (int axis = 0; axis < 3; ++axis) {
            ASSERT_EQ(take<double>(bytes, at), surface.positions(axis, v));
        }
        ASSERT_EQ(take<double>(bytes, at), extras.scalars[0].values[v]);
        at += 3;
    }
    for (Eigen::Index t = 0; t < surface.triangle_count(); ++t) {
        ASSERT_EQ(take<std::uint8_t>(bytes, at), 3);
        for (int k = 0; k < 3; ++k) {
            ASSERT_EQ(take<std::uint32_t>(bytes, at), surface.triangles(k, t));
        }
    }
    EXPECT_EQ(at, bytes.size());
}

TEST(WriteSurface, ObjReadsBackToTheBit) {
    const TempFolder folder;
    const Surface surface = some_slice();
    write_surface(folder / "a.obj", surface, SurfaceFormat::Obj);
    std::istringstream text(bytes_of(folder / "a.obj"));
    std::string word;
    for (Eigen::Index v = 0; v < surface.vertex_count(); ++v) {
        text >> word;
        ASSERT_EQ(word, "v");
        for (int axis = 0; axis < 3; ++axis) {
            text >> word;
            ASSERT_EQ(std::stod(word), surface.positions(axis, v));
        }
    }
    for (Eigen::Index t = 0; t < surface.triangle_count(); ++t) {
        text >> word;
        ASSERT_EQ(word, "f");
        for (int k = 0; k < 3; ++k) {
            std::uint32_t index = 0;
            text >> index;
            ASSERT_EQ(index, surface.triangles(k, t) + 1);
        }
    }
    EXPECT_FALSE(text >> word);
}

TEST(WriteSurface, VtuStatesWhereEachArrayIs) {
    const TempFolder folder;
    const Surface surface = some_slice();
    SurfaceExtras extras;
    extras.scalars.push_back({"speed", Eigen::VectorXd::Ones(surface.vertex_count())});
    write_surface(folder / "a.vtu", surface, SurfaceFormat::Vtu, extras);
    const std::string bytes = bytes_of(folder / "a.vtu");
    const std::size_t start = bytes.find("<AppendedData encoding=\"raw\">\n_");
    ASSERT_NE(start, std::string::npos);
    const std::size_t data = bytes.find('_', start) + 1;
    std::size_t expected = 0;
    std::size_t arrays = 0;
    for (std::size_t at = bytes.find("offset=\""); at < start; at = bytes.find("offset=\"", at)) {
        at += 8;
        ASSERT_EQ(std::stoull(bytes.substr(at)), expected);
        std::size_t place = data + expected;
        expected += 8 + take<std::uint64_t>(bytes, place);
        ++arrays;
    }
    EXPECT_EQ(arrays, 5U);  // points, connectivity, offsets, types, speed
    EXPECT_EQ(bytes.substr(data + expected), "\n</AppendedData>\n</VTKFile>\n");
    std::size_t first = data + 8;
    EXPECT_EQ(take<double>(bytes, first), surface.positions(0, 0));
}

TEST(WriteSurface, ObjHasColorsBehindPositions) {
    const TempFolder folder;
    Surface point;
    point.positions = Eigen::Vector3d(1, 2, 3);
    SurfaceExtras extras;
    extras.colors = Eigen::Vector3f(1, 0, 1);
    write_surface(folder / "a.obj", point, SurfaceFormat::Obj, extras);
    EXPECT_EQ(bytes_of(folder / "a.obj"), "v 1 2 3 1 0 1\n");
}

TEST(WriteSurface, WithoutTrianglesIsStillAFile) {
    const TempFolder folder;
    for (const SurfaceFormat format :
         {SurfaceFormat::Ply, SurfaceFormat::Obj, SurfaceFormat::Vtu}) {
        const std::filesystem::path path = folder / ("none" + extension(format));
        write_surface(path, Surface(), format);
        EXPECT_TRUE(std::filesystem::is_regular_file(path));
    }
}

TEST(WriteSurface, SaysWhichFolderIsMissing) {
    const TempFolder folder;
    EXPECT_THROW(write_surface(folder / "no/a.ply", some_slice(), SurfaceFormat::Ply), Error);
}

TEST(WritePng, ReadsBackToTheBit) {
    const TempFolder folder;
    Image image(7, 5);
    for (std::size_t i = 0; i < image.rgb.size(); ++i) {
        image.rgb[i] = static_cast<std::uint8_t>(11 * i);
    }
    write_png(folder / "a.png", image);
    png_image png = {};
    png.version = PNG_IMAGE_VERSION;
    ASSERT_NE(png_image_begin_read_from_file(&png, (folder / "a.png").c_str()), 0);
    EXPECT_EQ(png.width, 7U);
    EXPECT_EQ(png.height, 5U);
    png.format = PNG_FORMAT_RGB;
    std::vector<std::uint8_t> read(PNG_IMAGE_SIZE(png));
    ASSERT_NE(png_image_finish_read(&png, nullptr, read.data(), 0, nullptr), 0);
    EXPECT_EQ(read, image.rgb);
}

}  // namespace
}  // namespace pent::viewer
