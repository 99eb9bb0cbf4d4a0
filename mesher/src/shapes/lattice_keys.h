#pragma once

#include <Eigen/Core>

#include <cstdint>

namespace pent::mesher {

inline constexpr int kKeyBits = 16;  ///< Of a coordinate.

/// Moves the bits of a coordinate four places apart, as a Morton key has them; and back.
inline std::uint64_t spread(std::uint64_t z) {
    z = (z | z << 24) & 0x000000ff000000ffULL;
    z = (z | z << 12) & 0x000f000f000f000fULL;
    z = (z | z << 6) & 0x0303030303030303ULL;
    return (z | z << 3) & 0x1111111111111111ULL;
}

inline int gathered(std::uint64_t z) {
    z &= 0x1111111111111111ULL;
    z = (z | z >> 3) & 0x0303030303030303ULL;
    z = (z | z >> 6) & 0x000f000f000f000fULL;
    z = (z | z >> 12) & 0x000000ff000000ffULL;
    return static_cast<int>((z | z >> 24) & 0xffffULL);
}

/// Morton key: the bits of four coordinates interleaved. It never falls where no coordinate does.
inline std::uint64_t key_of(const Eigen::Vector4i& z) {
    std::uint64_t key = 0;
    for (int axis = 0; axis < 4; ++axis) {
        key |= spread(static_cast<std::uint64_t>(z[axis])) << (3 - axis);
    }
    return key;
}

inline Eigen::Vector4i point_of(std::uint64_t key) {
    return {gathered(key >> 3), gathered(key >> 2), gathered(key >> 1), gathered(key)};
}

inline bool is_key_in_range(const Eigen::Vector4i& z) {
    return z.minCoeff() >= 0 && z.maxCoeff() < 1 << kKeyBits;
}

/// Four digits of base 3, one an axis: a place among the 3^4 corners and middles of a cell, or,
/// less 1 each, the way to one of the cells around it.
inline Eigen::Vector4i digits(unsigned place) {
    const auto p = static_cast<int>(place);
    return {p % 3, p / 3 % 3, p / 9 % 3, p / 27};
}

inline unsigned place_of(const Eigen::Vector4i& digits) {
    return static_cast<unsigned>(digits[0] + 3 * digits[1] + 9 * digits[2] + 27 * digits[3]);
}

inline Eigen::Vector4i unit_steps(unsigned axes) {
    return {static_cast<int>(axes & 1U), static_cast<int>(axes >> 1 & 1U),
            static_cast<int>(axes >> 2 & 1U), static_cast<int>(axes >> 3 & 1U)};
}

}  // namespace pent::mesher
