#pragma once

#include <pent/mesher/surface.h>

#include <filesystem>
#include <string>

namespace pent::mesher {

/// As read_surface(path), but where a format is given, as in "obj", it counts and not the ending of
/// the name. OBJ, OFF, PLY and STL are read from standard input, too, by the path "-".
[[nodiscard]] SurfaceFile read_surface(const std::filesystem::path& path,
                                       const std::string& format);

}  // namespace pent::mesher
