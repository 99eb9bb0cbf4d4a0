#include "pent/viewer/movie.h"

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
#include <fcntl.h>
#include <fstream>
#include <spawn.h>
#include <sstream>
#include <string>
#include <sys/socket.h>
#include <sys/wait.h>
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

// Starts a program with the given standard input and standard error, and no output.
pid_t start(const std::vector<std::string>& words, int input, int errors) {
    std::vector<char*> arguments;
    arguments.reserve(words.size() + 1);
    for (const std::string& word : words) {
        arguments.push_back(const_cast<char*>(word.c_str()));  // posix_spawn does not write to them
    }
    arguments.push_back(nullptr);
    posix_spawn_file_actions_t actions;
    posix_spawn_file_actions_init(&actions);
    posix_spawn_file_actions_adddup2(&actions, input, STDIN_FILENO);
    posix_spawn_file_actions_addopen(&actions, STDOUT_FILENO, "/dev/null", O_WRONLY, 0);
    posix_spawn_file_actions_adddup2(&actions, errors, STDERR_FILENO);
    // In its own process group, so that Ctrl-C in a terminal reaches us alone and we decide.
    posix_spawnattr_t attributes;
    posix_spawnattr_init(&attributes);
    posix_spawnattr_setflags(&attributes, POSIX_SPAWN_SETPGROUP);
    pid_t process = -1;
    const int error = posix_spawn(&process, words.front().c_str(), &actions, &attributes,
                                  arguments.data(), environ);
    posix_spawnattr_destroy(&attributes);
    posix_spawn_file_actions_destroy(&actions);
    if (error != 0) {
        throw Error(words.front() + ": cannot be started: " + std::strerror(error));
    }
    return process;
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

struct CloseFile {
    void operator()(std::FILE* file) const { std::fclose(file); }
};

}  // namespace

struct Movie::Encoder {
    explicit Encoder(const std::filesystem::path& path)
        : name(path.string()), file(path), messages(std::tmpfile()) {
        if (!messages) {
            throw Error(name + ": no temporary file can be made: " + std::strerror(errno));
        }
    }
    ~Encoder() {
        close_input();
        wait();
    }
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

    // The exit status of ffmpeg; 0 if there is none to wait for.
    int wait() {
        int status = 0;
        if (process > 0) {
            while (::waitpid(process, &status, 0) < 0 && errno == EINTR) {
            }
            process = -1;
        }
        return status;
    }

    [[noreturn]] void give_up() {
        close_input();
        wait();
        std::rewind(messages.get());
        std::string last = "it wrote only a part; is the disk full?";
        std::array<char, 512> line{};
        while (std::fgets(line.data(), static_cast<int>(line.size()), messages.get()) != nullptr) {
            last = line.data();
        }
        throw Error(name + ": ffmpeg gave up: " + last);
    }

    std::string name;
    OutputFile file;
    std::unique_ptr<std::FILE, CloseFile> messages;
    int input = -1;
    pid_t process = -1;
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
    const std::vector<std::string> words = {program,
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
        encoder_->process = start(words, ends[1], ::fileno(encoder_->messages.get()));
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
    if (encoder_->wait() != 0 || !is_whole_mp4(encoder_->file.temporary())) {
        encoder_->give_up();
    }
    encoder_->file.commit();
}

}  // namespace pent::viewer
