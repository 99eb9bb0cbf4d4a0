#include "extrusion_file.h"

#include "body.h"
#include "input_file.h"

#include <pent/error.h>
#include <pent/formatted.h>
#include <pent/machine_memory.h>
#include <pent/with_dimension.h>

#include <algorithm>
#include <array>
#include <iterator>
#include <limits>
#include <numeric>
#include <utility>

namespace pent {

namespace {

constexpr const char* kLayer = "layer";
constexpr const char* kOrder = "order";
constexpr const char* kReversed = "reversed";
constexpr const char* kRegion = "region";
constexpr std::string_view kAxes = "xyzw";

// Columns of a file that are no members of base and layers.
struct Codes {
    std::vector<std::uint8_t> orders;    // of the corners of each base cell: see orders_of()
    std::vector<std::uint8_t> reversed;  // of each layer: whether the slab above it takes them
                                         // from the last to the first
};

template <int Corners>
using Order = std::array<std::uint8_t, Corners>;

// All orders of so many corners, in the sequence of a dictionary.
template <int Corners>
std::vector<Order<Corners>> all_orders() {
    Order<Corners> order{};
    std::iota(order.begin(), order.end(), std::uint8_t{0});
    std::vector<Order<Corners>> all;
    do {
        all.push_back(order);
    } while (std::next_permutation(order.begin(), order.end()));
    return all;
}

template <int Corners>
bool is_odd(const Order<Corners>& order) {
    bool odd = false;
    for (int i = 0; i < Corners; ++i) {
        for (int j = i + 1; j < Corners; ++j) {
            odd ^= order[i] > order[j];
        }
    }
    return odd;
}

template <typename Value>
char* bytes_of(const Value& value) {
    // Encoding only reads through the pointer; decoding is given values that are not const.
    return reinterpret_cast<char*>(const_cast<Value*>(&value));
}

template <int Dim>
std::vector<Column> base_columns(const SimplexMesh<Dim - 1>& base, const Codes& codes) {
    std::vector<Column> columns;
    for (int k = 0; k < Dim; ++k) {
        columns.push_back(row_column("v" + std::to_string(k), PlyType::Uint, base.cells, k));
    }
    if (!base.regions.empty()) {
        columns.push_back(
            {kRegion, PlyType::Ushort, bytes_of(base.regions[0]), sizeof(std::uint16_t)});
    }
    columns.push_back({kOrder, PlyType::Uchar, bytes_of(codes.orders[0]), 1});
    return columns;
}

// x = xx x + xy y + xz z + x and so on, of where a base vertex goes.
template <int Dim>
std::vector<Column> layer_columns(const std::vector<Layer<Dim>>& layers, const Codes& codes) {
    std::vector<Column> columns;
    for (int to = 0; to < Dim; ++to) {
        for (int from = 0; from < Dim - 1; ++from) {
            columns.push_back({std::string(1, kAxes[to]) + kAxes[from], PlyType::Double,
                               bytes_of(layers[0].linear(to, from)), sizeof(Layer<Dim>)});
        }
    }
    for (int to = 0; to < Dim; ++to) {
        columns.push_back({std::string(1, kAxes[to]), PlyType::Double,
                           bytes_of(layers[0].offset[to]), sizeof(Layer<Dim>)});
    }
    columns.push_back({kReversed, PlyType::Uchar, bytes_of(codes.reversed[0]), 1});
    return columns;
}

// The first layer that has vertices has a slab above it that is not reversed.
template <int Dim>
std::vector<std::uint8_t> reversed_slabs(const std::vector<Layer<Dim>>& layers, bool alternate) {
    const std::size_t first = layers.front().is_point() ? 1 : 0;
    std::vector<std::uint8_t> reversed(layers.size(), 0);
    for (std::size_t l = first + 1; alternate && l < layers.size(); l += 2) {
        reversed[l] = 1;
    }
    return reversed;
}

template <int Dim>
Codes codes_of(const Extrusion<Dim>& extrusion) {
    const std::vector<Order<Dim>> orders = all_orders<Dim>();
    Codes codes;
    codes.reversed = reversed_slabs<Dim>(extrusion.layers, extrusion.options.alternate);
    for (Eigen::Index cell = 0; cell < extrusion.base.cell_count(); ++cell) {
        const auto at = std::find_if(orders.begin(), orders.end(), [&](const Order<Dim>& order) {
            bool is_same = true;
            for (int i = 0; i < Dim; ++i) {
                is_same &= extrusion.base.cells(order[i], cell) == extrusion.ordered.cells(i, cell);
            }
            return is_same;
        });
        codes.orders.push_back(static_cast<std::uint8_t>(at - orders.begin()));
    }
    return codes;
}

template <int Dim>
OrderedCells<Dim - 1> order_corners(const Simplices<Dim>& cells,
                                    const std::vector<std::uint8_t>& codes,
                                    const std::string& path) {
    const std::vector<Order<Dim>> orders = all_orders<Dim>();
    OrderedCells<Dim - 1> ordered;
    ordered.cells.resize(Dim, cells.cols());
    ordered.is_odd.resize(codes.size());
    for (std::size_t cell = 0; cell < codes.size(); ++cell) {
        if (codes[cell] >= orders.size()) {
            throw Error(path + ": " + std::string(cell_name(Dim - 1)) + " " + std::to_string(cell)
                        + ": order is " + std::to_string(codes[cell]) + ", expected at most "
                        + std::to_string(orders.size() - 1));
        }
        const Order<Dim>& order = orders[codes[cell]];
        const auto column = static_cast<Eigen::Index>(cell);
        for (int i = 0; i < Dim; ++i) {
            ordered.cells(i, column) = cells(order[i], column);
        }
        ordered.is_odd[cell] = is_odd<Dim>(order) ? 1 : 0;
    }
    return ordered;
}

// Neighbors cut the prisms between them alike if every edge goes the same way in all cells.
template <int Dim>
void check_edges(const OrderedCells<Dim - 1>& ordered, const std::string& path) {
    constexpr int kHalf = 32;
    std::vector<std::uint64_t> up;
    std::vector<std::uint64_t> down;
    for (Eigen::Index cell = 0; cell < ordered.cells.cols(); ++cell) {
        for (int i = 0; i < Dim; ++i) {
            for (int j = i + 1; j < Dim; ++j) {
                const std::uint64_t from = ordered.cells(i, cell);
                const std::uint64_t to = ordered.cells(j, cell);
                (from < to ? up : down).push_back(std::min(from, to) << kHalf | std::max(from, to));
            }
        }
    }
    std::sort(up.begin(), up.end());
    std::sort(down.begin(), down.end());
    std::vector<std::uint64_t> both;
    std::set_intersection(up.begin(), up.end(), down.begin(), down.end(), std::back_inserter(both));
    if (!both.empty()) {
        throw Error(path + ": the edge of vertices " + std::to_string(both[0] >> kHalf) + " and "
                    + std::to_string(both[0] & 0xffffffffU)
                    + " goes one way in one cell and back in another; expected orders in which"
                      " neighbors agree");
    }
}

template <int Dim>
void check_layers(const std::vector<Layer<Dim>>& layers, const std::string& path) {
    const auto fail = [&](std::size_t layer, const std::string& what) {
        throw Error(path + ": layer " + std::to_string(layer) + ": " + what);
    };
    if (layers.size() < 2) {
        throw Error(path + ": " + std::to_string(layers.size()) + " layers, expected two or more");
    }
    for (std::size_t l = 0; l < layers.size(); ++l) {
        if (!layers[l].linear.allFinite() || !layers[l].offset.allFinite()) {
            fail(l, "has a number that is not finite");
        }
        if (layers[l].is_point() && l > 0 && l + 1 < layers.size()) {
            fail(l, "is a point, which only the first and the last may be");
        }
    }
    if (layers.size() == 2 && layers[0].is_point() && layers[1].is_point()) {
        fail(1, "is a point as the only other one is");
    }
}

template <int Dim>
void check(const Extrusion<Dim>& extrusion, const std::string& path) {
    validate(extrusion.base, path);
    check_layers<Dim>(extrusion.layers, path);
    check_edges<Dim>(extrusion.ordered, path);
}

void require(const PlyElement& element,
             const std::vector<Column>& columns,
             const std::filesystem::path& path) {
    for (const Column& column : columns) {
        if (!has_property(element, column.name, column.type, path)) {
            throw Error(path.string() + ": header: element " + element.name + " has no "
                        + column.name + ", which an extrusion needs");
        }
    }
    // Those of the vertices and of the base cells are looked at wherever a header is read.
    for (const PlyProperty& property : element.properties) {
        if (property.count_type) {
            throw Error(path.string() + ": header: element " + element.name
                        + " has the list property " + property.name
                        + ", expected properties of fixed width");
        }
    }
}

template <int Dim>
FileInfo info_of(const Header& header, const Extrusion<Dim>& extrusion) {
    const auto points = static_cast<std::uint64_t>(extrusion.layers.front().is_point())
                        + static_cast<std::uint64_t>(extrusion.layers.back().is_point());
    const std::uint64_t height = extrusion.layers.size() - points;
    FileInfo info = header.info;
    info.dimension = Dim;
    info.vertices = height * header.info.vertices + points;
    info.cells =
        header.info.cells * static_cast<std::uint64_t>(cells_of_column<Dim>(extrusion.layers));
    info.is_extrusion = true;
    return info;
}

}  // namespace

bool is_extrusion(const Header& header) {
    return !header.info.is_frame && header.info.dimension < 4 && header.elements.size() > 2
           && header.elements[2].name == kLayer;
}

FileInfo info_of_extrusion(const Header& header,
                           std::string_view file,
                           const std::filesystem::path& path) {
    return with_dimension(header.info.dimension + 1, [&](auto constant) {
        constexpr int kDim = decltype(constant)::value;
        return info_of<kDim>(header, parse_extrusion<kDim>(header, file, path));
    });
}

template <int Dim>
FileInfo info_in_memory(const Header& header,
                        const Extrusion<Dim>& extrusion,
                        int parts,
                        const std::filesystem::path& path) {
    constexpr std::uint64_t kMaxRows = std::numeric_limits<std::uint32_t>::max();
    constexpr double kGiga = 1e9;
    const FileInfo info = info_of<Dim>(header, extrusion);
    const std::string what =
        path.string() + ": its base and " + std::to_string(extrusion.layers.size())
        + " layers make " + std::to_string(info.vertices) + " vertices and "
        + std::to_string(info.cells) + " " + std::string(cell_name_plural(Dim));
    if (info.vertices > kMaxRows || info.cells > kMaxRows) {
        throw Error(what + "; at most 4294967295 of each can be numbered: take fewer layers");
    }
    const std::uint64_t vertex_bytes = Dim * sizeof(double) + 2 * sizeof(std::uint32_t);
    const std::uint64_t cell_bytes = (Dim + 1) * sizeof(std::uint32_t)
                                     + (extrusion.base.regions.empty() ? 0 : sizeof(std::uint16_t));
    const std::uint64_t bytes =
        info.vertices * vertex_bytes + info.cells / static_cast<std::uint64_t>(parts) * cell_bytes;
    if (bytes > static_cast<std::uint64_t>(machine_memory())) {
        throw Error(what
                    + formatted(", which take %.3g GB; this machine has %.3g: take fewer"
                                " layers, or a machine with more",
                                static_cast<double>(bytes) / kGiga,
                                static_cast<double>(machine_memory()) / kGiga));
    }
    return info;
}

template <int Dim>
MeshFile<Dim> extrude_file(const Header& header,
                           std::string_view file,
                           const std::filesystem::path& path) {
    const Extrusion<Dim> from = parse_extrusion<Dim>(header, file, path);
    MeshFile<Dim> result;
    result.info = info_in_memory<Dim>(header, from, 1, path);
    result.mesh = extrude<Dim>(from.base, from.ordered, from.layers, from.options);
    validate(result.mesh, path.string());
    return result;
}

template <int Dim>
Extrusion<Dim> parse_extrusion(const Header& header,
                               std::string_view file,
                               const std::filesystem::path& path) {
    BodyReader reader(header, file, path);
    const std::uint64_t cells = header.elements[1].count;
    const std::uint64_t layers = header.elements[2].count;
    Extrusion<Dim> extrusion;
    SimplexMesh<Dim - 1>& base = extrusion.base;
    base.positions.resize(Dim - 1, static_cast<Eigen::Index>(header.elements[0].count));
    base.cells.resize(Dim, static_cast<Eigen::Index>(cells));
    if (has_property(header.elements[1], kRegion, PlyType::Ushort, path)) {
        base.regions.resize(cells);
    }
    // One entry more than there are, so that columns have something to point at if there are none.
    Codes codes{std::vector<std::uint8_t>(cells + 1), std::vector<std::uint8_t>(layers + 1)};
    extrusion.layers.resize(layers + 1);
    const std::vector<Column> of_cells = base_columns<Dim>(base, codes);
    const std::vector<Column> of_layers = layer_columns<Dim>(extrusion.layers, codes);
    require(header.elements[1], of_cells, path);
    require(header.elements[2], of_layers, path);
    reader.read(vector_columns<Dim - 1>(base.positions, ""));
    reader.read(of_cells);
    reader.read(of_layers);
    reader.finish();
    codes.orders.pop_back();
    codes.reversed.pop_back();
    extrusion.layers.pop_back();
    validate(base, path.string());
    extrusion.ordered = order_corners<Dim>(base.cells, codes.orders, path.string());
    check<Dim>(extrusion, path.string());
    extrusion.options.alternate =
        std::count(codes.reversed.begin(), codes.reversed.end(), 0) != static_cast<int>(layers);
    if (codes.reversed != reversed_slabs<Dim>(extrusion.layers, extrusion.options.alternate)) {
        throw Error(path.string()
                    + ": the layers that are reversed are not every second one; expected those, or"
                      " none");
    }
    return extrusion;
}

template <int Dim>
std::uint32_t write_extrusion(const std::filesystem::path& path,
                              const Extrusion<Dim>& extrusion,
                              const WriteOptions& options) {
    check<Dim>(extrusion, path.string());
    const Codes codes = codes_of<Dim>(extrusion);
    const std::vector<Column> vertices = vector_columns<Dim - 1>(extrusion.base.positions, "");
    const std::vector<Column> cells = base_columns<Dim>(extrusion.base, codes);
    const std::vector<Column> layers = layer_columns<Dim>(extrusion.layers, codes);
    const auto vertex_count = static_cast<std::uint64_t>(extrusion.base.vertex_count());
    const auto cell_count = static_cast<std::uint64_t>(extrusion.base.cell_count());
    Header header;
    header.info.dimension = Dim - 1;
    header.info.encoding = options.encoding;
    header.info.created_by = options.created_by;
    header.elements = {make_element("vertex", vertex_count, vertices),
                       make_element(cell_name(Dim - 1), cell_count, cells),
                       make_element(kLayer, extrusion.layers.size(), layers)};
    std::string body;
    encode_rows(body, options.encoding, vertices, vertex_count);
    encode_rows(body, options.encoding, cells, cell_count);
    encode_rows(body, options.encoding, layers, extrusion.layers.size());
    return write_file(path, std::move(header), body);
}

template <int Dim>
Extrusion<Dim> read_extrusion(const std::filesystem::path& path) {
    const InputFile file = read_input(path);
    const Header header = parse_header(file.view(), path);
    if (!is_extrusion(header) || header.info.dimension != Dim - 1) {
        throw Error(path.string() + ": header: expected base and layers of a body of dimension "
                    + std::to_string(Dim));
    }
    return parse_extrusion<Dim>(header, file.view(), path);
}

#define PENT_INSTANTIATE(Dim)                                                                \
    template Extrusion<Dim> parse_extrusion<Dim>(const Header&, std::string_view,            \
                                                 const std::filesystem::path&);              \
    template FileInfo info_in_memory<Dim>(const Header&, const Extrusion<Dim>&, int,         \
                                          const std::filesystem::path&);                     \
    template MeshFile<Dim> extrude_file<Dim>(const Header&, std::string_view,                \
                                             const std::filesystem::path&);                  \
    template std::uint32_t write_extrusion<Dim>(const std::filesystem::path&,                \
                                                const Extrusion<Dim>&, const WriteOptions&); \
    template Extrusion<Dim> read_extrusion<Dim>(const std::filesystem::path&);
PENT_INSTANTIATE(3)
PENT_INSTANTIATE(4)
#undef PENT_INSTANTIATE

}  // namespace pent
