#pragma once

#include "shapes.h"
#include "support/kuhn_box.h"

#include <pent/base64.h>
#include <pent/formatted.h>
#include <pent/mesher/moving_mesh.h>

#include <cstring>
#include <filesystem>
#include <functional>
#include <numeric>
#include <string>
#include <string_view>
#include <utility>
#include <vector>
#include <zlib.h>

namespace pent::test {

/// Where a vertex is at a time.
using Motion = std::function<Eigen::Vector3d(const Eigen::Vector3d& x, double t)>;

/// A mesh that moves as told, with frames at these times.
inline mesher::MovingMesh moving(const SimplexMesh<3>& mesh,
                                 const std::vector<double>& times,
                                 const Motion& motion) {
    mesher::MovingMesh result;
    result.base = mesh;
    result.times = times;
    for (std::size_t i = 0; i < times.size(); ++i) {
        Positions<3> positions = mesh.positions;
        for (auto x : positions.colwise()) {
            x = motion(Eigen::Vector3d(x), times[i]);
        }
        result.positions.push_back(positions);
        result.frames.push_back("frame_" + std::to_string(i));
    }
    result.base.positions = result.positions.front();
    result.cell_numbers.resize(static_cast<std::size_t>(mesh.cell_count()));
    std::iota(result.cell_numbers.begin(), result.cell_numbers.end(), 0U);
    return result;
}

/// A box of cubes around the origin.
inline SimplexMesh<3> centered_box(int count, double size) {
    SimplexMesh<3> mesh = kuhn_box<3>({count, count, count}, {size, size, size});
    mesh.positions.array() -= size / 2;
    return mesh;
}

/// Ways in which VTK writes arrays.
struct VtuWay {
    std::string format = "ascii";  ///< "ascii", "binary" or "appended".
    bool is_raw = true;            ///< Appended bytes as they are, else base64.
    bool is_compressed = false;
    bool has_long_headers = false;
    bool is_big_endian = false;
    std::size_t block = 64;  ///< Bytes that are compressed together.
};

/// Writes .vtu files as VTK does, from its description of the format.
class VtuText {
public:
    explicit VtuText(VtuWay way) : way_(std::move(way)) {}

    template <typename Value>
    std::string array(const std::string& type,
                      const std::string& name,
                      int components,
                      const std::vector<Value>& values) {
        std::string xml = "<DataArray type=\"" + type + "\" Name=\"" + name
                          + "\" NumberOfComponents=\"" + std::to_string(components) + "\" format=\""
                          + way_.format + "\"";
        if (way_.format == "ascii") {
            xml += ">\n";
            for (const Value value : values) {
                xml += formatted("%.17g ", static_cast<double>(value));
            }
            return xml + "\n</DataArray>\n";
        }
        std::string bytes;
        for (const Value value : values) {
            append(bytes, &value, sizeof value);
        }
        const bool is_plain_raw = way_.format == "appended" && way_.is_raw;
        const std::string block =
            way_.is_compressed ? compressed(bytes, is_plain_raw) : plain(bytes, is_plain_raw);
        if (way_.format == "binary") {
            return xml + ">\n  " + block + "\n</DataArray>\n";
        }
        xml += " offset=\"" + std::to_string(appended_.size()) + "\"/>\n";
        appended_ += block;
        return xml;
    }

    [[nodiscard]] std::string file(const std::string& grid) const {
        std::string xml =
            "<?xml version=\"1.0\"?>\n<VTKFile type=\"UnstructuredGrid\" "
            "version=\"1.0\" byte_order=\"";
        xml += way_.is_big_endian ? "BigEndian\"" : "LittleEndian\"";
        xml += way_.has_long_headers ? " header_type=\"UInt64\"" : " header_type=\"UInt32\"";
        xml += way_.is_compressed ? " compressor=\"vtkZLibDataCompressor\">\n" : ">\n";
        xml += grid;
        if (way_.format == "appended") {
            xml += std::string("<AppendedData encoding=\"") + (way_.is_raw ? "raw" : "base64")
                   + "\">\n_" + appended_ + "\n</AppendedData>\n";
        }
        return xml + "</VTKFile>\n";
    }

private:
    void append(std::string& bytes, const void* value, std::size_t size) const {
        std::string raw(size, '\0');
        std::memcpy(raw.data(), value, size);
        if (way_.is_big_endian) {
            raw.assign(raw.rbegin(), raw.rend());
        }
        bytes += raw;
    }

    void append_word(std::string& bytes, std::uint64_t word) const {
        const auto short_word = static_cast<std::uint32_t>(word);
        way_.has_long_headers ? append(bytes, &word, 8) : append(bytes, &short_word, 4);
    }

    // One text of length and bytes.
    [[nodiscard]] std::string plain(const std::string& bytes, bool is_raw) const {
        std::string all;
        append_word(all, bytes.size());
        all += bytes;
        return is_raw ? all : to_base64(all);
    }

