#pragma once

#include <filesystem>
#include <string>

namespace pent {

struct FileLockOptions {
    bool is_shared = false;     ///< Others may have it, too, if they share it.
    bool is_inherited = false;  ///< Programs started meanwhile keep it until they end.
};

/// Keeps other programs from a file or folder for as long as it lives. Nothing is left of it: it is
/// a lock of the file itself, which the system takes back from a program that is killed. Where a
/// file system knows no locks, as some of networks do, nothing is locked.
class FileLock {
public:
    /// Throws an Error if another has it: "PATH: BUSY".
    FileLock(const std::filesystem::path& path,
             const std::string& busy,
             const FileLockOptions& options = {});
    ~FileLock();

    FileLock(const FileLock&) = delete;
    FileLock& operator=(const FileLock&) = delete;
    FileLock(FileLock&&) = delete;
    FileLock& operator=(FileLock&&) = delete;

private:
    int descriptor_ = -1;
};

}  // namespace pent
