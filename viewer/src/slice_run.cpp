#include "survey.h"
#include "vtu.h"

#include <pent/output_file.h>
#include <pent/viewer/slice_run.h>

#include <cstdio>
#include <map>
#include <utility>

namespace pent::viewer {

namespace {

std::string numbered(const char* format, std::size_t number) {
    char text[32];
    std::snprintf(text, sizeof text, format, static_cast<unsigned>(number));
    return text;
}

// "octopus", or "octopus_s01" where there are several hyperplanes.
std::string series_name(const std::string& body, std::size_t section, std::size_t sections) {
    return sections > 1 ? body + numbered("_s%02u", section) : body;
}

std::string csv_of(const std::vector<SliceRecord>& slices) {
    std::string csv = "file,frame,time,section,offset,body,vertices,triangles,volume,area\n";
    char line[256];
    for (const SliceRecord& slice : slices) {
        std::snprintf(line, sizeof line, ",%d,%.17g,", slice.frame, slice.time);
        csv += slice.file + line + '"' + slice.section + '"';
        std::snprintf(line, sizeof line, ",%.17g,%s,%lld,%lld,%.17g,%.17g\n", slice.offset,
                      slice.body.c_str(),
                      static_cast<long long>(slice.vertices),   // NOLINT(google-runtime-int)
                      static_cast<long long>(slice.triangles),  // NOLINT(google-runtime-int)
                      slice.volume, slice.area);
        csv += line;
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
          sections_(sections_at_start<Dim>(run, bodies_, options.sections)) {
        if (options.color != ColorBy::Body) {
            range_ =
                survey<Dim>(run, bodies_, sections_, options.frames, options.color, {}, {}).range;
        }
    }

    [[nodiscard]] bool write(const OnProgress& on_progress) {
        const auto total = static_cast<std::int64_t>(options_.frames.size());
        for (std::int64_t done = 0; done < total; ++done) {
            for (std::size_t body = 0; body < bodies_.size(); ++body) {
                write_frame(body, options_.frames[static_cast<std::size_t>(done)]);
            }
            if (!on_progress(done + 1, total) && done + 1 < total) {
                return false;
            }
        }
        return true;
    }

    void write_lists() const {
        write_text(folder_ / "slices.csv", csv_of(slices_));
        for (const auto& [series, entries] : collections_) {
            write_text(folder_ / (series + ".pvd"), to_pvd(entries));
        }
    }

    [[nodiscard]] std::vector<SliceRecord> take_records() { return std::move(slices_); }

private:
    void write_frame(std::size_t index, int frame_number) {
        const Body<Dim>& body = bodies_[index];
        const Frame<Dim> frame = load_frame<Dim>(run_, body, frame_number);
        const Eigen::VectorXd values = vertex_values<Dim>(body, frame, options_.color);
        for (std::size_t s = 0; s < sections_.size(); ++s) {
            Surface surface = take_section<Dim>(body, frame.positions, sections_[s]);
            if (!options_.keep_degenerate) {
                surface = merge_coincident(surface);
            }
            const std::string series = series_name(body.name, s, sections_.size());
            const std::string file = series
                                     + numbered("_%06u", static_cast<std::size_t>(frame_number))
                                     + extension(options_.format);
            write_surface(folder_ / file, surface, options_.format,
                          extras(surface, values, index, sections_[s]));
            slices_.push_back({file, frame_number, frame.time, sections_[s].label,
                               sections_[s].plane.offset, body.name, surface.vertex_count(),
                               surface.triangle_count(), enclosed_volume(surface), area(surface)});
            if (options_.format == SurfaceFormat::Vtu) {
                collections_[series].push_back({frame.time, file});
            }
        }
    }

    [[nodiscard]] SurfaceExtras extras(const Surface& surface,
                                       const Eigen::VectorXd& values,
                                       std::size_t body,
                                       const Section& section) const {
        const Eigen::VectorXd seen = interpolate(surface, values);
        SurfaceExtras extras;
        if (options_.color != ColorBy::Body) {
            extras.scalars.push_back({std::string(name_of(options_.color)), seen});
        }
        extras.colors = surface_colors(seen, options_.color, range_, body);
        extras.comment = options_.created_by + ": body " + bodies_[body].name
                         + (section.label.empty() ? "" : ", " + section.label);
        return extras;
    }

    const RunFolder& run_;
    const std::filesystem::path& folder_;
    const SliceRunOptions& options_;
    std::vector<Body<Dim>> bodies_;
    std::vector<Section> sections_;
    ColorRange range_;
    std::vector<SliceRecord> slices_;
    std::map<std::string, std::vector<PvdEntry>> collections_;
};

template <int Dim>
SliceRunReport slice_run_in(const RunFolder& run,
                            const std::filesystem::path& folder,
                            const SliceRunOptions& options,
                            const OnProgress& on_progress) {
    SliceWriter<Dim> writer(run, folder, options);
    make_folder(folder);
    SliceRunReport report;
    report.is_complete = writer.write(on_progress);
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
