#include <pent/error.h>
#include <pent/mesher/shapes.h>

#include <algorithm>
#include <bit>
#include <cmath>
#include <limits>
#include <numbers>
#include <numeric>
#include <string>
#include <vector>

namespace pent::mesher {

namespace {

// A simplex of the unit cube: each corner a set of axes along which it is at 1.
template <int Dim>
using CubeSimplex = std::array<unsigned, Dim + 1>;

template <int Dim>
std::vector<CubeSimplex<Dim>> cut_along_paths() {
    std::array<unsigned, Dim> axes{};
    std::iota(axes.begin(), axes.end(), 0U);
    std::vector<CubeSimplex<Dim>> simplices;
    do {
        CubeSimplex<Dim> simplex{};
        for (int i = 0; i < Dim; ++i) {
            simplex[i + 1] = simplex[i] | (1U << axes[i]);
        }
        simplices.push_back(simplex);
    } while (std::next_permutation(axes.begin(), axes.end()));
    return simplices;
}

// What is left between the corners cut off has the even corners: in the plane a segment, in space a
// tetrahedron, in 4D a cross-polytope, cut in eight around the diagonal 0000 - 1111.
template <int Dim>
std::vector<CubeSimplex<Dim>> middle_simplices() {
    if constexpr (Dim == 3) {
        return {{0b000, 0b011, 0b101, 0b110}};
    } else if constexpr (Dim == 4) {
        std::vector<CubeSimplex<4>> simplices;
        for (unsigned choice = 0; choice < 8; ++choice) {
            CubeSimplex<4> simplex = {0b0000, 0b1111};
            for (unsigned pair = 0; pair < 3; ++pair) {
                const unsigned corner = 0b0001U | (0b0010U << pair);
                simplex[pair + 2] = (choice >> pair & 1U) == 0 ? corner : corner ^ 0b1111U;
            }
            simplices.push_back(simplex);
        }
        return simplices;
    } else {
        return {};
    }
}

template <int Dim>
std::vector<CubeSimplex<Dim>> cut_off_corners() {
    std::vector<CubeSimplex<Dim>> simplices = middle_simplices<Dim>();
    for (unsigned corner = 0; corner < 1U << Dim; ++corner) {
        if (std::popcount(corner) % 2 == 1) {
            CubeSimplex<Dim> simplex{};
            simplex[0] = corner;
            for (int axis = 0; axis < Dim; ++axis) {
                simplex[axis + 1] = corner ^ (1U << axis);
            }
            simplices.push_back(simplex);
        }
    }
    return simplices;
}

template <int Dim>
void check_box(const std::array<int, Dim>& count, const std::array<double, Dim>& size) {
    double points = 1;
    for (int axis = 0; axis < Dim; ++axis) {
        if (count[axis] < 1) {
            throw Error("a box of " + std::to_string(count[axis]) + " cubes along " + "xyzw"[axis]
                        + "; expected 1 or more");
        }
        if (!(size[axis] > 0) || !std::isfinite(size[axis])) {
            throw Error("a box of " + std::to_string(size[axis]) + " m along " + "xyzw"[axis]
                        + "; expected a finite length above 0");
        }
        points *= count[axis] + 1.0;
    }
    if (points > std::numeric_limits<std::uint32_t>::max()) {
        throw Error("a box of more than 4294967295 vertices; ask for fewer cubes");
    }
}

template <int Dim>
class Grid {
public:
    explicit Grid(const std::array<int, Dim>& count) : count_(count) {
        stride_[0] = 1;
        for (int axis = 0; axis < Dim; ++axis) {
            stride_[axis + 1] = stride_[axis] * (count[axis] + 1);
        }
    }

    [[nodiscard]] Eigen::Index vertices() const { return stride_[Dim]; }
    [[nodiscard]] Eigen::Index cubes() const {
        return std::accumulate(count_.begin(), count_.end(), Eigen::Index{1},
                               std::multiplies<Eigen::Index>());
    }

    // Where a vertex is, in cubes.
    [[nodiscard]] Eigen::Index step(Eigen::Index vertex, int axis) const {
        return vertex / stride_[axis] % (count_[axis] + 1);
    }

    // The lowest corner of a cube.
    [[nodiscard]] Eigen::Index corner(Eigen::Index cube) const {
        Eigen::Index vertex = 0;
        for (int axis = 0; axis < Dim; ++axis) {
            vertex += cube % count_[axis] * stride_[axis];
            cube /= count_[axis];
        }
        return vertex;
    }

