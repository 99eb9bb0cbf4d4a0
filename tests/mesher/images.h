#pragma once

#include <pent/mesher/image.h>

#include <Eigen/Core>

#include <algorithm>
#include <cstdint>
#include <cstring>
#include <functional>
#include <string>
#include <zlib.h>

// Images as other programs write them, made by hand.

namespace pent::test {

/// What goes into a NIfTI-1 header; see its standard for the codes.
struct NiftiHeader {
    std::array<std::int16_t, 8> dim = {4, 2, 2, 2, 2, 1, 1, 1};
    std::array<float, 8> pixdim = {1, 1, 1, 1, 1, 1, 1, 1};
    std::int16_t datatype = 16;
    float vox_offset = 352;
    float scl_slope = 0;
    float scl_inter = 0;
    std::string magic = "n+1";
    bool is_swapped = false;
};

template <typename Value>
std::string bytes_of(Value value, bool is_swapped = false) {
    std::string bytes(sizeof(Value), '\0');
    std::memcpy(bytes.data(), &value, sizeof(Value));
    if (is_swapped) {
        std::reverse(bytes.begin(), bytes.end());
    }
    return bytes;
}

inline std::string nifti_header(const NiftiHeader& header) {
    std::string bytes(352, '\0');
    const auto put = [&](std::size_t at, auto value) {
        bytes.replace(at, sizeof(value), bytes_of(value, header.is_swapped));
    };
    put(0, std::int32_t{348});
    for (std::size_t i = 0; i < 8; ++i) {
        put(40 + 2 * i, header.dim[i]);
        put(76 + 4 * i, header.pixdim[i]);
    }
    put(70, header.datatype);
    put(108, header.vox_offset);
    put(112, header.scl_slope);
    put(116, header.scl_inter);
    bytes.replace(344, header.magic.size(), header.magic);
    return bytes;
}

/// A NIfTI-1 file of floats.
inline std::string nifti(const mesher::Image& image) {
    NiftiHeader header;
    for (int axis = 0; axis < 4; ++axis) {
        header.dim[static_cast<std::size_t>(axis) + 1] =
            static_cast<std::int16_t>(image.size[axis]);
        header.pixdim[static_cast<std::size_t>(axis) + 1] = static_cast<float>(image.spacing[axis]);
    }
    std::string bytes = nifti_header(header);
    for (const float value : image.values) {
        bytes += bytes_of(value);
    }
    return bytes;
}

/// Samples of a function of the place, from 0 on.
inline mesher::Image sampled(const Eigen::Vector4i& size,
                             const Eigen::Vector4d& spacing,
                             const std::function<double(const Eigen::Vector4d&)>& function) {
    mesher::Image image{"image", size, spacing, {}};
    Eigen::Vector4i at;
    for (at[3] = 0; at[3] < size[3]; ++at[3]) {
        for (at[2] = 0; at[2] < size[2]; ++at[2]) {
            for (at[1] = 0; at[1] < size[1]; ++at[1]) {
                for (at[0] = 0; at[0] < size[0]; ++at[0]) {
                    image.values.push_back(
                        static_cast<float>(function(at.cast<double>().cwiseProduct(spacing))));
                }
            }
        }
    }
    return image;
}

/// The bytes as gzip packs them.
inline std::string packed(std::string bytes) {
    z_stream stream{};
    constexpr int kGzip = 16;
    deflateInit2(&stream, Z_BEST_SPEED, Z_DEFLATED, MAX_WBITS + kGzip, 8, Z_DEFAULT_STRATEGY);
    std::string result(compressBound(bytes.size()) + 64, '\0');
    stream.next_in = reinterpret_cast<Bytef*>(bytes.data());
    stream.avail_in = static_cast<uInt>(bytes.size());
    stream.next_out = reinterpret_cast<Bytef*>(result.data());
    stream.avail_out = static_cast<uInt>(result.size());
    deflate(&stream, Z_FINISH);
    result.resize(stream.total_out);
    deflateEnd(&stream);
    return result;
}

}  // namespace pent::test
