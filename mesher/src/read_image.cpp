#include "read_image.h"

#include <pent/error.h>
#include <pent/formatted.h>
#include <pent/input_path.h>
#include <pent/read_text.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstring>

namespace pent::mesher {

namespace {

std::string place_of(const Image& image, std::size_t index) {
    const auto n = image.size.cast<std::size_t>();
    return formatted("(%zu, %zu, %zu, %zu)", index % n[0], index / n[0] % n[1],
                     index / n[0] / n[1] % n[2], index / n[0] / n[1] / n[2]);
}

template <typename Value>
double value_at(const char* at, bool is_swapped) {
    std::array<char, sizeof(Value)> bytes{};
    std::copy_n(at, sizeof(Value), bytes.begin());
    if (is_swapped) {
        std::reverse(bytes.begin(), bytes.end());
    }
    Value value{};
    std::memcpy(&value, bytes.data(), sizeof(Value));
    return static_cast<double>(value);
}

using Getter = double (*)(const char* at, bool is_swapped);

Getter getter_of(const SampleKind& kind) {
    if (kind.kind == 'f') {
        return kind.bytes == 4 ? value_at<float> : value_at<double>;
    }
    const bool is_signed = kind.kind == 'i';
    switch (kind.bytes) {
        case 1:
            return is_signed ? value_at<std::int8_t> : value_at<std::uint8_t>;
        case 2:
            return is_signed ? value_at<std::int16_t> : value_at<std::uint16_t>;
        default:
            return is_signed ? value_at<std::int32_t> : value_at<std::uint32_t>;
    }
}

}  // namespace

Image::Cell Image::cell(const Eigen::Vector4d& p) const {
    Cell result;
    for (int axis = 0; axis < 4; ++axis) {
        const double last = size[axis] - 1;
        const double at = std::clamp(p[axis] / spacing[axis], 0.0, last);
        const double low = std::min(std::floor(at), last - 1);
        result.low[axis] = static_cast<int>(low);
        result.part[axis] = at - low;
    }
    return result;
}

void check_size(const std::string& name, const Eigen::Vector4d& size) {
    const bool is_whole = size.allFinite() && size == size.array().floor().matrix();
    if (!is_whole || size.minCoeff() < 2 || size.prod() > kMaxSamples) {
        throw Error(name
                    + formatted(": an image of %g x %g x %g x %g samples; expected 2 or more along "
                                "each axis, and 2^30 at the most",
                                size[0], size[1], size[2], size[3]));
    }
}

void take_samples(
    std::string_view bytes, const SampleKind& kind, double slope, double intercept, Image& image) {
    const auto count = static_cast<std::size_t>(image.size.cast<std::int64_t>().prod());
    if (bytes.size() / kind.bytes < count) {
        throw Error(image.name
                    + formatted(": ends too soon: %zu bytes of samples, expected %zu; is it cut?",
                                bytes.size(), count * kind.bytes));
    }
    const Getter get = getter_of(kind);
    image.values.resize(count);
    for (std::size_t i = 0; i < count; ++i) {
        const double value = get(bytes.data() + i * kind.bytes, kind.is_swapped);
        image.values[i] = static_cast<float>(slope * value + intercept);
    }
    check_samples(image);
}

void check_samples(const Image& image) {
    const auto bad = std::find_if(image.values.begin(), image.values.end(),
                                  [](float value) { return !std::isfinite(value); });
    if (bad != image.values.end()) {
        throw Error(image.name + ": the sample "
                    + place_of(image, static_cast<std::size_t>(bad - image.values.begin()))
                    + formatted(" is %g; expected finite numbers everywhere: fill in what is not "
                                "known, as with 0",
                                static_cast<double>(*bad)));
    }
}

bool is_image_file(const std::filesystem::path& path) {
    const std::string ending = format_of(path, "");
    return ending == ".nii" || ending == ".nrrd"
           || (ending == ".gz" && format_of(path.stem(), "") == ".nii");
}

Image read_image(const std::filesystem::path& path, const std::optional<Eigen::Vector4d>& spacing) {
    require_file(path);
    const std::string name = path.string();
    const std::string bytes = read_text(path, "an image (NIfTI-1 or NRRD)");
    Image image = format_of(path, "") == ".nrrd" ? read_nrrd(bytes, name) : read_nifti(bytes, name);
    image.spacing = spacing.value_or(image.spacing);
    const Eigen::Vector4d& found = image.spacing;
    if (!(found.minCoeff() > 0) || !found.allFinite()) {
        throw Error(name
                    + formatted(": a spacing of %g x %g x %g x %g; expected lengths above 0: give "
                                "them by --spacing",
                                found[0], found[1], found[2], found[3]));
    }
    return image;
}

}  // namespace pent::mesher
