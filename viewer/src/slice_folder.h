#pragma once

#include "vtu.h"

#include <pent/viewer/slice_run.h>
#include <pent/viewer/surface.h>
#include <pent/viewer/surface_file.h>

#include <filesystem>
#include <map>
#include <string>
#include <vector>

namespace pent::viewer {

/// Which file of a folder of slices: SERIES_000123 and its ending.
struct SliceFile {
    std::string series;  ///< "octopus", or "octopus_s01" where there are several hyperplanes.
    int frame = 0;
    double time = 0;  ///< s.
};

/// The files of a folder of slices, and the lists that are written behind them.
class SliceFolder {
public:
    /// Makes the folder if need be. Throws an Error as make_folder does; the functions below as
    /// write_text does.
    SliceFolder(std::filesystem::path path, SurfaceFormat format);

    /// Gives the name of the file.
    std::string add_surface(const SliceFile& file,
                            const TriangleMesh& surface,
                            const SurfaceExtras& extras);
    void add_grid(const SliceFile& file, const VtuGrid& grid);
    void add_record(SliceRecord record) { records_.push_back(std::move(record)); }

    /// slices.csv with all records, and a ParaView collection of each series of VTU files.
    void write_lists() const;

    [[nodiscard]] const std::vector<SliceRecord>& records() const { return records_; }

private:
    std::filesystem::path path_;
    SurfaceFormat format_;
    std::vector<SliceRecord> records_;
    std::map<std::string, std::vector<PvdEntry>> collections_;  // by series
};

}  // namespace pent::viewer
