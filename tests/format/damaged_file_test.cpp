#include "support/kuhn_box.h"
#include "support/messages.h"
#include "support/temp_folder.h"

#include <pent/crc32c.h>
#include <pent/formatted.h>
#include <pent/pent_file.h>

#include <gtest/gtest.h>

#include <cstring>
#include <fstream>
#include <limits>
#include <random>
#include <sstream>
#include <string>

// Every kind of damage has its own message: file, place, what was found, what was expected.

namespace pent {
namespace {

using test::error_of;
using test::expect_contains;

class DamagedFile : public testing::Test {
protected:
    DamagedFile() {
        write_mesh(folder_ / "good.pent", test::kuhn_box<4>({1, 1, 1, 1}, {1, 1, 1, 1}));
        std::ostringstream text;
        text << std::ifstream(folder_ / "good.pent", std::ios::binary).rdbuf();
        set_bytes(text.str());
    }

    void set_bytes(const std::string& bytes) {
        whole_ = bytes;
        // As version 0.1.0 wrote it, so that what is wrong in a header is named itself.
        good_ = bytes;
        const std::size_t sum = good_.find("comment header_crc32c");
        good_.erase(sum, good_.find('\n', sum) - sum + 1);
        body_ = good_.find("end_header\n") + 11;
    }

    // The message for a file with these bytes.
    [[nodiscard]] std::string message(const std::string& bytes) const {
        std::ofstream(folder_ / "bad.pent", std::ios::binary) << bytes;
        const std::string text = error_of([&] { (void)read_mesh<4>(folder_ / "bad.pent"); });
        expect_contains(text, {"bad.pent"});
        EXPECT_EQ(text.find('\n'), std::string::npos) << text;
        return text;
    }

    // The good file with `from` in its header replaced.
    [[nodiscard]] std::string header_with(const std::string& from, const std::string& to) const {
        std::string bytes = good_;
        bytes.replace(bytes.find(from), from.size(), to);
        return bytes;
    }

    // The good file with a value in its body replaced, and a checksum that fits.
    template <typename Value>
    [[nodiscard]] std::string body_with(std::size_t offset, Value value) const {
        std::string bytes = good_;
        bytes.replace(body_ + offset, sizeof value,
                      std::string(reinterpret_cast<const char*>(&value), sizeof value));
        return with_checksum(bytes);
    }

    // The file with the checksum that its body has.
    [[nodiscard]] static std::string with_checksum(std::string bytes) {
        const std::string body = bytes.substr(bytes.find("end_header\n") + 11);
        return bytes.replace(bytes.find("crc32c ") + 7, 8,
                             formatted("%08x", crc32c(body.data(), body.size())));
    }

