#pragma once

#include "moving_shapes.h"

#include <algorithm>
#include <array>
#include <bit>
#include <cstdint>
#include <random>
#include <set>
#include <string>
#include <utility>
#include <vector>

namespace pent::test {

/// The tetrahedra whose quantities are known: those of a box, in eighths.
inline SimplexMesh<3> base_box() {
    return kuhn_box<3>({2, 1, 1}, {2, 1, 1.5});
}

/// A number of the points that is linear in space.
inline double warmth(const Eigen::Vector3d& x) {
    return 3 + 2 * x[0] - x[1] + 0.5 * x[2];
}

/// A vector of the cells.
inline Eigen::Vector3d first_edge(const SimplexMesh<3>& mesh, Eigen::Index cell) {
    return mesh.positions.col(mesh.cells(1, cell)) - mesh.positions.col(mesh.cells(0, cell));
}

/// Where the corners of a cell are, in no order.
inline std::set<std::array<double, 3>> corners_of(const SimplexMesh<3>& mesh, Eigen::Index cell) {
    std::set<std::array<double, 3>> corners;
    for (const std::uint32_t corner : mesh.cells.col(cell)) {
        const auto x = mesh.positions.col(corner);
        corners.insert({x[0], x[1], x[2]});
    }
    return corners;
}

/// `warmth` and `place` of the points, which are linear in space, and `number` and `fiber` of the
/// cells: their numbers and first edges.
inline std::string vtk_with_fields(const SimplexMesh<3>& mesh) {
    std::string text = to_legacy_vtk(parts_of(mesh));
    text += formatted("POINT_DATA %d\nSCALARS warmth double\nLOOKUP_TABLE default\n",
                      static_cast<int>(mesh.vertex_count()));
    for (const auto& x : mesh.positions.colwise()) {
        text += formatted("%.17g\n", warmth(x));
    }
    text += "VECTORS place double\n";
    for (const auto& x : mesh.positions.colwise()) {
        text += formatted("%.17g %.17g %.17g\n", x[0], x[1], x[2]);
    }
    text += formatted("CELL_DATA %d\nSCALARS number int\nLOOKUP_TABLE default\n",
                      static_cast<int>(mesh.cell_count()));
    for (Eigen::Index cell = 0; cell < mesh.cell_count(); ++cell) {
        text += formatted("%d\n", static_cast<int>(cell));
    }
    text += "VECTORS fiber double\n";
    for (Eigen::Index cell = 0; cell < mesh.cell_count(); ++cell) {
        const Eigen::Vector3d edge = first_edge(mesh, cell);
        text += formatted("%.17g %.17g %.17g\n", edge[0], edge[1], edge[2]);
    }
    return text;
}

/// Ways in which Gmsh writes files.
struct GmshWay {
    int version = 4;   ///< 2.2 or 4.1.
    char order = 't';  ///< 't' as text, 'l' or 'b' as bytes, little-endian or big-endian.
};

/// The same of a mesh as a file of Gmsh, from its description of the format: nodes and elements in
/// no order, with numbers that have gaps; a node and two triangles that no tetrahedron needs, the
/// triangles with values of their own, the node without.
class GmshFile {
public:
    GmshFile(const SimplexMesh<3>& mesh, GmshWay way) : mesh_(mesh), way_(way) {
        std::mt19937 random(7);
        nodes_ = shuffled(mesh.vertex_count(), random);
        cells_ = shuffled(mesh.cell_count(), random);
    }

    std::string text() {
        text_ = "$MeshFormat\n" + std::string(way_.version == 2 ? "2.2" : "4.1")
                + (way_.order == 't' ? " 0 8\n" : " 1 8\n");
        if (way_.order != 't') {
            whole<std::int32_t>(1);
            text_ += '\n';
        }
        text_ += "$EndMeshFormat\n";
        way_.version == 2 ? add_mesh_2() : add_mesh_4();
        begin("NodeData", "warmth", 1, mesh_.vertex_count());
        for (const Eigen::Index v : nodes_) {
            add_values(node_number(v), {warmth(mesh_.positions.col(v))});
        }
        end("NodeData");
        begin("NodeData", "place", 3, mesh_.vertex_count());
        for (Eigen::Index v = 0; v < mesh_.vertex_count(); ++v) {
            const Eigen::Vector3d x = mesh_.positions.col(v);
            add_values(node_number(v), {x[0], x[1], x[2]});
        }
        end("NodeData");
        begin("ElementData", "number", 1, mesh_.cell_count() + 1);
        add_values(3, {-1});  // of a triangle
        for (Eigen::Index cell = 0; cell < mesh_.cell_count(); ++cell) {
            add_values(cell_number(cell), {static_cast<double>(cell)});
        }
        end("ElementData");
        begin("ElementData", "fiber", 3, mesh_.cell_count());
        for (const Eigen::Index cell : cells_) {
            const Eigen::Vector3d edge = first_edge(mesh_, cell);
            add_values(cell_number(cell), {edge[0], edge[1], edge[2]});
        }
        end("ElementData");
        return text_;
    }

private:
    static std::vector<Eigen::Index> shuffled(Eigen::Index count, std::mt19937& random) {
        std::vector<Eigen::Index> all(static_cast<std::size_t>(count));
        std::iota(all.begin(), all.end(), Eigen::Index{0});
        std::shuffle(all.begin(), all.end(), random);
        return all;
    }

