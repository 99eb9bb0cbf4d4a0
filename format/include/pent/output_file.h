#pragma once

#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <string_view>

namespace pent {

/// A file that appears under its name whole or not at all.
///
/// Bytes go to `.NAME.PID.tmp` in the same folder; commit() renames it. Without commit() the
/// temporary file is removed. A link stays, and what it leads to is written. Devices and pipes, as
/// /dev/stdout, are written to at once. Every function throws an Error that names the path, what
/// failed (no such folder, permission, disk full) and what to do.
class OutputFile {
public:
    explicit OutputFile(std::filesystem::path path);
    ~OutputFile();
    OutputFile(const OutputFile&) = delete;
    OutputFile& operator=(const OutputFile&) = delete;
    OutputFile(OutputFile&&) = delete;
    OutputFile& operator=(OutputFile&&) = delete;

    void write(const void* data, std::size_t bytes);
    void write(std::string_view text) { write(text.data(), text.size()); }

    /// Where the bytes are until commit(): for libraries that write a file by name themselves.
    [[nodiscard]] const std::filesystem::path& temporary() const { return temporary_; }

    /// Closes the temporary file and gives it its name.
    void commit();

private:
    void close();

    std::filesystem::path path_;       // as given, for messages
    std::filesystem::path target_;     // what is to have the bytes
    std::filesystem::path temporary_;  // what has them; the target, if no file; empty at the end
    int descriptor_ = -1;
};

/// Writes bytes at an offset of the temporary file that an OutputFile of a process has for `path`,
/// which may be another process, on another machine.
void write_slab(const std::filesystem::path& path,
                std::int64_t process,
                std::uint64_t offset,
                std::string_view bytes);

/// Writes a whole text file through an OutputFile.
void write_text(const std::filesystem::path& path, std::string_view text);

/// Adds text to the end of a file, which it makes if need be, in one write: a kill leaves all of it
/// or its beginning. Throws an Error that names the path and says what to do.
void append_text(const std::filesystem::path& path, std::string_view text);

/// Makes a folder and its parents. Throws an Error that names it when that fails.
void make_folder(const std::filesystem::path& path);

}  // namespace pent
