#include "pent/slab_writers.h"

#include "slab_sum.h"

#include <pent/crc32c.h>
#include <pent/output_file.h>

#include <optional>
#include <unistd.h>

namespace pent {

SlabPlace place_slab(const SlabWriters* writers, std::uint64_t own) {
    if (writers == nullptr) {
        return {0, own};
    }
    SlabPlace slab;
    const std::vector<double> sizes = writers->list(static_cast<double>(own));
    for (std::size_t i = 0; i < sizes.size(); ++i) {
        const auto size = static_cast<std::uint64_t>(sizes[i]);
        slab.before += i < static_cast<std::size_t>(writers->place()) ? size : 0;
        slab.all += size;
    }
    return slab;
}

std::uint32_t joined_crc32c(const SlabWriters* writers, std::uint32_t own, std::uint64_t bytes) {
    if (writers == nullptr) {
        return own;
    }
    const std::vector<double> sums = writers->list(own);
    const std::vector<double> sizes = writers->list(static_cast<double>(bytes));
    std::uint32_t joined = 0;
    for (std::size_t i = 0; i < sums.size(); ++i) {
        joined = crc32c_joined(joined, static_cast<std::uint32_t>(sums[i]),
                               static_cast<std::uint64_t>(sizes[i]));
    }
    return joined;
}

std::uint32_t crc32c_of_slabs(const SlabWriters* writers, std::string_view own) {
    return joined_crc32c(writers, crc32c(own.data(), own.size()), own.size());
}

void write_slabs(const std::filesystem::path& path,
                 std::string_view header,
                 std::string_view own,
                 const SlabWriters* writers) {
    if (writers == nullptr) {
        OutputFile file(path);
        file.write(header);
        file.write(own);
        file.commit();
        return;
    }
    const std::uint64_t before = header.size() + place_slab(writers, own.size()).before;
    const auto process = static_cast<std::int64_t>(writers->list(::getpid())[0]);
    const bool is_first = writers->place() == 0;
    std::optional<OutputFile> file;
    writers->agree([&] {
        if (is_first) {
            file.emplace(path);
            file->write(header);
        }
    });
    writers->agree([&] { write_slab(path, process, before, own); });
    writers->agree([&] {
        if (is_first) {
            file->commit();
        }
    });
}

}  // namespace pent
