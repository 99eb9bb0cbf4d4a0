#include "extract.h"
#include "half_edges.h"
#include "shell.h"

#include <pent/counted.h>
#include <pent/error.h>
#include <pent/mesher/orient.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <string>
#include <vector>

namespace pent::mesher {

namespace {

struct Neighbors {
    std::array<std::uint32_t, 3> triangle{};  // behind each side
    std::array<bool, 3> is_turned{};          // the neighbor turns the other way
};

std::vector<Neighbors> find_neighbors(const Simplices<3>& triangles) {
    std::vector<Neighbors> neighbors(triangles.cols());
    for_each_edge(sorted_half_edges(triangles), [&](auto first, auto last) {
        if (last - first != 2) {
            throw Error(
                "a surface to be oriented must be closed and manifold, but an edge of "
                "triangle "
                + std::to_string(first->triangle) + " has "
                + counted(last - first, "triangle", "triangles"));
        }
        const HalfEdge& a = *first;
        const HalfEdge& b = *std::next(first);
        neighbors[a.triangle].triangle[a.side] = b.triangle;
        neighbors[b.triangle].triangle[b.side] = a.triangle;
        const bool is_turned = a.is_forward == b.is_forward;
        neighbors[a.triangle].is_turned[a.side] = is_turned;
        neighbors[b.triangle].is_turned[b.side] = is_turned;
    });
    return neighbors;
}

constexpr int kUnknown = -1;

struct Parts {
    std::vector<int> part;   // one a triangle
    std::vector<bool> flip;  // one a triangle
    int count = 0;
};

// Walks over each part from its first triangle, and turns all others to agree with it.
Parts agree(const std::vector<Neighbors>& neighbors) {
    Parts parts{std::vector<int>(neighbors.size(), kUnknown),
                std::vector<bool>(neighbors.size(), false)};
    std::vector<std::uint32_t> open;
    for (std::uint32_t seed = 0; seed < neighbors.size(); ++seed) {
        if (parts.part[seed] != kUnknown) {
            continue;
        }
        parts.part[seed] = parts.count;
        open.push_back(seed);
        while (!open.empty()) {
            const std::uint32_t t = open.back();
            open.pop_back();
            for (int side = 0; side < 3; ++side) {
                const std::uint32_t other = neighbors[t].triangle[side];
                const bool flip = parts.flip[t] != neighbors[t].is_turned[side];
                if (parts.part[other] == kUnknown) {
                    parts.part[other] = parts.count;
                    parts.flip[other] = flip;
                    open.push_back(other);
                } else if (parts.flip[other] != flip) {
                    throw Error("the surface has one side only (as a Klein bottle) at triangle "
                                + std::to_string(other) + "; it bounds no body");
                }
            }
        }
        ++parts.count;
    }
    return parts;
}

void flip(Simplices<3>& triangles, Eigen::Index t) {
    std::swap(triangles(1, t), triangles(2, t));
}

}  // namespace

Oriented orient(Surface surface) {
    const Parts parts = agree(find_neighbors(surface.triangles));
    std::vector<bool> is_flipped = parts.flip;
    for (Eigen::Index t = 0; t < surface.triangle_count(); ++t) {
        if (is_flipped[t]) {
            flip(surface.triangles, t);
        }
    }
    std::vector<Shell> shells;
    std::vector<std::vector<std::uint32_t>> members(parts.count);
    for (std::uint32_t t = 0; t < surface.triangle_count(); ++t) {
        members[parts.part[t]].push_back(t);
    }
    for (const std::vector<std::uint32_t>& triangles : members) {
        const Shell& shell = shells.emplace_back(extract(surface, triangles));
        if (std::abs(shell.volume()) < 1e-14 * std::pow(shell.box().diagonal().norm(), 3)) {
            throw Error("component " + std::to_string(shells.size() - 1)
                        + " of the surface is flat: it encloses no volume");
        }
    }
    Oriented result;
    result.components = parts.count;
    std::vector<bool> flip_shell(shells.size());
    for (std::size_t i = 0; i < shells.size(); ++i) {
        const Eigen::Vector3d point = surface.points.col(surface.triangles(0, members[i].front()));
        int depth = 0;
        for (std::size_t j = 0; j < shells.size(); ++j) {
            depth += j != i && shells[j].is_around(point) ? 1 : 0;
        }
        const bool is_cavity = depth % 2 == 1;
        result.cavities += is_cavity ? 1 : 0;
        flip_shell[i] = (shells[i].volume() < 0) != is_cavity;
    }
    for (Eigen::Index t = 0; t < surface.triangle_count(); ++t) {
        if (flip_shell[parts.part[t]]) {
            flip(surface.triangles, t);
            is_flipped[t] = !is_flipped[t];
        }
    }
    result.flipped_triangles = std::count(is_flipped.begin(), is_flipped.end(), true);
    result.surface = std::move(surface);
    return result;
}

}  // namespace pent::mesher
