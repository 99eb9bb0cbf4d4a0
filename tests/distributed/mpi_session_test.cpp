#include <pent/distributed/mpi_session.h>

#include <gtest/gtest.h>

#include <cstddef>
#include <cstdint>
#include <cstdlib>
#include <fstream>
#include <unistd.h>
#include <vector>

namespace pent::distributed {
namespace {

std::int64_t resident_bytes() {
    std::int64_t all = 0;
    std::int64_t resident = 0;
    std::ifstream("/proc/self/statm") >> all >> resident;
    return resident * sysconf(_SC_PAGESIZE);
}

// Whatever the libraries that are linked have asked of the allocator. Blocks that stay lie between
// those that go: only what was mapped by itself can go.
TEST(MpiSession, GivesFreedMemoryBack) {
    setenv("OMPI_ALLOW_RUN_AS_ROOT", "1", 1);
    setenv("OMPI_ALLOW_RUN_AS_ROOT_CONFIRM", "1", 1);
    const MpiSession session;
    constexpr std::size_t kBlocks = 32;
    constexpr std::size_t kBytes = std::size_t{4} << 20U;
    std::vector<std::vector<char>> blocks;
    for (std::size_t i = 0; i < kBlocks; ++i) {
        blocks.emplace_back(kBytes, 'a');
    }
    const std::int64_t full = resident_bytes();
    for (std::size_t i = 0; i < kBlocks; i += 2) {
        std::vector<char>().swap(blocks[i]);
    }
    const auto freed = static_cast<std::int64_t>(kBlocks / 2 * kBytes);
    EXPECT_GT(full - resident_bytes(), freed - freed / 10);
    EXPECT_EQ(blocks.back().front(), 'a');
}

}  // namespace
}  // namespace pent::distributed