    [[nodiscard]] std::int64_t node_number(Eigen::Index v) const { return 900 - 7 * v; }
    [[nodiscard]] std::int64_t cell_number(Eigen::Index cell) const { return 11 + 5 * (cell ^ 3); }

    template <typename T>
    void bytes(T value) {
        auto raw = std::bit_cast<std::array<char, sizeof(T)>>(value);
        if (way_.order == 'b') {
            std::reverse(raw.begin(), raw.end());
        }
        text_.append(raw.data(), raw.size());
    }

    template <typename T>
    void whole(std::int64_t value) {
        if (way_.order == 't') {
            text_ += std::to_string(value) + ' ';
        } else {
            bytes(static_cast<T>(value));
        }
    }

    void real(double value) {
        if (way_.order == 't') {
            text_ += formatted("%.17g ", value);
        } else {
            bytes(value);
        }
    }

    void line() {
        if (way_.order == 't') {
            text_ += '\n';
        }
    }

    void add_values(std::int64_t number, const std::vector<double>& values) {
        whole<std::int32_t>(number);
        for (const double value : values) {
            real(value);
        }
        line();
    }

    // Text in any file.
    void begin(const std::string& section,
               const std::string& name,
               int components,
               Eigen::Index count) {
        text_ += formatted("$%s\n1\n\"%s\"\n1\n0.5\n3\n0\n%d\n%d\n", section.c_str(), name.c_str(),
                           components, static_cast<int>(count));
    }

    void end(const std::string& section) { text_ += "\n$End" + section + "\n"; }

    void add_point(const Eigen::Vector3d& x) {
        for (const double coordinate : x) {
            real(coordinate);
        }
    }

    template <typename T, typename Corners>
    void add_corners(const Corners& corners) {
        for (const std::uint32_t corner : corners) {
            whole<T>(node_number(static_cast<Eigen::Index>(corner)));
        }
        line();
    }

    void add_mesh_2() {
        text_ += formatted("$Nodes\n%d\n", static_cast<int>(mesh_.vertex_count()) + 1);
        whole<std::int32_t>(5000);
        add_point({9, 9, 9});
        line();
        for (const Eigen::Index v : nodes_) {
            whole<std::int32_t>(node_number(v));
            add_point(mesh_.positions.col(v));
            line();
        }
        text_ += "\n$EndNodes\n";
        text_ += formatted("$Elements\n%d\n", static_cast<int>(mesh_.cell_count()) + 2);
        const auto add = [&](int type, std::int64_t number, const auto& corners) {
            if (way_.order == 't') {
                text_ += formatted("%d %d 2 1 1 ", static_cast<int>(number), type);
            } else {
                for (const std::int64_t one : {std::int64_t{type}, std::int64_t{1}, std::int64_t{2},
                                               number, std::int64_t{1}, std::int64_t{1}}) {
                    whole<std::int32_t>(one);
                }
            }
            add_corners<std::int32_t>(corners);
        };
        add(2, 3, std::vector<std::uint32_t>{0, 1, 2});
        for (const Eigen::Index cell : cells_) {
            add(4, cell_number(cell), mesh_.cells.col(cell));
        }
        add(2, 4000, std::vector<std::uint32_t>{1, 2, 3});
        text_ += "\n$EndElements\n";
    }

    void add_mesh_4() {
        const auto counts = [&](const std::vector<std::int64_t>& all) {
            for (const std::int64_t one : all) {
                whole<std::uint64_t>(one);
            }
            line();
        };
        const auto block = [&](int dimension, int type, Eigen::Index count) {
            for (const int one : {dimension, 1, type}) {
                whole<std::int32_t>(one);
            }
            counts({count});
        };
        text_ += "$Nodes\n";
        counts({2, mesh_.vertex_count() + 1, 1, 5000});
        block(0, 0, 1);
        counts({5000});
        add_point({9, 9, 9});
        line();
        block(3, 0, mesh_.vertex_count());
        for (const Eigen::Index v : nodes_) {
            counts({node_number(v)});
        }
        for (const Eigen::Index v : nodes_) {
            add_point(mesh_.positions.col(v));
            line();
        }
        text_ += "\n$EndNodes\n$Elements\n";
        counts({3, mesh_.cell_count() + 2, 1, 5000});
        block(2, 2, 1);
        whole<std::uint64_t>(3);
        add_corners<std::uint64_t>(std::vector<std::uint32_t>{0, 1, 2});
        block(3, 4, mesh_.cell_count());
        for (const Eigen::Index cell : cells_) {
            whole<std::uint64_t>(cell_number(cell));
            add_corners<std::uint64_t>(mesh_.cells.col(cell));
        }
        block(2, 2, 1);
        whole<std::uint64_t>(4000);
        add_corners<std::uint64_t>(std::vector<std::uint32_t>{1, 2, 3});
        text_ += "\n$EndElements\n";
    }

    const SimplexMesh<3>& mesh_;
    GmshWay way_;
    std::vector<Eigen::Index> nodes_;
    std::vector<Eigen::Index> cells_;
    std::string text_;
};

inline std::string gmsh_with_fields(const SimplexMesh<3>& mesh, GmshWay way) {
    return GmshFile(mesh, way).text();
}

}  // namespace pent::test
