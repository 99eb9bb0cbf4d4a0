#include "folder_lock.h"

#include <pent/error.h>

#include <cerrno>
#include <fcntl.h>
#include <sys/file.h>
#include <unistd.h>

namespace pent {

FolderLock::FolderLock(const std::filesystem::path& folder)
    // Programs that this one starts write to folders of their own, and must not keep this lock.
    : descriptor_(open(folder.c_str(), O_RDONLY | O_DIRECTORY | O_CLOEXEC)) {
    if (descriptor_ >= 0 && flock(descriptor_, LOCK_EX | LOCK_NB) != 0 && errno == EWOULDBLOCK) {
        close(descriptor_);
        throw Error(folder.string()
                    + ": another program is writing to this folder; wait until it is done, or use"
                      " another folder");
    }
}

FolderLock::~FolderLock() {
    if (descriptor_ >= 0) {
        close(descriptor_);
    }
}

}  // namespace pent
