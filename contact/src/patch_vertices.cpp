#include "patch_vertices.h"

#include <algorithm>

namespace pent::contact {

namespace {

// The vertices of some simplices, ascending, each once.
template <int Count>
std::vector<std::uint32_t> vertices_of(const Simplices<Count>& simplices,
                                       std::span<const std::uint32_t> patch) {
    std::vector<std::uint32_t> vertices;
    for (const std::uint32_t i : patch) {
        const auto corners = simplices.col(i);
        vertices.insert(vertices.end(), corners.begin(), corners.end());
    }
    std::sort(vertices.begin(), vertices.end());
    vertices.erase(std::unique(vertices.begin(), vertices.end()), vertices.end());
    return vertices;
}

}  // namespace

template <int Count>
PatchVertices::PatchVertices(const Simplices<Count>& simplices, const PatchPartition& partition)
    : corner_count_(Count) {
    static_assert(Count * kLanes <= 256);
    for (std::size_t patch = 0; patch < partition.size(); ++patch) {
        const std::span<const std::uint32_t> members = partition[patch];
        const std::vector<std::uint32_t> vertices = vertices_of<Count>(simplices, members);
        simplex_counts_.push_back(static_cast<std::uint8_t>(members.size()));
        starts_.push_back(vertices_.size());
        vertices_.insert(vertices_.end(), vertices.begin(), vertices.end());
        for (int corner = 0; corner < Count; ++corner) {
            for (std::size_t lane = 0; lane < kLanes; ++lane) {
                const std::uint32_t vertex =
                    simplices(corner, members[lane < members.size() ? lane : 0]);
                const auto place = std::lower_bound(vertices.begin(), vertices.end(), vertex);
                corners_.push_back(static_cast<std::int32_t>(vertex));
                places_.push_back(static_cast<std::uint8_t>(place - vertices.begin()));
            }
        }
    }
    starts_.push_back(vertices_.size());
}

std::int64_t PatchVertices::bytes() const {
    return static_cast<std::int64_t>(
        starts_.size() * sizeof(std::size_t) + vertices_.size() * sizeof(std::uint32_t)
        + corners_.size() * sizeof(std::int32_t) + places_.size() + simplex_counts_.size());
}

template PatchVertices::PatchVertices(const Simplices<1>&, const PatchPartition&);
template PatchVertices::PatchVertices(const Simplices<2>&, const PatchPartition&);
template PatchVertices::PatchVertices(const Simplices<3>&, const PatchPartition&);
template PatchVertices::PatchVertices(const Simplices<4>&, const PatchPartition&);

}  // namespace pent::contact
