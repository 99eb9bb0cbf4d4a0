#include "extract.h"
#include "generators.h"
#include "half_edges.h"
#include "union_find.h"

#include <pent/mesher/orient.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <map>

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
    for (std::vector<std::uint32_t>& component : components_of(surface)) {
        const bool is_outer = enclosed_volume(extract(surface, component)) > 0;
        (is_outer ? outer : cavities).push_back(std::move(component));
    }
    std::vector<Surface> shells;
    for (const std::vector<std::uint32_t>& triangles : outer) {
        shells.push_back(extract(surface, triangles));
    }
    // A cavity belongs to the smallest shell around it.
    for (const std::vector<std::uint32_t>& cavity : cavities) {
        const Eigen::Vector3d point = surface.points.col(surface.triangles(0, cavity.front()));
        std::size_t owner = 0;
        double smallest = std::numeric_limits<double>::infinity();
        for (std::size_t i = 0; i < shells.size(); ++i) {
            const double volume = enclosed_volume(shells[i]);
            if (volume < smallest && winding_number(shells[i], point) > 0.5) {
                owner = i;
                smallest = volume;
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
