#pragma once

#include <cstdint>
#include <filesystem>
#include <functional>
#include <string_view>
#include <vector>

namespace pent {

/// Processes that write a file together: each has a slab of its rows, and slabs follow one another
/// in the order of the processes. Every method is a collective operation: all processes call the
/// same ones, in the same order.
class SlabWriters {
public:
    SlabWriters() = default;
    virtual ~SlabWriters() = default;
    SlabWriters(const SlabWriters&) = delete;
    SlabWriters& operator=(const SlabWriters&) = delete;
    SlabWriters(SlabWriters&&) = delete;
    SlabWriters& operator=(SlabWriters&&) = delete;

    /// Which of them this is, from 0.
    [[nodiscard]] virtual int place() const = 0;

    /// A number of each; whole ones up to 2^53 stay as they are.
    [[nodiscard]] virtual std::vector<double> list(double own) const = 0;

    /// Does work that may throw an Error: if it does on one process, all of them throw it.
    virtual void agree(const std::function<void()>& work) const = 0;
};

/// Where the own slab lies among those of all writers, in bytes or rows.
struct SlabPlace {
    std::uint64_t before = 0;  ///< Of the writers in front of this one.
    std::uint64_t all = 0;     ///< Of all writers.
};

/// @param writers  Null for one alone.
[[nodiscard]] SlabPlace place_slab(const SlabWriters* writers, std::uint64_t own);

/// Checksum of the slabs of all, one behind the other.
[[nodiscard]] std::uint32_t crc32c_of_slabs(const SlabWriters* writers, std::string_view own);

/// Makes a file of a header and the slabs of all. Like an OutputFile it is there whole or not at
/// all; all writers have to see its folder. What fails on one writer fails on all, with an Error
/// that names the path.
///
/// @param header  The same for all.
void write_slabs(const std::filesystem::path& path,
                 std::string_view header,
                 std::string_view own,
                 const SlabWriters* writers);

}  // namespace pent
