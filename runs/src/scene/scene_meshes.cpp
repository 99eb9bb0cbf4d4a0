#include "scene/scene_meshes.h"

#include <pent/error.h>
#include <pent/formatted.h>
#include <pent/number_bounds.h>
#include <pent/simulator/placed_mesh.h>

#include <utility>

namespace pent::runs {

namespace {

std::string at(const std::string& source) {
    return source.empty() ? "" : source + ": ";
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
void judge_mesh(const Scene& scene,
                const Body& body,
                const SimplexMesh<Dim>& mesh,
                std::vector<std::string>& warnings) {
    check_size(mesh, body);
    judge_facets<Dim>(scene, body, match_facets<Dim>(mesh.cells, mesh.vertex_count()), warnings);
}

template <int Dim>
SceneMeshes<Dim> read_meshes(const Scene& scene) {
    SceneMeshes<Dim> result;
    for (const Body& body : scene.bodies) {
        static_cast<void>(info_of_mesh<Dim>(body));
        SimplexMesh<Dim> mesh;
        with_place_of(body, [&] { mesh = read_mesh<Dim>(body.mesh).mesh; });
        judge_mesh(scene, body, mesh, result.warnings);
        result.meshes.push_back(std::move(mesh));
    }
    return result;
}

template <int Dim>
void turn(std::vector<VertexField>& fields, const simulator::Placement& placement) {
    if (placement.rotate.empty()) {
        return;
    }
    SimplexMesh<Dim> axes;
    axes.fibers = Eigen::Matrix<double, Dim, Dim>::Identity();
    put_in_place(axes, placement);
    const Eigen::Matrix<double, Dim, Dim> rotation = axes.fibers;
    // One by one: a sum must not hang on how many of them a rank has.
    for (VertexField& field : fields) {
        for (Eigen::Index i = 0; field.values.rows() == Dim && i < field.values.cols(); ++i) {
            const Eigen::Matrix<double, Dim, 1> before = field.values.col(i);
            field.values.col(i) = rotation * before;
        }
    }
}

#define PENT_INSTANTIATE(Dim)                                                          \
    template SceneMeshes<Dim> read_meshes<Dim>(const Scene&);                          \
    template void judge_mesh<Dim>(const Scene&, const Body&, const SimplexMesh<Dim>&,  \
                                  std::vector<std::string>&);                          \
    template void turn<Dim>(std::vector<VertexField>&, const simulator::Placement&);   \
    template FileInfo info_of_mesh<Dim>(const Body&);                                  \
    template void check_size<Dim>(const SimplexMesh<Dim>&, const Body&);               \
    template void judge_facets<Dim>(const Scene&, const Body&, const FacetMatch<Dim>&, \
                                    std::vector<std::string>&);
PENT_INSTANTIATE(3)
PENT_INSTANTIATE(4)
#undef PENT_INSTANTIATE

}  // namespace pent::runs
