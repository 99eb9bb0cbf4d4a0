#include "model/rotation.h"

#include <pent/error.h>
#include <pent/formatted.h>
#include <pent/simulator/placed_mesh.h>

#include <algorithm>
#include <limits>
#include <sstream>

namespace pent::simulator {

namespace {

using Marks = std::vector<bool>;

template <int Dim>
struct Marker {
    const SimplexMesh<Dim>& mesh;
    const std::string& where;  // who selects
    Marks& marks;

    template <typename Contains>
    void mark_points(const Contains& contains) const {
        for (Eigen::Index vertex = 0; vertex < mesh.vertex_count(); ++vertex) {
            if (contains(Vector<Dim>(mesh.positions.col(vertex)))) {
                marks[static_cast<std::size_t>(vertex)] = true;
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
    void operator()(const LayerSelection& layers) const {
        if (mesh.layers.empty()) {
            throw Error(where
                        + " selects layers, but its mesh does not say which layer a vertex is"
                          " in; select by ball, box or half_space");
        }
        for (std::size_t vertex = 0; vertex < marks.size(); ++vertex) {
            const std::uint32_t layer = mesh.layers[vertex];
            if (layer >= layers.first && layer <= layers.last) {
                marks[vertex] = true;
            }
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
    void operator()(const EverythingSelection& /*everything*/) const {
        marks.assign(marks.size(), true);
    }
};

template <int Dim>
std::string vector_text(const Vector<Dim>& vector) {
    std::ostringstream text;
    const Eigen::IOFormat row(4, Eigen::DontAlignCols, ", ", ", ");
    text << "[" << vector.transpose().format(row) << "]";
    return text.str();
}

template <typename Labels>
std::string range_text(const Labels& labels) {
    const auto [least, most] = std::minmax_element(labels.begin(), labels.end());
    return std::to_string(*least) + " to " + std::to_string(*most);
}

// What a selection without a vertex came nearest to.
template <int Dim>
struct Nearest {
    const SimplexMesh<Dim>& mesh;

    // By a distance of points from the selected region.
    template <typename Distance>
    std::string vertex(const Distance& distance) const {
        double least = std::numeric_limits<double>::infinity();
        Eigen::Index nearest = 0;
        for (Eigen::Index i = 0; i < mesh.vertex_count(); ++i) {
            const double d = distance(Vector<Dim>(mesh.positions.col(i)));
            nearest = d < least ? i : nearest;
            least = std::min(d, least);
        }
        return "the nearest vertex is " + std::to_string(nearest) + " at "
               + vector_text<Dim>(mesh.positions.col(nearest)) + formatted(", %.3g m away", least);
    }
    std::string operator()(const BallSelection& ball) const {
        const Vector<Dim> center = ball.center;
        return vertex([&](const Vector<Dim>& p) { return (p - center).norm() - ball.radius; });
    }
    std::string operator()(const BoxSelection& box) const {
        const Vector<Dim> low = box.low;
        const Vector<Dim> high = box.high;
        return vertex(
            [&](const Vector<Dim>& p) { return (low - p).cwiseMax(p - high).cwiseMax(0).norm(); });
    }
    std::string operator()(const HalfSpaceSelection& half_space) const {
        const Vector<Dim> normal = half_space.normal;
        return vertex([&](const Vector<Dim>& p) { return normal.dot(p) - half_space.offset; });
    }
    std::string operator()(const LayerSelection& /*layers*/) const {
        return "the mesh has the layers " + range_text(mesh.layers);
    }
    std::string operator()(const RegionSelection& /*region*/) const {
        return mesh.regions.empty() ? "the mesh has no regions"
                                    : "the mesh has the regions " + range_text(mesh.regions);
    }
    std::string operator()(const EverythingSelection& /*everything*/) const {
        return "the mesh has no vertex";  // GCOVR_EXCL_LINE: none is without
    }
};

}  // namespace

std::string place_and_name(const Constraint& constraint) {
    return (constraint.source.empty() ? "" : constraint.source + ": ") + "constraint on \""
           + constraint.body + "\"";
}

std::string place_and_name(const Load& load) {
    return (load.source.empty() ? "" : load.source + ": ") + "load on \"" + load.body + "\"";
}

std::string place_and_name(const Attachment& attachment) {
    return (attachment.source.empty() ? "" : attachment.source + ": ") + "attachment of \""
           + attachment.body + "\"";
}

template <int Dim>
std::vector<std::uint32_t> select_vertices(const SimplexMesh<Dim>& mesh,
                                           const std::vector<Selection>& select,
                                           const std::string& where) {
    Marks marks(static_cast<std::size_t>(mesh.vertex_count()), false);
    for (const Selection& selection : select) {
        std::visit(Marker<Dim>{mesh, where, marks}, selection);
    }
    std::vector<std::uint32_t> selected;
    for (std::size_t vertex = 0; vertex < marks.size(); ++vertex) {
        if (marks[vertex]) {
            selected.push_back(static_cast<std::uint32_t>(vertex));
        }
    }
    if (selected.empty()) {
        throw Error(where + " selects no vertex: " + std::visit(Nearest<Dim>{mesh}, select.front())
                    + "; the body as placed reaches from "
                    + vector_text<Dim>(mesh.positions.rowwise().minCoeff()) + " to "
                    + vector_text<Dim>(mesh.positions.rowwise().maxCoeff()));
    }
    return selected;
}

template std::vector<std::uint32_t> select_vertices<3>(const SimplexMesh<3>&,
                                                       const std::vector<Selection>&,
                                                       const std::string&);
template std::vector<std::uint32_t> select_vertices<4>(const SimplexMesh<4>&,
                                                       const std::vector<Selection>&,
                                                       const std::string&);

}  // namespace pent::simulator
