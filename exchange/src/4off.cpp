#include "formats.h"
#include "text_lines.h"

#include <pent/output_file.h>

#include <algorithm>
#include <array>
#include <map>
#include <string>
#include <utility>
#include <vector>

namespace pent::exchange {

namespace {

using Triangle = std::array<std::uint32_t, 3>;
using Polygon = std::vector<std::uint32_t>;

// A count, and that many indices below `end`; what follows on the line, a color, is left out.
Polygon read_list(TextReader& text, std::size_t least, std::int64_t end, const char* expected) {
    next_line(text, expected);
    const std::int64_t count = text.count(text.word(), expected);
    if (count < static_cast<std::int64_t>(least)) {
        text.fail("found " + std::to_string(count) + " of them, expected " + std::string(expected)
                  + ", at least " + std::to_string(least));
    }
    Polygon list;
    for (std::int64_t i = 0; i < count; ++i) {
        list.push_back(text.index(text.word(), end));
    }
    return list;
}

// A polygon as triangles from its corner with the lowest index, so that two cells cut it alike.
std::vector<Triangle> fan_of(const Polygon& polygon) {
    const std::size_t n = polygon.size();
    const auto first = static_cast<std::size_t>(std::min_element(polygon.begin(), polygon.end())
                                                - polygon.begin());
    std::vector<Triangle> fan;
    for (std::size_t i = 1; i + 1 < n; ++i) {
        fan.push_back({polygon[first], polygon[(first + i) % n], polygon[(first + i + 1) % n]});
    }
    return fan;
}

// A cell as tetrahedra from its corner with the lowest index to the triangles that do not have it.
void add_cell(const std::vector<std::vector<Triangle>>& faces,
              const Polygon& cell,
              SurfaceBuilder& builder) {
    std::uint32_t tip = faces[cell[0]][0][0];
    for (const std::uint32_t face : cell) {
        tip = std::min(tip, faces[face][0][0]);  // a fan begins with the lowest
    }
    for (const std::uint32_t face : cell) {
        if (faces[face][0][0] == tip) {
            continue;
        }
        for (const Triangle& triangle : faces[face]) {
            builder.add_tetrahedron({tip, triangle[0], triangle[1], triangle[2]});
        }
    }
}

void check_keyword(TextReader& text) {
    next_line(text, "4OFF");
    const std::string keyword(text.word());
    if (keyword == "OFF" || keyword == "3OFF") {
        text.fail("\"" + keyword + "\": a surface of three dimensions; pent-mesh reads it");
    }
    if (keyword != "4OFF") {
        text.fail("found \"" + keyword.substr(0, 20) + "\", expected 4OFF");
    }
}

// The triangles of all tetrahedra, each once: numbered when they first appear.
class TriangleList {
public:
    std::uint32_t number_of(Triangle corners) {
        std::sort(corners.begin(), corners.end());
        const auto [found, is_new] =
            numbers_.try_emplace(corners, static_cast<std::uint32_t>(list_.size()));
        if (is_new) {
            list_.push_back(corners);
        }
        return found->second;
    }
    [[nodiscard]] const std::vector<Triangle>& list() const { return list_; }

private:
    std::map<Triangle, std::uint32_t> numbers_;
    std::vector<Triangle> list_;
};

// The faces of a tetrahedron in an order that gives readers which look at orientation (godot-4d) an
// outward normal: they take it from the corners of the first two faces, first the third corner of
// the first face, then the edge that both share, then the third corner of the second, which has to
// be an odd permutation of ours.
std::array<Triangle, 4> ordered_faces(const Eigen::Vector<std::uint32_t, 4>& outward) {
    std::uint32_t p = outward[0];
    std::uint32_t q = outward[1];
    const std::uint32_t low = std::min(outward[2], outward[3]);
    const std::uint32_t high = std::max(outward[2], outward[3]);
    // (p, low, high, q) is (0, 2, 3, 1) of ours, an even order, if nothing was exchanged.
    if (low == outward[2]) {
        std::swap(p, q);
    }
    return {{{low, high, p}, {low, high, q}, {low, p, q}, {high, p, q}}};
}

}  // namespace

Content read_4off(const std::filesystem::path& path) {
    TextReader text(path);
    check_keyword(text);
    const std::int64_t points = text.count(text.next_word("the number of points"), "points");
    const std::int64_t faces = text.count(text.next_word("the number of faces"), "faces");
    static_cast<void>(text.count(text.next_word("the number of edges"), "edges"));
    const std::int64_t cells = text.count(text.next_word("the number of cells"), "cells");
    SurfaceBuilder builder;
    for (std::int64_t i = 0; i < points; ++i) {
        next_line(text, "a point");
        builder.add_point(read_point(text));
    }
    std::vector<std::vector<Triangle>> fans;
    for (std::int64_t i = 0; i < faces; ++i) {
        fans.push_back(fan_of(read_list(text, 3, points, "corners of a face")));
    }
    for (std::int64_t i = 0; i < cells; ++i) {
        add_cell(fans, read_list(text, 4, faces, "faces of a cell"), builder);
    }
    auto [positions, tetrahedra] = builder.take();
    return TetSurface{std::move(positions), std::move(tetrahedra)};
}

void write_4off(const std::filesystem::path& path,
                const Content& content,
                const WriteOptions& /*options*/) {
    const auto& surface = std::get<TetSurface>(content);
    TriangleList triangles;
    std::string cells;
    for (Eigen::Index t = 0; t < surface.tetrahedra.cols(); ++t) {
        cells += '4';
        for (const Triangle& face : ordered_faces(surface.tetrahedra.col(t))) {
            cells += ' ' + std::to_string(triangles.number_of(face));
        }
        cells += '\n';
    }
    const std::size_t edges = 0;  // nobody reads their number
    std::string text = "4OFF\n" + std::to_string(surface.points.cols()) + ' '
                       + std::to_string(triangles.list().size()) + ' ' + std::to_string(edges) + ' '
                       + std::to_string(surface.tetrahedra.cols()) + '\n';
    for (const auto& point : surface.points.colwise()) {
        std::string line;
        append_point(line, point);
        text += line.substr(1) + '\n';
    }
    for (const Triangle& triangle : triangles.list()) {
        text += '3';
        append_corners(text, triangle);
        text += '\n';
    }
    write_text(path, text + cells);
}

}  // namespace pent::exchange
