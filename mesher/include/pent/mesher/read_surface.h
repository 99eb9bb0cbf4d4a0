#pragma once

#include <pent/mesher/step_limits.h>
#include <pent/mesher/surface.h>

#include <filesystem>
#include <string>

namespace pent::mesher {

/// As read_surface(path), but where a format is given, as in "obj", it counts and not the ending of
/// the name. OBJ, OFF, PLY and STL are read from standard input, too, by the path "-".
/// glTF is read in a process of its own with these limits.
[[nodiscard]] SurfaceFile read_surface(const std::filesystem::path& path,
                                       const std::string& format,
                                       const StepLimits& limits = {});

}  // namespace pent::mesher
