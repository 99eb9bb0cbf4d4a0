#include "pent/viewer/movie.h"

#include <pent/child_process.h>
#include <pent/error.h>
#include <pent/formatted.h>
#include <pent/output_file.h>

#include <algorithm>
#include <array>
#include <cerrno>
#include <cstdint>
#include <cstdio>
#include <cstdlib>
#include <cstring>
#include <fstream>
#include <optional>
#include <sstream>
#include <string>
#include <sys/socket.h>
#include <unistd.h>
#include <vector>

namespace pent::viewer {

namespace {

std::string find_in_path(const std::string& program) {
    const char* path = std::getenv("PATH");
    std::istringstream folders(path != nullptr ? path : "/usr/bin:/bin");
    for (std::string folder; std::getline(folders, folder, ':');) {
        std::string candidate = (folder.empty() ? "." : folder) + "/" + program;
        if (::access(candidate.c_str(), X_OK) == 0) {
            return candidate;
        }
    }
    return "";
}

// Whether the boxes an MP4 file is made of fill it exactly, pictures and index among them. ffmpeg
// says nothing but success when the disk is full.
bool is_whole_mp4(const std::filesystem::path& path) {
    std::ifstream file(path, std::ios::binary);
    const auto size = static_cast<std::uint64_t>(std::filesystem::file_size(path));
    std::uint64_t at = 0;
    bool has_pictures = false;
    bool has_index = false;
    while (at + 8 <= size) {
        std::array<unsigned char, 16> head{};
        file.seekg(static_cast<std::streamoff>(at));
        file.read(reinterpret_cast<char*>(head.data()), head.size());
        const auto big_endian = [&](std::size_t first, std::size_t count) {
            std::uint64_t value = 0;
            for (std::size_t i = first; i < first + count; ++i) {
                value = 256 * value + head[i];
            }
            return value;
        };
        const std::uint64_t length = big_endian(0, 4) == 1 ? big_endian(8, 8) : big_endian(0, 4);
        const std::string type(reinterpret_cast<const char*>(&head[4]), 4);
        has_pictures = has_pictures || (type == "mdat" && length > 8);
        has_index = has_index || type == "moov";
        if (length < 8 || length > size - at) {
            return false;
        }
        at += length;
        file.clear();
    }
    return at == size && has_pictures && has_index;
}

}  // namespace

struct Movie::Encoder {
    explicit Encoder(const std::filesystem::path& path)
        : name(path.string()), file(path), messages(temporary_file(name)) {}
    ~Encoder() { close_input(); }
    Encoder(const Encoder&) = delete;
    Encoder& operator=(const Encoder&) = delete;
    Encoder(Encoder&&) = delete;
    Encoder& operator=(Encoder&&) = delete;

    void close_input() {
        if (input >= 0) {
            ::close(input);
            input = -1;
        }
    }

    // Whether ffmpeg ended well; also if it never began.
    [[nodiscard]] bool wait() {
        const ChildEnd end = process ? process->wait() : ChildEnd();
        return end.signal == 0 && end.exit_code == 0;
    }

    [[noreturn]] void give_up() {
        close_input();
        static_cast<void>(wait());
        std::rewind(messages.get());
        std::string last = "it wrote only a part; is the disk full?";
        std::array<char, 512> line{};
        while (std::fgets(line.data(), static_cast<int>(line.size()), messages.get()) != nullptr) {
            last = line.data();
        }
        last.erase(last.find_last_not_of('\n') + 1);
        throw Error(name + ": ffmpeg gave up: " + last);
    }

    std::string name;
    OutputFile file;
    File messages;
    std::optional<ChildProcess> process;  // is waited for when its input has been closed
    int input = -1;
};

bool Movie::is_possible() {
    return !find_in_path("ffmpeg").empty();
}

Movie::Movie(const std::filesystem::path& path, int width, int height, double frames_per_second)
    : encoder_(std::make_unique<Encoder>(path)) {
    const std::string program = find_in_path("ffmpeg");
    if (program.empty()) {
        throw Error(path.string() + ": ffmpeg not found; install it, or ask for PNG pictures");
    }
    // A socket instead of a pipe: writing to it can be told not to raise SIGPIPE.
    std::array<int, 2> ends{};
    if (::socketpair(AF_UNIX, SOCK_STREAM | SOCK_CLOEXEC, 0, ends.data()) != 0) {
        throw Error(path.string() + ": no connection to ffmpeg: " + std::strerror(errno));
    }
    encoder_->input = ends[0];
    const std::vector<std::string> arguments = {
        "-hide_banner",
        "-loglevel",
        "error",
        "-nostdin",
        "-y",
        "-f",
        "rawvideo",
        "-pixel_format",
        "rgb24",
        "-video_size",
        std::to_string(width) + "x" + std::to_string(height),
        "-framerate",
        formatted("%.9g", frames_per_second),
        "-i",
        "pipe:0",
        "-c:v",
        "libx264",
        "-preset",
        "fast",
        "-crf",
        "18",
        "-pix_fmt",
        "yuv420p",
        "-movflags",
        "+faststart",
        "-f",
        "mp4",
        encoder_->file.temporary().string()};
    try {
        encoder_->process.emplace(program, arguments,
                                  ChildOptions{.input = ends[1],
                                               .errors = ::fileno(encoder_->messages.get()),
                                               .has_own_group = true});
    } catch (...) {
        ::close(ends[1]);
        throw;
    }
    ::close(ends[1]);
}

Movie::~Movie() = default;

void Movie::add(const Image& picture) {
    const std::uint8_t* data = picture.rgb.data();
    std::size_t left = picture.rgb.size();
    while (left > 0) {
        const ssize_t sent = ::send(encoder_->input, data, left, MSG_NOSIGNAL);
        if (sent < 0 && errno != EINTR) {
            encoder_->give_up();
        }
        data += std::max<ssize_t>(sent, 0);
        left -= static_cast<std::size_t>(std::max<ssize_t>(sent, 0));
    }
}

void Movie::finish() {
    encoder_->close_input();
    if (!encoder_->wait() || !is_whole_mp4(encoder_->file.temporary())) {
        encoder_->give_up();
    }
    encoder_->file.commit();
}

}  // namespace pent::viewer
