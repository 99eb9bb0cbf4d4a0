#include <pent/error.h>
#include <pent/extrusion.h>

#include <Eigen/Geometry>

#include <algorithm>
#include <array>
#include <cassert>
#include <cmath>
#include <limits>
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
Stack stack_of(const SimplexMesh<Dim - 1>& base, const std::vector<Layer<Dim>>& layers) {
    Stack stack;
    stack.columns = base.vertex_count();
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

template <int Dim>
void place_vertices(const SimplexMesh<Dim - 1>& base,
                    const std::vector<Layer<Dim>>& layers,
                    const Stack& stack,
                    SimplexMesh<Dim>& mesh) {
    const Eigen::Index first = stack.has_first_point ? 1 : 0;
    mesh.positions.resize(Dim, stack.vertices());
    mesh.columns.resize(stack.vertices());
    mesh.layers.resize(stack.vertices());
    Eigen::Index vertex = 0;
    for (Eigen::Index column = 0; column < stack.columns; ++column) {
        const Eigen::Matrix<double, Dim - 1, 1> x = base.positions.col(column);
        for (Eigen::Index layer = first; layer < first + stack.height; ++layer, ++vertex) {
            mesh.positions.col(vertex).noalias() = layers[layer].linear * x + layers[layer].offset;
            mesh.columns[vertex] = static_cast<std::uint32_t>(column);
            mesh.layers[vertex] = static_cast<std::uint32_t>(layer);
        }
    }
    const auto add_point = [&](Eigen::Index layer, Eigen::Index column) {
        mesh.positions.col(vertex) = layers[layer].offset;
        mesh.columns[vertex] = static_cast<std::uint32_t>(column);
        mesh.layers[vertex] = static_cast<std::uint32_t>(layer);
        ++vertex;
    };
    if (stack.has_first_point) {
        add_point(0, stack.columns);
    }
    if (stack.has_last_point) {
        add_point(static_cast<Eigen::Index>(layers.size()) - 1,
                  stack.columns + (stack.has_first_point ? 1 : 0));
    }
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
                       const Stack& stack,
                       const SimplexMesh<Dim>& mesh) {
    double clearest = 0;
    for (Eigen::Index cell = 0; cell < std::min<Eigen::Index>(base.cell_count(), 64); ++cell) {
        const double volume =
            cell_volume<Dim>(mesh.positions, first_simplex<Dim>(ordered, cell, stack), 0);
        clearest = std::abs(volume) > std::abs(clearest) ? volume : clearest;
    }
    return clearest < 0;
}

}  // namespace

template <int Dim>
SimplexMesh<Dim> extrude(const SimplexMesh<Dim - 1>& base,
                         const OrderedCells<Dim - 1>& ordered,
                         const std::vector<Layer<Dim>>& layers,
                         const ExtrudeOptions& options) {
    const Stack stack = stack_of<Dim>(base, layers);
    SimplexMesh<Dim> mesh;
    place_vertices<Dim>(base, layers, stack, mesh);
    const Eigen::Index per_base =
        Dim * (stack.height - 1) + (stack.has_first_point ? 1 : 0) + (stack.has_last_point ? 1 : 0);
    mesh.cells.resize(Dim + 1, base.cell_count() * per_base);
    const bool is_backward = proceeds_backward<Dim>(base, ordered, stack, mesh);
    std::uint32_t* out = mesh.cells.data();
    for (Eigen::Index cell = 0; cell < base.cell_count(); ++cell) {
        const bool is_odd = (ordered.is_odd[cell] != 0) != is_backward;
        out = fill_column<Dim>(ordered, cell, stack, is_odd, options.alternate, out);
    }
    if (!base.regions.empty()) {
        mesh.regions.resize(mesh.cell_count());
        for (Eigen::Index cell = 0; cell < mesh.cell_count(); ++cell) {
            mesh.regions[cell] = base.regions[cell / per_base];
        }
    }
    return mesh;
}

#define PENT_INSTANTIATE(Dim)                                            \
    template SimplexMesh<Dim> extrude<Dim>(const SimplexMesh<Dim - 1>&,  \
                                           const OrderedCells<Dim - 1>&, \
                                           const std::vector<Layer<Dim>>&, const ExtrudeOptions&);

PENT_INSTANTIATE(2)
PENT_INSTANTIATE(3)
PENT_INSTANTIATE(4)

#undef PENT_INSTANTIATE

}  // namespace pent
