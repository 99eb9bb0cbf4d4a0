#include <pent/error.h>
#include <pent/extrusion.h>

#include <Eigen/Geometry>

#include <algorithm>
#include <array>
#include <cassert>
#include <cmath>
#include <limits>
#include <numeric>
#include <string>

namespace pent {

namespace {

// Layers without the point ones, which have no vertices in the columns.
struct Stack {
    Eigen::Index columns = 0;
    Eigen::Index height = 0;  // layers in a column
    bool has_first_point = false;
    bool has_last_point = false;

    [[nodiscard]] std::uint32_t vertex(std::uint32_t column) const {
        return static_cast<std::uint32_t>(column * height);
    }
    [[nodiscard]] Eigen::Index vertices() const {
        return columns * height + (has_first_point ? 1 : 0) + (has_last_point ? 1 : 0);
    }
    [[nodiscard]] std::uint32_t first_point() const {
        return static_cast<std::uint32_t>(columns * height);
    }
    [[nodiscard]] std::uint32_t last_point() const {
        return static_cast<std::uint32_t>(vertices() - 1);
    }
};

template <int Dim>
Stack stack_of(Eigen::Index columns, const std::vector<Layer<Dim>>& layers) {
    Stack stack;
    stack.columns = columns;
    stack.has_first_point = layers.front().is_point();
    stack.has_last_point = layers.back().is_point();
    stack.height = static_cast<Eigen::Index>(layers.size()) - (stack.has_first_point ? 1 : 0)
                   - (stack.has_last_point ? 1 : 0);
    assert(stack.height >= 1);
    if (stack.vertices() > std::numeric_limits<std::uint32_t>::max()) {
        throw Error("an extrusion to " + std::to_string(stack.vertices())
                    + " vertices; at most 4294967295 can be numbered");
    }
    return stack;
}

// Where a vertex lies.
template <int Dim>
Eigen::Matrix<double, Dim, 1> place_of(const SimplexMesh<Dim - 1>& base,
                                       const std::vector<Layer<Dim>>& layers,
                                       const Stack& stack,
                                       Eigen::Index vertex) {
    if (vertex >= stack.columns * stack.height) {
        const bool is_first = stack.has_first_point && vertex == stack.first_point();
        return is_first ? layers.front().offset : layers.back().offset;
    }
    const auto layer =
        static_cast<std::size_t>(vertex % stack.height + (stack.has_first_point ? 1 : 0));
    const Eigen::Matrix<double, Dim - 1, 1> x = base.positions.col(vertex / stack.height);
    return layers[layer].linear * x + layers[layer].offset;
}

template <int Dim>
SimplexMesh<Dim> place_vertices(const SimplexMesh<Dim - 1>& base,
                                const std::vector<Layer<Dim>>& layers,
                                const Stack& stack) {
    const Eigen::Index first = stack.has_first_point ? 1 : 0;
    SimplexMesh<Dim> mesh;
    mesh.positions.resize(Dim, stack.vertices());
    mesh.columns.resize(stack.vertices());
    mesh.layers.resize(stack.vertices());
    for (Eigen::Index vertex = 0; vertex < stack.columns * stack.height; ++vertex) {
        mesh.positions.col(vertex) = place_of<Dim>(base, layers, stack, vertex);
        mesh.columns[vertex] = static_cast<std::uint32_t>(vertex / stack.height);
        mesh.layers[vertex] = static_cast<std::uint32_t>(first + vertex % stack.height);
    }
    const auto add_point = [&](std::uint32_t vertex, std::size_t layer, Eigen::Index column) {
        mesh.positions.col(vertex) = layers[layer].offset;
        mesh.columns[vertex] = static_cast<std::uint32_t>(column);
        mesh.layers[vertex] = static_cast<std::uint32_t>(layer);
    };
    if (stack.has_first_point) {
        add_point(stack.first_point(), 0, stack.columns);
    }
    if (stack.has_last_point) {
        add_point(stack.last_point(), layers.size() - 1,
                  stack.columns + (stack.has_first_point ? 1 : 0));
    }
    return mesh;
}

// The simplices of the lowest prism over a base cell; the others add the number of their slab.
template <int Dim>
using Prism = std::array<std::array<std::uint32_t, Dim + 1>, Dim>;

template <int Dim>
Prism<Dim> lowest_prism(const std::array<std::uint32_t, Dim>& bottom, bool is_odd) {
    Prism<Dim> prism{};
    for (int k = 0; k < Dim; ++k) {
        std::array<std::uint32_t, Dim + 1>& simplex = prism[k];
        for (int i = 0; i <= k; ++i) {
            simplex[i] = bottom[i];
        }
        for (int i = k; i < Dim; ++i) {
            simplex[i + 1] = bottom[i] + 1;  // the top is the next layer of the same column
        }
        if (((Dim - 1 - k) % 2 == 1) != is_odd) {
            std::swap(simplex[Dim - 1], simplex[Dim]);
        }
    }
    return prism;
}

// A cone from a layer to a point: all simplices of the prism but one are flat.
template <int Dim>
std::array<std::uint32_t, Dim + 1> cone(const std::array<std::uint32_t, Dim>& corners,
                                        std::uint32_t point,
                                        bool is_point_first,
                                        bool is_odd) {
    std::array<std::uint32_t, Dim + 1> simplex{};
    if (is_point_first) {
        simplex[0] = point;
        std::copy(corners.begin(), corners.end(), simplex.begin() + 1);
    } else {
        std::copy(corners.begin(), corners.end(), simplex.begin());
        simplex[Dim] = point;
    }
    // k = 0 with the point as bottom, k = Dim - 1 with the point as top: see lowest_prism().
    const bool is_turned = is_point_first ? (Dim - 1) % 2 == 1 : false;
    if (is_turned != is_odd) {
        std::swap(simplex[Dim - 1], simplex[Dim]);
    }
    return simplex;
}

template <int Dim>
std::array<std::uint32_t, Dim> ordered_corners(const OrderedCells<Dim - 1>& ordered,
                                               Eigen::Index cell,
                                               const Stack& stack) {
    std::array<std::uint32_t, Dim> corners{};
    for (int i = 0; i < Dim; ++i) {
        corners[i] = stack.vertex(ordered.cells(i, cell));
    }
    return corners;
}

constexpr bool reversal_is_odd(int count) {
    return count / 2 % 2 == 1;
}

// All cells over one base cell, written one after the other.
template <int Dim>
std::uint32_t* fill_column(const OrderedCells<Dim - 1>& ordered,
                           Eigen::Index cell,
                           const Stack& stack,
                           bool is_odd,
                           bool alternate,
                           std::uint32_t* out) {
    std::array<std::uint32_t, Dim> corners = ordered_corners<Dim>(ordered, cell, stack);
    const auto append = [&out](const std::array<std::uint32_t, Dim + 1>& simplex) {
        out = std::copy(simplex.begin(), simplex.end(), out);
    };
    if (stack.has_first_point) {
        append(cone<Dim>(corners, stack.first_point(), true, is_odd));
    }
    const Prism<Dim> even = lowest_prism<Dim>(corners, is_odd);
    std::reverse(corners.begin(), corners.end());
    const Prism<Dim> odd = lowest_prism<Dim>(corners, is_odd != reversal_is_odd(Dim));
    std::reverse(corners.begin(), corners.end());
    const auto slabs = static_cast<std::uint32_t>(stack.height - 1);
    for (std::uint32_t slab = 0; slab < slabs; ++slab) {
        const Prism<Dim>& prism = alternate && slab % 2 == 1 ? odd : even;
        const std::uint32_t* in = prism.front().data();
        for (int i = 0; i < Dim * (Dim + 1); ++i) {
            out[i] = in[i] + slab;
        }
        out += Dim * (Dim + 1);
    }
    if (stack.has_last_point) {
        for (std::uint32_t& corner : corners) {
            corner += slabs;
        }
        append(cone<Dim>(corners, stack.last_point(), false, is_odd));
    }
    return out;
}

// The first simplex over a base cell, as it is when the layers proceed forward.
template <int Dim>
Simplices<Dim + 1> first_simplex(const OrderedCells<Dim - 1>& ordered,
                                 Eigen::Index cell,
                                 const Stack& stack) {
    const std::array<std::uint32_t, Dim> corners = ordered_corners<Dim>(ordered, cell, stack);
    const bool is_odd = ordered.is_odd[cell] != 0;
    std::array<std::uint32_t, Dim + 1> simplex{};
    if (stack.height > 1) {
        simplex = lowest_prism<Dim>(corners, is_odd)[0];
    } else if (stack.has_first_point) {
        simplex = cone<Dim>(corners, stack.first_point(), true, is_odd);
    } else {
        simplex = cone<Dim>(corners, stack.last_point(), false, is_odd);
    }
    return Eigen::Map<const Simplices<Dim + 1>>(simplex.data(), Dim + 1, 1);
}

// Whether the layers proceed to the negative side, told by the clearest of a few simplices.
template <int Dim>
bool proceeds_backward(const SimplexMesh<Dim - 1>& base,
                       const OrderedCells<Dim - 1>& ordered,
                       const std::vector<Layer<Dim>>& layers,
                       const Stack& stack) {
    double clearest = 0;
    for (Eigen::Index cell = 0; cell < std::min<Eigen::Index>(base.cell_count(), 64); ++cell) {
        const Simplices<Dim + 1> simplex = first_simplex<Dim>(ordered, cell, stack);
        Eigen::Matrix<double, Dim, Dim + 1> corners;
        for (int i = 0; i <= Dim; ++i) {
            corners.col(i) = place_of<Dim>(base, layers, stack, simplex(i, 0));
        }
        const double volume = simplex_volume<Dim>(corners);
        clearest = std::abs(volume) > std::abs(clearest) ? volume : clearest;
    }
    return clearest < 0;
}

// The cells over some base cells.
template <int Dim>
void fill_cells(const SimplexMesh<Dim - 1>& base,
                const OrderedCells<Dim - 1>& ordered,
                const std::vector<Layer<Dim>>& layers,
                bool alternate,
                std::span<const std::uint32_t> base_cells,
                SimplexMesh<Dim>& mesh) {
    const Stack stack = stack_of<Dim>(base.vertex_count(), layers);
    const Eigen::Index per_base = cells_of_column<Dim>(layers);
    const bool is_backward = proceeds_backward<Dim>(base, ordered, layers, stack);
    mesh.cells.resize(Dim + 1, static_cast<Eigen::Index>(base_cells.size()) * per_base);
    if (!base.regions.empty()) {
        mesh.regions.reserve(static_cast<std::size_t>(mesh.cell_count()));
    }
    std::uint32_t* out = mesh.cells.data();
    for (const std::uint32_t cell : base_cells) {
        const bool is_odd = (ordered.is_odd[cell] != 0) != is_backward;
        out = fill_column<Dim>(ordered, cell, stack, is_odd, alternate, out);
        if (!base.regions.empty()) {
            mesh.regions.insert(mesh.regions.end(), static_cast<std::size_t>(per_base),
                                base.regions[cell]);
        }
    }
}

}  // namespace

template <int Dim>
SimplexMesh<Dim> extrude(const SimplexMesh<Dim - 1>& base,
                         const OrderedCells<Dim - 1>& ordered,
                         const std::vector<Layer<Dim>>& layers,
                         const ExtrudeOptions& options) {
    SimplexMesh<Dim> mesh =
        place_vertices<Dim>(base, layers, stack_of<Dim>(base.vertex_count(), layers));
    std::vector<std::uint32_t> all(static_cast<std::size_t>(base.cell_count()));
    std::iota(all.begin(), all.end(), 0U);
    fill_cells<Dim>(base, ordered, layers, options.alternate, all, mesh);
    return mesh;
}

template <int Dim>
SimplexMesh<Dim> extrude_vertices(const Extrusion<Dim>& extrusion) {
    return place_vertices<Dim>(extrusion.base, extrusion.layers,
                               stack_of<Dim>(extrusion.base.vertex_count(), extrusion.layers));
}

template <int Dim>
SimplexMesh<Dim> extrude_cells(const Extrusion<Dim>& extrusion,
                               std::span<const std::uint32_t> base_cells) {
    SimplexMesh<Dim> mesh;
    fill_cells<Dim>(extrusion.base, extrusion.ordered, extrusion.layers,
                    extrusion.options.alternate, base_cells, mesh);
    return mesh;
}

template <int Dim>
Eigen::Index cells_of_column(const std::vector<Layer<Dim>>& layers) {
    const Eigen::Index points =
        (layers.front().is_point() ? 1 : 0) + (layers.back().is_point() ? 1 : 0);
    return Dim * (static_cast<Eigen::Index>(layers.size()) - points - 1) + points;
}

#define PENT_INSTANTIATE(Dim)                                                                      \
    template SimplexMesh<Dim> extrude<Dim>(const SimplexMesh<Dim - 1>&,                            \
                                           const OrderedCells<Dim - 1>&,                           \
                                           const std::vector<Layer<Dim>>&, const ExtrudeOptions&); \
    template SimplexMesh<Dim> extrude_vertices<Dim>(const Extrusion<Dim>&);                        \
    template SimplexMesh<Dim> extrude_cells<Dim>(const Extrusion<Dim>&,                            \
                                                 std::span<const std::uint32_t>);                  \
    template Eigen::Index cells_of_column<Dim>(const std::vector<Layer<Dim>>&);

PENT_INSTANTIATE(2)
PENT_INSTANTIATE(3)
PENT_INSTANTIATE(4)

#undef PENT_INSTANTIATE

}  // namespace pent
