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

std::string obstacle_name(std::size_t i) {
    return "obstacle." + std::to_string(i + 1);
}

std::string after_comma(const std::string& label) {
    return label.empty() ? "" : ", " + label;
}

template <int Dim>
class SliceWriter {
public:
    SliceWriter(const RunFolder& run, const SliceRunOptions& options)
        : run_(run),
          options_(options),
          bodies_(load_bodies<Dim>(run)),
          start_(load_snapshot<Dim>(run, bodies_, run.frames.front(), options.color)),
          sections_(make_sections<Dim>(options.sections, start_.frames)) {}

    // The range of colors and the extent of the bodies, from all frames; false if ended early.
    [[nodiscard]] bool look(const OnProgress& on_progress) {
        if (options_.color == ColorBy::Body && !shows_obstacles()) {
            return true;
        }
        Survey survey;
        const bool is_complete = for_each_frame("looked at frame", on_progress, [&](int number) {
            const Snapshot<Dim> snapshot =
                load_snapshot<Dim>(run_, bodies_, number, options_.color);
            for (std::size_t body = 0; body < bodies_.size(); ++body) {
                for (const Section& section : sections_) {
                    const Surface surface =
                        take_section<Dim>(bodies_[body], snapshot.frames[body].positions, section);
                    survey.add(surface, snapshot.values[body], options_.color);
                }
            }
        });
        range_ = survey.range();
        const Eigen::AlignedBox3d& box = survey.box();
        view_ = box.isEmpty() ? Sphere{Eigen::Vector3d::Zero(), 1}
                              : Sphere{box.center(), std::max(box.diagonal().norm(), 1e-12)};
        return is_complete;
    }

    [[nodiscard]] bool write(SliceFolder& folder, const OnProgress& on_progress) const {
        return for_each_frame("sliced frame", on_progress, [&](int number) {
            const Snapshot<Dim> snapshot =
                load_snapshot<Dim>(run_, bodies_, number, options_.color);
            for (std::size_t body = 0; body < bodies_.size(); ++body) {
                for (std::size_t section = 0; section < sections_.size(); ++section) {
                    write_slice(folder, body, snapshot, section);
                }
                if constexpr (Dim == 4) {
                    write_outline(folder, body, snapshot);
                    write_boundary(folder, body, snapshot);
                }
            }
            if (shows_obstacles()) {
                write_obstacles(folder, snapshot);
            }
        });
    }

    [[nodiscard]] int obstacle_count() const { return static_cast<int>(start_.obstacles.size()); }

private:
    template <typename Action>
    [[nodiscard]] bool for_each_frame(std::string_view what,
                                      const OnProgress& on_progress,
                                      const Action& action) const {
        const auto total = static_cast<std::int64_t>(options_.frames.size());
        std::int64_t done = 0;
        for (const int frame : options_.frames) {
            if (!on_progress(what, done, total)) {
                return false;
            }
            action(frame);
            ++done;
        }
        (void)on_progress(what, done, total);  // all is done: too late to stop
        return true;
    }

    static SliceFile file_of(std::string series, const Snapshot<Dim>& snapshot) {
        return {std::move(series), snapshot.number, snapshot.frames.front().time};
    }

    void write_slice(SliceFolder& folder,
                     std::size_t body,
                     const Snapshot<Dim>& snapshot,
                     std::size_t index) const {
        const Section& section = sections_[index];
        Surface surface =
            take_section<Dim>(bodies_[body], snapshot.frames[body].positions, section);
        if (!options_.keep_degenerate) {
            surface = merge_coincident(surface);
        }
        const SliceFile file =
            file_of(series_name(bodies_[body].name, index, sections_.size()), snapshot);
        SliceRecord record = record_of(file, section, bodies_[body].name, surface);
        record.file = folder.add_surface(
            file, surface, extras_of(surface, snapshot, body, after_comma(section.label)));
        record.volume = enclosed_volume(surface);
        folder.add_record(std::move(record));
    }

