#include <pent/error.h>
#include <pent/mesher/subdivide.h>

#include <algorithm>
#include <array>
#include <cassert>
#include <limits>
#include <map>
#include <numeric>
#include <string>
#include <utility>
#include <vector>

namespace pent::mesher {

namespace {

// The subdivision of one simplex v0..vDim, the same for all: its points are the whole numbers
// k >= x1 >= ... >= xDim >= 0, and its cells those of the grid of unit cubes cut along paths. The
// weight of vi in a point is x(i) - x(i+1), with x0 = k.
template <int Dim>
struct Pattern {
    std::vector<std::array<int, Dim + 1>> weights;  // of each point, adding to k
    std::vector<std::array<int, Dim + 1>> cells;    // points of each cell
    std::vector<bool> is_odd;                       // cell turned over
};

template <int Dim>
using Steps = std::array<int, Dim>;

template <int Dim>
bool is_inside(const Steps<Dim>& x, int k) {
    int above = k;
    for (const int value : x) {
        if (value > above) {
            return false;
        }
        above = value;
    }
    return x[Dim - 1] >= 0;
}

// Points in lexicographic order, so that they can be found again.
template <int Dim>
std::vector<Steps<Dim>> points_of(int k) {
    std::vector<Steps<Dim>> points;
    Steps<Dim> x{};
    while (true) {
        if (is_inside<Dim>(x, k)) {
            points.push_back(x);
        }
        int axis = Dim - 1;
        while (axis >= 0 && x[axis] == k) {
            x[axis--] = 0;
        }
        if (axis < 0) {
            return points;
        }
        ++x[axis];
    }
}

template <std::size_t Size>
bool is_odd_permutation(const std::array<int, Size>& permutation) {
    bool is_odd = false;
    for (std::size_t i = 0; i < Size; ++i) {
        for (std::size_t j = i + 1; j < Size; ++j) {
            is_odd = is_odd != (permutation[i] > permutation[j]);
        }
    }
    return is_odd;
}

template <int Dim>
Pattern<Dim> pattern_for(int k) {
    const std::vector<Steps<Dim>> points = points_of<Dim>(k);
    Pattern<Dim> pattern;
    for (const Steps<Dim>& x : points) {
        std::array<int, Dim + 1> weights{};
        for (int i = 0; i <= Dim; ++i) {
            weights[i] = (i == 0 ? k : x[i - 1]) - (i == Dim ? 0 : x[i]);
        }
        pattern.weights.push_back(weights);
    }
    std::array<int, Dim> axes{};
    std::iota(axes.begin(), axes.end(), 0);
    for (const Steps<Dim>& start : points) {
        std::sort(axes.begin(), axes.end());
        do {
            std::array<int, Dim + 1> cell{};
            Steps<Dim> x = start;
            bool is_whole = true;
            for (int i = 0; i <= Dim && is_whole; ++i) {
                is_whole = is_inside<Dim>(x, k);
                cell[i] = static_cast<int>(std::lower_bound(points.begin(), points.end(), x)
                                           - points.begin());
                if (i < Dim) {
                    ++x[axes[i]];
                }
            }
            if (is_whole) {
                pattern.cells.push_back(cell);
                pattern.is_odd.push_back(is_odd_permutation(axes));
            }
        } while (std::next_permutation(axes.begin(), axes.end()));
    }
    return pattern;
}

// A point of the finer mesh by its name: vertices with weights above 0, in the order of numbers.
template <int Dim>
struct NamedPoint {
    std::array<std::uint64_t, Dim + 1> name{};  // vertex and weight; 0 behind the last
    std::uint64_t place = 0;                    // in the list of all points of all cells

