#include "input_file.h"

#include <pent/error.h>

#include <algorithm>
#include <cerrno>
#include <fcntl.h>
#include <sys/stat.h>
#include <system_error>
#include <unistd.h>

namespace pent {

namespace {

[[noreturn]] void fail(const std::filesystem::path& path, int error) {
    throw Error(path.string() + ": cannot be read: " + std::generic_category().message(error));
}

// Closes a file descriptor at the end of a scope.
class Descriptor {
public:
    explicit Descriptor(int number) : number_(number) {}
    [[nodiscard]] int number() const { return number_; }
    ~Descriptor() { ::close(number_); }
    Descriptor(const Descriptor&) = delete;
    Descriptor& operator=(const Descriptor&) = delete;
    Descriptor(Descriptor&&) = delete;
    Descriptor& operator=(Descriptor&&) = delete;

private:
    int number_;  // or -1
};

}  // namespace

InputFile read_input(const std::filesystem::path& path, std::size_t limit, std::uint64_t first) {
    const Descriptor descriptor(::open(path.c_str(), O_RDONLY | O_CLOEXEC));
    struct stat status = {};
    if (descriptor.number() < 0 || ::fstat(descriptor.number(), &status) != 0) {
        fail(path, errno);
    }
    if (!S_ISREG(status.st_mode)) {
        throw Error(path.string() + ": not a regular file, expected a .pent file");
    }
    InputFile file;
    const auto size = static_cast<std::uint64_t>(status.st_size);
    const auto wanted =
        static_cast<std::size_t>(std::min<std::uint64_t>(limit, size - std::min(size, first)));
    file.data.reset(new char[wanted]);  // not set to zero: the file fills it
    while (file.bytes < wanted) {
        const ssize_t got = ::pread(descriptor.number(), file.data.get() + file.bytes,
                                    wanted - file.bytes, static_cast<off_t>(first + file.bytes));
        if (got < 0 && errno != EINTR) {
            fail(path, errno);  // GCOVR_EXCL_LINE: a disk that breaks
        }
        if (got == 0) {
            break;  // the file became shorter while it was read; the header's counts will tell
        }
        file.bytes += static_cast<std::size_t>(std::max<ssize_t>(got, 0));
    }
    return file;
}

}  // namespace pent
