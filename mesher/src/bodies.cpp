#include "extract.h"
#include "generators.h"
#include "half_edges.h"
#include "shell.h"
#include "union_find.h"

#include <limits>
#include <map>
#include <utility>

namespace pent::mesher {

namespace {

std::vector<std::vector<std::uint32_t>> components_of(const Surface& surface) {
    UnionFind parts(surface.triangle_count());
    for_each_edge(sorted_half_edges(surface.triangles), [&](auto first, auto last) {
        for (auto other = std::next(first); other != last; ++other) {
            parts.join(first->triangle, other->triangle);
        }
    });
    std::map<std::uint32_t, std::vector<std::uint32_t>> members;
    for (std::uint32_t t = 0; t < surface.triangle_count(); ++t) {
        members[parts.find(t)].push_back(t);
    }
    std::vector<std::vector<std::uint32_t>> components;
    for (auto& [root, triangles] : members) {
        components.push_back(std::move(triangles));
    }
    return components;
}

}  // namespace

std::vector<Surface> bodies_of(const Surface& surface) {
    std::vector<std::vector<std::uint32_t>> outer;
    std::vector<std::vector<std::uint32_t>> cavities;
    std::vector<Shell> shells;
    for (std::vector<std::uint32_t>& component : components_of(surface)) {
        Shell shell(extract(surface, component));
        if (shell.volume() > 0) {
            outer.push_back(std::move(component));
            shells.push_back(std::move(shell));
        } else {
            cavities.push_back(std::move(component));
        }
    }
    // A cavity belongs to the smallest shell around it.
    for (const std::vector<std::uint32_t>& cavity : cavities) {
        const Eigen::Vector3d point = surface.points.col(surface.triangles(0, cavity.front()));
        std::size_t owner = 0;
        double smallest = std::numeric_limits<double>::infinity();
        for (std::size_t i = 0; i < shells.size(); ++i) {
            if (shells[i].volume() < smallest && shells[i].is_around(point)) {
                owner = i;
                smallest = shells[i].volume();
            }
        }
        outer[owner].insert(outer[owner].end(), cavity.begin(), cavity.end());
    }
    std::vector<Surface> bodies;
    for (const std::vector<std::uint32_t>& triangles : outer) {
        bodies.push_back(extract(surface, triangles));
    }
    return bodies;
}

}  // namespace pent::mesher
