#include <pent/processor.h>

#include <gtest/gtest.h>

#include <fstream>
#include <initializer_list>
#include <set>
#include <sstream>
#include <string>

namespace pent {
namespace {

// What the kernel says of the first processor; empty where it is not asked.
std::set<std::string> flags_of_the_kernel() {
    std::ifstream file("/proc/cpuinfo");
    std::set<std::string> flags;
    for (std::string line; flags.empty() && std::getline(file, line);) {
        if (line.starts_with("flags")) {
            std::istringstream words(line.substr(line.find(':') + 1));
            for (std::string word; words >> word;) {
                flags.insert(word);
            }
        }
    }
    return flags;
}

bool has_all(const std::set<std::string>& flags, std::initializer_list<const char*> wanted) {
    for (const char* flag : wanted) {
        if (!flags.contains(flag)) {
            return false;
        }
    }
    return true;
}

TEST(Processor, HasWhatTheKernelSays) {
    const std::set<std::string> flags = flags_of_the_kernel();
    if (flags.empty()) {
        GTEST_SKIP() << "no flags in /proc/cpuinfo";
    }
    EXPECT_EQ(has_avx2(), has_all(flags, {"avx2", "fma"}));
    EXPECT_EQ(has_avx512(), has_all(flags, {"avx512f", "avx512dq", "avx512bw", "avx512vl"}));
}

}  // namespace
}  // namespace pent