    // Two texts: the numbers of the blocks, and the blocks.
    [[nodiscard]] std::string compressed(const std::string& bytes, bool is_raw) const {
        std::string blocks;
        std::vector<std::uint64_t> sizes;
        for (std::size_t at = 0; at < bytes.size(); at += way_.block) {
            const std::string part = bytes.substr(at, way_.block);
            uLongf size = compressBound(part.size());
            std::string out(size, '\0');
            compress(reinterpret_cast<Bytef*>(out.data()), &size,
                     reinterpret_cast<const Bytef*>(part.data()), part.size());
            blocks += out.substr(0, size);
            sizes.push_back(size);
        }
        std::string header;
        append_word(header, sizes.size());
        append_word(header, way_.block);
        append_word(header, bytes.size() % way_.block);
        for (const std::uint64_t size : sizes) {
            append_word(header, size);
        }
        return is_raw ? header + blocks : to_base64(header) + to_base64(blocks);
    }

    VtuWay way_;
    std::string appended_;
};

/// The parts of a grid of tetrahedra, and triangles behind them.
struct VtuParts {
    Positions<3> points;
    Simplices<4> tetrahedra;
    Simplices<3> triangles;
    std::vector<int> regions;          ///< Of all cells, or empty.
    std::vector<double> temperature;   ///< Of the points, or empty.
    std::vector<double> cell_vectors;  ///< Three a cell, or empty.
};

inline std::string to_vtu(const VtuParts& parts, const VtuWay& way) {
    VtuText text(way);
    std::vector<std::int64_t> corners;
    std::vector<std::int64_t> ends;
    std::vector<std::uint8_t> types;
    const auto add = [&](auto cell, std::uint8_t type) {
        corners.insert(corners.end(), cell.begin(), cell.end());
        ends.push_back(static_cast<std::int64_t>(corners.size()));
        types.push_back(type);
    };
    for (const auto& cell : parts.tetrahedra.colwise()) {
        add(cell, 10);
    }
    for (const auto& cell : parts.triangles.colwise()) {
        add(cell, 5);
    }
    const std::vector<double> points(parts.points.data(),
                                     parts.points.data() + parts.points.size());
    std::string grid = formatted(
        "<UnstructuredGrid>\n<Piece NumberOfPoints=\"%d\" "
        "NumberOfCells=\"%d\">\n<PointData>\n",
        static_cast<int>(parts.points.cols()), static_cast<int>(types.size()));
    if (!parts.temperature.empty()) {
        grid += text.array("Float64", "temperature", 1, parts.temperature);
    }
    grid += "</PointData>\n<CellData>\n";
    if (!parts.regions.empty()) {
        grid += text.array("Int32", "region", 1, parts.regions);
    }
    if (!parts.cell_vectors.empty()) {
        grid += text.array("Float64", "flow", 3, parts.cell_vectors);
    }
    grid += "</CellData>\n<Points>\n" + text.array("Float64", "Points", 3, points)
            + "</Points>\n<Cells>\n" + text.array("Int64", "connectivity", 1, corners)
            + text.array("Int64", "offsets", 1, ends) + text.array("UInt8", "types", 1, types)
            + "</Cells>\n</Piece>\n</UnstructuredGrid>\n";
    return text.file(grid);
}

inline std::string to_legacy_vtk(const VtuParts& parts) {
    std::string text = "# vtk DataFile Version 3.0\na frame\nASCII\nDATASET UNSTRUCTURED_GRID\n";
    text += formatted("POINTS %d double\n", static_cast<int>(parts.points.cols()));
    for (const auto& x : parts.points.colwise()) {
        text += formatted("%.17g %.17g %.17g\n", x[0], x[1], x[2]);
    }
    const auto count = static_cast<int>(parts.tetrahedra.cols());
    text += formatted("CELLS %d %d\n", count, 5 * count);
    for (const auto& cell : parts.tetrahedra.colwise()) {
        text += formatted("4 %u %u %u %u\n", cell[0], cell[1], cell[2], cell[3]);
    }
    text += formatted("CELL_TYPES %d\n", count);
    for (int i = 0; i < count; ++i) {
        text += "10\n";
    }
    return text;
}

inline VtuParts parts_of(const SimplexMesh<3>& mesh) {
    return {mesh.positions, mesh.cells, {}, {}, {}, {}};
}

// Two tetrahedra with a labeled triangle, regions, a temperature and a flow.
inline VtuParts rich_parts(double t) {
    VtuParts parts;
    parts.points.resize(3, 5);
    parts.points << 0, 1, 0, 0, 1, 0, 0, 1, 0, 1, 0, 0, 0, 1, 1;
    parts.points *= 1 + t / 3;
    parts.tetrahedra.resize(4, 2);
    parts.tetrahedra << 0, 1, 1, 2, 2, 4, 3, 3;
    parts.triangles.resize(3, 1);
    parts.triangles << 0, 1, 2;
    parts.regions = {3, 4, 9};
    parts.temperature = {t, 1 / 3.0, 2 + t, -1e-300, 5};
    parts.cell_vectors = {1, 2, 3, 4, 5, 6, 7, 8, 9};
    return parts;
}

inline std::string write_pvd(const std::filesystem::path& folder,
                             const std::vector<std::pair<double, std::string>>& frames) {
    std::string text =
        "<?xml version=\"1.0\"?>\n<VTKFile type=\"Collection\" version=\"0.1\">\n"
        "<Collection>\n";
    for (const auto& [time, file] : frames) {
        text += formatted("<DataSet timestep=\"%.17g\" group=\"\" part=\"0\" file=\"", time) + file
                + "\"/>\n";
    }
    write_file(folder / "a.pvd", text + "</Collection>\n</VTKFile>\n");
    return (folder / "a.pvd").string();
}

}  // namespace pent::test
