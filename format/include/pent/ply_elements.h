#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

namespace pent {

/// What the header of a PLY file [turk1994] says of its body. Two parsers of such headers share it:
/// that of .pent files, which wants a fixed profile and names what a line should have been, and
/// that of surfaces by others, which takes any order, lists and big-endian numbers from a stream.

enum class PlyType { Char, Uchar, Short, Ushort, Int, Uint, Float, Double };

struct PlyTypeName {
    std::string_view name;
    std::string_view alias;
    PlyType type;
    std::size_t size;  ///< Bytes.
};

/// In the order of PlyType.
inline constexpr std::array<PlyTypeName, 8> kPlyTypes = {{
    {"char", "int8", PlyType::Char, 1},
    {"uchar", "uint8", PlyType::Uchar, 1},
    {"short", "int16", PlyType::Short, 2},
    {"ushort", "uint16", PlyType::Ushort, 2},
    {"int", "int32", PlyType::Int, 4},
    {"uint", "uint32", PlyType::Uint, 4},
    {"float", "float32", PlyType::Float, 4},
    {"double", "float64", PlyType::Double, 8},
}};

/// The type that goes by a word; nothing if none does.
[[nodiscard]] constexpr std::optional<PlyType> ply_type_called(std::string_view word) {
    for (const PlyTypeName& known : kPlyTypes) {
        if (word == known.name || word == known.alias) {
            return known.type;
        }
    }
    return std::nullopt;
}

struct PlyProperty {
    std::string name;
    PlyType type = PlyType::Double;
    std::optional<PlyType> count_type;  ///< Of a list: the type of its length.
};

struct PlyElement {
    std::string name;
    std::uint64_t count = 0;
    std::vector<PlyProperty> properties;
};

}  // namespace pent
