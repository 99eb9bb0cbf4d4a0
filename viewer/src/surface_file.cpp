#include "pent/viewer/surface_file.h"

#include "vtu.h"

#include <pent/formatted.h>
#include <pent/output_file.h>

#include <algorithm>
#include <array>
#include <cstdint>
#include <cstring>

namespace pent::viewer {

namespace {

// Appends the bytes of a value as they lie in memory: little-endian on every machine we build for.
template <typename Value>
void append(std::string& bytes, const Value& value) {
    char raw[sizeof value];
    std::memcpy(raw, &value, sizeof value);
    bytes.append(raw, sizeof value);
}

bool has_colors(const SurfaceExtras& extras) {
    return extras.colors.cols() > 0;
}

// In one line, whatever is in the name of a body.
std::string comment_line(const char* mark, const SurfaceExtras& extras) {
    std::string comment = extras.comment;
    std::ranges::replace_if(
        comment, [](char c) { return c == '\n' || c == '\r'; }, ' ');
    return comment.empty() ? "" : mark + comment + "\n";
}

std::string ply_header(const TriangleMesh& surface, const SurfaceExtras& extras) {
    std::string header = "ply\nformat binary_little_endian 1.0\n";
    header += comment_line("comment ", extras);
    header += "element vertex " + std::to_string(surface.vertex_count())
              + "\nproperty double x\nproperty double y\nproperty double z\n";
    for (const VertexScalar& scalar : extras.scalars) {
        header += "property double " + scalar.name + "\n";
    }
    if (has_colors(extras)) {
        header += "property uchar red\nproperty uchar green\nproperty uchar blue\n";
    }
    return header + "element face " + std::to_string(surface.triangle_count())
           + "\nproperty list uchar uint vertex_indices\nend_header\n";
}

std::string ply_bytes(const TriangleMesh& surface, const SurfaceExtras& extras) {
    std::string bytes = ply_header(surface, extras);
    bytes.reserve(bytes.size() + 72 * static_cast<std::size_t>(surface.vertex_count())
                  + 13 * static_cast<std::size_t>(surface.triangle_count()));
    for (Eigen::Index v = 0; v < surface.vertex_count(); ++v) {
        for (int axis = 0; axis < 3; ++axis) {
            append(bytes, surface.positions(axis, v));
        }
        for (const VertexScalar& scalar : extras.scalars) {
            append(bytes, scalar.values[v]);
        }
        if (has_colors(extras)) {
            append(bytes, to_srgb(extras.colors.col(v)));
        }
    }
    for (const auto& triangle : surface.triangles.colwise()) {
        append(bytes, std::uint8_t{3});
        for (const std::uint32_t vertex : triangle) {
            append(bytes, vertex);
        }
    }
    return bytes;
}

std::string obj_text(const TriangleMesh& surface, const SurfaceExtras& extras) {
    std::string text = comment_line("# ", extras);
    for (Eigen::Index v = 0; v < surface.vertex_count(); ++v) {
        const auto p = surface.positions.col(v);
        text += formatted("v %.17g %.17g %.17g", p.x(), p.y(), p.z());
        if (has_colors(extras)) {
            const std::array<std::uint8_t, 3> c = to_srgb(extras.colors.col(v));
            text += formatted(" %.4g %.4g %.4g", c[0] / 255.0, c[1] / 255.0, c[2] / 255.0);
        }
        text += '\n';
    }
    for (const auto& triangle : surface.triangles.colwise()) {
        text += formatted("f %u %u %u\n", triangle[0] + 1, triangle[1] + 1, triangle[2] + 1);
    }
    return text;
}

std::string vtu_bytes(const TriangleMesh& surface, const SurfaceExtras& extras) {
    VtuGrid grid;
    grid.points = surface.positions;
    grid.cells = surface.triangles;
    for (const VertexScalar& scalar : extras.scalars) {
        grid.point_data.push_back({scalar.name, scalar.values});
    }
    return to_vtu(grid);
}

}  // namespace

std::string extension(SurfaceFormat format) {
    switch (format) {
        case SurfaceFormat::Ply:
            return ".ply";
        case SurfaceFormat::Obj:
            return ".obj";
        case SurfaceFormat::Vtu:
            break;
    }
    return ".vtu";
}

void write_surface(const std::filesystem::path& path,
                   const TriangleMesh& surface,
                   SurfaceFormat format,
                   const SurfaceExtras& extras) {
    switch (format) {
        case SurfaceFormat::Ply:
            return write_text(path, ply_bytes(surface, extras));
        case SurfaceFormat::Obj:
            return write_text(path, obj_text(surface, extras));
        case SurfaceFormat::Vtu:
            return write_text(path, vtu_bytes(surface, extras));
    }
}

}  // namespace pent::viewer
