#include "linear/line_allocator.h"

#include <gtest/gtest.h>

#include <cstdint>
#include <numeric>
#include <vector>

namespace pent::simulator {
namespace {

constexpr std::size_t kMegabyte = std::size_t{1} << 20;

TEST(LineAllocatorTest, StartsAtCacheLinesAndMuchMemoryAtLargePages) {
    for (const std::size_t bytes : {std::size_t{0}, std::size_t{1}, std::size_t{100}, kMegabyte,
                                    8 * kMegabyte - 1, 8 * kMegabyte, 9 * kMegabyte + 5}) {
        void* memory = allocate_lines(bytes);
        const std::uintptr_t line = bytes < 8 * kMegabyte ? 64 : 2 * kMegabyte;
        EXPECT_EQ(reinterpret_cast<std::uintptr_t>(memory) % line, 0U) << bytes;
        free_lines(memory, bytes);
    }
}

// From small to large pages and back.
TEST(LineAllocatorTest, KeepsNumbersOfArraysThatGrowAndShrink) {
    std::vector<std::uint32_t, LineAllocator<std::uint32_t>> numbers(kMegabyte);  // 4 MB
    std::iota(numbers.begin(), numbers.end(), 0U);
    numbers.resize(3 * kMegabyte, 7U);
    numbers.resize(kMegabyte + 1);
    numbers.shrink_to_fit();
    for (std::uint32_t i = 0; i < kMegabyte; ++i) {
        ASSERT_EQ(numbers[i], i);
    }
    EXPECT_EQ(numbers.back(), 7U);
}

}  // namespace
}  // namespace pent::simulator
