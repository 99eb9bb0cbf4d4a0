#include "formats.h"
#include "text_lines.h"

#include <pent/counted.h>
#include <pent/error.h>
#include <pent/facets.h>
#include <pent/output_file.h>

#include <algorithm>
#include <array>
#include <limits>
#include <map>
#include <string>
#include <utility>
#include <vector>

namespace pent::exchange {

namespace {

constexpr int kPentatope = 8;
constexpr int kTetrahedron = 4;

using Corners = Eigen::Vector<std::uint32_t, 4>;

Corners sorted(Corners corners) {
    std::sort(corners.begin(), corners.end());
    return corners;
}

struct IsBefore {
    bool operator()(const Corners& a, const Corners& b) const {
        return std::lexicographical_compare(a.begin(), a.end(), b.begin(), b.end());
    }
};

// Labels of the boundary's facets: those that the body has for them, unless 0; else, where it was
// extruded, by whether a facet is in the first layer, in the last, or between.
class BoundaryLabels {
public:
    BoundaryLabels(const Body& body, const WriteOptions& options) : mesh_(body.mesh) {
        for (std::size_t f = 0; f < body.extras.labels.size(); ++f) {
            if (body.extras.labels[f] != 0) {
                known_[sorted(body.extras.boundary.col(static_cast<Eigen::Index>(f)))] =
                    body.extras.labels[f];
            }
        }
        if (!mesh_.layers.empty()) {
            const auto [first, last] =
                std::minmax_element(mesh_.layers.begin(), mesh_.layers.end());
            first_ = *first;
            last_ = *last;
        }
        is_mfem_ = options.has_mfem_attributes && !(known_.empty() && mesh_.layers.empty());
        for (const std::uint16_t region : mesh_.regions) {
            cell_labels_ = std::max(cell_labels_, region + 1);
        }
    }

    [[nodiscard]] int of(const Corners& corners, std::size_t cell) const {
        const int label = own_label(corners);
        if (!is_mfem_) {
            return label;
        }
        if (label != static_cast<int>(BoundaryLabel::Bottom)) {
            return cell_labels_ + label - 1;
        }
        return mesh_.regions.empty() ? 1 : mesh_.regions[cell] + 1;
    }

private:
    [[nodiscard]] int own_label(const Corners& corners) const {
        const auto found = known_.find(sorted(corners));
        if (found != known_.end()) {
            return found->second;
        }
        const auto are_in = [&](std::uint32_t layer) {
            return std::all_of(corners.begin(), corners.end(),
                               [&](std::uint32_t corner) { return mesh_.layers[corner] == layer; });
        };
        const BoundaryLabel label = mesh_.layers.empty() || are_in(first_) ? BoundaryLabel::Bottom
                                    : are_in(last_)                        ? BoundaryLabel::Top
                                                                           : BoundaryLabel::Lateral;
        return static_cast<int>(label);
    }

