#include "pent/viewer/slice_run.h"

#include "moment.h"
#include "survey.h"
#include "vtu.h"

#include <pent/error.h>
#include <pent/formatted.h>
#include <pent/output_file.h>
#include <pent/viewer/attributes.h>

#include <cinttypes>
#include <map>
#include <utility>

namespace pent::viewer {

namespace {

// "octopus", or "octopus_s01" where there are several hyperplanes.
std::string series_name(const std::string& body, std::size_t section, std::size_t sections) {
    return sections > 1 ? body + formatted("_s%02zu", section) : body;
}

std::string csv_of(const std::vector<SliceRecord>& slices) {
    std::string csv = "file,frame,time,section,offset,body,vertices,triangles,volume,area\n";
    for (const SliceRecord& slice : slices) {
        csv += slice.file + formatted(",%d,%.17g,\"", slice.frame, slice.time) + slice.section
               + formatted("\",%.17g,", slice.offset) + slice.body
               + formatted(",%" PRId64 ",%" PRId64 ",%.17g,%.17g\n", slice.vertices,
                           slice.triangles, slice.volume, slice.area);
    }
    return csv;
}

template <int Dim>
class SliceWriter {
public:
    SliceWriter(const RunFolder& run,
                const std::filesystem::path& folder,
                const SliceRunOptions& options)
        : run_(run),
          folder_(folder),
          options_(options),
          bodies_(load_bodies<Dim>(run)),
          start_(load_moment<Dim>(run, bodies_, run.frames.front(), options.color)),
          sections_(make_sections<Dim>(options.sections, start_.frames)) {}

    // The range of colors, from all frames; false if ended early.
    [[nodiscard]] bool look(const OnProgress& on_progress) {
        if (options_.color == ColorBy::Body) {
            return true;
        }
        Survey survey;
        const bool is_complete = for_each_frame("looked at frame", on_progress, [&](int number) {
            const Moment<Dim> moment = load_moment<Dim>(run_, bodies_, number, options_.color);
            for (std::size_t body = 0; body < bodies_.size(); ++body) {
                for (const Section& section : sections_) {
                    const Surface surface =
                        take_section<Dim>(bodies_[body], moment.frames[body].positions, section);
                    survey.add(surface, interpolate(surface, moment.values[body]), options_.color);
                }
            }
        });
        range_ = survey.range.value_or(ColorRange());
        return is_complete;
    }

    [[nodiscard]] bool write(const OnProgress& on_progress) {
        return for_each_frame("sliced frame", on_progress, [&](int number) {
            const Moment<Dim> moment = load_moment<Dim>(run_, bodies_, number, options_.color);
            for (std::size_t body = 0; body < bodies_.size(); ++body) {
                for (std::size_t section = 0; section < sections_.size(); ++section) {
                    write_slice(body, moment, number, section);
                }
                if constexpr (Dim == 4) {
                    write_outline(body, moment, number);
                    write_boundary(body, moment, number);
                }
            }
        });
    }

    void write_lists() const {
        write_text(folder_ / "slices.csv", csv_of(slices_));
        for (const auto& [series, entries] : collections_) {
            write_text(folder_ / (series + ".pvd"), to_pvd(entries));
        }
    }

    [[nodiscard]] std::vector<SliceRecord> take_records() { return std::move(slices_); }

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

    void write_slice(std::size_t body, const Moment<Dim>& moment, int number, std::size_t index) {
        const Section& section = sections_[index];
        const Frame<Dim>& frame = moment.frames[body];
        Surface surface = take_section<Dim>(bodies_[body], frame.positions, section);
        if (!options_.keep_degenerate) {
            surface = merge_coincident(surface);
        }
        const std::string series = series_name(bodies_[body].name, index, sections_.size());
        const std::string file = write_part(series, surface, moment, body, number,
                                            section.label.empty() ? "" : ", " + section.label);
        slices_.push_back({file, number, frame.time, section.label, section.plane.offset,
                           bodies_[body].name, surface.vertex_count(), surface.triangle_count(),
                           enclosed_volume(surface), area(surface)});
    }

    void write_outline(std::size_t body, const Moment<4>& moment, int number) {
        if (!options_.projection.has_value()) {
            return;
        }
        const Projection projection =
            make_projection(*options_.projection, sections_.front().plane, start_.frames);
        const Surface surface =
            outline(bodies_[body].boundary, moment.frames[body].positions, projection);
        write_part(bodies_[body].name + "_outline", surface, moment, body, number,
                   ", outline of the projection");
    }

    void write_boundary(std::size_t body, const Moment<4>& moment, int number) {
        if (!options_.has_boundary) {
            return;
        }
        const Frame<4>& frame = moment.frames[body];
        VtuGrid grid;
        grid.points = frame.positions.template topRows<3>();
        grid.cells = bodies_[body].boundary.facets;
        std::vector<ColorBy> quantities = {ColorBy::W, ColorBy::Speed, ColorBy::Strain};
        if (has_contact_forces(frame)) {
            quantities.push_back(ColorBy::Force);
        }
        for (const ColorBy by : quantities) {
            grid.point_data.push_back(
                {std::string(name_of(by)), vertex_values<4>(bodies_[body], frame, by)});
        }
        const std::string series = bodies_[body].name + "_boundary";
        const std::string file = file_name(series, number, ".vtu");
        write_text(folder_ / file, to_vtu(grid));
        collections_[series].push_back({frame.time, file});
    }

    static std::string file_name(const std::string& series, int number, const std::string& ending) {
        return series + formatted("_%06d", number) + ending;
    }

    // Writes one surface with what colors it; gives the file's name.
    std::string write_part(const std::string& series,
                           const Surface& surface,
                           const Moment<Dim>& moment,
                           std::size_t body,
                           int number,
                           const std::string& remark) {
        const Eigen::VectorXd seen = interpolate(surface, moment.values[body]);
        SurfaceExtras extras;
        if (options_.color != ColorBy::Body) {
            extras.scalars.push_back({std::string(name_of(options_.color)), seen});
        }
        extras.colors = surface_colors(seen, options_.color, range_, body);
        extras.comment = options_.created_by + ": body " + bodies_[body].name + remark;
        std::string file = file_name(series, number, extension(options_.format));
        write_surface(folder_ / file, surface, options_.format, extras);
        if (options_.format == SurfaceFormat::Vtu) {
            collections_[series].push_back({moment.frames[body].time, file});
        }
        return file;
    }

    const RunFolder& run_;
    const std::filesystem::path& folder_;
    const SliceRunOptions& options_;
    std::vector<Body<Dim>> bodies_;
    Moment<Dim> start_;
    std::vector<Section> sections_;
    ColorRange range_;
    std::vector<SliceRecord> slices_;
    std::map<std::string, std::vector<PvdEntry>> collections_;
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
                            const std::filesystem::path& folder,
                            const SliceRunOptions& options,
                            const OnProgress& on_progress) {
    check_dimension<Dim>(options);
    SliceWriter<Dim> writer(run, folder, options);
    make_folder(folder);
    SliceRunReport report;
    report.is_complete = writer.look(on_progress) && writer.write(on_progress);
    writer.write_lists();
    report.slices = writer.take_records();
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