    test::TempFolder folder_;
    std::string whole_;
    std::string good_;
    std::size_t body_ = 0;
    static constexpr std::size_t kCells = 16 * 32;  // where the cells begin in the body
};

TEST_F(DamagedFile, WithoutAChecksumOfItsHeaderIsStillRead) {
    std::ofstream(folder_ / "old.pent", std::ios::binary) << good_;
    EXPECT_EQ(read_mesh<4>(folder_ / "old.pent").mesh.cells,
              read_mesh<4>(folder_ / "good.pent").mesh.cells);
}

// Any bit of the header, of its checksum and of the comments that nothing else checks; but in the
// word that names the checksum, without which all that is believed is right.
TEST_F(DamagedFile, HasNoBitInItsHeaderThatCouldBeAnother) {
    constexpr std::string_view kName = "header_crc32c ";
    const std::size_t name = whole_.find(kName);
    for (std::size_t at = 0; at < whole_.find("end_header\n") + 11; ++at) {
        if (at >= name && at < name + kName.size()) {
            continue;
        }
        std::string bytes = whole_;
        bytes[at] = static_cast<char>(bytes[at] ^ 1);
        std::ofstream(folder_ / "bad.pent", std::ios::binary) << bytes;
        EXPECT_THROW((void)read_mesh<4>(folder_ / "bad.pent"), Error) << at;
        EXPECT_THROW((void)read_info(folder_ / "bad.pent"), Error) << at;
    }
    std::string bytes = whole_;
    bytes.replace(bytes.find("created_by pent"), 15, "created_by mine");
    expect_contains(message(bytes), {"header: its checksum is", "changed since it was written"});
}

TEST_F(DamagedFile, Missing) {
    expect_contains(error_of([&] { (void)read_mesh<4>(folder_ / "none.pent"); }),
                    {"none.pent", "cannot be read", "No such file"});
}

TEST_F(DamagedFile, AFolder) {
    expect_contains(error_of([&] { (void)read_mesh<4>(folder_.path()); }), {"not a regular file"});
}

TEST_F(DamagedFile, Empty) {
    expect_contains(message(""), {"empty", "expected a .pent file"});
}

TEST_F(DamagedFile, AnotherKindOfFile) {
    expect_contains(message("solid cube\nfacet normal\n"), {"line 1", "'solid cube'", "'ply'"});
    expect_contains(message(std::string(10000, '\0')), {"line 1", "is this a .pent file?"});
}

TEST_F(DamagedFile, TruncatedAnywhereInTheHeader) {
    for (std::size_t bytes = 1; bytes < body_; ++bytes) {
        expect_contains(message(good_.substr(0, bytes)), {"header line", "expected"});
    }
    expect_contains(message("ply"), {"found 'ply', expected a line that ends with a newline"});
}

TEST_F(DamagedFile, TruncatedAnywhereInTheBody) {
    for (std::size_t bytes = body_; bytes < good_.size(); bytes += 7) {
        expect_contains(message(good_.substr(0, bytes)),
                        {"element ", "the header announces", "bytes are left", "truncated"});
    }
}

TEST_F(DamagedFile, SwappedHeaderLines) {
    expect_contains(message(header_with("comment pent 1.0\ncomment dimension 4\n",
                                        "comment dimension 4\ncomment pent 1.0\n")),
                    {"line 3", "'comment dimension 4'", "expected 'comment pent 1.0'"});
    expect_contains(
        message(header_with("double x\nproperty double y", "double y\nproperty double x")),
        {"property 0 of element vertex", "double y", "expected 'property double x'"});
    expect_contains(message(header_with("element vertex 16", "element pentachoron 24")),
                    {"line", "each element only once"});
    expect_contains(
        message(header_with("property uint v0\n", "")),
        {"property 0 of element pentachoron", "uint v1", "expected 'property uint v0'"});
}

TEST_F(DamagedFile, WrongTypeOfProperty) {
    expect_contains(message(header_with("property double w", "property float w")),
                    {"property 3 of element vertex", "float w", "expected 'property double w'"});
    expect_contains(message(header_with("property uint v0", "property list uchar uint v0")),
                    {"property 0 of element pentachoron", "list uint v0"});
    expect_contains(message(header_with("property uint v0", "property word v0")),
                    {"'property word v0'", "expected a PLY type"});
}

TEST_F(DamagedFile, ImpossibleCounts) {
    for (const std::string count : {"9223372036854775808", "18446744073709551615", "4294967296"}) {
        for (const std::string of : {"vertex 16", "pentachoron 24"}) {
            const std::string element = "element " + of.substr(0, of.find(' '));
            expect_contains(message(header_with("element " + of, element + " " + count)),
                            {element + " has " + count + " rows, expected at most 4294967295"});
        }
    }
    for (const std::string count : {"4294967295", "1000"}) {
        expect_contains(message(header_with("element vertex 16", "element vertex " + count)),
                        {"element vertex", count});
        expect_contains(
            message(header_with("element pentachoron 24", "element pentachoron " + count)),
            {"element pentachoron", count, "bytes are left"});
    }
    expect_contains(message(header_with("element pentachoron 24", "element pentachoron 25")),
                    {"element pentachoron", "25", "bytes are left"});
    expect_contains(
        message(header_with("element vertex 16", "element vertex 36893488147419103232")),
        {"line", "expected 'element NAME COUNT'"});
    expect_contains(message(header_with("element vertex 16", "element vertex -1")),
                    {"line", "expected 'element NAME COUNT'"});
}

TEST_F(DamagedFile, CountTooSmall) {
    expect_contains(message(header_with("element pentachoron 24", "element pentachoron 23")),
                    {"end of file", "20 bytes follow"});
}

TEST_F(DamagedFile, TrailingBytes) {
    expect_contains(message(good_ + "xyz"), {"end of file", "3 bytes follow", "expected none"});
}

TEST_F(DamagedFile, WrongChecksum) {
    for (std::size_t offset = 0; offset < good_.size() - body_; offset += 13) {
        std::string bytes = good_;
        bytes[body_ + offset] = static_cast<char>(bytes[body_ + offset] ^ 4);
        expect_contains(message(bytes), {"checksum", "crc32c", "expected", "changed"});
    }
}

TEST_F(DamagedFile, MissingChecksum) {
    const std::size_t at = good_.find("comment crc32c");
    expect_contains(message(good_.substr(0, at) + good_.substr(good_.find('\n', at) + 1)),
                    {"no 'comment crc32c'"});
}

TEST_F(DamagedFile, NotANumber) {
    expect_contains(message(body_with(3 * 32 + 8, std::numeric_limits<double>::quiet_NaN())),
                    {"vertex 3", "y is", "expected a finite number"});
    expect_contains(message(body_with(8, -std::numeric_limits<double>::infinity())),
                    {"vertex 0", "y is -inf", "expected a finite number"});
}

TEST_F(DamagedFile, IndexOutOfRange) {
    expect_contains(message(body_with(kCells + 2 * 20 + 4, std::uint32_t{16})),
                    {"pentachoron 2", "vertex 16 of 16", "at most 15"});
    expect_contains(message(body_with(kCells, std::uint32_t{0xFFFFFFFF})),
                    {"pentachoron 0", "vertex 4294967295 of 16"});
}

TEST_F(DamagedFile, RepeatedIndex) {
    const std::string v1 = good_.substr(body_ + kCells + 4, 4);
    std::uint32_t index = 0;
    std::memcpy(&index, v1.data(), 4);
    expect_contains(message(body_with(kCells, index)), {"pentachoron 0", "appears twice"});
}

TEST_F(DamagedFile, InvertedCell) {
    std::uint64_t pair = 0;
    std::memcpy(&pair, good_.data() + body_ + kCells + 5 * 20, 8);
    expect_contains(message(body_with(kCells + 5 * 20, (pair >> 32) | (pair << 32))),
                    {"pentachoron 5", "inverted", "expected positive orientation"});
}

TEST_F(DamagedFile, FlatCell) {
    // Vertex 8 (0,0,0,1) moved onto vertex 0, so that cells that have both are flat.
    std::string bytes = body_with(8 * 32 + 24, 0.0);
    expect_contains(message(bytes), {"pentachoron", "degenerate"});
}

TEST_F(DamagedFile, AnotherDimension) {
    write_mesh(folder_ / "flat.pent", test::kuhn_box<3>({1, 1, 1}, {1, 1, 1}));
    expect_contains(error_of([&] { (void)read_mesh<4>(folder_ / "flat.pent"); }),
                    {"flat.pent", "dimension 3", "expected 4"});
    expect_contains(message(header_with("comment dimension 4", "comment dimension 5")),
                    {"line 4", "D = 2, 3 or 4"});
    expect_contains(message(header_with("comment dimension 4", "comment dimension 3")),
                    {"element pentachoron", "expected element tetrahedron"});
}

TEST_F(DamagedFile, AnotherVersionOrByteOrder) {
    expect_contains(message(header_with("comment pent 1.0", "comment pent 2.0")),
                    {"line 3", "'comment pent 1.0'"});
    expect_contains(message(header_with("little", "big")), {"line 2", "binary_big_endian"});
}

TEST_F(DamagedFile, LineEndsOfATextModeTransfer) {
    expect_contains(message(header_with("ply\n", "ply\r\n")), {"line 1", "CR LF"});
}

TEST_F(DamagedFile, CommentTwice) {
    expect_contains(
        message(header_with("comment crc32c", "comment crc32c 00000000\ncomment crc32c")),
        {"line", "only once"});
    expect_contains(message(header_with("comment crc32c ", "comment crc32c x")),
                    {"line", "8 hexadecimal digits"});
    expect_contains(message(header_with("comment crc32c ", "comment crc32c 0")),
                    {"line", "8 hexadecimal digits"});  // nine of them
    for (const std::string line : {"comment pent 1.0\n", "comment dimension 4\n"}) {
        expect_contains(message(header_with("element vertex", line + "element vertex")),
                        {"the comment '", "only once"});
    }
}

TEST_F(DamagedFile, CommentBehindAnElement) {
    expect_contains(message(header_with("property double x", "comment step 3\nproperty double x")),
                    {"line 8", "'comment step 3'", "in front of the first element"});
}

TEST_F(DamagedFile, OptionalPropertyOfAnotherType) {
    expect_contains(
        message(with_checksum(header_with("end_header", "property double region\nend_header")
                              + std::string(24 * 8, '\0'))),
        {"property region of element pentachoron is double", "expected ushort"});
}

TEST_F(DamagedFile, BoundaryWithoutALabel) {
    std::string properties = "element boundary 0\n";
    for (const char* name : {"v0", "v1", "v2"}) {
        properties += std::string("property uint ") + name + "\n";
    }
    expect_contains(message(with_checksum(header_with("end_header", properties + "end_header"))),
                    {"element boundary has no v3, expected v0 to v3 and label"});
    properties += "property uint v3\n";
    expect_contains(message(with_checksum(header_with("end_header", properties + "end_header"))),
                    {"element boundary has no label, expected v0 to v3 and label"});
}

TEST_F(DamagedFile, ZeroBytesInNamesDoNotEndItsMessage) {
    const std::string bytes = header_with("double x\n", std::string("double x\0\n", 10));
    expect_contains(message(bytes), {"is 'property double x\\x00', expected 'property double x'"});
}

TEST_F(DamagedFile, UnknownElementsCutOff) {
    const auto extra = [&](const std::string& element, const std::string& bytes) {
        return with_checksum(header_with("end_header", "element extra 2\n" + element + "end_header")
                             + bytes);
    };
    expect_contains(message(extra("", "")), {"element extra", "has no properties"});
    // Two lists at least of their lengths' bytes; the first takes all of them.
    const std::string list = "property list short int more\n";
    expect_contains(message(extra(list, std::string("\0\0\1", 3))),
                    {"element extra", "the header announces 2"});
    expect_contains(message(extra(list, std::string("\0\0\1\0", 4))),
                    {"extra 1", "the file ends within property more"});
    expect_contains(message(extra(list, std::string("\1\0wxyz", 6))),
                    {"extra 1", "the file ends here: it is truncated"});
    expect_contains(message(extra(list, std::string("\xff\xff\0\0", 4))),
                    {"extra 0", "the file ends within property more"});
    expect_contains(message(extra(list, std::string("\0\0\0\0!", 5))),
                    {"end of file", "1 bytes follow", "expected none"});
}

TEST_F(DamagedFile, PropertyThatIsNone) {
    for (const std::string line : {"property list uchar v0", "property uint v0 v1"}) {
        expect_contains(
            message(header_with("property uint v0", line)),
            {"'" + line + "'", "'property TYPE NAME' or 'property list TYPE TYPE NAME'"});
    }
    expect_contains(message(header_with("end_header", "property list float uint v9\nend_header")),
                    {"list float", "a whole-number type for the length of a list"});
    expect_contains(message(header_with("end_header", "property uint v0\nend_header")),
                    {"'property uint v0'", "each property only once"});
    expect_contains(message(header_with("element vertex", "property int a\nelement vertex")),
                    {"'property int a'", "an element line in front"});
    expect_contains(message(header_with("end_header", "property list uchar int more\nend_header")),
                    {"pentachoron", "list property more", "fixed width"});
}

class DamagedAscii : public DamagedFile {
protected:
    DamagedAscii() {
        write_mesh(folder_ / "good.pent", test::kuhn_box<4>({1, 1, 1, 1}, {1, 1, 1, 1}),
                   {.encoding = Encoding::Ascii});
        std::ostringstream text;
        text << std::ifstream(folder_ / "good.pent").rdbuf();
        set_bytes(text.str());
    }
};

TEST_F(DamagedAscii, TruncatedAnywhereInTheBody) {
    for (std::size_t bytes = body_; bytes + 1 < good_.size(); bytes += 5) {
        const std::string text = message(good_.substr(0, bytes));
        EXPECT_TRUE(text.find("truncated") != std::string::npos
                    || text.find("ends") != std::string::npos)
            << text;
    }
}

TEST_F(DamagedAscii, AWordInPlaceOfANumber) {
    expect_contains(message(header_with("end_header\n0 ", "end_header\nzero ")),
                    {"vertex 0", "x is 'zero'", "expected a number of type double"});
}

TEST_F(DamagedAscii, TooFewAndTooManyNumbersOnALine) {
    expect_contains(message(header_with("end_header\n0 ", "end_header\n")),
                    {"vertex 0", "the line ends before w", "4 numbers"});
    expect_contains(message(header_with("end_header\n0 ", "end_header\n0 0 ")),
                    {"vertex 0", "more than 4 numbers"});
}

TEST_F(DamagedAscii, ANegativeIndex) {
    const std::size_t last_line = good_.rfind('\n', good_.size() - 2) + 1;
    std::string bytes = good_;
    bytes.insert(last_line, "-");
    expect_contains(message(bytes), {"pentachoron 23", "v0 is '-", "type uint"});
}

TEST_F(DamagedAscii, NotANumberIsNamedWhenThereIsNoChecksum) {
    std::string bytes = header_with("end_header\n0 ", "end_header\nnan ");
    const std::size_t at = bytes.find("comment crc32c");
    bytes.erase(at, bytes.find('\n', at) + 1 - at);
    expect_contains(message(bytes), {"vertex 0", "x is nan", "finite"});
}

TEST_F(DamagedAscii, UnknownElementsCutOff) {
    const std::string announced =
        header_with("end_header", "element extra 2\nproperty char a\nend_header");
    expect_contains(message(announced + "1\n3 "), {"extra 1", "the file ends here"});
    expect_contains(message(announced + "1\n2\n3\n"), {"end of file", "2 bytes follow"});
}

TEST_F(DamagedAscii, NumbersThatDoNotFitTheirType) {
    const auto with_type = [&](const std::string& type, const std::string& number) {
        std::string bytes =
            header_with("property double w\n", "property double w\nproperty " + type + " a\n");
        return bytes.replace(bytes.find('\n', bytes.find("end_header") + 11), 1,
                             " " + number + "\n");
    };
    for (const auto& [type, number] : {std::pair("char", "128"),
                                       {"uchar", "256"},
                                       {"short", "-32769"},
                                       {"ushort", "-1"},
                                       {"int", "2147483648"},
                                       {"uint", "4294967296"},
                                       {"float", "1e39"},
                                       {"double", "1e400"}}) {
        expect_contains(
            message(with_type(type, number)),
            {"vertex 0", "a is '" + std::string(number) + "'", std::string("type ") + type});
    }
}

TEST_F(DamagedAscii, WrongChecksum) {
    expect_contains(message(header_with("end_header\n0 ", "end_header\n0.0 ")),
                    {"checksum", "changed"});
}

// Whatever the bytes are, the answer is a mesh or an Error.
// Either it is refused, or what was damaged says nothing of the mesh, as who made it.
TEST_F(DamagedFile, RandomDamageOfTheHeaderNeverChangesAMesh) {
    std::mt19937 random(11);
    const SimplexMesh<4> good = read_mesh<4>(folder_ / "good.pent").mesh;
    int refused = 0;
    int read = 0;
    for (int trial = 0; trial < 3000; ++trial) {
        std::string bytes = good_;
        const int changes = 1 + static_cast<int>(random() % 4);
        for (int i = 0; i < changes; ++i) {
            bytes[random() % body_] = static_cast<char>(random() % 256);
        }
        if (bytes == good_) {
            continue;
        }
        std::ofstream(folder_ / "bad.pent", std::ios::binary) << bytes;
        try {
            const SimplexMesh<4> mesh = read_mesh<4>(folder_ / "bad.pent").mesh;
            ++read;
            ASSERT_EQ(mesh.positions, good.positions) << bytes.substr(0, body_);
            ASSERT_EQ(mesh.cells, good.cells) << bytes.substr(0, body_);
            ASSERT_EQ(mesh.regions, good.regions) << bytes.substr(0, body_);
        } catch (const Error& error) {
            ++refused;
            expect_contains(error.what(), {"bad.pent: "});
        }
    }
    EXPECT_GT(refused, 2000);
    EXPECT_GT(read, 10);
}

}  // namespace
}  // namespace pent
