#include "pent/viewer/slice_run.h"

#include "obstacle_view.h"
#include "slice_folder.h"
#include "snapshot.h"
#include "survey.h"

#include <pent/error.h>
#include <pent/formatted.h>
#include <pent/obstacles_file.h>
#include <pent/viewer/attributes.h>
#include <pent/viewer/obstacle_surface.h>

#include <algorithm>
#include <limits>
#include <utility>

namespace pent::viewer {

namespace {

// "octopus", or "octopus_s01" where there are several hyperplanes.
std::string series_name(const std::string& body, std::size_t section, std::size_t sections) {
    return sections > 1 ? body + formatted("_s%02zu", section) : body;
}

std::string after_comma(const std::string& label) {
    return label.empty() ? "" : ", " + label;
}

// What is the same in all frames.
template <int Dim>
struct Slicing {
    const RunFolder& run;
    const SliceRunOptions& options;
    std::vector<Body<Dim>> bodies = load_bodies<Dim>(run);
    Snapshot<Dim> start = snapshot(run.frames.front());
    std::vector<Section> sections = make_sections<Dim>(options.sections, start.frames);

    [[nodiscard]] Snapshot<Dim> snapshot(int frame) const {
        return load_snapshot<Dim>(run, bodies, frame, options.color);
    }
    [[nodiscard]] bool shows_obstacles() const {
        return options.has_obstacles && !start.obstacles.empty();
    }
};

// What only all frames together tell.
struct Overview {
    ColorRange range;
    Sphere view;  // how far planes are written
};

// False if on_progress ended it early.
template <typename Action>
[[nodiscard]] bool for_each_frame(const std::vector<int>& frames,
                                  std::string_view what,
                                  const OnProgress& on_progress,
                                  const Action& action) {
    const auto total = static_cast<std::int64_t>(frames.size());
    std::int64_t done = 0;
    for (const int frame : frames) {
        if (!on_progress(what, done, total)) {
            return false;
        }
        action(frame);
        ++done;
    }
    (void)on_progress(what, done, total);  // all is done: too late to stop
    return true;
}

// Nothing if ended early.
template <int Dim>
std::optional<Overview> overview_of(const Slicing<Dim>& slicing, const OnProgress& on_progress) {
    const ColorBy& color = slicing.options.color;
    if (color == ColorBy::Body && !slicing.shows_obstacles()) {
        return Overview{};
    }
    Survey survey;
    const auto look = [&](int frame) {
        const Snapshot<Dim> snapshot = slicing.snapshot(frame);
        for (std::size_t body = 0; body < slicing.bodies.size(); ++body) {
            for (const Section& section : slicing.sections) {
                survey.add(take_section<Dim>(slicing.bodies[body], snapshot.frames[body].positions,
                                             section),
                           snapshot.values[body], color);
            }
        }
    };
    if (!for_each_frame(slicing.options.frames, "looked at frame", on_progress, look)) {
        return std::nullopt;
    }
    const Eigen::AlignedBox3d& box = survey.box();
    Sphere around{Eigen::Vector3d::Zero(), 1};
    if (!box.isEmpty()) {
        const double size = box.diagonal().norm();
        around = {box.center(), size > 0 ? size : 1};
    }
    return Overview{survey.range(), around};
}

template <int Dim>
SliceFile file_of(const std::string& series, const Snapshot<Dim>& snapshot) {
    return {series, snapshot.number, snapshot.frames.front().time};
}

SliceRecord record_of(const SliceFile& file,
                      const Section& section,
                      const std::string& name,
                      const TriangleMesh& surface) {
    SliceRecord record;
    record.frame = file.frame;
    record.time = file.time;
    record.section = section.label;
    record.offset = section.plane.offset;
    record.body = name;
    record.vertices = surface.vertex_count();
    record.triangles = surface.triangle_count();
    record.area = area(surface);
    return record;
}

// What colors a surface of a body, and what its file says of it.
template <int Dim>
SurfaceExtras extras_of(const Slicing<Dim>& slicing,
                        const ColorRange& range,
                        const Snapshot<Dim>& snapshot,
                        std::size_t body,
                        const Surface& surface,
                        const std::string& remark) {
    const SliceRunOptions& options = slicing.options;
    const Eigen::VectorXd seen = interpolate(surface, snapshot.values[body]);
    SurfaceExtras extras;
    if (options.color != ColorBy::Body) {
        extras.scalars.push_back({name_of(options.color), seen});
    }
    extras.colors = surface_colors(seen, options.color, range, body);
    extras.comment = options.created_by + ": body " + slicing.bodies[body].name + remark;
    if (!slicing.start.obstacles.empty()) {
        extras.comment +=
            options.has_obstacles ? ", obstacles in files of their own" : ", without obstacles";
    }
    return extras;
}

template <int Dim>
void write_slices(const Slicing<Dim>& slicing,
                  const ColorRange& range,
                  const Snapshot<Dim>& snapshot,
                  std::size_t body,
                  SliceFolder& folder) {
    const std::string& name = slicing.bodies[body].name;
    for (std::size_t index = 0; index < slicing.sections.size(); ++index) {
        const Section& section = slicing.sections[index];
        Surface surface =
            take_section<Dim>(slicing.bodies[body], snapshot.frames[body].positions, section);
        if (!slicing.options.keep_degenerate) {
            surface = merge_coincident(surface);
        }
        const SliceFile file = file_of(series_name(name, index, slicing.sections.size()), snapshot);
        SliceRecord record = record_of(file, section, name, surface);
        record.file = folder.add_surface(
            file, surface,
            extras_of(slicing, range, snapshot, body, surface, after_comma(section.label)));
        record.volume = enclosed_volume(surface);
        folder.add_record(std::move(record));
    }
}

void write_outline(const Slicing<4>& slicing,
                   const ColorRange& range,
                   const Snapshot<4>& snapshot,
                   std::size_t body,
                   SliceFolder& folder) {
    const Projection projection = make_projection(
        *slicing.options.projection, slicing.sections.front().plane, slicing.start.frames);
    const Surface surface =
        outline(slicing.bodies[body].boundary, snapshot.frames[body].positions, projection);
    folder.add_surface(
        file_of(slicing.bodies[body].name + ".outline", snapshot), surface,
        extras_of(slicing, range, snapshot, body, surface, ", outline of the projection"));
}

void write_boundary(const Body<4>& body,
                    const Frame<4>& frame,
                    const SliceFile& file,
                    SliceFolder& folder) {
    VtuGrid grid;
    grid.points = frame.positions.topRows<3>();
    grid.cells = body.boundary.facets;
    const auto add = [&](const ColorBy& by) {
        grid.point_data.push_back({name_of(by), vertex_values<4>(body, frame, by)});
    };
    for (const ColorBy& by : all_colorings()) {
        if (by != ColorBy::Body && !lacks(body, frame, by)) {
            add(by);
        }
    }
    for (const ColorBy& by : field_colorings<4>(body, frame)) {
        add(by);
    }
    folder.add_grid(file, grid);
}

template <int Dim>
void write_obstacles(const Slicing<Dim>& slicing,
                     const Sphere& view,
                     const Snapshot<Dim>& snapshot,
                     SliceFolder& folder) {
    for (std::size_t i = 0; i < snapshot.obstacles.size(); ++i) {
        const std::string name = "obstacle." + std::to_string(i + 1);
        for (std::size_t index = 0; index < slicing.sections.size(); ++index) {
            const Section& section = slicing.sections[index];
            const ObstacleSlice cut = take_section<Dim>(snapshot.obstacles[i], section);
            const TriangleMesh surface = obstacle_surface(cut, view);
            SurfaceExtras extras;
            extras.colors = obstacle_color().replicate(1, surface.vertex_count());
            extras.comment = slicing.options.created_by + ": obstacle " + std::to_string(i + 1)
                             + ", " + std::string(name_of<Dim>(snapshot.obstacles[i]))
                             + after_comma(section.label) + (cut.plane ? ", cut off" : "")
                             + (cut.is_everything() ? ", solid everywhere" : "");
            const SliceFile file =
                file_of(series_name(name, index, slicing.sections.size()), snapshot);
            SliceRecord record = record_of(file, section, name, surface);
            record.file = folder.add_surface(file, surface, extras);
            record.volume =
                cut.plane ? std::numeric_limits<double>::quiet_NaN() : enclosed_volume(surface);
            record.is_obstacle = true;
            folder.add_record(std::move(record));
        }
    }
}

template <int Dim>
void write_frame(const Slicing<Dim>& slicing,
                 const Overview& overview,
                 const Snapshot<Dim>& snapshot,
                 SliceFolder& folder) {
    for (std::size_t body = 0; body < slicing.bodies.size(); ++body) {
        write_slices(slicing, overview.range, snapshot, body, folder);
        if constexpr (Dim == 4) {
            if (slicing.options.projection) {
                write_outline(slicing, overview.range, snapshot, body, folder);
            }
            if (slicing.options.has_boundary) {
                write_boundary(slicing.bodies[body], snapshot.frames[body],
                               file_of(slicing.bodies[body].name + ".boundary", snapshot), folder);
            }
        }
    }
    if (slicing.shows_obstacles()) {
        write_obstacles(slicing, overview.view, snapshot, folder);
    }
}

template <int Dim>
void check_dimension(const SliceRunOptions& options) {
    if (Dim == 3 && (options.projection.has_value() || options.has_boundary)) {
        throw Error(
            "slices: the bodies have dimension 3; there is nothing to project or to slice "
            "later");
    }
}

template <int Dim>
SliceRunReport slice_run_in(const RunFolder& run,
                            const std::filesystem::path& path,
                            const SliceRunOptions& options,
                            const OnProgress& on_progress) {
    check_dimension<Dim>(options);
    const Slicing<Dim> slicing{.run = run, .options = options};
    SliceFolder folder(path, options.format);
    SliceRunReport report;
    const std::optional<Overview> overview = overview_of(slicing, on_progress);
    report.is_complete =
        overview && for_each_frame(options.frames, "sliced frame", on_progress, [&](int frame) {
            write_frame(slicing, *overview, slicing.snapshot(frame), folder);
        });
    folder.write_lists();
    report.slices = folder.records();
    report.obstacles = static_cast<int>(slicing.start.obstacles.size());
    return report;
}

}  // namespace

SliceRunReport slice_run(const RunFolder& run,
                         const std::filesystem::path& folder,
                         const SliceRunOptions& options,
                         const OnProgress& on_progress) {
    return run.dimension == 4 ? slice_run_in<4>(run, folder, options, on_progress)
                              : slice_run_in<3>(run, folder, options, on_progress);
}

}  // namespace pent::viewer
