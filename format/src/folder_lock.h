#pragma once

#include <filesystem>

namespace pent {

/// Keeps other programs from writing to a folder for as long as it lives. No file is left of it: it
/// is a lock of the folder itself, which the system takes back from a program that is killed.
class FolderLock {
public:
    /// Throws an Error if another has the folder. Where a file system knows no locks, as some of
    /// networks do, nothing is locked.
    explicit FolderLock(const std::filesystem::path& folder);
    ~FolderLock();

    FolderLock(const FolderLock&) = delete;
    FolderLock& operator=(const FolderLock&) = delete;
    FolderLock(FolderLock&&) = delete;
    FolderLock& operator=(FolderLock&&) = delete;

private:
    int descriptor_ = -1;
};

}  // namespace pent
