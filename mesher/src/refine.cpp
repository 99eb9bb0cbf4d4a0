#include "refine.h"

#include <array>
#include <cassert>
#include <queue>
#include <unordered_map>
#include <vector>

namespace pent::mesher {

namespace {

using Triangle = std::array<std::uint32_t, 3>;

struct Edge {
    double squared_length = 0;
    std::uint32_t low = 0;
    std::uint32_t high = 0;

    [[nodiscard]] std::uint64_t key() const { return (std::uint64_t{low} << 32U) | high; }
    [[nodiscard]] bool operator<(const Edge& other) const {
        return squared_length != other.squared_length ? squared_length < other.squared_length
                                                      : key() > other.key();
    }
};

class Refinement {
public:
    explicit Refinement(const Surface& surface) {
        for (const auto& point : surface.points.colwise()) {
            points_.emplace_back(point);
        }
        for (const auto& t : surface.triangles.colwise()) {
            add_triangle({t[0], t[1], t[2]});
        }
        // An edge is bisected once and then gone, so each enters the queue once.
        for (const Triangle& t : triangles_) {
            for (int i = 0; i < 3; ++i) {
                if (t[i] < t[(i + 1) % 3]) {
                    queue_.push(make_edge(t[i], t[(i + 1) % 3]));
                }
            }
        }
    }

    [[nodiscard]] Eigen::Index size() const { return static_cast<Eigen::Index>(triangles_.size()); }

    void bisect_longest() {
        const Edge edge = queue_.top();
        queue_.pop();
        const std::array<std::uint32_t, 2> sides = sides_.at(edge.key());
        sides_.erase(edge.key());
        const auto middle = static_cast<std::uint32_t>(points_.size());
        points_.emplace_back((points_[edge.low] + points_[edge.high]) / 2);
        for (const std::uint32_t side : sides) {
            split(side, edge, middle);
        }
        queue_.push(make_edge(edge.low, middle));
        queue_.push(make_edge(edge.high, middle));
    }

    [[nodiscard]] Surface result() const {
        Surface surface;
        surface.points.resize(3, static_cast<Eigen::Index>(points_.size()));
        for (std::size_t i = 0; i < points_.size(); ++i) {
            surface.points.col(static_cast<Eigen::Index>(i)) = points_[i];
        }
        surface.triangles = Eigen::Map<const Simplices<3>>(triangles_.front().data(), 3, size());
        return surface;
    }

private:
    static constexpr std::uint32_t kNone = 0xffffffff;

    [[nodiscard]] Edge make_edge(std::uint32_t a, std::uint32_t b) const {
        return {(points_[a] - points_[b]).squaredNorm(), std::min(a, b), std::max(a, b)};
    }

    void add_triangle(const Triangle& t) {
        const auto name = static_cast<std::uint32_t>(triangles_.size());
        triangles_.push_back(t);
        for (int i = 0; i < 3; ++i) {
            replace_side(t[i], t[(i + 1) % 3], kNone, name);
        }
    }

    void replace_side(std::uint32_t a, std::uint32_t b, std::uint32_t old, std::uint32_t name) {
        const Edge edge{0, std::min(a, b), std::max(a, b)};
        auto& sides = sides_.try_emplace(edge.key(), std::array{kNone, kNone}).first->second;
        assert(sides[0] == old || sides[1] == old);
        (sides[0] == old ? sides[0] : sides[1]) = name;
    }

    // Triangle a b c with the edge a b becomes a m c, and m b c is added.
    void split(std::uint32_t name, const Edge& edge, std::uint32_t middle) {
        const Triangle t = triangles_[name];
        int i = 0;
        while (t[i] != edge.low && t[i] != edge.high) {
            ++i;
        }
        if (t[(i + 1) % 3] != edge.low && t[(i + 1) % 3] != edge.high) {
            i = (i + 2) % 3;
        }
        const std::uint32_t a = t[i];
        const std::uint32_t b = t[(i + 1) % 3];
        const std::uint32_t c = t[(i + 2) % 3];
        triangles_[name] = {a, middle, c};
        replace_side(a, middle, kNone, name);
        replace_side(middle, c, kNone, name);
        const auto added = static_cast<std::uint32_t>(triangles_.size());
        triangles_.push_back({middle, b, c});
        replace_side(middle, b, kNone, added);
        replace_side(b, c, name, added);
        replace_side(middle, c, kNone, added);
        queue_.push(make_edge(middle, c));
    }

    std::vector<Eigen::Vector3d> points_;
    std::vector<Triangle> triangles_;
    std::unordered_map<std::uint64_t, std::array<std::uint32_t, 2>> sides_;  // of each edge
    std::priority_queue<Edge> queue_;
};

}  // namespace

Surface refine(const Surface& surface, Eigen::Index triangles) {
    Refinement refinement(surface);
    while (refinement.size() < triangles) {
        refinement.bisect_longest();
    }
    return refinement.result();
}

}  // namespace pent::mesher
