#include "readers.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <filesystem>
#include <fstream>
#include <iterator>
#include <ostream>
#include <random>
#include <string>
#include <vector>

namespace pent::fuzz {

// What a test is about, in the names that ctest shows.
void PrintTo(const Reader& reader, std::ostream* out) {
    *out << reader.name;
}

namespace {

namespace fs = std::filesystem;

class EveryReader : public testing::TestWithParam<Reader> {};

std::vector<std::string> samples(const Reader& reader) {
    std::vector<fs::path> paths;
    for (const auto& entry : fs::directory_iterator(fs::path(PENT_FUZZ_CORPUS) / reader.name)) {
        paths.push_back(entry.path());
    }
    std::sort(paths.begin(), paths.end());
    std::vector<std::string> contents;
    for (const fs::path& path : paths) {
        std::ifstream file(path, std::ios::binary);
        contents.emplace_back(std::istreambuf_iterator<char>(file),
                              std::istreambuf_iterator<char>());
    }
    return contents;
}

// A law that is broken aborts: the test cannot pass then.
TEST_P(EveryReader, TakesEverySampleOrSaysWhyNot) {
    const std::vector<std::string> all = samples(GetParam());
    ASSERT_FALSE(all.empty()) << "no samples for " << GetParam().name;
    int accepted = 0;
    for (const std::string& sample : all) {
        accepted += try_bytes(GetParam(), sample.data(), sample.size()) ? 1 : 0;
    }
    EXPECT_GT(accepted, 0) << "else damage of the samples would try no more than the first lines";
}

std::string damage(std::string text, std::mt19937& random) {
    const auto pick = [&](std::size_t below) { return random() % below; };
    const std::size_t times = 1 + pick(4);
    for (std::size_t i = 0; i < times && !text.empty(); ++i) {
        const std::size_t at = pick(text.size());
        switch (pick(5)) {
            case 0:
                text[at] = static_cast<char>(pick(256));
                break;
            case 1:
                text.erase(at, 1 + pick(8));
                break;
            case 2:
                text.insert(at, std::string(1 + pick(8), "0123456789-.e \n"[pick(15)]));
                break;
            case 3:
                text.resize(at);
                break;
            default:  // a piece from elsewhere
                text.insert(at, text.substr(pick(text.size()), pick(40)));
        }
    }
    return text;
}

TEST_P(EveryReader, TakesDamagedSamplesOrSaysWhyNot) {
    constexpr int kTries = 300;
    std::mt19937 random(4);  // NOLINT(cert-msc51-cpp): the same tries every time
    const std::vector<std::string> all = samples(GetParam());
    for (int i = 0; i < kTries; ++i) {
        const std::string bytes = damage(all[random() % all.size()], random);
        try_bytes(GetParam(), bytes.data(), bytes.size());
    }
}

INSTANTIATE_TEST_SUITE_P(Fuzz, EveryReader, testing::ValuesIn(readers()), [](const auto& reader) {
    return std::string(reader.param.name);
});

}  // namespace
}  // namespace pent::fuzz
