#include "pent/viewer/movie.h"

#include <gtest/gtest.h>

#include <array>
#include <cstdlib>
#include <fstream>
#include <string>
#include <support/messages.h>
#include <support/temp_folder.h>
#include <sys/resource.h>
#include <unistd.h>

// What becomes of a movie when ffmpeg does not do its part: programs of that name, written here,
// take its place.

namespace pent::viewer {
namespace {

using pent::test::error_of;
using pent::test::expect_contains;

class FakeFfmpeg : public testing::Test {
protected:
    FakeFfmpeg() {
        const char* path = std::getenv("PATH");
        path_ = path != nullptr ? path : "";
        std::filesystem::create_directory(folder_ / "bin");
        set_path((folder_ / "bin").string() + ":" + path_);
    }
    ~FakeFfmpeg() override { set_path(path_); }
    FakeFfmpeg(const FakeFfmpeg&) = delete;
    FakeFfmpeg& operator=(const FakeFfmpeg&) = delete;
    FakeFfmpeg(FakeFfmpeg&&) = delete;
    FakeFfmpeg& operator=(FakeFfmpeg&&) = delete;

    static void set_path(const std::string& path) {
        ::setenv("PATH", path.c_str(), 1);  // NOLINT(concurrency-mt-unsafe)
    }

    void write_ffmpeg(const std::string& text) const {
        const std::filesystem::path program = folder_ / "bin/ffmpeg";
        std::ofstream(program) << text;
        std::filesystem::permissions(program, std::filesystem::perms::owner_all);
    }

    // ffmpeg reads all pictures, then leaves these bytes as its movie; its last argument is where.
    void write_ffmpeg_that_makes(const std::string& bytes) const {
        std::ofstream(folder_ / "made", std::ios::binary) << bytes;
        write_ffmpeg("#!/bin/sh\ncat >/dev/null\nfor last; do :; done\ncp "
                     + (folder_ / "made").string() + " \"$last\"\n");
    }

    // The Error of a movie of one picture, or "" if there is none.
    [[nodiscard]] std::string failure() const {
        try {
            Movie movie(folder_ / "a.mp4", 16, 16, 10);
            movie.add(Image(16, 16));
            movie.finish();
        } catch (const Error& error) {
            return error.what();
        }
        return "";
    }

    // No movie, and none in the making.
    void expect_nothing_left() const {
        EXPECT_FALSE(std::filesystem::exists(folder_ / "a.mp4"));
        for (const auto& entry : std::filesystem::directory_iterator(folder_.path())) {
            EXPECT_NE(entry.path().extension(), ".tmp") << entry.path();
        }
    }

    pent::test::TempFolder folder_;
    std::string path_;
};

// A box of an MP4 file: its length in four bytes, its name, zeros.
std::string box(const std::string& name, std::size_t length) {
    std::string bytes = {'\0', '\0', static_cast<char>(length / 256),
                         static_cast<char>(length % 256)};
    bytes += name;
    bytes.resize(length, '\0');
    return bytes;
}

TEST_F(FakeFfmpeg, MayBeMissing) {
    set_path((folder_ / "bin").string());
    EXPECT_FALSE(Movie::is_possible());
    expect_contains(failure(), {"a.mp4", "ffmpeg not found", "PNG"});
    expect_nothing_left();
}

TEST_F(FakeFfmpeg, IsSearchedForWhereTheSystemHasProgramsWithoutAPath) {
    ::unsetenv("PATH");  // NOLINT(concurrency-mt-unsafe)
    const bool is_there =
        ::access("/usr/bin/ffmpeg", X_OK) == 0 || ::access("/bin/ffmpeg", X_OK) == 0;
    EXPECT_EQ(Movie::is_possible(), is_there);
}

TEST_F(FakeFfmpeg, MayBeNoProgram) {
    write_ffmpeg("neither a script nor a program\n");
    EXPECT_TRUE(Movie::is_possible());
    expect_contains(failure(), {"bin/ffmpeg", "cannot be started", "Exec format error"});
    expect_nothing_left();
}

TEST_F(FakeFfmpeg, SaysItselfWhatIsWrong) {
    write_ffmpeg("#!/bin/sh\ncat >/dev/null\necho first >&2\necho no such codec >&2\nexit 1\n");
    expect_contains(failure(), {"a.mp4", "ffmpeg gave up: no such codec"});
    expect_nothing_left();
}

TEST_F(FakeFfmpeg, MayStopListening) {
    write_ffmpeg("#!/bin/sh\nexec <&-\necho enough >&2\nexit 1\n");
    const std::string message = error_of([&] {
        Movie movie(folder_ / "a.mp4", 16, 16, 10);
        const Image picture(16, 16);
        for (int i = 0; i < 100000; ++i) {  // more than any connection holds
            movie.add(picture);
        }
    });
    expect_contains(message, {"ffmpeg gave up: enough"});
    expect_nothing_left();
}

TEST_F(FakeFfmpeg, MayLeaveAMovieThatIsNotWhole) {
    const std::string index = box("moov", 24);
    const std::string pictures = box("mdat", 300);
    const std::string whole = box("ftyp", 16) + index + pictures;
    for (const std::string& bytes :
         {std::string(), whole.substr(0, whole.size() - 1), whole + "x", index, pictures,
          index + box("mdat", 8), index + box("mdat", 8).replace(3, 1, "\4")}) {
        write_ffmpeg_that_makes(bytes);
        expect_contains(failure(), {"a.mp4", "wrote only a part"});
        expect_nothing_left();
    }
    write_ffmpeg_that_makes(whole);
    EXPECT_EQ(failure(), "");
    EXPECT_EQ(std::filesystem::file_size(folder_ / "a.mp4"), whole.size());
}

TEST_F(FakeFfmpeg, MayMakeABoxOfMoreThanFourGibibytes) {
    // Length 1 announces eight more bytes for the length.
    std::string large = box("mdat", 300).replace(0, 4, std::string("\0\0\0\1", 4));
    large.replace(8, 8, std::string("\0\0\0\0\0\0\1\x2c", 8));  // 300
    write_ffmpeg_that_makes(box("moov", 8) + large);
    EXPECT_EQ(failure(), "");
}

TEST_F(FakeFfmpeg, NeedsTwoFilesAndAConnection) {
    write_ffmpeg_that_makes("");
    rlimit before = {};
    ASSERT_EQ(::getrlimit(RLIMIT_NOFILE, &before), 0);
    const int next = ::dup(0);
    ::close(next);
    std::array<std::string, 3> messages;
    for (std::size_t more = 0; more < messages.size(); ++more) {
        const rlimit few = {static_cast<rlim_t>(next) + more, before.rlim_max};
        ::setrlimit(RLIMIT_NOFILE, &few);
        messages[more] = failure();
        ::setrlimit(RLIMIT_NOFILE, &before);
    }
    expect_contains(messages[0], {"a.mp4", "cannot be written", "Too many open files"});
    expect_contains(messages[1], {"a.mp4", "cannot make a temporary file", "Too many open files"});
    expect_contains(messages[2], {"a.mp4", "no connection to ffmpeg", "Too many open files"});
    expect_nothing_left();
}

}  // namespace
}  // namespace pent::viewer
