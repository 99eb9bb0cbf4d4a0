#include "vtu.h"

#include <pent/formatted.h>

#include <cstring>

namespace pent::viewer {

namespace {

constexpr std::uint8_t kTriangle = 5;      // VTK_TRIANGLE
constexpr std::uint8_t kTetrahedron = 10;  // VTK_TETRA

// The appended block: arrays one after the other, each behind its size in bytes.
class Appended {
public:
    // Adds an array and gives the XML element that refers to it.
    template <typename Value>
    std::string add(const std::string& type,
                    const std::string& name,
                    int components,
                    const Value* data,
                    std::size_t count) {
        std::string element = "<DataArray type=\"" + type + "\" Name=\"" + name
                              + "\" NumberOfComponents=\"" + std::to_string(components)
                              + "\" format=\"appended\" offset=\"" + std::to_string(bytes_.size())
                              + "\"/>\n";
        const std::uint64_t size = count * sizeof(Value);
        bytes_.append(reinterpret_cast<const char*>(&size), sizeof size);
        bytes_.append(reinterpret_cast<const char*>(data), size);
        return element;
    }

    [[nodiscard]] const std::string& bytes() const { return bytes_; }

private:
    std::string bytes_;
};

// As the value of an attribute.
std::string escaped(const std::string& text) {
    std::string result;
    for (const char c : text) {
        const bool is_special =
            c == '&' || c == '<' || c == '"' || c == '\n' || c == '\t' || c == '\r';
        result += is_special ? formatted("&#%d;", c) : std::string(1, c);
    }
    return result;
}

}  // namespace

std::string to_vtu(const VtuGrid& grid) {
    const auto corners = static_cast<int>(grid.cells.rows());
    const auto count = static_cast<std::size_t>(grid.cells.cols());
    std::vector<std::int64_t> offsets(count);
    for (std::size_t c = 0; c < count; ++c) {
        offsets[c] = static_cast<std::int64_t>(c + 1) * corners;
    }
    const std::vector<std::uint8_t> types(count, corners == 4 ? kTetrahedron : kTriangle);
    const std::vector<std::int64_t> connectivity(grid.cells.reshaped().begin(),
                                                 grid.cells.reshaped().end());
    Appended data;
    std::string xml =
        "<?xml version=\"1.0\"?>\n<VTKFile type=\"UnstructuredGrid\" version=\"1.0\" "
        "byte_order=\"LittleEndian\" header_type=\"UInt64\">\n<UnstructuredGrid>\n"
        "<Piece NumberOfPoints=\""
        + std::to_string(grid.points.cols()) + "\" NumberOfCells=\"" + std::to_string(count)
        + "\">\n<Points>\n";
    xml += data.add("Float64", "points", 3, grid.points.data(),
                    static_cast<std::size_t>(grid.points.size()));
    xml += "</Points>\n<Cells>\n";
    xml += data.add("Int64", "connectivity", 1, connectivity.data(), connectivity.size());
    xml += data.add("Int64", "offsets", 1, offsets.data(), offsets.size());
    xml += data.add("UInt8", "types", 1, types.data(), types.size());
    xml += "</Cells>\n<PointData>\n";
    for (const VtuGrid::PointData& array : grid.point_data) {
        xml += data.add("Float64", array.name, 1, array.values.data(),
                        static_cast<std::size_t>(array.values.size()));
    }
    xml += "</PointData>\n</Piece>\n</UnstructuredGrid>\n<AppendedData encoding=\"raw\">\n_";
    return xml + data.bytes() + "\n</AppendedData>\n</VTKFile>\n";
}

std::string to_pvd(const std::vector<PvdEntry>& entries) {
    std::string xml =
        "<?xml version=\"1.0\"?>\n<VTKFile type=\"Collection\" version=\"1.0\" "
        "byte_order=\"LittleEndian\">\n<Collection>\n";
    for (const PvdEntry& entry : entries) {
        xml += formatted("<DataSet timestep=\"%.17g\" part=\"0\" file=\"", entry.time)
               + escaped(entry.file) + "\"/>\n";
    }
    return xml + "</Collection>\n</VTKFile>\n";
}

}  // namespace pent::viewer
