#include "selection.h"

#include "rotation.h"

#include <pent/error.h>

#include <sstream>

namespace pent::simulator {

namespace {

using Marks = std::vector<bool>;

template <int Dim>
struct Marker {
    const SimplexMesh<Dim>& mesh;
    const std::string& body;
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
            throw Error("constraint on \"" + body
                        + "\" selects layers, but its mesh does not say which layer a vertex is"
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
std::string extent(const SimplexMesh<Dim>& mesh) {
    std::ostringstream text;
    const Vector<Dim> low = mesh.positions.rowwise().minCoeff();
    const Vector<Dim> high = mesh.positions.rowwise().maxCoeff();
    const Eigen::IOFormat row(4, Eigen::DontAlignCols, ", ", ", ");
    text << "[" << low.transpose().format(row) << "] to [" << high.transpose().format(row) << "]";
    return text.str();
}

}  // namespace

template <int Dim>
std::vector<std::uint32_t> select_vertices(const SimplexMesh<Dim>& mesh,
                                           const Constraint& constraint) {
    Marks marks(static_cast<std::size_t>(mesh.vertex_count()), false);
    for (const Selection& selection : constraint.select) {
        std::visit(Marker<Dim>{mesh, constraint.body, marks}, selection);
    }
    std::vector<std::uint32_t> selected;
    for (std::size_t vertex = 0; vertex < marks.size(); ++vertex) {
        if (marks[vertex]) {
            selected.push_back(static_cast<std::uint32_t>(vertex));
        }
    }
    if (selected.empty()) {
        throw Error("constraint on \"" + constraint.body
                    + "\" selects no vertex; the body as placed reaches from " + extent(mesh));
    }
    return selected;
}

template std::vector<std::uint32_t> select_vertices<3>(const SimplexMesh<3>&, const Constraint&);
template std::vector<std::uint32_t> select_vertices<4>(const SimplexMesh<4>&, const Constraint&);

}  // namespace pent::simulator