    const SimplexMesh<4>& mesh_;
    std::map<Corners, std::uint16_t, IsBefore> known_;
    std::uint32_t first_ = 0;
    std::uint32_t last_ = 0;
    int cell_labels_ = 1;
    bool is_mfem_ = false;
};

void expect_word(TextReader& text, std::string_view expected) {
    const std::string found(text.next_word(expected));
    if (found != expected) {
        text.fail("found \"" + found.substr(0, 20) + "\", expected \"" + std::string(expected)
                  + "\"");
    }
}

void check_header(TextReader& text) {
    for (const char* word : {"MFEM", "mesh"}) {
        expect_word(text, word);
    }
    text.skip_line();  // v1.0
    expect_word(text, "dimension");
    const std::int64_t dimension = text.integer(text.next_word("a dimension"), "a dimension");
    if (dimension != 4) {
        text.fail("a mesh of " + counted(dimension, "dimension", "dimensions") + "; expected 4");
    }
}

// Label, kind and corners of the elements of a section; indices are checked when all points are
// known.
struct Elements {
    std::vector<std::int64_t> labels;  // from 1
    std::vector<std::array<std::int64_t, 5>> corners;
};

Elements read_elements(TextReader& text, std::string_view section, int kind) {
    expect_word(text, section);
    const std::int64_t count = text.count(text.next_word("a number of elements"), "elements");
    // Those of cells become regions, from 0.
    const std::int64_t most = kind == kPentatope ? std::numeric_limits<std::uint16_t>::max() + 1
                                                 : std::numeric_limits<std::int32_t>::max();
    Elements elements;
    for (std::int64_t i = 0; i < count; ++i) {
        const std::int64_t label = text.integer(text.next_word("a label"), "a label");
        const std::int64_t found = text.integer(text.next_word("a kind"), "a kind");
        if (found != kind) {
            text.fail("an element of kind " + std::to_string(found) + "; expected "
                      + std::to_string(kind) + (kind == kPentatope ? ", a pentatope" : ""));
        }
        if (label < 1 || label > most) {
            text.fail("a label of " + std::to_string(label) + "; expected 1 to "
                      + std::to_string(most));
        }
        elements.labels.push_back(label);
        std::array<std::int64_t, 5>& corners = elements.corners.emplace_back();
        for (int k = 0; k < (kind == kPentatope ? 5 : 4); ++k) {
            corners[static_cast<std::size_t>(k)] =
                text.integer(text.next_word("a corner"), "a corner");
        }
    }
    return elements;
}

Positions<4> read_vertices(TextReader& text) {
    expect_word(text, "vertices");
    const std::int64_t count = text.count(text.next_word("a number of points"), "points");
    const std::string size(text.next_word("4"));
    if (size != "4") {
        text.fail("found \"" + size.substr(0, 20)
                  + "\", expected 4 coordinates a point (curved meshes, with nodes, are not read)");
    }
    Positions<4> positions(4, count);
    for (double& coordinate : positions.reshaped()) {
        coordinate = text.number(text.next_word("a coordinate"), "a coordinate");
    }
    return positions;
}

// The facets of the boundary that have labels, outward. Where all have 1, as without any, there are
// none; nor has one that a .pent file could not hold.
void label_boundary(TextReader& text, const Elements& elements, Body& body) {
    if (std::all_of(elements.labels.begin(), elements.labels.end(),
                    [](std::int64_t label) { return label == 1; })) {
        return;
    }
    std::map<Corners, std::uint16_t, IsBefore> known;
    for (std::size_t e = 0; e < elements.corners.size(); ++e) {
        Corners corners;
        for (int k = 0; k < 4; ++k) {
            corners[k] = text.index(elements.corners[e][static_cast<std::size_t>(k)],
                                    body.mesh.positions.cols());
        }
        if (elements.labels[e] <= std::numeric_limits<std::uint16_t>::max()) {
            known[sorted(corners)] = static_cast<std::uint16_t>(elements.labels[e]);
        }
    }
    const FacetMatch<4> match = match_facets<4>(body.mesh.cells, body.mesh.vertex_count());
    std::vector<Eigen::Index> labeled;
    for (Eigen::Index f = 0; f < match.boundary.cols(); ++f) {
        const auto found = known.find(sorted(match.boundary.col(f)));
        if (found != known.end()) {
            labeled.push_back(f);
            body.extras.labels.push_back(found->second);
        }
    }
    body.extras.boundary = match.boundary(Eigen::all, labeled);
}

}  // namespace

Content read_mfem(const std::filesystem::path& path) {
    TextReader text(path);
    check_header(text);
    const Elements elements = read_elements(text, "elements", kPentatope);
    const Elements boundary = read_elements(text, "boundary", kTetrahedron);
    Body body;
    SimplexMesh<4>& mesh = body.mesh;
    mesh.positions = read_vertices(text);
    mesh.cells.resize(5, static_cast<Eigen::Index>(elements.corners.size()));
    for (std::size_t e = 0; e < elements.corners.size(); ++e) {
        const auto cell = static_cast<Eigen::Index>(e);
        for (int k = 0; k < 5; ++k) {
            mesh.cells(k, cell) =
                text.index(elements.corners[e][static_cast<std::size_t>(k)], mesh.positions.cols());
        }
        if (cell_volume<4>(mesh.positions, mesh.cells, cell) < 0) {
            std::swap(mesh.cells(3, cell), mesh.cells(4, cell));
        }
    }
    if (std::any_of(elements.labels.begin(), elements.labels.end(),
                    [](std::int64_t label) { return label != 1; })) {
        for (const std::int64_t label : elements.labels) {
            mesh.regions.push_back(static_cast<std::uint16_t>(label - 1));
        }
    }
    validate<4>(mesh, path.string());
    label_boundary(text, boundary, body);
    return body;
}

void write_mfem(const std::filesystem::path& path,
                const Content& content,
                const WriteOptions& options) {
    const auto& body = std::get<Body>(content);
    const SimplexMesh<4>& mesh = body.mesh;
    std::string text = "MFEM mesh v1.0\n\n# " + options.created_by
                       + "; time is the last coordinate\n\ndimension\n4\n\nelements\n"
                       + std::to_string(mesh.cell_count()) + '\n';
    for (Eigen::Index cell = 0; cell < mesh.cell_count(); ++cell) {
        const int region = mesh.regions.empty() ? 0 : mesh.regions[static_cast<std::size_t>(cell)];
        text += std::to_string(region + 1) + ' ' + std::to_string(kPentatope);
        append_corners(text, mesh.cells.col(cell));
        text += '\n';
    }
    const FacetMatch<4> match = match_facets<4>(mesh.cells, mesh.vertex_count());
    const BoundaryLabels labels(body, options);
    text += "\nboundary\n" + std::to_string(match.boundary.cols()) + '\n';
    for (Eigen::Index f = 0; f < match.boundary.cols(); ++f) {
        const std::uint32_t cell = match.boundary_cells[static_cast<std::size_t>(f)];
        text += std::to_string(labels.of(match.boundary.col(f), cell)) + ' '
                + std::to_string(kTetrahedron);
        append_corners(text, match.boundary.col(f));
        text += '\n';
    }
    text += "\nvertices\n" + std::to_string(mesh.vertex_count()) + "\n4\n";
    for (const auto& point : mesh.positions.colwise()) {
        std::string line;
        append_point(line, point);
        text += line.substr(1) + '\n';
    }
    write_text(path, text);
}

}  // namespace pent::exchange
