#include "model/rotation.h"
#include "model/selection_marks.h"

#include <pent/dimensions.h>
#include <pent/error.h>
#include <pent/formatted.h>
#include <pent/simulator/placed_mesh.h>

#include <algorithm>
#include <sstream>

namespace pent::simulator {

namespace {

using Marks = std::vector<bool>;

// Marks points, each a vertex or the center of a cell, that are in a place.
template <int Dim>
struct PlaceMarker {
    const SimplexMesh<Dim>& mesh;
    const Positions<Dim>& points;
    const std::string& where;  // who selects
    Marks& marks;

    template <typename Contains>
    void mark_points(const Contains& contains) const {
        for (Eigen::Index i = 0; i < points.cols(); ++i) {
            if (contains(Vector<Dim>(points.col(i)))) {
                marks[static_cast<std::size_t>(i)] = true;
            }
        }
    }
    void operator()(const BallSelection& ball) const {
        const Vector<Dim> center = ball.center;
        mark_points([&](const Vector<Dim>& p) {
            return (p - center).squaredNorm() <= ball.radius * ball.radius;
        });
    }
    void operator()(const BoxSelection& box) const {
        const Vector<Dim> low = box.low;
        const Vector<Dim> high = box.high;
        mark_points([&](const Vector<Dim>& p) {
            return (p.array() >= low.array()).all() && (p.array() <= high.array()).all();
        });
    }
    void operator()(const HalfSpaceSelection& half_space) const {
        const Vector<Dim> normal = half_space.normal;
        mark_points([&](const Vector<Dim>& p) { return normal.dot(p) <= half_space.offset; });
    }
    void operator()(const EverythingSelection& /*everything*/) const {
        marks.assign(marks.size(), true);
    }

protected:
    [[nodiscard]] bool is_in(const LayerSelection& layers, std::uint32_t vertex) const {
        if (mesh.layers.empty()) {
            throw Error(where
                        + " selects layers, but its mesh does not say which layer a vertex is"
                          " in; select by ball, box or half_space");
        }
        return mesh.layers[vertex] >= layers.first && mesh.layers[vertex] <= layers.last;
    }
};

template <int Dim>
struct VertexMarker : PlaceMarker<Dim> {
    using PlaceMarker<Dim>::operator();
    using PlaceMarker<Dim>::marks;
    using PlaceMarker<Dim>::mesh;

    void operator()(const LayerSelection& layers) const {
        for (std::uint32_t vertex = 0; vertex < marks.size(); ++vertex) {
            marks[vertex] = marks[vertex] || this->is_in(layers, vertex);
        }
    }
    void operator()(const RegionSelection& region) const {
        for (std::size_t cell = 0; cell < mesh.regions.size(); ++cell) {
            if (mesh.regions[cell] == region.region) {
                for (const std::uint32_t vertex : mesh.cells.col(static_cast<Eigen::Index>(cell))) {
                    marks[vertex] = true;
                }
            }
        }
    }
};

template <int Dim>
struct CellMarker : PlaceMarker<Dim> {
    using PlaceMarker<Dim>::operator();
    using PlaceMarker<Dim>::marks;
    using PlaceMarker<Dim>::mesh;

    void operator()(const LayerSelection& layers) const {
        for (Eigen::Index cell = 0; cell < mesh.cell_count(); ++cell) {
            const auto corners = mesh.cells.col(cell);
            if (std::all_of(corners.begin(), corners.end(),
                            [&](std::uint32_t vertex) { return this->is_in(layers, vertex); })) {
                marks[static_cast<std::size_t>(cell)] = true;
            }
        }
    }
    void operator()(const RegionSelection& region) const {
        for (std::size_t cell = 0; cell < mesh.regions.size(); ++cell) {
            marks[cell] = marks[cell] || mesh.regions[cell] == region.region;
        }
    }
};

template <int Dim>
std::string vector_text(const Vector<Dim>& vector) {
    std::ostringstream text;
    const Eigen::IOFormat row(4, Eigen::DontAlignCols, ", ", ", ");
    text << "[" << vector.transpose().format(row) << "]";
    return text.str();
}

// Looks for the point that is nearest to a place.
template <int Dim>
struct MissFinder {
    const Positions<Dim>& points;
    const std::vector<std::uint32_t>& numbers;
    NearMiss<Dim>& miss;

