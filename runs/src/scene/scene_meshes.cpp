#include "scene/scene_meshes.h"

#include <pent/error.h>
#include <pent/formatted.h>
#include <pent/number_bounds.h>
#include <pent/simulator/placed_mesh.h>

#include <algorithm>
#include <map>
#include <utility>

namespace pent::runs {

namespace {

std::string at(const std::string& source) {
    return source.empty() ? "" : source + ": ";
}

bool do_overlap(const Constraint& a, const Constraint& b) {
    return a.from < b.to && b.from < a.to;
}

}  // namespace

template <int Dim>
FileInfo info_of_mesh(const Body& body) {
    FileInfo info;
    with_place_of(body, [&] {
        info = read_info(body.mesh);
        if (info.dimension != Dim) {
            throw Error(body.mesh + ": is of dimension " + std::to_string(info.dimension)
                        + ", the scene of " + std::to_string(Dim) + "; expected another mesh, or"
                        " [scene] dimension = " + std::to_string(info.dimension));
        }
    });
    return info;
}

void with_place_of(const Body& body, const std::function<void()>& work) {
    try {
        work();
    } catch (const Error& error) {
        throw Error(at(body.source) + error.what());
    }
}

template <int Dim>
void check_size(const SimplexMesh<Dim>& mesh, const Body& body) {
    const double extent =
        body.place.scale
        * (mesh.positions.rowwise().maxCoeff() - mesh.positions.rowwise().minCoeff()).norm();
    if (!is_size(extent)) {
        throw Error(at(body.source) + "body \"" + body.name + "\" is placed "
                    + formatted("%.3g m large; expected a size from %.0e to %.0e m", extent,
                                kSmallestNumber, kLargestNumber));
    }
}

template <int Dim>
void judge_facets(const Scene& scene,
                  const Body& body,
                  const FacetMatch<Dim>& facets,
                  std::vector<std::string>& warnings) {
    if (facets.is_conforming()) {
        return;
    }
    const std::string line =
        body.mesh + ": its cells do not fit together: "
        + (facets.overfull > 0
               ? std::to_string(facets.overfull) + " of its facets have more than two cells"
               : std::to_string(facets.one_sided) + " of its facets have both cells on one side")
        + ", first at " + std::string(cell_name(Dim)) + " " + std::to_string(facets.first_fault)
        + " (pent-check says more)";
    if (scene.contact) {
        throw Error(at(body.source) + line
                    + "; contact needs a closed surface: mend the mesh or leave out [contact]");
    }
    warnings.push_back(line);
}

template <int Dim>
void check_constraints(const Scene& scene, const Body& body, const SimplexMesh<Dim>& mesh) {
    if (std::none_of(scene.constraints.begin(), scene.constraints.end(),
                     [&](const Constraint& constraint) { return constraint.body == body.name; })) {
        return;
    }
    SimplexMesh<Dim> placed = mesh;
    put_in_place(placed, body.place);
    std::multimap<std::uint32_t, const Constraint*> held;
    for (const Constraint& constraint : scene.constraints) {
        if (constraint.body != body.name) {
            continue;
        }
        for (const std::uint32_t vertex : select_vertices(placed, constraint)) {
            const auto [begin, end] = held.equal_range(vertex);
            const auto other = std::find_if(begin, end, [&](const auto& entry) {
                return do_overlap(*entry.second, constraint);
            });
            if (other != end) {
                throw Error(at(constraint.source) + "vertex " + std::to_string(vertex)
                            + " of body \"" + body.name
                            + "\" is held by two constraints at one time"
                            + (other->second->source.empty()
                                   ? ""
                                   : ", this one and that at " + other->second->source)
                            + "; make their selections disjoint, or let one end before the"
                              " other begins");
            }
            held.emplace(vertex, &constraint);
        }
    }
}

template <int Dim>
SceneMeshes<Dim> read_meshes(const Scene& scene) {
    SceneMeshes<Dim> result;
    for (const Body& body : scene.bodies) {
        static_cast<void>(info_of_mesh<Dim>(body));
        SimplexMesh<Dim> mesh;
        with_place_of(body, [&] { mesh = read_mesh<Dim>(body.mesh).mesh; });
        check_size(mesh, body);
        judge_facets<Dim>(scene, body, match_facets<Dim>(mesh.cells, mesh.vertex_count()),
                          result.warnings);
        result.meshes.push_back(std::move(mesh));
    }
    for (std::size_t i = 0; i < scene.bodies.size(); ++i) {
        check_constraints(scene, scene.bodies[i], result.meshes[i]);
    }
    return result;
}

#define PENT_INSTANTIATE(Dim)                                                          \
    template SceneMeshes<Dim> read_meshes<Dim>(const Scene&);                          \
    template FileInfo info_of_mesh<Dim>(const Body&);                                  \
    template void check_size<Dim>(const SimplexMesh<Dim>&, const Body&);               \
    template void judge_facets<Dim>(const Scene&, const Body&, const FacetMatch<Dim>&, \
                                    std::vector<std::string>&);                        \
    template void check_constraints<Dim>(const Scene&, const Body&, const SimplexMesh<Dim>&);
PENT_INSTANTIATE(3)
PENT_INSTANTIATE(4)
#undef PENT_INSTANTIATE

}  // namespace pent::runs
