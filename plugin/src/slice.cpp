// Slices, by the viewer; a library that was built without it says so.

#include "handles.h"

#ifdef PENT_HAS_VIEWER
#include <pent/viewer/slice.h>

#include <cmath>
#include <utility>
#endif

using namespace pent;
using namespace pent::plugin;

#ifdef PENT_HAS_VIEWER

namespace {

template <int Dim>
viewer::Surface section(const viewer::Boundary<Dim>& boundary,
                        const Positions<Dim>& positions,
                        const viewer::Hyperplane& plane) {
    if constexpr (Dim == 3) {
        return viewer::skin(boundary, positions);
    } else {
        return viewer::merge_coincident(viewer::slice(boundary, positions, plane));
    }
}

template <int Dim>
viewer::Hyperplane hyperplane(const double* normal, double offset) {
    if (Dim == 3) {
        return {};
    }
    const Eigen::Vector4d n = vector<4>(normal, "normal");
    if (!std::isfinite(offset)) {
        throw Error("the offset of a slice must be finite");
    }
    return viewer::hyperplane_across(n, offset / n.norm());
}

// Keeps a surface in `seen`, and gives what a host sees of it.
pent_surface show(viewer::Surface made, const viewer::Hyperplane& plane, SeenSurface& seen) {
    seen = {std::move(made.positions), std::move(made.triangles), std::move(made.ends),
            std::move(made.weights)};
    pent_surface surface = {.positions = seen.positions.data(),
                            .vertices = seen.positions.cols(),
                            .triangles = seen.triangles.data(),
                            .triangle_count = seen.triangles.cols(),
                            .ends = seen.ends.data(),
                            .weights = seen.weights.data(),
                            .frame = {}};
    Eigen::Map<Eigen::Matrix<double, 4, 4, Eigen::RowMajor>>(surface.frame) = plane.frame;
    return surface;
}

template <int Dim>
pent_surface slice_stored(StoredMesh& stored,
                          const SimplexMesh<Dim>& mesh,
                          const double* positions,
                          const viewer::Hyperplane& plane) {
    static thread_local SeenSurface seen;
    const Positions<Dim> places = positions == nullptr
                                      ? mesh.positions
                                      : array<Dim>(positions, mesh.vertex_count(), "positions");
    if (!places.allFinite()) {
        throw Error(stored.name + ": the positions of a slice must be finite");
    }
    const std::vector<std::uint32_t>& facets = boundary_of(stored, mesh);
    const auto boundary = viewer::index_boundary<Dim>(
        Eigen::Map<const Simplices<Dim>>(facets.data(), Dim,
                                         static_cast<Eigen::Index>(facets.size()) / Dim),
        mesh.vertex_count());
    return show(section<Dim>(boundary, places, plane), plane, seen);
}

}  // namespace

int pent_slice(pent_simulation* simulation,
               int body,
               const double* normal,
               double offset,
               pent_surface* surface) {
    return with_body(simulation, body, -1, [&](auto& held, Opened& opened) {
        constexpr int kDim = kDimOf<std::remove_reference_t<decltype(held)>>;
        require(surface, "surface");
        const viewer::Hyperplane plane = hyperplane<kDim>(normal, offset);
        const auto boundary = viewer::make_boundary<kDim>(held.mesh(body), "the mesh");
        *surface =
            show(section<kDim>(boundary, held.positions(body), plane), plane, opened.surface);
        return 0;
    });
}

int pent_slice_mesh(const pent_stored_mesh* mesh,
                    const double* positions,
                    const double* normal,
                    double offset,
                    pent_surface* surface) {
    return guarded(-1, [&] {
        const std::shared_ptr<StoredMesh> stored = meshes().find(mesh, "mesh");
        require(surface, "surface");
        *surface = std::visit(
            [&]<int Dim>(const SimplexMesh<Dim>& held) -> pent_surface {
                if constexpr (Dim == 2) {
                    throw Error(stored->name
                                + ": a mesh of 2 dimensions; slices are of bodies of 3 or 4");
                } else {
                    return slice_stored(*stored, held, positions, hyperplane<Dim>(normal, offset));
                }
            },
            stored->mesh);
        return 0;
    });
}

#else

namespace {

constexpr const char* kNoViewer =
    "this library was built without the viewer (PENT_BUILD_VIEWER), which slices";

}  // namespace

int pent_slice(pent_simulation* simulation,
               int body,
               const double* /*normal*/,
               double /*offset*/,
               pent_surface* /*surface*/) {
    return with_body(simulation, body, -1,
                     [](auto& /*held*/, Opened& /*opened*/) -> int { throw Error(kNoViewer); });
}

int pent_slice_mesh(const pent_stored_mesh* /*mesh*/,
                    const double* /*positions*/,
                    const double* /*normal*/,
                    double /*offset*/,
                    pent_surface* /*surface*/) {
    return guarded(-1, []() -> int { throw Error(kNoViewer); });
}

#endif