    [[nodiscard]] Eigen::Index along(unsigned axes) const {
        Eigen::Index offset = 0;
        for (int axis = 0; axis < Dim; ++axis) {
            offset += (axes >> axis & 1U) != 0 ? stride_[axis] : 0;
        }
        return offset;
    }

private:
    std::array<int, Dim> count_;
    std::array<Eigen::Index, Dim + 1> stride_{};
};

// The axes along which a cube has an odd place: mirrored there, it fits its neighbors.
template <int Dim>
unsigned odd_axes(const Grid<Dim>& grid, Eigen::Index corner) {
    unsigned axes = 0;
    for (int axis = 0; axis < Dim; ++axis) {
        axes |= static_cast<unsigned>(grid.step(corner, axis) % 2) << axis;
    }
    return axes;
}

// The corners of a regular icosahedron, and its faces, counterclockwise from outside.
constexpr double kGolden = std::numbers::phi;
constexpr std::array<std::array<double, 3>, 12> kCorners = {{{-1, kGolden, 0},
                                                             {1, kGolden, 0},
                                                             {-1, -kGolden, 0},
                                                             {1, -kGolden, 0},
                                                             {0, -1, kGolden},
                                                             {0, 1, kGolden},
                                                             {0, -1, -kGolden},
                                                             {0, 1, -kGolden},
                                                             {kGolden, 0, -1},
                                                             {kGolden, 0, 1},
                                                             {-kGolden, 0, -1},
                                                             {-kGolden, 0, 1}}};
constexpr std::array<std::array<int, 3>, 20> kFaces = {
    {{0, 11, 5},  {0, 5, 1},  {0, 1, 7},  {0, 7, 10}, {0, 10, 11}, {1, 5, 9}, {5, 11, 4},
     {11, 10, 2}, {10, 7, 6}, {7, 1, 8},  {3, 9, 4},  {3, 4, 2},   {3, 2, 6}, {3, 6, 8},
     {3, 8, 9},   {4, 9, 5},  {2, 4, 11}, {6, 2, 10}, {8, 6, 7},   {9, 8, 1}}};

// Point of face `face` with barycentric steps i, j, f - i - j. Two faces see a point of their
// common edge alike to the last bit: the sum runs over corners in the order of their numbers.
Eigen::Vector3d face_point(int face, int i, int j, int frequency) {
    std::array<std::pair<int, int>, 3> weights = {
        {{kFaces[face][0], frequency - i - j}, {kFaces[face][1], i}, {kFaces[face][2], j}}};
    std::sort(weights.begin(), weights.end());
    Eigen::Vector3d point = Eigen::Vector3d::Zero();
    for (const auto& [corner, weight] : weights) {
        point += weight * Eigen::Map<const Eigen::Vector3d>(kCorners[corner].data());
    }
    return point.normalized();
}

}  // namespace

template <int Dim>
SimplexMesh<Dim> box(const std::array<int, Dim>& count,
                     const std::array<double, Dim>& size,
                     CubeCut cut) {
    check_box<Dim>(count, size);
    const Grid<Dim> grid(count);
    const std::vector<CubeSimplex<Dim>> simplices =
        cut == CubeCut::Paths ? cut_along_paths<Dim>() : cut_off_corners<Dim>();
    SimplexMesh<Dim> mesh;
    mesh.positions.resize(Dim, grid.vertices());
    for (Eigen::Index v = 0; v < grid.vertices(); ++v) {
        for (int axis = 0; axis < Dim; ++axis) {
            mesh.positions(axis, v) =
                size[axis] * static_cast<double>(grid.step(v, axis)) / count[axis];
        }
    }
    mesh.cells.resize(Dim + 1, grid.cubes() * static_cast<Eigen::Index>(simplices.size()));
    Eigen::Index cell = 0;
    for (Eigen::Index cube = 0; cube < grid.cubes(); ++cube) {
        const Eigen::Index corner = grid.corner(cube);
        const unsigned mirror = cut == CubeCut::Corners ? odd_axes(grid, corner) : 0;
        for (const CubeSimplex<Dim>& simplex : simplices) {
            for (int i = 0; i <= Dim; ++i) {
                mesh.cells(i, cell) =
                    static_cast<std::uint32_t>(corner + grid.along(simplex[i] ^ mirror));
            }
            if (cell_volume<Dim>(mesh.positions, mesh.cells, cell) < 0) {
                std::swap(mesh.cells(Dim - 1, cell), mesh.cells(Dim, cell));
            }
            ++cell;
        }
    }
    return mesh;
}

Surface sphere(int frequency) {
    if (frequency < 1 || frequency > 1000) {
        throw Error("a sphere of frequency " + std::to_string(frequency) + "; expected 1 to 1000");
    }
    std::vector<Eigen::Vector3d> points;
    std::vector<std::uint32_t> corners;
    for (int face = 0; face < 20; ++face) {
        const auto name = [&, first = points.size()](int i, int j) {
            // Row i holds the points j = 0 to frequency - i.
            return static_cast<std::uint32_t>(first + i * (frequency + 1) - i * (i - 1) / 2 + j);
        };
        for (int i = 0; i <= frequency; ++i) {
            for (int j = 0; i + j <= frequency; ++j) {
                points.push_back(face_point(face, i, j, frequency));
                if (i + j < frequency) {
                    corners.insert(corners.end(), {name(i, j), name(i + 1, j), name(i, j + 1)});
                }
                if (i + j + 1 < frequency) {
                    corners.insert(corners.end(),
                                   {name(i + 1, j), name(i + 1, j + 1), name(i, j + 1)});
                }
            }
        }
    }
    Positions<3> all(3, static_cast<Eigen::Index>(points.size()));
    for (std::size_t i = 0; i < points.size(); ++i) {
        all.col(static_cast<Eigen::Index>(i)) = points[i];
    }
    return weld(all, Eigen::Map<const Simplices<3>>(corners.data(), 3,
                                                    static_cast<Eigen::Index>(corners.size() / 3)))
        .surface;
}

SimplexMesh<3> ball(int frequency) {
    const Surface surface = sphere(frequency);
    SimplexMesh<3> mesh;
    mesh.positions.resize(3, surface.point_count() + 1);
    mesh.positions << surface.points, Eigen::Vector3d::Zero();
    mesh.cells.resize(4, surface.triangle_count());
    mesh.cells.row(0).setConstant(static_cast<std::uint32_t>(surface.point_count()));
    mesh.cells.bottomRows<3>() = surface.triangles;
    return mesh;
}

template SimplexMesh<2> box<2>(const std::array<int, 2>&, const std::array<double, 2>&, CubeCut);
template SimplexMesh<3> box<3>(const std::array<int, 3>&, const std::array<double, 3>&, CubeCut);
template SimplexMesh<4> box<4>(const std::array<int, 4>&, const std::array<double, 4>&, CubeCut);

}  // namespace pent::mesher
