#include "gzip.h"

#include <pent/error.h>

#include <algorithm>
#include <limits>
#include <zlib.h>

namespace pent::mesher {

namespace {

// A stream that is ended whatever happens.
class Inflation {
public:
    explicit Inflation(const std::string& name) {
        constexpr int kGzipOnly = 16;
        if (inflateInit2(&stream_, MAX_WBITS + kGzipOnly) != Z_OK) {
            throw Error(name + ": not enough memory to unpack it");  // GCOVR_EXCL_LINE
        }
    }
    ~Inflation() { inflateEnd(&stream_); }
    Inflation(const Inflation&) = delete;
    Inflation& operator=(const Inflation&) = delete;

    z_stream* operator->() { return &stream_; }
    [[nodiscard]] int step() { return inflate(&stream_, Z_NO_FLUSH); }
    [[nodiscard]] int begin_anew() { return inflateReset(&stream_); }

private:
    z_stream stream_{};
};

}  // namespace

bool is_gzip(std::string_view bytes) {
    return bytes.starts_with("\x1f\x8b");
}

std::string unpack_gzip(std::string_view bytes, std::size_t most, const std::string& name) {
    constexpr std::size_t kChunk = 1 << 20;
    Inflation inflation(name);
    std::string input(bytes);  // zlib takes bytes that may be written to
    std::size_t taken = 0;
    std::string result;
    int state = Z_OK;
    while (state == Z_OK && result.size() < most) {
        if (inflation->avail_in == 0) {
            const std::size_t next = std::min(kChunk, input.size() - taken);
            // NOLINTNEXTLINE(cppcoreguidelines-pro-type-reinterpret-cast): bytes
            inflation->next_in = reinterpret_cast<Bytef*>(input.data() + taken);
            inflation->avail_in = static_cast<uInt>(next);
            taken += next;
        }
        const std::size_t before = result.size();
        result.resize(before + std::min(kChunk, most - before));
        // NOLINTNEXTLINE(cppcoreguidelines-pro-type-reinterpret-cast): bytes
        inflation->next_out = reinterpret_cast<Bytef*>(result.data() + before);
        inflation->avail_out = static_cast<uInt>(result.size() - before);
        state = inflation.step();
        result.resize(result.size() - inflation->avail_out);
        // What is packed in blocks, as by bgzip, is one gzip file behind the other.
        if (state == Z_STREAM_END && is_gzip(bytes.substr(taken - inflation->avail_in))) {
            state = inflation.begin_anew();
        }
    }
    if (state == Z_BUF_ERROR) {
        throw Error(name + ": ends too soon: what is packed in it goes on");
    }
    if (state != Z_OK && state != Z_STREAM_END) {
        throw Error(name + ": is damaged: what is packed in it cannot be unpacked");
    }
    return result;
}

}  // namespace pent::mesher
