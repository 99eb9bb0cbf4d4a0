#pragma once

#include <pent/viewer/coloring.h>
#include <pent/viewer/project.h>
#include <pent/viewer/run_folder.h>
#include <pent/viewer/section.h>
#include <pent/viewer/surface_file.h>

#include <cstdint>
#include <filesystem>
#include <functional>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

namespace pent::viewer {

/// Called before and after each piece of work with what it is ("sliced frame") and how many of
/// these are done, from 0 to total; ends the work early by returning false.
using OnProgress =
    std::function<bool(std::string_view what, std::int64_t done, std::int64_t total)>;

struct SliceRunOptions {
    SectionOptions sections;
    std::vector<int> frames;  ///< Out of run.frames; at least one.
    SurfaceFormat format = SurfaceFormat::Ply;
    ColorBy color = ColorBy::Body;  ///< Written as vertex colors, and as a scalar but for Body.
    bool keep_degenerate = false;   ///< Keep triangles of zero area, as slice() makes them.
    /// Write the outlines of the whole bodies as well: BODY.outline_000123.ply. A dot is in no
    /// body's name.
    std::optional<ProjectionOptions> projection;
    /// Write the obstacles as well: obstacle.1_000123.ply.
    bool has_obstacles = false;
    /// Write the whole boundaries as well: BODY.boundary_000123.vtu.
    bool has_boundary = false;
    std::string created_by = "pent-slice";
};

/// One file that was written.
struct SliceRecord {
    std::string file;  ///< Name in the output folder.
    int frame = 0;
    double time = 0;  ///< s.
    std::string section;
    double offset = 0;  ///< m.
    std::string body;   ///< Or the obstacle.
    std::int64_t vertices = 0;
    std::int64_t triangles = 0;
    double volume = 0;  ///< m^3; NaN for a surface that is open, as a plane's is.
    double area = 0;    ///< m^2.
    bool is_obstacle = false;
};

struct SliceRunReport {
    std::vector<SliceRecord> slices;
    int obstacles = 0;         ///< That the scene has.
    bool is_complete = false;  ///< False if on_progress ended it.
};

/// Slices frames of a run and writes one surface file per body, frame and hyperplane into a folder,
/// which is made if need be: BODY_000123.ply, or BODY_s01_000123.ply when there are several
/// hyperplanes. Beside them slices.csv lists all of them with volumes and areas; for VTU,
/// BODY.pvd puts them in time for ParaView. The boundary is tetrahedra at x, y, z with w, speed,
/// strain and, where frames or meshes have them, contact forces and fields as point data: a contour
/// of w is a slice.
///
/// A file says whether there are obstacles beside its body, and whether they have files of their
/// own. A plane is cut off where it is as far from the bodies as they reach over all frames.
///
/// The color range is that of the frames chosen. Throws an Error as reading and writing do.
[[nodiscard]] SliceRunReport slice_run(const RunFolder& run,
                                       const std::filesystem::path& folder,
                                       const SliceRunOptions& options,
                                       const OnProgress& on_progress);

}  // namespace pent::viewer