    template <typename Distance>
    void find(const Distance& distance) const {
        for (Eigen::Index i = 0; i < points.cols(); ++i) {
            const double d = distance(Vector<Dim>(points.col(i)));
            if (d < miss.distance) {
                miss.distance = d;
                miss.number =
                    numbers.empty() ? static_cast<double>(i) : numbers[static_cast<std::size_t>(i)];
                miss.point = points.col(i);
            }
        }
    }
    void operator()(const BallSelection& ball) const {
        const Vector<Dim> center = ball.center;
        find([&](const Vector<Dim>& p) { return (p - center).norm() - ball.radius; });
    }
    void operator()(const BoxSelection& box) const {
        const Vector<Dim> low = box.low;
        const Vector<Dim> high = box.high;
        find([&](const Vector<Dim>& p) { return (low - p).cwiseMax(p - high).cwiseMax(0).norm(); });
    }
    void operator()(const HalfSpaceSelection& half_space) const {
        const Vector<Dim> normal = half_space.normal;
        find([&](const Vector<Dim>& p) { return normal.dot(p) - half_space.offset; });
    }
    template <typename Other>
    void operator()(const Other& /*no place*/) const {}
};

std::string range_text(double least, double most) {
    return formatted("%.0f to %.0f", least, most);
}

// Says what there is in place of what was selected.
template <int Dim>
struct MissText {
    const SimplexMesh<Dim>& mesh;
    const std::string& what;
    const NearMiss<Dim>& miss;

