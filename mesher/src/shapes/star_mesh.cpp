#include "star_mesh.h"

#include <pent/mesher/quality.h>

#include <Eigen/LU>

#include <algorithm>
#include <array>
#include <limits>

namespace pent::mesher {

namespace {

using Corners = Eigen::Matrix<double, 4, 5>;

// Mean ratio, with the sign of the volume.
double signed_quality(const Corners& corners) {
    const double quality = mean_ratio<4>(corners);
    if (quality > 0) {
        return quality;
    }
    Corners mirrored = corners;
    mirrored.col(0).swap(mirrored.col(1));
    return -mean_ratio<4>(mirrored);
}

bool has(const std::array<std::uint32_t, 5>& cell, std::uint32_t vertex) {
    return std::find(cell.begin(), cell.end(), vertex) != cell.end();
}

}  // namespace

StarMesh::StarMesh(SimplexMesh<4> mesh) {
    places_.resize(mesh.vertex_count());
    for (std::size_t v = 0; v < places_.size(); ++v) {
        places_[v] = mesh.positions.col(static_cast<Eigen::Index>(v));
    }
    mesh.positions.resize(4, 0);
    cells_.resize(mesh.cell_count());
    stars_.resize(places_.size());
    changes_.resize(places_.size(), last_change_);
    for (std::uint32_t c = 0; c < cell_count(); ++c) {
        for (int i = 0; i < 5; ++i) {
            cells_[c][i] = mesh.cells(i, c);
            stars_[cells_[c][i]].push_back(c);
        }
    }
}

std::vector<std::uint32_t> StarMesh::star(std::span<const std::uint32_t> simplex) const {
    std::vector<std::uint32_t> cells;
    for (const std::uint32_t c : stars_[simplex[0]]) {
        if (std::all_of(simplex.begin() + 1, simplex.end(),
                        [&](std::uint32_t vertex) { return has(cells_[c], vertex); })) {
            cells.push_back(c);
        }
    }
    return cells;
}

double StarMesh::quality(std::uint32_t cell) const {
    Corners corners;
    for (int i = 0; i < 5; ++i) {
        corners.col(i) = places_[cells_[cell][i]];
    }
    return signed_quality(corners);
}

StarQuality StarMesh::quality_if_moved(std::uint32_t vertex, const Eigen::Vector4d& place) const {
    StarQuality around;
    for (const std::uint32_t c : stars_[vertex]) {
        Corners corners;
        for (int i = 0; i < 5; ++i) {
            corners.col(i) = cells_[c][i] == vertex ? place : places_[cells_[c][i]];
        }
        const double quality = signed_quality(corners);
        around.least = std::min(around.least, quality);
        around.sum += quality;
    }
    return around;
}

Eigen::Vector4d StarMesh::quality_slope(std::uint32_t cell, std::uint32_t vertex) const {
    const std::array<std::uint32_t, 5>& corners = cells_[cell];
    Eigen::Matrix4d edges;  // from the vertex
    double squares = 0;
    int column = 0;
    for (int i = 0; i < 5; ++i) {
        if (corners[i] != vertex) {
            edges.col(column++) = places_[corners[i]] - places_[vertex];
        }
        for (int j = 0; j < i; ++j) {
            squares += (places_[corners[i]] - places_[corners[j]]).squaredNorm();
        }
    }
    // The mean ratio is det(edges)^(1/2) over the squared edges. Moving the vertex moves all edges
    // from it at once.
    const Eigen::Vector4d of_volume = -0.5 * edges.transpose().inverse() * Eigen::Vector4d::Ones();
    const Eigen::Vector4d of_edges = 2 * edges.rowwise().sum() / squares;
    return of_volume + of_edges;
}

double StarMesh::quality_if_split(std::span<const std::uint32_t> simplex,
                                  const Eigen::Vector4d& place) const {
    double least = std::numeric_limits<double>::infinity();
    for (const std::uint32_t c : star(simplex)) {
        for (const std::uint32_t replaced : simplex) {
            Corners corners;
            for (int i = 0; i < 5; ++i) {
                corners.col(i) = cells_[c][i] == replaced ? place : places_[cells_[c][i]];
            }
            least = std::min(least, signed_quality(corners));
        }
    }
    return least;
}

void StarMesh::note_change(std::span<const std::uint32_t> cells) {
    ++last_change_;
    for (const std::uint32_t c : cells) {
        for (const std::uint32_t corner : cells_[c]) {
            changes_[corner] = last_change_;
        }
    }
}

void StarMesh::move(std::uint32_t vertex, const Eigen::Vector4d& place) {
    places_[vertex] = place;
    note_change(stars_[vertex]);
}

std::uint32_t StarMesh::split(std::span<const std::uint32_t> simplex,
                              const Eigen::Vector4d& place) {
    const std::uint32_t added = vertex_count();
    places_.push_back(place);
    stars_.emplace_back();
    changes_.push_back(last_change_);
    for (const std::uint32_t c : star(simplex)) {
        const std::array<std::uint32_t, 5> old = cells_[c];
        for (std::size_t k = 0; k < simplex.size(); ++k) {
            // The first piece takes the place of the cell.
            const std::uint32_t piece = k == 0 ? c : cell_count();
            if (k > 0) {
                cells_.push_back(old);
            }
            std::replace(cells_[piece].begin(), cells_[piece].end(), simplex[k], added);
            for (const std::uint32_t vertex : old) {
                if (k > 0 && vertex != simplex[k]) {
                    stars_[vertex].push_back(piece);
                }
            }
            stars_[added].push_back(piece);
        }
        std::erase(stars_[simplex[0]], c);
    }
    note_change(stars_[added]);
    return added;
}

SimplexMesh<4> StarMesh::mesh() const {
    SimplexMesh<4> mesh;
    mesh.positions.resize(4, vertex_count());
    for (std::uint32_t v = 0; v < vertex_count(); ++v) {
        mesh.positions.col(v) = places_[v];
    }
    mesh.cells.resize(5, cell_count());
    for (std::uint32_t c = 0; c < cell_count(); ++c) {
        for (int i = 0; i < 5; ++i) {
            mesh.cells(i, c) = cells_[c][i];
        }
    }
    return mesh;
}

}  // namespace pent::mesher