    [[nodiscard]] bool is_same(const NamedPoint& other) const { return name == other.name; }
    [[nodiscard]] bool operator<(const NamedPoint& other) const {
        return name != other.name ? name < other.name : place < other.place;
    }
};

template <int Dim>
std::array<std::uint32_t, Dim + 1> sorted_corners(const SimplexMesh<Dim>& mesh,
                                                  Eigen::Index cell,
                                                  bool& is_odd) {
    std::array<std::uint32_t, Dim + 1> corners{};
    std::copy_n(mesh.cells.col(cell).data(), Dim + 1, corners.begin());
    is_odd = false;
    for (int i = 1; i <= Dim; ++i) {
        for (int j = i; j > 0 && corners[j] < corners[j - 1]; --j) {
            std::swap(corners[j], corners[j - 1]);
            is_odd = !is_odd;
        }
    }
    return corners;
}

template <int Dim>
std::vector<NamedPoint<Dim>> name_points(const SimplexMesh<Dim>& mesh,
                                         const Pattern<Dim>& pattern) {
    std::vector<NamedPoint<Dim>> points;
    points.reserve(mesh.cell_count() * pattern.weights.size());
    for (Eigen::Index cell = 0; cell < mesh.cell_count(); ++cell) {
        bool is_odd = false;
        const auto corners = sorted_corners(mesh, cell, is_odd);
        for (const auto& weights : pattern.weights) {
            NamedPoint<Dim> point;
            point.place = points.size();
            int parts = 0;
            for (int i = 0; i <= Dim; ++i) {
                if (weights[i] > 0) {
                    point.name[parts++] =
                        (std::uint64_t{corners[i]} << 32U) | static_cast<std::uint32_t>(weights[i]);
                }
            }
            points.push_back(point);
        }
    }
    return points;
}

constexpr std::uint32_t kUnnamed = std::numeric_limits<std::uint32_t>::max();

// The number of each point of each cell: old vertices keep theirs, others by first appearance.
template <int Dim>
std::vector<std::uint32_t> number_points(const SimplexMesh<Dim>& mesh,
                                         std::vector<NamedPoint<Dim>> points,
                                         std::vector<std::uint64_t>& first_places) {
    std::sort(points.begin(), points.end());
    std::vector<std::uint64_t> first(points.size());  // the place where a point appears first
    for (std::size_t i = 0; i < points.size(); ++i) {
        const bool is_new = i == 0 || !points[i].is_same(points[i - 1]);
        first[points[i].place] = is_new ? points[i].place : first[points[i - 1].place];
    }
    std::vector<std::uint32_t> numbers(points.size(), kUnnamed);
    for (const NamedPoint<Dim>& point : points) {
        if (point.name[1] == 0) {
            numbers[point.place] = static_cast<std::uint32_t>(point.name[0] >> 32U);
        }
    }
    auto next = static_cast<std::uint64_t>(mesh.vertex_count());
    for (std::size_t place = 0; place < first.size(); ++place) {
        if (numbers[place] != kUnnamed) {
            continue;
        }
        if (first[place] == place) {
            first_places.push_back(place);
            if (next >= kUnnamed) {
                // GCOVR_EXCL_START: a mesh of a hundred gigabytes
                throw Error("a subdivision to more than 4294967295 vertices; use a smaller factor");
                // GCOVR_EXCL_STOP
            }
            numbers[place] = static_cast<std::uint32_t>(next++);
        } else {
            numbers[place] = numbers[first[place]];
        }
    }
    return numbers;
}

// A point of the finer mesh that is no vertex of the coarse one.
template <int Dim>
struct NewPoint {
    std::array<std::uint32_t, Dim + 1> corners;  // of a cell it lies in, increasing
    std::array<int, Dim + 1> weights;            // of each, adding to k
};

template <int Dim>
std::vector<NewPoint<Dim>> new_points(const SimplexMesh<Dim>& mesh,
                                      const Pattern<Dim>& pattern,
                                      const std::vector<std::uint64_t>& first_places) {
    std::vector<NewPoint<Dim>> points;
    for (const std::uint64_t place : first_places) {
        bool is_odd = false;
        points.push_back(
            {sorted_corners(mesh, static_cast<Eigen::Index>(place / pattern.weights.size()),
                            is_odd),
             pattern.weights[place % pattern.weights.size()]});
    }
    return points;
}

// What vertices have, a column each, and linear between them what new points get.
template <int Dim>
Eigen::MatrixXd spread(const Eigen::MatrixXd& values,
                       const std::vector<NewPoint<Dim>>& points,
                       int k) {
    Eigen::MatrixXd all(values.rows(), values.cols() + static_cast<Eigen::Index>(points.size()));
    all.leftCols(values.cols()) = values;
    Eigen::Index next = values.cols();
    for (const NewPoint<Dim>& point : points) {
        Eigen::VectorXd sum = Eigen::VectorXd::Zero(values.rows());
        for (int c = 0; c <= Dim; ++c) {
            sum += point.weights[c] * values.col(point.corners[c]);
        }
        all.col(next++) = sum / k;
    }
    return all;
}

// What cells have, for the cells of each, which follow one another.
Eigen::MatrixXd repeat(const Eigen::MatrixXd& values, Eigen::Index children) {
    Eigen::MatrixXd all(values.rows(), values.cols() * children);
    for (Eigen::Index cell = 0; cell < all.cols(); ++cell) {
        all.col(cell) = values.col(cell / children);
    }
    return all;
}

// Where mesh has columns and layers: a vertex keeps its column and is in layer k times its own. A
// new point is in the column that the columns of its corners name by their weights, as a point of
// the base mesh is named by vertices, and in the layer that its corners' layers add up to.
template <int Dim>
void hand_down_columns(const SimplexMesh<Dim>& mesh,
                       const std::vector<NewPoint<Dim>>& points,
                       int k,
                       SimplexMesh<Dim>& fine) {
    if (mesh.columns.empty() || mesh.layers.empty()) {
        return;
    }
    fine.columns = mesh.columns;
    for (const std::uint32_t layer : mesh.layers) {
        fine.layers.push_back(layer * static_cast<std::uint32_t>(k));
    }
    std::map<std::map<std::uint32_t, int>, std::uint32_t> numbers;  // of columns by their names
    std::uint32_t next = *std::max_element(mesh.columns.begin(), mesh.columns.end()) + 1;
    for (const NewPoint<Dim>& point : points) {
        std::map<std::uint32_t, int> name;
        std::uint32_t layer = 0;
        for (int c = 0; c <= Dim; ++c) {
            if (point.weights[c] > 0) {
                name[mesh.columns[point.corners[c]]] += point.weights[c];
                layer +=
                    mesh.layers[point.corners[c]] * static_cast<std::uint32_t>(point.weights[c]);
            }
        }
        fine.layers.push_back(layer);
        if (name.size() == 1) {
            fine.columns.push_back(name.begin()->first);
            continue;
        }
        const auto [place, is_new] = numbers.try_emplace(std::move(name), next);
        next += is_new ? 1 : 0;
        fine.columns.push_back(place->second);
    }
}

}  // namespace

template <int Dim>
SimplexMesh<Dim> subdivide(const SimplexMesh<Dim>& mesh, int k) {
    assert(k >= 1);
    const Pattern<Dim> pattern = pattern_for<Dim>(k);
    const auto per_cell = static_cast<Eigen::Index>(pattern.weights.size());
    std::vector<std::uint64_t> first_places;
    const std::vector<std::uint32_t> numbers =
        number_points<Dim>(mesh, name_points(mesh, pattern), first_places);
    SimplexMesh<Dim> fine;
    const std::vector<NewPoint<Dim>> points = new_points(mesh, pattern, first_places);
    fine.positions = spread<Dim>(mesh.positions, points, k);
    hand_down_columns(mesh, points, k, fine);
    const auto children = static_cast<Eigen::Index>(pattern.cells.size());
    fine.cells.resize(Dim + 1, mesh.cell_count() * children);
    for (Eigen::Index cell = 0; cell < mesh.cell_count(); ++cell) {
        bool is_odd = false;
        static_cast<void>(sorted_corners(mesh, cell, is_odd));
        for (Eigen::Index child = 0; child < children; ++child) {
            auto column = fine.cells.col(cell * children + child);
            for (int i = 0; i <= Dim; ++i) {
                column[i] = numbers[cell * per_cell + pattern.cells[child][i]];
            }
            if (is_odd != pattern.is_odd[child]) {
                std::swap(column[Dim - 1], column[Dim]);
            }
        }
    }
    for (const std::uint16_t region : mesh.regions) {
        fine.regions.insert(fine.regions.end(), children, region);
    }
    if (mesh.fibers.cols() > 0) {
        fine.fibers = repeat(mesh.fibers, children);
    }
    return fine;
}

template <int Dim>
MeshExtras<Dim> subdivide_fields(const SimplexMesh<Dim>& mesh,
                                 const MeshExtras<Dim>& fields,
                                 int k) {
    MeshExtras<Dim> fine;
    if (fields.vertex_fields.empty() && fields.cell_fields.empty()) {
        return fine;
    }
    const Pattern<Dim> pattern = pattern_for<Dim>(k);
    std::vector<std::uint64_t> first_places;
    static_cast<void>(number_points<Dim>(mesh, name_points(mesh, pattern), first_places));
    const std::vector<NewPoint<Dim>> points = new_points(mesh, pattern, first_places);
    for (const VertexField& field : fields.vertex_fields) {
        fine.vertex_fields.push_back({field.name, spread<Dim>(field.values, points, k)});
    }
    const auto children = static_cast<Eigen::Index>(pattern.cells.size());
    for (const VertexField& field : fields.cell_fields) {
        fine.cell_fields.push_back({field.name, repeat(field.values, children)});
    }
    return fine;
}

template <int Dim>
SimplexMesh<Dim> make_quadratic(const SimplexMesh<Dim>& mesh) {
    SimplexMesh<Dim> fine = subdivide<Dim>(mesh, 2);
    constexpr Eigen::Index kChildren = Eigen::Index{1} << Dim;
    for (Eigen::Index cell = 0; cell < fine.cell_count(); ++cell) {
        fine.parents.push_back(static_cast<std::uint32_t>(cell / kChildren));
    }
    return fine;
}

template <int Dim>
std::vector<std::array<std::uint32_t, 2>> cut_edges(const SimplexMesh<Dim>& mesh) {
    const Pattern<Dim> pattern = pattern_for<Dim>(2);
    std::vector<std::uint64_t> first_places;
    static_cast<void>(number_points<Dim>(mesh, name_points(mesh, pattern), first_places));
    std::vector<std::array<std::uint32_t, 2>> edges;
    for (const NewPoint<Dim>& point : new_points(mesh, pattern, first_places)) {
        std::array<std::uint32_t, 2> edge{};
        int end = 0;
        for (int c = 0; c <= Dim; ++c) {
            if (point.weights[c] > 0) {
                edge[end++] = point.corners[c];
            }
        }
        edges.push_back(edge);
    }
    return edges;
}

template SimplexMesh<2> subdivide<2>(const SimplexMesh<2>&, int);
template SimplexMesh<3> subdivide<3>(const SimplexMesh<3>&, int);
template SimplexMesh<4> subdivide<4>(const SimplexMesh<4>&, int);
template MeshExtras<3> subdivide_fields<3>(const SimplexMesh<3>&, const MeshExtras<3>&, int);
template MeshExtras<4> subdivide_fields<4>(const SimplexMesh<4>&, const MeshExtras<4>&, int);
template SimplexMesh<3> make_quadratic<3>(const SimplexMesh<3>&);
template SimplexMesh<4> make_quadratic<4>(const SimplexMesh<4>&);
template std::vector<std::array<std::uint32_t, 2>> cut_edges<3>(const SimplexMesh<3>&);
template std::vector<std::array<std::uint32_t, 2>> cut_edges<4>(const SimplexMesh<4>&);

}  // namespace pent::mesher
