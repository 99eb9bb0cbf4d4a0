#include "formats.h"
#include "text_lines.h"

#include <pent/output_file.h>

#include <array>
#include <string>
#include <utility>

namespace pent::exchange {

namespace {

// Coordinates at the end that are zero may be missing.
Eigen::Vector4d read_short_point(TextReader& text) {
    Eigen::Vector4d point = Eigen::Vector4d::Zero();
    int known = 0;
    for (std::string_view word = text.word(); !word.empty() && known < 4; word = text.word()) {
        point[known++] = text.number(word, "a coordinate");
    }
    if (known == 0) {
        text.fail("a point without a coordinate");
    }
    return point;
}

}  // namespace

Content read_4obj(const std::filesystem::path& path) {
    TextReader text(path);
    SurfaceBuilder builder;
    std::int64_t faces = 0;
    while (text.next_line()) {
        const std::string_view keyword = text.word();
        if (keyword == "v") {
            builder.add_point(read_short_point(text));
        } else if (keyword == "t") {
            std::array<std::uint32_t, 4> corners{};
            for (std::uint32_t& corner : corners) {
                const std::string_view word = text.word();
                const std::int64_t from_one =
                    text.integer(word.substr(0, word.find('/')), "a corner");
                corner = text.index(from_one - 1, builder.point_count());
            }
            builder.add_tetrahedron(corners);
        } else if (keyword == "f") {
            ++faces;
        }
    }
    if (builder.tetrahedra().empty() && faces > 0) {
        text.fail(
            "faces and no tetrahedra (t lines): a surface of three dimensions; pent-mesh reads"
            " it");
    }
    auto [positions, tetrahedra] = builder.take();
    return TetSurface{std::move(positions), std::move(tetrahedra)};
}

void write_4obj(const std::filesystem::path& path,
                const Content& content,
                const WriteOptions& options) {
    const auto& surface = std::get<TetSurface>(content);
    std::string text = "# " + options.created_by + "\n";
    for (const auto& point : surface.points.colwise()) {
        text += 'v';
        append_point(text, point);
        text += '\n';
    }
    for (const auto& tetrahedron : surface.tetrahedra.colwise()) {
        text += 't';
        append_corners(text, tetrahedron, 1);
        text += '\n';
    }
    write_text(path, text);
}

}  // namespace pent::exchange
