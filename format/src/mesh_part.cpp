#include "pent/mesh_part.h"

#include "element_rows.h"
#include "extras_columns.h"
#include "extrusion_file.h"
#include "input_file.h"
#include "mesh_columns.h"
#include "slab_sum.h"

#include <pent/crc32c.h>
#include <pent/error.h>
#include <pent/extrusion.h>

#include <algorithm>
#include <functional>
#include <numeric>
#include <optional>
#include <string_view>
#include <utility>

namespace pent {

namespace {

// Whether any writer has something of the kind.
bool has_any(const SlabWriters* writers, std::size_t own) {
    return place_slab(writers, own).all > 0;
}

// A mesh of one vertex and one cell that has the same optional arrays as the slabs together: what
// the columns of the file follow from, on a process whose own slab may be empty, too.
template <int Dim>
SimplexMesh<Dim> pattern_of(const SimplexMesh<Dim>& slab, const SlabWriters* writers) {
    SimplexMesh<Dim> pattern;
    pattern.positions.resize(Dim, 1);
    pattern.cells.resize(Dim + 1, 1);
    pattern.columns.resize(has_any(writers, slab.columns.size()) ? 1 : 0);
    pattern.layers.resize(has_any(writers, slab.layers.size()) ? 1 : 0);
    pattern.regions.resize(has_any(writers, slab.regions.size()) ? 1 : 0);
    pattern.parents.resize(has_any(writers, slab.parents.size()) ? 1 : 0);
    pattern.fibers.resize(Dim,
                          has_any(writers, static_cast<std::size_t>(slab.fibers.cols())) ? 1 : 0);
    return pattern;
}

// The same of what is beside it. Quantities are named on all.
template <int Dim>
MeshExtras<Dim> pattern_of(const MeshExtras<Dim>& slab, const SlabWriters* writers) {
    MeshExtras<Dim> pattern;
    for (const VertexField& field : slab.vertex_fields) {
        pattern.vertex_fields.push_back({field.name, Eigen::MatrixXd(field.values.rows(), 0)});
    }
    for (const VertexField& field : slab.cell_fields) {
        pattern.cell_fields.push_back({field.name, Eigen::MatrixXd(field.values.rows(), 0)});
    }
    pattern.bisection_tags.resize(has_any(writers, slab.bisection_tags.size()) ? 1 : 0);
    pattern.base_labels.resize(has_any(writers, slab.base_labels.size()) ? 1 : 0);
    return pattern;
}

template <int Dim>
std::string encode(const SimplexMesh<Dim>& slab, const MeshExtras<Dim>& extras, Encoding encoding) {
    std::string body;
    if (slab.vertex_count() > 0) {
        encode_rows(body, encoding, vertex_columns(slab, extras),
                    static_cast<std::uint64_t>(slab.vertex_count()));
    }
    if (slab.cell_count() > 0) {
        encode_rows(body, encoding, cell_columns(slab, extras),
                    static_cast<std::uint64_t>(slab.cell_count()));
    }
    if (extras.boundary.cols() > 0) {
        encode_rows(body, encoding, boundary_columns(extras),
                    static_cast<std::uint64_t>(extras.boundary.cols()));
    }
    return body;
}

template <typename Value>
std::vector<Value> cut(const std::vector<Value>& values, Eigen::Index first, Eigen::Index last) {
    return values.empty() ? values
                          : std::vector<Value>(values.begin() + first, values.begin() + last);
}

// Lines of text differ in length: of every so many of them one is known where it begins, and the
// others are found by reading on from there.
constexpr std::uint64_t kLines = 1024;

// Goes through a text file behind its header. Calls visit(line, at) for every line that ends, with
// its number from 0 and the offset at which it begins; returns both for what follows the last one.
template <typename Visit>
std::pair<std::uint64_t, std::uint64_t> for_each_line(const std::filesystem::path& path,
                                                      std::uint64_t begin,
                                                      const Visit& visit) {
    constexpr std::size_t kPiece = std::size_t{1} << 20;
    std::uint64_t at = begin;
    std::uint64_t line = 0;
    std::uint64_t line_begin = begin;
    for (;;) {
        const InputFile piece = read_input(path, kPiece, at);
        if (piece.bytes == 0) {
            return {line, line_begin};
        }
        const std::string_view text = piece.view();
        for (std::size_t end = text.find('\n'); end != std::string_view::npos;
             end = text.find('\n', end + 1)) {
            visit(line++, line_begin);
            line_begin = at + end + 1;
        }
        at += piece.bytes;
    }
}

}  // namespace

MeshSlab slab_of(Eigen::Index vertices, Eigen::Index cells, int place, int count) {
    const Eigen::Index rows = vertices + cells;
    const Eigen::Index first = rows * place / count;
    const Eigen::Index last = rows * (place + 1) / count;
    return {std::min(first, vertices), std::min(last, vertices),
            std::max(first, vertices) - vertices, std::max(last, vertices) - vertices};
}

template <int Dim>
SimplexMesh<Dim> rows_of(const SimplexMesh<Dim>& mesh, const MeshSlab& slab) {
    const Eigen::Index vertices = slab.last_vertex - slab.first_vertex;
    const Eigen::Index cells = slab.last_cell - slab.first_cell;
    SimplexMesh<Dim> rows;
    rows.positions = mesh.positions.middleCols(slab.first_vertex, vertices);
    rows.columns = cut(mesh.columns, slab.first_vertex, slab.last_vertex);
    rows.layers = cut(mesh.layers, slab.first_vertex, slab.last_vertex);
    rows.cells = mesh.cells.middleCols(slab.first_cell, cells);
    rows.regions = cut(mesh.regions, slab.first_cell, slab.last_cell);
    rows.parents = cut(mesh.parents, slab.first_cell, slab.last_cell);
    if (mesh.fibers.cols() > 0) {
        rows.fibers = mesh.fibers.middleCols(slab.first_cell, cells);
    }
    return rows;
}

template <int Dim>
std::uint32_t write_mesh_slab(const std::filesystem::path& path,
                              const SimplexMesh<Dim>& slab,
                              const MeshExtras<Dim>& extras,
                              const WriteOptions& options) {
    const SimplexMesh<Dim> pattern = pattern_of(slab, options.writers);
    const MeshExtras<Dim> beside = pattern_of(extras, options.writers);
    const auto count = [&](Eigen::Index own) {
        return place_slab(options.writers, static_cast<std::uint64_t>(own)).all;
    };
    Header header;
    header.info.dimension = Dim;
    header.info.encoding = options.encoding;
    header.info.created_by = options.created_by;
    header.elements = {
        make_element("vertex", count(slab.vertex_count()), vertex_columns(pattern, beside)),
        make_element(cell_name(Dim), count(slab.cell_count()), cell_columns(pattern, beside))};
    if (const std::uint64_t facets = count(extras.boundary.cols()); facets > 0) {
        header.elements.push_back(make_element(kBoundary, facets, boundary_columns(beside)));
    }
    return write_file(path, std::move(header), encode(slab, extras, options.encoding),
                      options.writers);
}

template <int Dim>
std::uint32_t checksum_of_mesh(const SimplexMesh<Dim>& slab, const SlabWriters* writers) {
    return crc32c_of_slabs(writers, encode<Dim>(slab, {}, Encoding::Binary));
}

void check_checksum(const std::filesystem::path& path, const SlabWriters* readers) {
    constexpr std::uint64_t kPiece = std::uint64_t{1} << 20;
    Header header;
    std::uint64_t bytes = 0;
    const auto agree = [&](const std::function<void()>& work) {
        readers != nullptr ? readers->agree(work) : work();
    };
    agree([&] {
        header = read_header(path);
        bytes = std::filesystem::file_size(path) - header.body;
    });
    if (!header.has_checksum) {
        return;
    }
    const std::uint64_t count = readers != nullptr ? readers->list(0).size() : 1;
    const auto place = static_cast<std::uint64_t>(readers != nullptr ? readers->place() : 0);
    const std::uint64_t first = bytes * place / count;
    const std::uint64_t last = bytes * (place + 1) / count;
    std::uint32_t sum = 0;
    agree([&] {
        for (std::uint64_t at = first; at < last;) {
            const InputFile piece = read_input(path, std::min(kPiece, last - at), header.body + at);
            if (piece.bytes == 0) {
                throw Error(path.string() + ": became shorter while it was read");
            }
            sum = crc32c(piece.data.get(), piece.bytes, sum);
            at += piece.bytes;
        }
    });
    refuse_checksum(joined_crc32c(readers, sum, last - first), header.info.crc32c, path);
}

template <int Dim>
struct MeshSource<Dim>::Content {
    std::filesystem::path path;
    Header header;
    FileInfo info;
    std::optional<Extrusion<Dim>> extrusion;
    // Of text: where every kLines-th cell begins, and where the last ends.
    std::vector<std::uint64_t> cell_lines;

