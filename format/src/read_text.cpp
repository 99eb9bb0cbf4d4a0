#include "pent/read_text.h"

#include <pent/error.h>

#include <array>
#include <cerrno>
#include <fcntl.h>
#include <system_error>
#include <unistd.h>

namespace pent {

namespace {

[[noreturn]] void fail(const std::filesystem::path& path, int error, const std::string& expected) {
    throw Error(path.string() + ": cannot be read: " + std::generic_category().message(error)
                + "; expected " + expected);
}

}  // namespace

std::string read_text(const std::filesystem::path& path, const std::string& expected) {
    const int descriptor = ::open(path.c_str(), O_RDONLY | O_CLOEXEC);
    if (descriptor < 0) {
        fail(path, errno, expected);
    }
    std::string text;
    std::array<char, 65536> part{};
    ssize_t got = 0;
    do {
        got = ::read(descriptor, part.data(), part.size());
        if (got > 0) {
            text.append(part.data(), static_cast<std::size_t>(got));
        }
    } while (got > 0 || (got < 0 && errno == EINTR));
    const int error = errno;
    ::close(descriptor);
    if (got < 0) {
        fail(path, error, expected);
    }
    return text;
}

}  // namespace pent
