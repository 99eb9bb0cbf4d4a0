#pragma once

#include <pent/mesher/image.h>

#include <string>
#include <string_view>

namespace pent::mesher {

/// How samples are kept in a file.
struct SampleKind {
    char kind = 'f';        ///< 'u', 'i' or 'f': whole numbers without and with a sign, real ones.
    std::size_t bytes = 4;  ///< 1, 2, 4; 8 of real ones.
    bool is_swapped = false;  ///< Bytes in the other order than the machine's.
};

/// Samples an image may have at most.
inline constexpr double kMaxSamples = 1 << 30;

/// Throws an Error if the image's axes are shorter than 2 or it has too many samples.
void check_size(const std::string& name, const Eigen::Vector4d& size);

/// Takes the samples of an image of known size from bytes, each times `slope` plus `intercept`.
/// Throws an Error for bytes that end too soon, and samples that are not finite.
void take_samples(
    std::string_view bytes, const SampleKind& kind, double slope, double intercept, Image& image);

/// Throws an Error with the place of the first sample that is not finite.
void check_samples(const Image& image);

/// Readers of one format each; the spacing is what the file says, also where that is nothing.
[[nodiscard]] Image read_nifti(std::string_view bytes, const std::string& name);
[[nodiscard]] Image read_nrrd(std::string_view bytes, const std::string& name);

}  // namespace pent::mesher
