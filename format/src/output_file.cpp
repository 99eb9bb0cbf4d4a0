#include "pent/output_file.h"

#include <pent/error.h>

#include <algorithm>
#include <cerrno>
#include <cstring>
#include <fcntl.h>
#include <string>
#include <system_error>
#include <unistd.h>
#include <utility>

namespace pent {

namespace {

std::string advice(int error) {
    switch (error) {
        case ENOSPC:
        case EDQUOT:
            return "free some space or choose another folder";
        case EFBIG:
            return "a limit on file size is set; raise it (ulimit -f) or choose a smaller output";
        case EACCES:
        case EPERM:
        case EROFS:
            return "choose a folder that you may write to";
        case ENOENT:
        case ENOTDIR:
            return "make its folder first or correct the path";
        default:
            return "choose another place";
    }
}

[[noreturn]] void fail(const std::filesystem::path& path, int error) {
    throw Error(path.string() + ": cannot be written: " + std::generic_category().message(error)
                + "; " + advice(error));
}

// 0, or what went wrong. Goes on where the descriptor is.
int write_all(int descriptor, const void* data, std::size_t bytes) {
    const char* at = static_cast<const char*>(data);
    while (bytes > 0) {
        const ssize_t written = ::write(descriptor, at, bytes);
        if (written < 0 && errno != EINTR) {
            return errno;
        }
        at += std::max<ssize_t>(written, 0);
        bytes -= static_cast<std::size_t>(std::max<ssize_t>(written, 0));
    }
    return 0;
}

std::filesystem::path temporary_for(const std::filesystem::path& path, std::int64_t process) {
    const std::string name =
        "." + path.filename().string() + "." + std::to_string(process) + ".tmp";
    return path.parent_path() / name;
}

// What is to have the bytes of a file with this name: where a link leads to.
std::filesystem::path target_of(const std::filesystem::path& path) {
    std::error_code ignored;
    const bool is_link = std::filesystem::is_regular_file(path, ignored)
                         && std::filesystem::is_symlink(path, ignored);
    return is_link ? std::filesystem::canonical(path) : path;
}

}  // namespace

OutputFile::OutputFile(std::filesystem::path path)
    : path_(std::move(path)), target_(target_of(path_)) {
    namespace fs = std::filesystem;
    std::error_code ignored;
    const fs::file_status status = fs::status(path_, ignored);
    if (path_.filename().empty() || fs::is_directory(status)) {
        fail(path_, EISDIR);
    }
    // A file must not take the place of a device or a pipe.
    const bool is_stream = fs::exists(status) && !fs::is_regular_file(status);
    temporary_ = is_stream ? target_ : temporary_for(target_, ::getpid());
    descriptor_ = ::open(temporary_.c_str(), O_WRONLY | O_CREAT | O_TRUNC | O_CLOEXEC, 0666);
    if (descriptor_ < 0) {
        fail(path_, errno);
    }
}

OutputFile::~OutputFile() {
    if (descriptor_ >= 0) {
        ::close(descriptor_);
    }
    if (!temporary_.empty() && temporary_ != target_) {
        ::unlink(temporary_.c_str());
    }
}

void OutputFile::write(const void* data, std::size_t bytes) {
    if (const int error = write_all(descriptor_, data, bytes); error != 0) {
        fail(path_, error);
    }
}

void OutputFile::close() {
    const int descriptor = std::exchange(descriptor_, -1);
    if (descriptor >= 0 && ::close(descriptor) != 0) {
        fail(path_, errno);  // GCOVR_EXCL_LINE: file systems on a network put errors off until here
    }
}

void OutputFile::commit() {
    close();
    if (temporary_ != target_ && ::rename(temporary_.c_str(), target_.c_str()) != 0) {
        fail(path_, errno);
    }
    temporary_.clear();
}

void write_slab(const std::filesystem::path& path,
                std::int64_t process,
                std::uint64_t offset,
                std::string_view bytes) {
    const std::filesystem::path file = temporary_for(target_of(path), process);
    const int descriptor = ::open(file.c_str(), O_WRONLY | O_CLOEXEC);
    if (descriptor < 0) {
        fail(path, errno);
    }
    int error = ::lseek(descriptor, static_cast<off_t>(offset), SEEK_SET) < 0 ? errno : 0;
    error = error != 0 ? error : write_all(descriptor, bytes.data(), bytes.size());
    if (::close(descriptor) != 0 || error != 0) {
        fail(path, error != 0 ? error : errno);
    }
}

void write_text(const std::filesystem::path& path, std::string_view text) {
    OutputFile file(path);
    file.write(text);
    file.commit();
}

void append_text(const std::filesystem::path& path, std::string_view text) {
    const int descriptor = ::open(path.c_str(), O_WRONLY | O_CREAT | O_APPEND | O_CLOEXEC, 0666);
    if (descriptor < 0) {
        fail(path, errno);
    }
    const int error = write_all(descriptor, text.data(), text.size());
    if (::close(descriptor) != 0 || error != 0) {
        fail(path, error != 0 ? error : errno);
    }
}

void make_folder(const std::filesystem::path& path) {
    std::error_code error;
    std::filesystem::create_directories(path, error);
    if (error) {
        throw Error(path.string() + ": folder cannot be made: " + error.message() + "; "
                    + advice(error.value()));
    }
}

}  // namespace pent
