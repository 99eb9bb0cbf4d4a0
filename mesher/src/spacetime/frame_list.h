#pragma once

#include <filesystem>
#include <optional>
#include <string>
#include <vector>

namespace pent::mesher {

/// A frame of a series in a file of its own.
struct FrameFile {
    std::filesystem::path path;
    double time = 0;    ///< s.
    std::string place;  ///< Where the list has it, as in "heart.pvd: line 5".
};

/// The frames that a .pvd file, a .series file or the name of a numbered file stands for, in order.
///
/// @param time_step  Between numbered files, s; without meaning for lists, which have times.
/// Throws an Error with file and line for what is damaged, several files of one time, times that do
/// not increase, missing numbers, and fewer than two frames.
[[nodiscard]] std::vector<FrameFile> list_frames(const std::filesystem::path& path,
                                                 std::optional<double> time_step);

}  // namespace pent::mesher