    template <typename Place>
    std::string operator()(const Place& /*place*/) const {
        return "the nearest " + what + " is " + formatted("%.0f", miss.number) + " at "
               + vector_text<Dim>(miss.point) + formatted(", %.3g m away", miss.distance);
    }
    std::string operator()(const LayerSelection& /*layers*/) const {
        const auto [least, most] = std::minmax_element(mesh.layers.begin(), mesh.layers.end());
        return "the mesh has the layers " + range_text(*least, *most);
    }
    std::string operator()(const RegionSelection& /*region*/) const {
        return miss.most_label < miss.least_label
                   ? "the mesh has no regions"
                   : "the mesh has the regions " + range_text(miss.least_label, miss.most_label);
    }
    std::string operator()(const EverythingSelection& /*everything*/) const {
        return "the mesh has no vertex";  // GCOVR_EXCL_LINE: none is without
    }
};

template <int Dim>
std::string extent_text(const Positions<Dim>& positions) {
    return "the body as placed reaches from " + vector_text<Dim>(positions.rowwise().minCoeff())
           + " to " + vector_text<Dim>(positions.rowwise().maxCoeff());
}

bool has_any(const Marks& marks) {
    return std::find(marks.begin(), marks.end(), true) != marks.end();
}

}  // namespace

std::string place_and_name(const Region& region) {
    return (region.source.empty() ? "" : region.source + ": ") + "region \"" + region.name + "\"";
}

std::string place_and_name(const Constraint& constraint) {
    return (constraint.source.empty() ? "" : constraint.source + ": ") + "constraint on \""
           + constraint.body + "\"";
}

std::string place_and_name(const Load& load) {
    return (load.source.empty() ? "" : load.source + ": ") + "load on \"" + load.body + "\"";
}

std::string place_and_name(const Activation& activation) {
    return (activation.source.empty() ? "" : activation.source + ": ") + "activation of \""
           + activation.body + "\"";
}

std::string place_and_name(const Attachment& attachment) {
    return (attachment.source.empty() ? "" : attachment.source + ": ") + "attachment of \""
           + attachment.body + "\"";
}

template <int Dim>
Positions<Dim> centers(const SimplexMesh<Dim>& mesh) {
    Positions<Dim> all = Positions<Dim>::Zero(Dim, mesh.cell_count());
    for (Eigen::Index cell = 0; cell < mesh.cell_count(); ++cell) {
        for (const std::uint32_t vertex : mesh.cells.col(cell)) {
            all.col(cell) += mesh.positions.col(vertex) / (Dim + 1);
        }
    }
    return all;
}

template <int Dim>
NearMiss<Dim> near_miss(const SimplexMesh<Dim>& mesh,
                        const Positions<Dim>& points,
                        const std::vector<std::uint32_t>& numbers,
                        const Selection& selection) {
    NearMiss<Dim> miss;
    std::visit(MissFinder<Dim>{points, numbers, miss}, selection);
    for (const std::uint16_t label : mesh.regions) {
        miss.least_label = std::min<double>(miss.least_label, label);
        miss.most_label = std::max<double>(miss.most_label, label);
    }
    return miss;
}

template <int Dim>
void refuse_none(const SimplexMesh<Dim>& mesh,
                 const std::string& what,
                 const NearMiss<Dim>& miss,
                 const std::vector<Selection>& select,
                 const std::string& where) {
    throw Error(where + " selects no " + what + ": "
                + std::visit(MissText<Dim>{mesh, what, miss}, select.front()) + "; "
                + extent_text<Dim>(mesh.positions));
}

bool selects_by_region(const std::vector<Selection>& select) {
    return std::any_of(select.begin(), select.end(), [](const Selection& selection) {
        return std::holds_alternative<RegionSelection>(selection);
    });
}

template <int Dim>
std::vector<bool> mark_vertices(const SimplexMesh<Dim>& mesh,
                                const std::vector<Selection>& select,
                                const std::string& where) {
    Marks marks(static_cast<std::size_t>(mesh.vertex_count()), false);
    for (const Selection& selection : select) {
        std::visit(VertexMarker<Dim>{{mesh, mesh.positions, where, marks}}, selection);
    }
    return marks;
}

template <int Dim>
std::vector<bool> mark_cells(const SimplexMesh<Dim>& mesh,
                             const std::vector<Selection>& select,
                             const std::string& where) {
    // Selections by label or layer need no centers of cells, and a body may have a thousand regions
    // by their labels.
    const bool needs_places =
        std::any_of(select.begin(), select.end(), [](const Selection& selection) {
            return !std::holds_alternative<RegionSelection>(selection)
                   && !std::holds_alternative<LayerSelection>(selection);
        });
    const Positions<Dim> points = needs_places ? centers(mesh) : Positions<Dim>();
    Marks marks(static_cast<std::size_t>(mesh.cell_count()), false);
    for (const Selection& selection : select) {
        std::visit(CellMarker<Dim>{{mesh, points, where, marks}}, selection);
    }
    return marks;
}

template <int Dim>
std::vector<std::uint32_t> select_vertices(const SimplexMesh<Dim>& mesh,
                                           const std::vector<Selection>& select,
                                           const std::string& where) {
    const Marks marks = mark_vertices(mesh, select, where);
    if (!has_any(marks)) {
        refuse_none(mesh, "vertex", near_miss(mesh, mesh.positions, {}, select.front()), select,
                    where);
    }
    std::vector<std::uint32_t> selected;
    for (std::size_t vertex = 0; vertex < marks.size(); ++vertex) {
        if (marks[vertex]) {
            selected.push_back(static_cast<std::uint32_t>(vertex));
        }
    }
    return selected;
}

template <int Dim>
std::vector<bool> select_cells(const SimplexMesh<Dim>& mesh,
                               const std::vector<Selection>& select,
                               const std::string& where) {
    Marks marks = mark_cells(mesh, select, where);
    if (!has_any(marks)) {
        refuse_none(mesh, "cell", near_miss(mesh, centers(mesh), {}, select.front()), select,
                    where);
    }
    return marks;
}

std::vector<std::uint16_t> materials_by_regions(
    std::size_t cells,
    const Body& body,
    const std::function<std::vector<bool>(const Region&)>& mark) {
    std::vector<std::uint16_t> numbers(cells, 0);
    for (std::size_t i = 0; i < body.regions.size(); ++i) {
        const std::vector<bool> is_in = mark(body.regions[i]);
        for (std::size_t cell = 0; cell < numbers.size(); ++cell) {
            numbers[cell] = is_in[cell] ? static_cast<std::uint16_t>(i + 1) : numbers[cell];
        }
    }
    return numbers;
}

template <int Dim>
std::vector<std::uint16_t> materials_of_cells(const SimplexMesh<Dim>& mesh, const Body& body) {
    return materials_by_regions(
        static_cast<std::size_t>(mesh.cell_count()), body, [&](const Region& region) {
            return select_cells(mesh, region.select, place_and_name(region));
        });
}

const Material& material_of(const Body& body, std::uint16_t number) {
    return number == 0 ? body.material : body.regions[number - 1U].material;
}

#define PENT_INSTANTIATE(Dim)                                                                      \
    template Positions<Dim> centers<Dim>(const SimplexMesh<Dim>&);                                 \
    template NearMiss<Dim> near_miss<Dim>(const SimplexMesh<Dim>&, const Positions<Dim>&,          \
                                          const std::vector<std::uint32_t>&, const Selection&);    \
    template void refuse_none<Dim>(const SimplexMesh<Dim>&, const std::string&,                    \
                                   const NearMiss<Dim>&, const std::vector<Selection>&,            \
                                   const std::string&);                                            \
    template std::vector<bool> mark_vertices<Dim>(                                                 \
        const SimplexMesh<Dim>&, const std::vector<Selection>&, const std::string&);               \
    template std::vector<bool> mark_cells<Dim>(const SimplexMesh<Dim>&,                            \
                                               const std::vector<Selection>&, const std::string&); \
    template std::vector<std::uint32_t> select_vertices<Dim>(                                      \
        const SimplexMesh<Dim>&, const std::vector<Selection>&, const std::string&);               \
    template std::vector<bool> select_cells<Dim>(                                                  \
        const SimplexMesh<Dim>&, const std::vector<Selection>&, const std::string&);               \
    template std::vector<std::uint16_t> materials_of_cells<Dim>(const SimplexMesh<Dim>&,           \
                                                                const Body&);
PENT_FOR_EACH_DIMENSION(PENT_INSTANTIATE)
#undef PENT_INSTANTIATE

}  // namespace pent::simulator
