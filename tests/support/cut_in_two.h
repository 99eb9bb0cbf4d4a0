#pragma once

#include <pent/simplex_mesh.h>

#include <algorithm>
#include <array>
#include <map>
#include <utility>

namespace pent::test {

/// The mesh with every edge cut in two, each cell with the number of the one it lies in as its
/// parent: what pent-mesh --quadratic makes, written down from [edelsbrunner2000, section 2].
///
/// With corners v0 .. vDim by increasing number, each of the 2^Dim cells is a way from the point
/// (v0, vp) to the point (vp, vDim), at every step of which one of the two goes on to the next
/// corner; (va, vb) is the middle between, and (va, va) a corner.
template <int Dim>
[[nodiscard]] SimplexMesh<Dim> cut_in_two(const SimplexMesh<Dim>& mesh) {
    using Edge = std::pair<std::uint32_t, std::uint32_t>;
    SimplexMesh<Dim> fine = mesh;
    fine.cells.resize(Dim + 1, mesh.cell_count() << Dim);
    fine.regions.clear();
    for (std::uint32_t& layer : fine.layers) {
        layer *= 2;
    }
    std::map<Edge, std::uint32_t> middles;
    std::map<Edge, std::uint32_t> columns;  // of middles between columns
    const auto columns_before = static_cast<std::uint32_t>(mesh.vertex_count());
    const auto middle = [&](std::uint32_t a, std::uint32_t b) {
        const auto number = static_cast<std::uint32_t>(mesh.vertex_count()
                                                       + static_cast<Eigen::Index>(middles.size()));
        const auto [place, is_new] = middles.try_emplace({a, b}, number);
        if (is_new) {
            fine.positions.conservativeResize(Dim, number + 1);
            fine.positions.col(number) = (mesh.positions.col(a) + mesh.positions.col(b)) / 2;
        }
        if (is_new && !mesh.columns.empty()) {
            const Edge names = std::minmax(mesh.columns[a], mesh.columns[b]);
            const auto fresh = columns_before + static_cast<std::uint32_t>(columns.size());
            fine.columns.push_back(names.first == names.second
                                       ? names.first
                                       : columns.try_emplace(names, fresh).first->second);
            fine.layers.push_back(mesh.layers[a] + mesh.layers[b]);
        }
        return place->second;
    };
    for (Eigen::Index cell = 0; cell < fine.cell_count(); ++cell) {
        const Eigen::Index parent = cell >> Dim;
        std::array<std::uint32_t, Dim + 1> corners{};
        std::copy_n(mesh.cells.col(parent).data(), Dim + 1, corners.begin());
        std::sort(corners.begin(), corners.end());
        std::size_t low = 0;
        std::size_t high = 0;
        for (int step = 0; step < Dim; ++step) {
            high += static_cast<std::size_t>(cell >> step & 1);
        }
        for (int k = 0; k <= Dim; ++k) {
            fine.cells(k, cell) = low == high ? corners[low] : middle(corners[low], corners[high]);
            ++((cell >> k & 1) != 0 ? low : high);
        }
        if (cell_volume<Dim>(fine.positions, fine.cells, cell) < 0) {
            std::swap(fine.cells(Dim - 1, cell), fine.cells(Dim, cell));
        }
        fine.parents.push_back(static_cast<std::uint32_t>(parent));
        if (!mesh.regions.empty()) {
            fine.regions.push_back(mesh.regions[static_cast<std::size_t>(parent)]);
        }
    }
    return fine;
}

}  // namespace pent::test
