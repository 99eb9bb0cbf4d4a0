#include "images.h"
#include "support/messages.h"
#include "support/temp_folder.h"

#include <pent/mesher/image.h>

#include <gtest/gtest.h>

#include <fstream>
#include <limits>
#include <numeric>

namespace pent::mesher {
namespace {

using test::bytes_of;
using test::nifti_header;
using test::NiftiHeader;

Image read_as(const std::string& name, const std::string& bytes) {
    const test::TempFolder folder;
    std::ofstream(folder / name, std::ios::binary) << bytes;
    return read_image(folder / name);
}

std::string error_as(const std::string& name, const std::string& bytes) {
    const std::string message = test::error_of([&] { static_cast<void>(read_as(name, bytes)); });
    EXPECT_EQ(message.find('\n'), std::string::npos);
    return message;
}

std::vector<float> counted(std::size_t count) {
    std::vector<float> values(count);
    std::iota(values.begin(), values.end(), 0.0F);
    return values;
}

template <typename Value>
std::string samples(std::size_t count, bool is_swapped = false) {
    std::string bytes;
    for (std::size_t i = 0; i < count; ++i) {
        bytes += bytes_of(static_cast<Value>(i), is_swapped);
    }
    return bytes;
}

const std::string kNrrd = "NRRD0004\n# by hand\ndimension: 4\nsizes: 2 3 2 4\n";

TEST(ReadImage, TakesEveryKindOfNiftiSampleInEitherOrderOfBytes) {
    for (const bool is_swapped : {false, true}) {
        const auto expect = [&](std::int16_t code, const std::string& bytes) {
            NiftiHeader header;
            header.dim = {4, 2, 3, 2, 4, 1, 1, 1};
            header.pixdim = {1, 0.5F, 0.25F, 2, 4, 0, 0, 0};
            header.datatype = code;
            header.is_swapped = is_swapped;
            const Image image = read_as("a.nii", nifti_header(header) + bytes);
            EXPECT_EQ(image.size, Eigen::Vector4i(2, 3, 2, 4));
            EXPECT_EQ(image.spacing, Eigen::Vector4d(0.5, 0.25, 2, 4));
            EXPECT_EQ(image.values, counted(48)) << code << is_swapped;
            EXPECT_EQ(image.value({1, 2, 1, 3}), 47);
            EXPECT_EQ(image.value({1, 0, 0, 1}), 13);
        };
        expect(2, samples<std::uint8_t>(48, is_swapped));
        expect(256, samples<std::int8_t>(48, is_swapped));
        expect(4, samples<std::int16_t>(48, is_swapped));
        expect(512, samples<std::uint16_t>(48, is_swapped));
        expect(8, samples<std::int32_t>(48, is_swapped));
        expect(768, samples<std::uint32_t>(48, is_swapped));
        expect(16, samples<float>(48, is_swapped));
        expect(64, samples<double>(48, is_swapped));
    }
}

TEST(ReadImage, TakesSlopeAndInterceptOffsetAndGzip) {
    NiftiHeader header;
    header.dim = {5, 2, 2, 2, 2, 1, 1, 1};  // a fifth axis of one
    header.scl_slope = 2;
    header.scl_inter = -3;
    header.vox_offset = 360;
    const std::string bytes = nifti_header(header) + std::string(8, 'x') + samples<float>(16);
    for (const Image& image :
         {read_as("a.nii", bytes), read_as("a.nii.gz", test::packed(bytes)),
          read_as("a.nii", test::packed(bytes)),
          read_as("a.nii.gz", test::packed(bytes.substr(0, 370)) + test::packed(bytes.substr(370))
                                  + test::packed("")),
          read_as("a.nii.gz", test::packed(bytes) + "something else")}) {
        EXPECT_EQ(image.values.front(), -3);
        EXPECT_EQ(image.values.back(), 27);
    }
    EXPECT_TRUE(is_image_file("x/scan.nii.gz"));
    EXPECT_TRUE(is_image_file("scan.NRRD"));
    EXPECT_FALSE(is_image_file("scan.tar.gz"));
}

TEST(ReadImage, TakesEveryKindOfNrrd) {
    const std::string spacing = "spacings: 0.5 0.25 2 4\n";
    const auto expect = [&](const std::string& header, const std::string& bytes) {
        const Image image = read_as("a.nrrd", kNrrd + spacing + header + "\n" + bytes);
        EXPECT_EQ(image.size, Eigen::Vector4i(2, 3, 2, 4));
        EXPECT_EQ(image.spacing, Eigen::Vector4d(0.5, 0.25, 2, 4));
        EXPECT_EQ(image.values, counted(48)) << header;
    };
    const std::string raw = "encoding: raw\n";
    expect("type: float\nendian: little\n" + raw, samples<float>(48));
    expect("type: double\nendian: big\n" + raw, samples<double>(48, true));
    expect("type: unsigned char\n" + raw, samples<std::uint8_t>(48));
    expect("type: short\nendian: little\n" + raw, samples<std::int16_t>(48));
    expect("type: uint16\r\nendian: big\r\nkind:=value\r\nencoding: raw\r\n",
           samples<std::uint16_t>(48, true));
    expect("type: int\nendian: little\nencoding: gzip\n", test::packed(samples<std::int32_t>(48)));
    std::string text;
    for (int i = 0; i < 48; ++i) {
        text += std::to_string(i) + (i % 7 == 0 ? "\n" : " ");
    }
    expect("type: float\nencoding: ascii\n", text);
    const std::string directions = "space directions: (0,3,4) (1,0,0) (0,0,-2) (0,0,0,7)\n";
    EXPECT_EQ(read_as("a.nrrd", kNrrd + directions + "type: uchar\nencoding: raw\n\n"
                                    + samples<std::uint8_t>(48))
                  .spacing,
              Eigen::Vector4d(5, 1, 2, 7));
}

TEST(ReadImage, SaysWhatIsWrongWithANifti) {
    NiftiHeader header;
    const std::string sound = nifti_header(header) + samples<float>(16);
    using test::expect_contains;
    expect_contains(error_as("a.nii", sound.substr(0, 100)), {"a.nii: ends too soon", "348"});
    expect_contains(error_as("a.nii", sound.substr(0, 400)), {"48 bytes", "expected 64", "cut?"});
    expect_contains(error_as("a.nii", std::string(400, 'x')), {"no NIfTI-1 file"});
    expect_contains(error_as("a.nii.gz", test::packed(sound).substr(0, 60)), {"ends too soon"});
    std::string damaged = test::packed(sound);
    damaged[15] = '\xff';
    damaged[16] = '\xff';
    EXPECT_NE(error_as("a.nii.gz", damaged), "");
    std::string with_nan = sound;
    with_nan.replace(352 + 4 * 6, 4, bytes_of(std::numeric_limits<float>::quiet_NaN()));
    expect_contains(error_as("a.nii", with_nan), {"sample (0, 1, 1, 0) is nan", "fill in"});
    const auto error_with = [&](const auto& change) {
        NiftiHeader changed;
        change(changed);
        return error_as("a.nii", nifti_header(changed) + samples<float>(16));
    };
    expect_contains(error_with([](NiftiHeader& h) { h.dim[0] = 3; }), {"3 axes; expected 4"});
    expect_contains(error_with([](NiftiHeader& h) { h.dim = {5, 2, 2, 2, 2, 3, 1, 1}; }),
                    {"5 axes; expected 4"});
    expect_contains(error_with([](NiftiHeader& h) { h.dim[3] = 1; }), {"2 x 2 x 1 x 2"});
    expect_contains(error_with([](NiftiHeader& h) { h.dim[2] = -4; }), {"2 x -4 x 2 x 2"});
    expect_contains(error_with([](NiftiHeader& h) { h.dim = {4, 999, 999, 999, 999, 1, 1, 1}; }),
                    {"2^30 at the most"});
    expect_contains(error_with([](NiftiHeader& h) { h.pixdim[4] = 0; }), {"--spacing"});
    expect_contains(error_with([](NiftiHeader& h) { h.datatype = 128; }), {"type 128"});
    expect_contains(error_with([](NiftiHeader& h) { h.magic = "ni1"; }), {"another file"});
    expect_contains(error_with([](NiftiHeader& h) { h.magic = "xyz"; }), {"no \"n+1\""});
    expect_contains(error_with([](NiftiHeader& h) { h.vox_offset = 1e9F; }), {"from byte 1e+09"});
    std::string second = sound;
    second.replace(0, 4, bytes_of(std::int32_t{540}));
    expect_contains(error_as("a.nii", second), {"NIfTI-2"});
}

TEST(ReadImage, SaysWhatIsWrongWithANrrd) {
    using test::expect_contains;
    const auto error_with = [](const std::string& header) {
        return error_as("a.nrrd", header + "\n\n" + samples<std::uint8_t>(48));
    };
    const std::string spacing = "spacings: 1 1 1 1\n";
    const std::string raw = "type: uchar\nencoding: raw";
    expect_contains(error_as("a.nrrd", "OFF\n"), {"no NRRD file"});
    expect_contains(error_as("a.nrrd", kNrrd + raw + "\n"), {"no empty line"});
    expect_contains(error_with(kNrrd + raw), {"a spacing of nan", "--spacing"});
    expect_contains(error_with("NRRD0004\ndimension: 3\nsizes: 2 2 2\n" + raw), {"3 axes"});
    expect_contains(error_with("NRRD0004\ndimension: 4\nsizes: 2 2 2 x\n" + raw), {"nan samples"});
    expect_contains(error_with("NRRD0004\ndimension: 4\nsizes: 2 2 2 2.5\n" + raw), {"2.5"});
    expect_contains(error_with(kNrrd + spacing + "type: block\nencoding: raw"), {"\"block\""});
    expect_contains(error_with(kNrrd + spacing + "type: uchar\nencoding: bzip2"), {"\"bzip2\""});
    expect_contains(error_with(kNrrd + spacing + "type: float\nencoding: raw"), {"expected 192"});
    expect_contains(error_with(kNrrd + "data file: a.raw\n" + raw), {"line 5", "another file"});
    expect_contains(error_with(kNrrd + "byte skip: -1\n" + raw), {"line 5", "skips"});
    expect_contains(error_as("a.nrrd", kNrrd + spacing + "type: float\nencoding: text\n\n1 2 3"),
                    {"3 samples, expected 48"});
    EXPECT_THROW(static_cast<void>(read_image("/no/such.nii")), Error);
}

}  // namespace
}  // namespace pent::mesher
