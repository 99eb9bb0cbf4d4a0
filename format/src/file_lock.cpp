#include "pent/file_lock.h"

#include <pent/error.h>

#include <cerrno>
#include <fcntl.h>
#include <sys/file.h>
#include <unistd.h>

namespace pent {

namespace {

// Over NFS only a file that is open for writing can be locked; a folder cannot be opened so.
int open_best(const std::filesystem::path& path, int flags) {
    const int descriptor = ::open(path.c_str(), O_RDWR | flags);
    return descriptor >= 0 ? descriptor : ::open(path.c_str(), O_RDONLY | flags);
}

}  // namespace

FileLock::FileLock(const std::filesystem::path& path,
                   const std::string& busy,
                   const FileLockOptions& options)
    : descriptor_(open_best(path, options.is_inherited ? 0 : O_CLOEXEC)) {
    const int kind = options.is_shared ? LOCK_SH : LOCK_EX;
    if (descriptor_ >= 0 && ::flock(descriptor_, kind | LOCK_NB) != 0 && errno == EWOULDBLOCK) {
        ::close(descriptor_);
        throw Error(path.string() + ": " + busy);
    }
}

FileLock::~FileLock() {
    if (descriptor_ >= 0) {
        ::close(descriptor_);
    }
}

}  // namespace pent