    void find_lines();
    [[nodiscard]] RowBytes vertex_bytes() const;
    [[nodiscard]] RowBytes cell_bytes(std::uint64_t first, std::uint64_t last) const;
};

// Throws an Error for missing lines of elements that nobody will read, and for bytes behind the
// last element. Missing lines of vertices and cells are noticed when these are read.
template <int Dim>
void MeshSource<Dim>::Content::find_lines() {
    const std::uint64_t vertices = header.elements[0].count;
    const std::uint64_t cells = header.elements[1].count;
    std::uint64_t expected = 0;
    for (const PlyElement& element : header.elements) {
        expected += element.count;
    }
    std::uint64_t end = 0;  // of the cells, and of all
    std::uint64_t end_of_all = 0;
    const auto [lines, last] =
        for_each_line(path, header.body, [&](std::uint64_t line, std::uint64_t at) {
            if (line >= vertices && line < vertices + cells && (line - vertices) % kLines == 0) {
                cell_lines.push_back(at);
            }
            end = line == vertices + cells ? at : end;
            end_of_all = line == expected ? at : end_of_all;
        });
    const std::uint64_t bytes = std::filesystem::file_size(path);
    cell_lines.push_back(lines > vertices + cells ? end : bytes);
    std::uint64_t in_front = vertices + cells;
    for (std::size_t i = 2; i < header.elements.size(); in_front += header.elements[i++].count) {
        const PlyElement& element = header.elements[i];
        if (lines >= in_front && lines - in_front < element.count) {
            throw Error(path.string() + ": " + element.name + " " + std::to_string(lines - in_front)
                        + ": the file ends here: it is truncated");
        }
    }
    const std::uint64_t behind = lines > expected ? bytes - end_of_all : bytes - last;
    if (lines >= expected && behind > 0) {
        throw Error(path.string() + ": end of file: " + std::to_string(behind)
                    + " bytes follow the last element, expected none");
    }
}

template <int Dim>
RowBytes MeshSource<Dim>::Content::vertex_bytes() const {
    const PlyElement& vertex = header.elements[0];
    return {.first = header.body,
            .last = cell_lines.empty() ? header.body + vertex.count * row_bytes(vertex)
                                       : cell_lines.front()};
}

// In text some lines in front of the first cell, and some behind the last, are read, too.
template <int Dim>
RowBytes MeshSource<Dim>::Content::cell_bytes(std::uint64_t first, std::uint64_t last) const {
    if (cell_lines.empty()) {
        const std::uint64_t begin = vertex_bytes().last;
        const std::uint64_t each = row_bytes(header.elements[1]);
        return {.first = begin + first * each, .last = begin + last * each, .in_front = first};
    }
    const auto at = [&](std::uint64_t piece) {
        return cell_lines[std::min<std::uint64_t>(piece, cell_lines.size() - 1)];
    };
    return {.first = at(first / kLines),
            .last = at((last + kLines - 1) / kLines),
            .in_front = first / kLines * kLines};
}

template <int Dim>
MeshSource<Dim>::MeshSource(const std::filesystem::path& path, int parts)
    : content_(std::make_unique<Content>()) {
    constexpr std::uint64_t kMaxRows = 0xffffffff;
    content_->path = path;
    content_->header = read_header(path);
    const Header& header = content_->header;
    content_->info = header.info;
    if (pent::is_extrusion(header)) {
        const InputFile file = read_input(path);
        content_->extrusion = parse_extrusion<Dim>(header, file.view(), path);
        content_->info = info_in_memory<Dim>(header, *content_->extrusion, parts, path);
        return;
    }
    refuse_frame(header, path);
    check_counts(header, std::filesystem::file_size(path) - header.body, path);
    if (header.info.cells == 0 || header.info.cells > kMaxRows) {
        throw Error(path.string() + ": " + std::to_string(header.info.cells) + " "
                    + std::string(cell_name_plural(Dim)) + ", expected 1 to 4294967295");
    }
    if (header.info.encoding == Encoding::Ascii) {
        content_->find_lines();
    }
}

template <int Dim>
MeshSource<Dim>::~MeshSource() = default;
template <int Dim>
MeshSource<Dim>::MeshSource(MeshSource&&) noexcept = default;
template <int Dim>
MeshSource<Dim>& MeshSource<Dim>::operator=(MeshSource&&) noexcept = default;

template <int Dim>
const FileInfo& MeshSource<Dim>::info() const {
    return content_->info;
}

template <int Dim>
bool MeshSource<Dim>::is_extrusion() const {
    return content_->extrusion.has_value();
}

template <int Dim>
SimplexMesh<Dim> MeshSource<Dim>::vertices() const {
    if (content_->extrusion) {
        return extrude_vertices<Dim>(*content_->extrusion);
    }
    const PlyElement& vertex = content_->header.elements[0];
    SimplexMesh<Dim> mesh;
    size_vertices(vertex, content_->path, mesh);
    read_rows(content_->path, content_->header.info.encoding, content_->vertex_bytes(), vertex,
              vertex_columns(mesh));
    return mesh;
}

template <int Dim>
SimplexMesh<Dim> MeshSource<Dim>::cells(Eigen::Index first, Eigen::Index last) const {
    if (content_->extrusion) {
        if (first == last) {
            return {};
        }
        const Eigen::Index each = cells_of_column<Dim>(content_->extrusion->layers);
        std::vector<std::uint32_t> base(
            static_cast<std::size_t>((last - 1) / each - first / each + 1));
        std::iota(base.begin(), base.end(), static_cast<std::uint32_t>(first / each));
        const Eigen::Index before = first / each * each;
        return rows_of<Dim>(extrude_cells<Dim>(*content_->extrusion, base),
                            {.first_cell = first - before, .last_cell = last - before});
    }
    const RowBytes bytes =
        content_->cell_bytes(static_cast<std::uint64_t>(first), static_cast<std::uint64_t>(last));
    const auto in_front = static_cast<Eigen::Index>(bytes.in_front);
    PlyElement rows = content_->header.elements[1];
    rows.count = static_cast<std::uint64_t>(last) - bytes.in_front;
    SimplexMesh<Dim> mesh;
    size_cells(rows, content_->path, mesh);
    read_rows(content_->path, content_->header.info.encoding, bytes, rows, cell_columns(mesh));
    return in_front == first
               ? mesh
               : rows_of(mesh, {.first_cell = first - in_front, .last_cell = last - in_front});
}

template <int Dim>
MeshPart<Dim> MeshSource<Dim>::cells_over(const std::vector<bool>& is_wanted) const {
    const Simplices<Dim>& cells = content_->extrusion->base.cells;
    std::vector<std::uint32_t> base;
    for (Eigen::Index cell = 0; cell < cells.cols(); ++cell) {
        const auto corners = cells.col(cell);
        if (std::any_of(corners.begin(), corners.end(),
                        [&](std::uint32_t vertex) { return is_wanted[vertex]; })) {
            base.push_back(static_cast<std::uint32_t>(cell));
        }
    }
    const auto each = static_cast<std::uint32_t>(cells_of_column<Dim>(content_->extrusion->layers));
    MeshPart<Dim> part;
    part.mesh = extrude_cells<Dim>(*content_->extrusion, base);
    part.cell_count = static_cast<Eigen::Index>(content_->info.cells);
    part.numbers.reserve(base.size() * each);
    for (const std::uint32_t cell : base) {
        for (std::uint32_t k = 0; k < each; ++k) {
            part.numbers.push_back(cell * each + k);
        }
    }
    return part;
}

#define PENT_INSTANTIATE(Dim)                                                                    \
    template SimplexMesh<Dim> rows_of<Dim>(const SimplexMesh<Dim>&, const MeshSlab&);            \
    template std::uint32_t write_mesh_slab<Dim>(const std::filesystem::path&,                    \
                                                const SimplexMesh<Dim>&, const MeshExtras<Dim>&, \
                                                const WriteOptions&);                            \
    template std::uint32_t checksum_of_mesh<Dim>(const SimplexMesh<Dim>&, const SlabWriters*);   \
    template class MeshSource<Dim>;
PENT_INSTANTIATE(3)
PENT_INSTANTIATE(4)
#undef PENT_INSTANTIATE

}  // namespace pent
