#include "bisection.h"

#include <algorithm>
#include <array>
#include <numeric>
#include <utility>

namespace pent::mesher {

namespace {

using Cell = std::array<std::uint32_t, 5>;

// Where two sequences differ; -2 if in more than one place, -1 if nowhere.
int place_of_difference(const Cell& a, const Cell& b) {
    int found = -1;
    for (int i = 0; i < 5; ++i) {
        if (a[i] != b[i]) {
            if (found >= 0) {
                return -2;
            }
            found = i;
        }
    }
    return found;
}

// The same cell with the same children, read from its other end.
Cell reversed_of_type_0(const Cell& cell) {
    return {cell[4], cell[3], cell[2], cell[1], cell[0]};
}
Cell reversed_of_type_1(const Cell& cell) {
    return {cell[4], cell[1], cell[3], cell[2], cell[0]};
}

bool are_reflected(const Cell& a, const Cell& reversed_a, const Cell& b) {
    return place_of_difference(a, b) >= 0 || place_of_difference(reversed_a, b) >= 0;
}

constexpr std::uint32_t kMiddle = 0xFFFFFFFFU;  // of a refinement edge; no index of a vertex

// The child, of type 1, that keeps the first corner, or the last one. The new vertex has one name
// in both cells: it is where they may differ, as are the corners that the facet does not have.
Cell child(const Cell& cell, bool keeps_first) {
    return keeps_first ? Cell{cell[0], kMiddle, cell[1], cell[2], cell[3]}
                       : Cell{cell[4], kMiddle, cell[3], cell[2], cell[1]};
}

// Facet `left_out` of cell a is that of b without its corner `left_out_b`.
bool is_matching(const Cell& a, int left_out, const Cell& b, int left_out_b) {
    const bool has_a_edge = left_out != 0 && left_out != 4;
    const bool has_b_edge = left_out_b != 0 && left_out_b != 4;
    if (has_a_edge || has_b_edge) {
        return are_reflected(a, reversed_of_type_0(a), b);
    }
    const Cell child_a = child(a, left_out == 4);
    Cell child_b = child(b, left_out_b == 4);
    // The middles of two different edges are different vertices.
    child_b[1] = kMiddle - 1;
    return are_reflected(child_a, reversed_of_type_1(child_a), child_b);
}

struct Facet {
    std::array<std::uint32_t, 4> corners;  // sorted
    std::uint32_t cell;
    std::uint8_t left_out;
};

std::vector<Facet> sorted_facets(const Simplices<5>& cells) {
    std::vector<Facet> facets;
    facets.reserve(static_cast<std::size_t>(5 * cells.cols()));
    for (Eigen::Index cell = 0; cell < cells.cols(); ++cell) {
        for (int k = 0; k < 5; ++k) {
            Facet facet{{}, static_cast<std::uint32_t>(cell), static_cast<std::uint8_t>(k)};
            int next = 0;
            for (int i = 0; i < 5; ++i) {
                if (i != k) {
                    facet.corners[next++] = cells(i, cell);
                }
            }
            std::sort(facet.corners.begin(), facet.corners.end());
            facets.push_back(facet);
        }
    }
    std::sort(facets.begin(), facets.end(), [](const Facet& a, const Facet& b) {
        return a.corners != b.corners ? a.corners < b.corners : a.cell < b.cell;
    });
    return facets;
}

// Tetrahedra that share a triangle, for each tetrahedron and corner that the other does not have;
// -1 at the boundary.
std::vector<std::array<std::int64_t, 4>> neighbors_of(const Simplices<4>& cells) {
    struct Side {
        std::array<std::uint32_t, 3> corners;
        std::int64_t cell;
        int left_out;
    };
    std::vector<Side> sides;
    for (Eigen::Index cell = 0; cell < cells.cols(); ++cell) {
        for (int k = 0; k < 4; ++k) {
            Side side{
                {cells((k + 1) % 4, cell), cells((k + 2) % 4, cell), cells((k + 3) % 4, cell)},
                cell,
                k};
            std::sort(side.corners.begin(), side.corners.end());
            sides.push_back(side);
        }
    }
    std::sort(sides.begin(), sides.end(), [](const Side& a, const Side& b) {
        return a.corners != b.corners ? a.corners < b.corners : a.cell < b.cell;
    });
    std::vector<std::array<std::int64_t, 4>> neighbors(static_cast<std::size_t>(cells.cols()),
                                                       {-1, -1, -1, -1});
    for (std::size_t i = 1; i < sides.size(); ++i) {
        if (sides[i].corners == sides[i - 1].corners) {
            neighbors[sides[i].cell][sides[i].left_out] = sides[i - 1].cell;
            neighbors[sides[i - 1].cell][sides[i - 1].left_out] = sides[i].cell;
        }
    }
    return neighbors;
}

// All edges or triangles of the tetrahedra, each once by its sorted corners.
template <std::size_t Corners>
std::vector<std::array<std::uint32_t, Corners>> faces_of(
    const Simplices<4>& cells, const std::vector<std::array<int, Corners>>& places) {
    std::vector<std::array<std::uint32_t, Corners>> faces;
    for (Eigen::Index cell = 0; cell < cells.cols(); ++cell) {
        for (const std::array<int, Corners>& place : places) {
            std::array<std::uint32_t, Corners> face{};
            for (std::size_t i = 0; i < Corners; ++i) {
                face[i] = cells(place[i], cell);
            }
            std::sort(face.begin(), face.end());
            faces.push_back(face);
        }
    }
    std::sort(faces.begin(), faces.end());
    faces.erase(std::unique(faces.begin(), faces.end()), faces.end());
    return faces;
}

template <std::size_t Corners>
std::uint32_t number_of(const std::vector<std::array<std::uint32_t, Corners>>& faces,
                        std::array<std::uint32_t, Corners> face) {
    std::sort(face.begin(), face.end());
    return static_cast<std::uint32_t>(std::lower_bound(faces.begin(), faces.end(), face)
                                      - faces.begin());
}

// The points of a barycentric cut.
class Barycenters {
public:
    explicit Barycenters(const SimplexMesh<3>& mesh)
        : vertices_(mesh.vertex_count()),
          cells_(mesh.cells),
          edges_(faces_of<2>(mesh.cells, {{0, 1}, {0, 2}, {0, 3}, {1, 2}, {1, 3}, {2, 3}})),
          triangles_(faces_of<3>(mesh.cells, {{1, 2, 3}, {0, 2, 3}, {0, 1, 3}, {0, 1, 2}})) {}

