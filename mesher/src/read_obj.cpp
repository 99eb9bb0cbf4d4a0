#include "surface_readers.h"
#include "text_reader.h"

#include <Eigen/Geometry>

#include <string>
#include <vector>

namespace pent::mesher {

namespace {

using Corners = std::vector<std::uint32_t>;

// Twice the vector area of a polygon, its direction independent of where the polygon starts.
Eigen::Vector3d twice_vector_area(const std::vector<Eigen::Vector3d>& points,
                                  const Corners& polygon) {
    const Eigen::Vector3d origin = points[polygon[0]];
    Eigen::Vector3d sum = Eigen::Vector3d::Zero();
    for (std::size_t i = 1; i + 1 < polygon.size(); ++i) {
        sum += (points[polygon[i]] - origin).cross(points[polygon[i + 1]] - origin);
    }
    return sum;
}

// The first corner from which a fan covers the polygon without a triangle turned over; 0 if there
// is none.
std::size_t fan_start(const std::vector<Eigen::Vector3d>& points, const Corners& polygon) {
    const std::size_t n = polygon.size();
    if (n == 3) {
        return 0;
    }
    const Eigen::Vector3d normal = twice_vector_area(points, polygon);
    for (std::size_t start = 0; start < n; ++start) {
        const Eigen::Vector3d& a = points[polygon[start]];
        bool is_turned = false;
        for (std::size_t i = 1; i + 1 < n && !is_turned; ++i) {
            const Eigen::Vector3d& b = points[polygon[(start + i) % n]];
            const Eigen::Vector3d& c = points[polygon[(start + i + 1) % n]];
            is_turned = (b - a).cross(c - a).dot(normal) <= 0;
        }
        if (!is_turned) {
            return start;
        }
    }
    return 0;
}

std::uint32_t read_corner(const TextReader& text, std::string_view word, std::size_t points) {
    const std::int64_t index = text.integer(word.substr(0, word.find('/')), "a corner of a face");
    const auto count = static_cast<std::int64_t>(points);
    const std::int64_t from_zero = index < 0 ? count + index : index - 1;
    if (from_zero < 0 || from_zero >= count) {
        text.fail("corner " + std::to_string(index) + " of a face, but there are "
                  + std::to_string(points) + " points so far");
    }
    return static_cast<std::uint32_t>(from_zero);
}

Eigen::Vector3d read_point(TextReader& text) {
    Eigen::Vector3d point;
    for (double& coordinate : point) {
        coordinate = text.number(text.word(), "a coordinate");
    }
    return point;
}

Corners read_polygon(TextReader& text, std::size_t points) {
    Corners polygon;
    for (std::string_view word = text.word(); !word.empty(); word = text.word()) {
        polygon.push_back(read_corner(text, word, points));
    }
    if (polygon.size() < 3) {
        text.fail("a face with " + std::to_string(polygon.size()) + " corners; expected 3 or more");
    }
    return polygon;
}

}  // namespace

TriangleSoup read_obj(const std::filesystem::path& path) {
    TextReader text(path);
    std::vector<Eigen::Vector3d> points;
    std::vector<std::uint32_t> corners;
    while (text.next_line()) {
        const std::string_view keyword = text.word();
        if (keyword == "v") {
            points.push_back(read_point(text));
        } else if (keyword == "f") {
            const Corners polygon = read_polygon(text, points.size());
            const std::size_t n = polygon.size();
            const std::size_t start = fan_start(points, polygon);
            for (std::size_t i = 1; i + 1 < n; ++i) {
                corners.push_back(polygon[start]);
                corners.push_back(polygon[(start + i) % n]);
                corners.push_back(polygon[(start + i + 1) % n]);
            }
        }
    }
    TriangleSoup soup;
    soup.points.resize(3, static_cast<Eigen::Index>(points.size()));
    for (std::size_t i = 0; i < points.size(); ++i) {
        soup.points.col(static_cast<Eigen::Index>(i)) = points[i];
    }
    soup.triangles = Eigen::Map<const Simplices<3>>(corners.data(), 3,
                                                    static_cast<Eigen::Index>(corners.size() / 3));
    return soup;
}

}  // namespace pent::mesher
