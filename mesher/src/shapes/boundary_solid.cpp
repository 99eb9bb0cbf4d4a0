#include "closed_boundary.h"
#include "solid_data.h"
#include "tet_boundary.h"

#include <pent/error.h>
#include <pent/exchange/exchange.h>
#include <pent/formatted.h>
#include <pent/input_path.h>
#include <pent/mesher/boundary_solid.h>

#include <fstream>
#include <string>
#include <utility>
#include <variant>
#include <vector>

namespace pent::mesher {

namespace {

using Long = long long;  // NOLINT(google-runtime-int): printf's type

// Passes over what some editors put in front of a text in UTF-8.
void skip_byte_order_mark(std::istream& file) {
    constexpr std::string_view kMark = "\xEF\xBB\xBF";
    std::string start(kMark.size(), '\0');
    file.read(start.data(), static_cast<std::streamsize>(start.size()));
    if (start != kMark) {
        file.clear();
        file.seekg(0);
    }
}

// The first word of a text file, or that of its first line that begins with one of some words.
bool begins_with_4off(std::istream& file) {
    for (std::string line; std::getline(file, line);) {
        const std::size_t first = line.find_first_not_of(" \t\r");
        if (first != std::string::npos && line[first] != '#') {
            return line.compare(first, 4, "4OFF") == 0;
        }
    }
    return false;
}

bool has_tetrahedra_lines(std::istream& file) {
    for (std::string line; std::getline(file, line);) {
        if (line.starts_with("t ") || line.starts_with("t\t")) {
            return true;
        }
        if (line.starts_with("f ")) {
            return false;  // of three dimensions
        }
    }
    return false;
}

}  // namespace

std::string describe(const BoundaryReport& report) {
    std::string text;
    const auto add = [&](std::int64_t count, const char* what) {
        if (count > 0) {
            text +=
                (text.empty() ? "" : ", ") + formatted("%lld ", static_cast<Long>(count)) + what;
        }
    };
    add(report.degenerate, "degenerate tetrahedra left out");
    add(report.repeated, "repeated tetrahedra left out");
    add(report.turned, "tetrahedra turned over");
    add(report.open, "open triangles");
    if (report.holes > 0) {
        const Eigen::Vector4d& p = report.hole_place;
        text += formatted(
            " around %lld hole%s closed, the largest by %.3g m^3 at "
            "(%.4g, %.4g, %.4g, %.4g)",
            static_cast<Long>(report.holes), report.holes == 1 ? "" : "s", report.largest_hole,
            p[0], p[1], p[2], p[3]);
    }
    add(report.inner, "tetrahedra within the body left out");
    return text.empty() ? "nothing" : text;
}

BoundarySolid boundary_solid(const exchange::TetSurface& surface,
                             const std::string& name,
                             bool may_mend) {
    BoundaryReport report;
    const exchange::TetSurface closed = closed_boundary(surface, name, report);
    auto boundary = std::make_shared<const TetBoundary>(closed);
    report.inner = boundary->inner_count();
    report.patches = boundary->patch_count();
    if (report.patches == 0) {
        throw Error(name
                    + ": encloses nothing: its tetrahedra cancel each other, as the two sides of a "
                      "sheet do; expected the boundary of a body");
    }
    if (report.is_mended() && !may_mend) {
        throw Error(
            name + ": is no sound boundary: " + describe(report)
            + "; expected one that is closed and does not cross itself, or leave to mend it");
    }
    const Box4 box{closed.points.rowwise().minCoeff(), closed.points.rowwise().maxCoeff()};
    return {solid_of(BoundaryField{std::move(boundary)}, box, (box.high - box.low).minCoeff(),
                     {1, true}),
            report};
}

bool is_boundary_file(const std::filesystem::path& path) {
    const std::string ending = format_of(path, "");
    if (ending == ".off" || ending == ".obj") {
        std::ifstream file(path, std::ios::binary);
        skip_byte_order_mark(file);
        return ending == ".off" ? begins_with_4off(file) : has_tetrahedra_lines(file);
    }
    return ending == ".pent" || ending == ".4off" || ending == ".g4tf" || ending == ".g4b"
           || ending == ".4do" || ending == ".mfem";
}

exchange::TetSurface read_boundary(const std::filesystem::path& path) {
    // What is wrong with it is for boundary_solid() to say.
    exchange::Content content = exchange::read(path, {.is_welded = false});
    if (const auto* body = std::get_if<exchange::Body>(&content)) {
        return exchange::boundary_of(body->mesh);
    }
    return std::get<exchange::TetSurface>(std::move(content));
}

}  // namespace pent::mesher