    [[nodiscard]] std::uint32_t of_edge(std::uint32_t a, std::uint32_t b) const {
        return static_cast<std::uint32_t>(vertices_) + number_of<2>(edges_, {a, b});
    }
    [[nodiscard]] std::uint32_t of_triangle(std::uint32_t a,
                                            std::uint32_t b,
                                            std::uint32_t c) const {
        return static_cast<std::uint32_t>(vertices_ + static_cast<Eigen::Index>(edges_.size()))
               + number_of<3>(triangles_, {a, b, c});
    }
    [[nodiscard]] std::uint32_t of_cell(Eigen::Index cell) const {
        return static_cast<std::uint32_t>(vertices_ + static_cast<Eigen::Index>(edges_.size())
                                          + static_cast<Eigen::Index>(triangles_.size()) + cell);
    }

    // Values at the vertices, and their means at all other points.
    template <typename Matrix>
    [[nodiscard]] Matrix spread(const Matrix& values) const {
        Matrix all(values.rows(), of_cell(cells_.cols()));
        all.leftCols(vertices_) = values;
        Eigen::Index next = vertices_;
        for (const auto& edge : edges_) {
            all.col(next++) = (values.col(edge[0]) + values.col(edge[1])) / 2;
        }
        for (const auto& triangle : triangles_) {
            all.col(next++) =
                (values.col(triangle[0]) + values.col(triangle[1]) + values.col(triangle[2])) / 3;
        }
        for (Eigen::Index cell = 0; cell < cells_.cols(); ++cell) {
            all.col(next++) = (values.col(cells_(0, cell)) + values.col(cells_(1, cell))
                               + values.col(cells_(2, cell)) + values.col(cells_(3, cell)))
                              / 4;
        }
        return all;
    }

private:
    Eigen::Index vertices_;
    const Simplices<4>& cells_;
    std::vector<std::array<std::uint32_t, 2>> edges_;
    std::vector<std::array<std::uint32_t, 3>> triangles_;
};

constexpr int kPieces = 24;  // of a tetrahedron

Simplices<4> pieces_of(const SimplexMesh<3>& mesh, const Barycenters& centers) {
    Simplices<4> cells(4, kPieces * mesh.cell_count());
    Eigen::Index next = 0;
    for (Eigen::Index cell = 0; cell < mesh.cell_count(); ++cell) {
        std::array<int, 4> p = {0, 1, 2, 3};
        bool is_odd = false;
        do {
            const std::uint32_t a = mesh.cells(p[0], cell);
            const std::uint32_t b = mesh.cells(p[1], cell);
            const std::uint32_t c = mesh.cells(p[2], cell);
            std::array<std::uint32_t, 4> piece = {
                a, centers.of_edge(a, b), centers.of_triangle(a, b, c), centers.of_cell(cell)};
            int inversions = 0;
            for (int i = 0; i < 4; ++i) {
                for (int j = i + 1; j < 4; ++j) {
                    inversions += p[i] > p[j] ? 1 : 0;
                }
            }
            is_odd = inversions % 2 == 1;
            if (is_odd) {
                std::swap(piece[2], piece[3]);
            }
            std::copy(piece.begin(), piece.end(), cells.col(next++).data());
        } while (std::next_permutation(p.begin(), p.end()));
    }
    return cells;
}

template <typename Value>
std::vector<Value> repeated(const std::vector<Value>& values, int times) {
    std::vector<Value> result;
    result.reserve(values.size() * static_cast<std::size_t>(times));
    for (const Value& value : values) {
        result.insert(result.end(), static_cast<std::size_t>(times), value);
    }
    return result;
}

void cut_triangles(const MovingMesh& moving, const Barycenters& centers, MovingMesh& cut) {
    constexpr int kParts = 6;
    cut.triangles.resize(3, kParts * moving.triangles.cols());
    cut.triangle_labels = repeated(moving.triangle_labels, kParts);
    Eigen::Index next = 0;
    for (const auto& triangle : moving.triangles.colwise()) {
        std::array<int, 3> p = {0, 1, 2};
        do {
            cut.triangles.col(next++) << triangle[p[0]],
                centers.of_edge(triangle[p[0]], triangle[p[1]]),
                centers.of_triangle(triangle[0], triangle[1], triangle[2]);
        } while (std::next_permutation(p.begin(), p.end()));
    }
}

}  // namespace

std::int64_t bisection_faults(const Simplices<5>& cells) {
    const std::vector<Facet> facets = sorted_facets(cells);
    const auto cell_of = [&](const Facet& facet) {
        Cell cell{};
        std::copy_n(cells.col(facet.cell).data(), 5, cell.begin());
        return cell;
    };
    std::int64_t faults = 0;
    for (std::size_t i = 1; i < facets.size(); ++i) {
        const Facet& a = facets[i - 1];
        const Facet& b = facets[i];
        if (a.corners == b.corners) {
            faults += is_matching(cell_of(a), a.left_out, cell_of(b), b.left_out) ? 0 : 1;
        }
    }
    return faults;
}

std::optional<std::vector<std::uint8_t>> color_vertices(const SimplexMesh<3>& mesh) {
    constexpr std::uint8_t kNone = 255;
    const std::vector<std::array<std::int64_t, 4>> neighbors = neighbors_of(mesh.cells);
    std::vector<std::uint8_t> colors(static_cast<std::size_t>(mesh.vertex_count()), kNone);
    std::vector<bool> is_done(neighbors.size(), false);
    std::vector<std::int64_t> next;
    for (std::size_t start = 0; start < neighbors.size(); ++start) {
        if (is_done[start]) {
            continue;
        }
        next.push_back(static_cast<std::int64_t>(start));
        is_done[start] = true;
        while (!next.empty()) {
            const std::int64_t cell = next.back();
            next.pop_back();
            // Colors that are known from neighbors are taken over; what is left is given in order.
            std::array<bool, 4> is_used{};
            for (int i = 0; i < 4; ++i) {
                const std::uint8_t color = colors[mesh.cells(i, cell)];
                if (color != kNone && std::exchange(is_used[color], true)) {
                    return std::nullopt;
                }
            }
            for (int i = 0; i < 4; ++i) {
                std::uint8_t& color = colors[mesh.cells(i, cell)];
                if (color == kNone) {
                    color = static_cast<std::uint8_t>(
                        std::find(is_used.begin(), is_used.end(), false) - is_used.begin());
                    is_used[color] = true;
                }
            }
            for (const std::int64_t neighbor : neighbors[cell]) {
                if (neighbor >= 0 && !is_done[neighbor]) {
                    is_done[neighbor] = true;
                    next.push_back(neighbor);
                }
            }
        }
    }
    return colors;
}

MovingMesh barycentric_cut(const MovingMesh& moving) {
    const Barycenters centers(moving.base);
    MovingMesh cut;
    cut.times = moving.times;
    cut.frames = moving.frames;
    cut.cut = moving.cut;
    cut.left_out = moving.left_out;
    cut.curved_cells = moving.curved_cells;
    cut.cell_numbers = repeated(moving.cell_numbers, kPieces);
    cut.base.cells = pieces_of(moving.base, centers);
    cut.base.regions = repeated(moving.base.regions, kPieces);
    for (const Positions<3>& positions : moving.positions) {
        cut.positions.push_back(centers.spread(positions));
    }
    cut.base.positions = cut.positions.front();
    if (moving.triangles.cols() > 0) {
        cut_triangles(moving, centers, cut);
    }
    for (const MovingField& field : moving.vertex_fields) {
        MovingField all{field.name, {}};
        for (const Eigen::MatrixXd& values : field.values) {
            all.values.push_back(centers.spread(values));
        }
        cut.vertex_fields.push_back(std::move(all));
    }
    for (const MovingField& field : moving.cell_fields) {
        MovingField all{field.name, {}};
        for (const Eigen::MatrixXd& values : field.values) {
            Eigen::MatrixXd handed_down(values.rows(), kPieces * values.cols());
            for (Eigen::Index piece = 0; piece < handed_down.cols(); ++piece) {
                handed_down.col(piece) = values.col(piece / kPieces);
            }
            all.values.push_back(std::move(handed_down));
        }
        cut.cell_fields.push_back(std::move(all));
    }
    return cut;
}

}  // namespace pent::mesher
