// Entry points of libFuzzer; the environment variable PENT_FUZZ_READER names the reader to try.

#include "readers.h"

#include <cstdint>
#include <cstdio>
#include <cstdlib>

namespace {
const pent::fuzz::Reader* reader = nullptr;
}

extern "C" int LLVMFuzzerInitialize(int* /*argc*/, char*** /*argv*/) {
    const char* name = std::getenv("PENT_FUZZ_READER");
    reader = name == nullptr ? nullptr : pent::fuzz::find_reader(name);
    if (reader == nullptr) {
        std::fprintf(stderr, "fuzz_readers: PENT_FUZZ_READER must be one of:");
        for (const pent::fuzz::Reader& known : pent::fuzz::readers()) {
            std::fprintf(stderr, " %s", known.name);
        }
        std::fprintf(stderr, "\n");
        std::exit(2);
    }
    return 0;
}

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
    pent::fuzz::try_bytes(*reader, data, size);
    return 0;
}
