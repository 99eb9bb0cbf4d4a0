#include "slice_folder.h"

#include <pent/csv_field.h>
#include <pent/formatted.h>
#include <pent/output_file.h>

#include <cinttypes>
#include <utility>

namespace pent::viewer {

namespace {

std::string csv_of(const std::vector<SliceRecord>& records) {
    std::string csv = "file,frame,time,section,offset,body,vertices,triangles,volume,area\n";
    for (const SliceRecord& record : records) {
        csv += csv_field(record.file) + formatted(",%d,%.17g,\"", record.frame, record.time)
               + record.section + formatted("\",%.17g,", record.offset) + csv_field(record.body)
               + formatted(",%" PRId64 ",%" PRId64 ",%.17g,%.17g\n", record.vertices,
                           record.triangles, record.volume, record.area);
    }
    return csv;
}

std::string name_of(const SliceFile& file, const std::string& ending) {
    return file.series + formatted("_%06d", file.frame) + ending;
}

}  // namespace

SliceFolder::SliceFolder(std::filesystem::path path, SurfaceFormat format)
    : path_(std::move(path)), format_(format) {
    make_folder(path_);
}

std::string SliceFolder::add_surface(const SliceFile& file,
                                     const TriangleMesh& surface,
                                     const SurfaceExtras& extras) {
    std::string name = name_of(file, extension(format_));
    write_surface(path_ / name, surface, format_, extras);
    if (format_ == SurfaceFormat::Vtu) {
        collections_[file.series].push_back({file.time, name});
    }
    return name;
}

void SliceFolder::add_grid(const SliceFile& file, const VtuGrid& grid) {
    const std::string name = name_of(file, extension(SurfaceFormat::Vtu));
    write_text(path_ / name, to_vtu(grid));
    collections_[file.series].push_back({file.time, name});
}

void SliceFolder::write_lists() const {
    write_text(path_ / "slices.csv", csv_of(records_));
    for (const auto& [series, entries] : collections_) {
        write_text(path_ / (series + ".pvd"), to_pvd(entries));
    }
}

}  // namespace pent::viewer
