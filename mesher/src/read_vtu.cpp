#include "vtk_data.h"
#include "vtk_grid.h"

#include <pent/error.h>
#include <pent/input_path.h>
#include <pent/read_text.h>

#include <charconv>
#include <cmath>
#include <string>
#include <utility>

namespace pent::mesher {

namespace {

class VtuReader {
public:
    explicit VtuReader(const std::filesystem::path& path)
        : name_(input_name(path)),
          text_(read_text(path.string() == kStandardInput ? "/dev/stdin" : path,
                          "an unstructured grid of VTK (.vtu)")),
          file_(parse_xml(text_, name_)),
          encoding_(encoding_of(file_, name_, text_.size())) {}

    FileGrid read() {
        const XmlElement& piece = find_piece();
        const std::int64_t points = count_of(piece, "NumberOfPoints");
        const std::int64_t cells = count_of(piece, "NumberOfCells");
        read_points(piece, points);
        read_cells(piece, cells);
        read_arrays(piece.child("PointData"), points, grid_.point_arrays);
        read_arrays(piece.child("CellData"), cells, grid_.cell_arrays);
        return std::move(grid_);
    }

private:
    [[noreturn]] void fail(const XmlElement& element, const std::string& message) const {
        throw Error(name_ + ": line " + std::to_string(element.line) + ": " + message);
    }

    const XmlElement& find_piece() {
        if (file_.root.name != "VTKFile" || file_.root.attribute("type") != "UnstructuredGrid") {
            fail(file_.root, "found " + in_quotes(file_.root.name) + " of type "
                                 + in_quotes(file_.root.attribute("type"))
                                 + ", expected VTKFile of type UnstructuredGrid");
        }
        const XmlElement& grid = required(file_.root, "UnstructuredGrid");
        const XmlElement& piece = required(grid, "Piece");
        for (const XmlElement& other : grid.children) {
            if (other.name == "Piece" && &other != &piece) {
                fail(other, "a second piece; expected one: merge them first");
            }
        }
        return piece;
    }

    const XmlElement& required(const XmlElement& parent, std::string_view name) {
        const XmlElement* found = parent.child(name);
        if (found == nullptr) {
            fail(parent, "no " + std::string(name) + " in " + in_quotes(parent.name)
                             + ": the file is cut, or none of VTK's");
        }
        return *found;
    }

    // Not bounded by the size of the file: what zlib compresses may take less than a byte each.
    std::int64_t count_of(const XmlElement& piece, std::string_view key) {
        constexpr std::int64_t kMaxCount = std::int64_t{1} << 32;
        const std::string_view word = piece.attribute(key);
        std::int64_t count = 0;
        const auto [end, error] = std::from_chars(word.data(), word.data() + word.size(), count);
        if (error != std::errc() || end != word.data() + word.size() || word.empty() || count < 0
            || count >= kMaxCount) {
            fail(piece, std::string(key) + " is " + in_quotes(word)
                            + ", expected a whole number below 2^32");
        }
        return count;
    }

    const XmlElement& array_of(const XmlElement& parent, std::string_view name) {
        for (const XmlElement& array : parent.children) {
            if (array.attribute("Name") == name) {
                return array;
            }
        }
        fail(parent, "no array " + std::string(name) + " in " + in_quotes(parent.name));
    }

    void read_points(const XmlElement& piece, std::int64_t count) {
        const XmlElement& array = required(required(piece, "Points"), "DataArray");
        const std::vector<double> values = reals_of(array, encoding_, 3 * count);
        for (std::int64_t point = 0; point < count; ++point) {
            const Eigen::Vector3d position(values[3 * point], values[3 * point + 1],
                                           values[3 * point + 2]);
            if (!position.allFinite()) {
                throw Error(place_of(array, encoding_) + "point " + std::to_string(point)
                            + " is not finite");
            }
            grid_.soup.points.push_back(position);
        }
    }

    void read_cells(const XmlElement& piece, std::int64_t count) {
        const XmlElement& cells = required(piece, "Cells");
        const XmlElement& ends_array = array_of(cells, "offsets");
        const std::vector<std::int64_t> ends = integers_of(ends_array, encoding_, count);
        const std::vector<std::int64_t> types =
            integers_of(array_of(cells, "types"), encoding_, count);
        const std::vector<std::int64_t> corners =
            integers_of(array_of(cells, "connectivity"), encoding_, ends.empty() ? 0 : ends.back());
        std::int64_t begin = 0;
        for (std::int64_t cell = 0; cell < count; ++cell) {
            if (ends[cell] < begin || ends[cell] > ends.back()) {
                throw Error(place_of(ends_array, encoding_) + "cell " + std::to_string(cell)
                            + " ends at " + std::to_string(ends[cell]) + ", expected "
                            + std::to_string(begin) + " to " + std::to_string(ends.back()));
            }
            const Fail fail_cell = [&](const std::string& message) {
                throw Error(name_ + ": cell " + std::to_string(cell) + ": " + message);
            };
            add_cell(grid_, types[cell],
                     std::span(corners).subspan(static_cast<std::size_t>(begin),
                                                static_cast<std::size_t>(ends[cell] - begin)),
                     fail_cell);
            begin = ends[cell];
        }
    }

    void read_arrays(const XmlElement* data, std::int64_t count, std::vector<FileArray>& arrays) {
        if (data == nullptr) {
            return;
        }
        for (const XmlElement& array : data->children) {
            if (has_numbers(array)) {
                const std::int64_t components = components_of(array, encoding_);
                arrays.push_back({std::string(array.attribute("Name")), components,
                                  reals_of(array, encoding_, components * count)});
            }
        }
    }

    std::string name_;
    std::string text_;
    XmlFile file_;
    VtkEncoding encoding_;
    FileGrid grid_;
};

}  // namespace

FileGrid read_vtu_grid(const std::filesystem::path& path) {
    return VtuReader(path).read();
}

}  // namespace pent::mesher
