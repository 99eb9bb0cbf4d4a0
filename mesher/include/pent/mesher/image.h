#pragma once

#include <Eigen/Core>

#include <cstdint>
#include <filesystem>
#include <optional>
#include <string>
#include <vector>

namespace pent::mesher {

/// Samples on a grid of four dimensions: a volume in time, or of space alone.
struct Image {
    std::string name;                     ///< Goes in front of messages.
    Eigen::Vector4i size{0, 0, 0, 0};     ///< Samples along each axis, 2 or more.
    Eigen::Vector4d spacing{1, 1, 1, 1};  ///< Between samples, m, above 0. The first is at 0.
    std::vector<float> values;            ///< The first axis runs fastest; finite.

    [[nodiscard]] std::size_t index(const Eigen::Vector4i& at) const {
        const auto n = size.cast<std::size_t>();
        const auto i = at.cast<std::size_t>();
        return i[0] + n[0] * (i[1] + n[1] * (i[2] + n[2] * i[3]));
    }
    [[nodiscard]] float value(const Eigen::Vector4i& at) const { return values[index(at)]; }

    /// The cell of the grid that holds a point, or the nearest point of the grid if it is outside,
    /// and where in the cell that is, 0 to 1 along each axis.
    struct Cell {
        Eigen::Vector4i low;
        Eigen::Vector4d part;
    };
    [[nodiscard]] Cell cell(const Eigen::Vector4d& p) const;
};

/// Whether the name ends as those of images do: .nii, .nii.gz or .nrrd.
[[nodiscard]] bool is_image_file(const std::filesystem::path& path);

/// Reads a NIfTI-1 image (one file, whole or compressed by gzip) [cox2004] or an NRRD with its data
/// in it (raw, gzip or text) [nrrd], of four axes; whole numbers of up to 32 bits and real ones, in
/// either order of bytes. Of orientation nothing but spacing is taken.
///
/// @param spacing  Instead of that in the file, which is taken as it is, whatever its units.
/// Throws an Error that begins with the file's name, and says what was found where, for other
/// numbers of axes, kinds of samples, files that end too soon, and samples that are not finite.
[[nodiscard]] Image read_image(const std::filesystem::path& path,
                               const std::optional<Eigen::Vector4d>& spacing = {});

}  // namespace pent::mesher
