#pragma once

#include <cstddef>
#include <filesystem>
#include <vector>

namespace pent::fuzz {

/// One kind of input, and a law that must hold for any bytes of it: an Error, or a value that
/// passes its checks and survives being written and read again. Anything else aborts.
struct Reader {
    const char* name;    ///< Also the folder of its samples under corpus/.
    const char* ending;  ///< Of a file of this kind.
    void (*try_file)(const std::filesystem::path& path);
};

/// All readers of our own.
[[nodiscard]] const std::vector<Reader>& readers();

/// The reader of that name, or nullptr.
[[nodiscard]] const Reader* find_reader(const char* name);

/// Gives some bytes to a reader as a file. Does not return if the law is broken.
/// @return  Whether they were accepted; else they were refused by an Error.
bool try_bytes(const Reader& reader, const void* data, std::size_t bytes);

}  // namespace pent::fuzz
