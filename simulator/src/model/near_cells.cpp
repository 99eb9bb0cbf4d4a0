#include "model/near_cells.h"

#include <pent/dimensions.h>
#include <pent/simulator/mesh_parts.h>

#include <algorithm>
#include <span>
#include <utility>

namespace pent::simulator {

bool do_terms_couple_anything(const Scene& scene) {
    return scene.contact.has_value() || !scene.attachments.empty();
}

bool NeededCells::is_near(std::span<const std::uint32_t> corners) const {
    return std::any_of(corners.begin(), corners.end(), is_own_);
}

void NeededCells::see(std::span<const std::uint32_t> corners, std::uint32_t parent) {
    if (!is_near(corners)) {
        return;
    }
    if (kind_ == ElementKind::Quadratic) {
        parents_.insert(parent);
    } else if (kind_ == ElementKind::Smoothed) {
        for (const std::uint32_t corner : corners) {
            if (corner < is_near_vertex_.size()) {  // else the mesh is refused later
                is_near_vertex_[corner] = true;
            }
        }
    }
}

bool NeededCells::has(std::span<const std::uint32_t> corners, std::uint32_t parent) const {
    switch (kind_) {
        case ElementKind::Quadratic:
            return parents_.find(parent) != parents_.end();
        case ElementKind::Smoothed:
            return std::count_if(corners.begin(), corners.end(),
                                 [&](std::uint32_t corner) {
                                     return corner < is_near_vertex_.size()
                                            && is_near_vertex_[corner];
                                 })
                   > 1;
        case ElementKind::Linear:
            break;
    }
    return is_near(corners);
}

namespace {

template <int Dim>
std::span<const std::uint32_t> corners_of(const Bodies<Dim>& bodies, Eigen::Index cell) {
    return {bodies.cells().col(cell).data(), Dim + 1};
}

template <int Dim>
std::uint32_t parent_of(const Bodies<Dim>& bodies, Eigen::Index cell) {
    const std::vector<std::uint32_t>& parents = bodies.quadratic.parents;
    return parents.empty() ? 0 : parents[static_cast<std::size_t>(cell)];
}

// Drops quadratic cells that no kept cell is a child of, and numbers the others anew.
template <int Dim>
void keep_parents(QuadraticCells<Dim>& quadratic) {
    std::vector<std::uint32_t> places(static_cast<std::size_t>(quadratic.nodes.cols()), 0);
    for (const std::uint32_t parent : quadratic.parents) {
        places[parent] = 1;
    }
    std::uint32_t next = 0;
    for (CellRange& range : quadratic.ranges) {
        const Eigen::Index begin = next;
        for (Eigen::Index simplex = range.begin; simplex < range.end; ++simplex) {
            std::uint32_t& place = places[static_cast<std::size_t>(simplex)];
            if (place != 0) {
                quadratic.nodes.col(next) = quadratic.nodes.col(simplex);
                place = next++;
            }
        }
        range.begin = begin;
        range.end = next;
    }
    quadratic.nodes.conservativeResize(Eigen::NoChange, next);
    for (std::uint32_t& parent : quadratic.parents) {
        parent = places[parent];
    }
}

}  // namespace

template <int Dim>
void keep_near_cells(ElementKind kind, Bodies<Dim>& bodies) {
    NeededCells needed(kind, static_cast<std::size_t>(bodies.vertex_count()),
                       [&](std::uint32_t vertex) { return bodies.sharing.owns(vertex); });
    for (Eigen::Index cell = 0; needed.has_to_see_all() && cell < bodies.cells().cols(); ++cell) {
        needed.see(corners_of(bodies, cell), parent_of(bodies, cell));
    }
    if (!bodies.joined_cells) {
        bodies.joined_cells = bodies.meshes.front().cells;
    }
    Simplices<Dim + 1>& cells = *bodies.joined_cells;
    std::vector<std::uint32_t> mesh_cells;
    std::vector<Eigen::Index> first_cell(bodies.first_cell.size(), 0);
    std::vector<std::uint32_t>& parents = bodies.quadratic.parents;
    Eigen::Index next = 0;
    for (CellRange& range : bodies.ranges) {
        const Eigen::Index begin = next;
        for (Eigen::Index cell = range.begin; cell < range.end; ++cell) {
            const std::uint32_t parent = parent_of(bodies, cell);
            if (!needed.has(corners_of(bodies, cell), parent)) {
                continue;
            }
            mesh_cells.push_back(bodies.mesh_cell(range.body, cell));
            if (!parents.empty()) {
                parents[static_cast<std::size_t>(next)] = parent;
            }
            cells.col(next++) = cells.col(cell);
        }
        range.begin = begin;
        range.end = next;
        first_cell[range.body + 1] = next;
    }
    cells.conservativeResize(Eigen::NoChange, next);
    mesh_cells.shrink_to_fit();
    bodies.mesh_cells = std::move(mesh_cells);
    bodies.first_cell = std::move(first_cell);
    if (!parents.empty()) {
        parents.resize(static_cast<std::size_t>(next));
        keep_parents(bodies.quadratic);
    }
}

#define PENT_INSTANTIATE(Dim) template void keep_near_cells(ElementKind, Bodies<Dim>&);
PENT_FOR_EACH_DIMENSION(PENT_INSTANTIATE)
#undef PENT_INSTANTIATE

}  // namespace pent::simulator