    void write_outline(SliceFolder& folder, std::size_t body, const Snapshot<4>& snapshot) const {
        if (!options_.projection.has_value()) {
            return;
        }
        const Projection projection =
            make_projection(*options_.projection, sections_.front().plane, start_.frames);
        const Surface surface =
            outline(bodies_[body].boundary, snapshot.frames[body].positions, projection);
        folder.add_surface(file_of(bodies_[body].name + "_outline", snapshot), surface,
                           extras_of(surface, snapshot, body, ", outline of the projection"));
    }

    void write_boundary(SliceFolder& folder, std::size_t body, const Snapshot<4>& snapshot) const {
        if (!options_.has_boundary) {
            return;
        }
        const Frame<4>& frame = snapshot.frames[body];
        VtuGrid grid;
        grid.points = frame.positions.template topRows<3>();
        grid.cells = bodies_[body].boundary.facets;
        for (const ColorBy by : all_colorings()) {
            if (by != ColorBy::Body && !lacks(frame, by)) {
                grid.point_data.push_back(
                    {std::string(name_of(by)), vertex_values<4>(bodies_[body], frame, by)});
            }
        }
        folder.add_grid(file_of(bodies_[body].name + "_boundary", snapshot), grid);
    }

    [[nodiscard]] bool shows_obstacles() const {
        return options_.has_obstacles && !start_.obstacles.empty();
    }

    void write_obstacles(SliceFolder& folder, const Snapshot<Dim>& snapshot) const {
        for (std::size_t i = 0; i < snapshot.obstacles.size(); ++i) {
            for (std::size_t index = 0; index < sections_.size(); ++index) {
                const Section& section = sections_[index];
                const ObstacleSlice cut = take_section<Dim>(snapshot.obstacles[i], section);
                const TriangleMesh surface = obstacle_surface(cut, view_);
                SurfaceExtras extras;
                extras.colors = obstacle_color().replicate(1, surface.vertex_count());
                extras.comment = options_.created_by + ": obstacle " + std::to_string(i + 1) + ", "
                                 + std::string(name_of<Dim>(snapshot.obstacles[i]))
                                 + after_comma(section.label) + (cut.plane ? ", cut off" : "")
                                 + (cut.is_everything() ? ", solid everywhere" : "");
                const std::string name = obstacle_name(i);
                const SliceFile file =
                    file_of(series_name(name, index, sections_.size()), snapshot);
                SliceRecord record = record_of(file, section, name, surface);
                record.file = folder.add_surface(file, surface, extras);
                record.volume =
                    cut.plane ? std::numeric_limits<double>::quiet_NaN() : enclosed_volume(surface);
                record.is_obstacle = true;
                folder.add_record(std::move(record));
            }
        }
    }

    static SliceRecord record_of(const SliceFile& file,
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
    [[nodiscard]] SurfaceExtras extras_of(const Surface& surface,
                                          const Snapshot<Dim>& snapshot,
                                          std::size_t body,
                                          const std::string& remark) const {
        const Eigen::VectorXd seen = interpolate(surface, snapshot.values[body]);
        SurfaceExtras extras;
        if (options_.color != ColorBy::Body) {
            extras.scalars.push_back({std::string(name_of(options_.color)), seen});
        }
        extras.colors = surface_colors(seen, options_.color, range_, body);
        extras.comment = options_.created_by + ": body " + bodies_[body].name + remark;
        if (!start_.obstacles.empty()) {
            extras.comment += options_.has_obstacles ? ", obstacles in files of their own"
                                                     : ", without obstacles";
        }
        return extras;
    }

    const RunFolder& run_;
    const SliceRunOptions& options_;
    std::vector<Body<Dim>> bodies_;
    Snapshot<Dim> start_;
    std::vector<Section> sections_;
    ColorRange range_;
    Sphere view_;  // how far planes are written
};

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
    SliceWriter<Dim> writer(run, options);
    SliceFolder folder(path, options.format);
    SliceRunReport report;
    report.is_complete = writer.look(on_progress) && writer.write(folder, on_progress);
    folder.write_lists();
    report.slices = folder.records();
    report.obstacles = writer.obstacle_count();
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
