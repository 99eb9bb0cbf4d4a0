#include "gzip.h"
#include "read_image.h"

#include <pent/counted.h>
#include <pent/error.h>
#include <pent/formatted.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstring>

namespace pent::mesher {

namespace {

constexpr std::size_t kHeader = 348;
constexpr double kLastPlace = 1e8;  // of samples: what is before them is small

// The header's fields at their places, in either order of bytes.
class Header {
public:
    Header(std::string_view bytes, std::string name) : bytes_(bytes), name_(std::move(name)) {
        if (bytes.size() < kHeader) {
            fail(formatted("ends too soon: %zu bytes, expected a header of 348", bytes.size()));
        }
        constexpr std::int32_t kSwapped = 0x5c010000;
        const auto length = at<std::int32_t>(0);
        is_swapped_ = length == kSwapped;
        if (length != static_cast<std::int32_t>(kHeader) && !is_swapped_) {
            fail(length == 540 ? "is of NIfTI-2; expected NIfTI-1, into which most programs convert"
                               : "is no NIfTI-1 file: it does not begin with the number 348");
        }
        const std::string_view magic = bytes.substr(344, 3);
        if (magic == "ni1") {
            fail("has its samples in another file (.img); expected both in one .nii");
        }
        if (magic != "n+1") {
            fail("is no NIfTI-1 file: no \"n+1\" at byte 344");
        }
    }

    template <typename Value>
    [[nodiscard]] Value at(std::size_t place) const {
        std::array<char, sizeof(Value)> bytes{};
        std::copy_n(bytes_.data() + place, sizeof(Value), bytes.begin());
        if (is_swapped_) {
            std::reverse(bytes.begin(), bytes.end());
        }
        Value value{};
        std::memcpy(&value, bytes.data(), sizeof(Value));
        return value;
    }

    [[nodiscard]] bool is_swapped() const { return is_swapped_; }

    [[noreturn]] void fail(const std::string& message) const {
        throw Error(name_ + ": " + message);
    }

private:
    std::string_view bytes_;
    std::string name_;
    bool is_swapped_ = false;
};

SampleKind kind_of(const Header& header) {
    const int code = header.at<std::int16_t>(70);
    SampleKind kind;
    kind.is_swapped = header.is_swapped();
    switch (code) {
        case 2:
            kind.kind = 'u', kind.bytes = 1;
            break;
        case 4:
            kind.kind = 'i', kind.bytes = 2;
            break;
        case 8:
            kind.kind = 'i', kind.bytes = 4;
            break;
        case 16:
            break;
        case 64:
            kind.bytes = 8;
            break;
        case 256:
            kind.kind = 'i', kind.bytes = 1;
            break;
        case 512:
            kind.kind = 'u', kind.bytes = 2;
            break;
        case 768:
            kind.kind = 'u', kind.bytes = 4;
            break;
        default:
            header.fail(
                formatted("samples of type %d; expected whole numbers of 8, 16 or 32 bits "
                          "or real ones of 32 or 64 (2, 4, 8, 16, 64, 256, 512, 768)",
                          code));
    }
    return kind;
}

}  // namespace

Image read_nifti(std::string_view bytes, const std::string& name) {
    const bool is_packed = is_gzip(bytes);
    std::string unpacked;
    if (is_packed) {
        unpacked = unpack_gzip(bytes, kHeader, name);
    }
    const Header header(is_packed ? unpacked : bytes, name);
    const int axes = header.at<std::int16_t>(40);
    bool has_four = axes >= 4 && axes <= 7;
    for (int axis = 4; has_four && axis < axes; ++axis) {
        has_four = header.at<std::int16_t>(42 + 2 * static_cast<std::size_t>(axis)) == 1;
    }
    if (!has_four) {
        header.fail("an image of " + counted(axes, "axis", "axes")
                    + "; expected 4, as x y z and time");
    }
    Image image;
    image.name = name;
    for (int axis = 0; axis < 4; ++axis) {
        const auto at = static_cast<std::size_t>(axis);
        image.size[axis] = header.at<std::int16_t>(42 + 2 * at);
        image.spacing[axis] = std::abs(static_cast<double>(header.at<float>(80 + 4 * at)));
    }
    check_size(name, image.size.cast<double>());
    const SampleKind kind = kind_of(header);
    const auto place = static_cast<double>(header.at<float>(108));
    if (!(place >= static_cast<double>(kHeader) && place <= kLastPlace)) {
        header.fail(formatted("samples from byte %g on; expected one from 352 to 1e8", place));
    }
    const auto slope = static_cast<double>(header.at<float>(112));
    const auto intercept = static_cast<double>(header.at<float>(116));
    const bool is_scaled = slope != 0 && std::isfinite(slope) && std::isfinite(intercept);
    const auto offset = static_cast<std::size_t>(place);
    if (is_packed) {  // no more than the header says, whatever is in it
        const auto count = static_cast<std::size_t>(image.size.cast<std::int64_t>().prod());
        unpacked = unpack_gzip(bytes, offset + count * kind.bytes, name);
        bytes = unpacked;
    }
    take_samples(bytes.substr(std::min(offset, bytes.size())), kind, is_scaled ? slope : 1,
                 is_scaled ? intercept : 0, image);
    return image;
}

}  // namespace pent::mesher
