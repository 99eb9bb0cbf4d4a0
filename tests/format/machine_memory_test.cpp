#include <pent/machine_memory.h>

#include <gtest/gtest.h>

namespace pent {
namespace {

TEST(MachineMemory, IsThatOfAMachineOfThisCentury) {
    EXPECT_GT(machine_memory(), std::int64_t{1} << 28);
    EXPECT_LT(machine_memory(), std::int64_t{1} << 50);
}

}  // namespace
}  // namespace pent
