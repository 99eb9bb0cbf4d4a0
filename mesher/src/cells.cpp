#include "cells.h"

#include <cassert>
#include <string_view>

namespace pent::mesher {

namespace {

struct KindInfo {
    std::string_view name;
    std::string_view plural;
    int dimension;
    std::size_t corners;
};

constexpr std::array<KindInfo, kCellKinds> kKinds = {{
    {"tetrahedron", "tetrahedra", 3, 4},
    {"pyramid", "pyramids", 3, 5},
    {"prism", "prisms", 3, 6},
    {"hexahedron", "hexahedra", 3, 8},
    {"pentagonal prism", "pentagonal prisms", 3, 0},
    {"hexagonal prism", "hexagonal prisms", 3, 0},
    {"polyhedron", "polyhedra", 3, 0},
    {"triangle", "triangles", 2, 0},
    {"quadrilateral", "quadrilaterals", 2, 0},
    {"polygon", "polygons", 2, 0},
    {"line", "lines", 1, 0},
    {"point", "points", 0, 0},
}};

constexpr std::array<CellFace, 4> kTetrahedronFaces = {
    {{1, 2, 3, -1}, {0, 3, 2, -1}, {0, 1, 3, -1}, {0, 2, 1, -1}}};
constexpr std::array<CellFace, 5> kPyramidFaces = {
    {{0, 3, 2, 1}, {0, 1, 4, -1}, {1, 2, 4, -1}, {2, 3, 4, -1}, {3, 0, 4, -1}}};
constexpr std::array<CellFace, 5> kPrismFaces = {
    {{0, 2, 1, -1}, {3, 4, 5, -1}, {0, 1, 4, 3}, {1, 2, 5, 4}, {2, 0, 3, 5}}};
constexpr std::array<CellFace, 6> kHexahedronFaces = {
    {{0, 3, 2, 1}, {4, 5, 6, 7}, {0, 1, 5, 4}, {1, 2, 6, 5}, {2, 3, 7, 6}, {3, 0, 4, 7}}};

const KindInfo& info(CellKind kind) {
    return kKinds[static_cast<std::size_t>(kind)];
}

}  // namespace

int dimension_of(CellKind kind) {
    return info(kind).dimension;
}

std::size_t corners_of(CellKind kind) {
    return info(kind).corners;
}

std::span<const CellFace> faces_of(CellKind kind) {
    switch (kind) {
        case CellKind::Tetrahedron:
            return kTetrahedronFaces;
        case CellKind::Pyramid:
            return kPyramidFaces;
        case CellKind::Prism:
            return kPrismFaces;
        case CellKind::Hexahedron:
            return kHexahedronFaces;
        default:
            return {};
    }
}

std::string list_counts(const CellCounts& counts, CellKind first, CellKind last) {
    std::string text;
    for (auto i = static_cast<std::size_t>(first); i <= static_cast<std::size_t>(last); ++i) {
        if (counts[i] > 0) {
            text += (text.empty() ? "" : ", ") + std::to_string(counts[i]) + " "
                    + std::string(counts[i] == 1 ? kKinds[i].name : kKinds[i].plural);
        }
    }
    return text;
}

void CellSoup::add(CellKind kind, std::span<const std::uint32_t> nodes, std::int64_t label) {
    ++counts[static_cast<std::size_t>(kind)];
    if (dimension_of(kind) < 3) {
        return;
    }
    const std::size_t count = corners_of(kind);
    assert(nodes.size() >= count);
    kinds.push_back(kind);
    labels.push_back(label);
    corners.insert(corners.end(), nodes.begin(),
                   nodes.begin() + static_cast<std::ptrdiff_t>(count));
    curved_cells += count > 0 && nodes.size() > count ? 1 : 0;
}

}  // namespace pent::mesher
