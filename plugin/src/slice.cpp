// Slices, by the viewer; a library that was built without it says so.

#include "handles.h"

#ifdef PENT_HAS_VIEWER
#include <pent/viewer/attributes.h>
#include <pent/viewer/slice.h>

#include <algorithm>
#include <cmath>
#include <iterator>
#include <memory>
#include <numbers>
#include <utility>
#endif

using namespace pent;
using namespace pent::plugin;

#ifdef PENT_HAS_VIEWER

namespace {

template <int Dim>
viewer::Surface section(const viewer::Boundary<Dim>& boundary,
                        const Positions<Dim>& positions,
                        const viewer::FramedHyperplane& plane) {
    if constexpr (Dim == 3) {
        return viewer::skin(boundary, positions);
    } else {
        return viewer::merge_coincident(viewer::slice(boundary, positions, plane));
    }
}

template <int Dim>
viewer::FramedHyperplane hyperplane(const double* normal, double offset) {
    if (Dim == 3) {
        return {};
    }
    const Eigen::Vector4d n = vector<4>(normal, "normal");
    if (!std::isfinite(offset)) {
        throw Error("the offset of a slice must be finite");
    }
    return viewer::hyperplane_across(n, offset / n.stableNorm());
}

// Keeps a surface in `seen`, and gives what a host sees of it.
pent_surface show(viewer::Surface made, const viewer::FramedHyperplane& plane, SeenSurface& seen) {
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

[[noreturn]] void refuse_sheet(const std::string& name) {
    throw Error(name + ": a mesh of 2 dimensions; slices and strains are of bodies of 3 or 4");
}

// Calls work(mesh, stored) with a mesh of 3 or 4 dimensions.
template <typename Value, typename Work>
Value with_solid(const pent_stored_mesh* handle, Value failure, const Work& work) {
    return guarded(failure, [&]() -> Value {
        const std::shared_ptr<StoredMesh> stored = meshes().find(handle, "mesh");
        return std::visit(
            [&]<int Dim>(const SimplexMesh<Dim>& held) -> Value {
                if constexpr (Dim == 2) {
                    refuse_sheet(stored->name);
                } else {
                    return work(held, *stored);
                }
            },
            stored->mesh);
    });
}

// The boundary of a stored mesh as slices need it.
template <int Dim>
const viewer::Boundary<Dim>& indexed(StoredMesh& stored, const SimplexMesh<Dim>& mesh) {
    std::call_once(stored.is_indexed, [&] {
        const std::vector<std::uint32_t>& facets = boundary_of(stored, mesh);
        const Eigen::Map<const Simplices<Dim>> columns(
            facets.data(), Dim, static_cast<Eigen::Index>(facets.size()) / Dim);
        stored.index = std::make_shared<const viewer::Boundary<Dim>>(
            viewer::index_boundary<Dim>(columns, mesh.vertex_count()));
    });
    return *static_cast<const viewer::Boundary<Dim>*>(stored.index.get());
}

// The same of a body: no step changes which vertices its facets have.
template <int Dim>
const viewer::Boundary<Dim>& indexed(BodyBoundary& kept, const SimplexMesh<Dim>& mesh) {
    if (kept.index == nullptr) {
        kept.index = std::make_shared<const viewer::Boundary<Dim>>(
            viewer::make_boundary<Dim>(mesh, "the mesh"));
    }
    return *static_cast<const viewer::Boundary<Dim>*>(kept.index.get());
}

// Where the vertices of a stored mesh are: as a host says, or at rest.
template <int Dim>
Positions<Dim> places_of(const StoredMesh& stored,
                         const SimplexMesh<Dim>& mesh,
                         const double* positions) {
    const Positions<Dim> places = positions == nullptr
                                      ? mesh.positions
                                      : array<Dim>(positions, mesh.vertex_count(), "positions");
    if (!places.allFinite()) {
        throw Error(stored.name + ": the positions of a slice must be finite");
    }
    return places;
}

// The slice by the hyperplane that plane(dimension) gives; `normals` gets those of smooth shading
// unless it is NULL.
template <typename Plane>
int slice_stored(const pent_stored_mesh* mesh,
                 const double* positions,
                 const Plane& plane_of,
                 pent_surface* surface,
                 const double** normals) {
    return with_solid(mesh, -1, [&]<int Dim>(const SimplexMesh<Dim>& held, StoredMesh& stored) {
        require(surface, "surface");
        const viewer::FramedHyperplane plane = plane_of(std::integral_constant<int, Dim>());
        const Positions<Dim> places = places_of(stored, held, positions);
        const viewer::Boundary<Dim>& boundary = indexed(stored, held);
        viewer::Surface made = section<Dim>(boundary, places, plane);
        if (normals != nullptr) {
            static thread_local Positions<3> shading;
            const Eigen::Matrix<double, 3, Dim> axes = plane.frame.topLeftCorner<3, Dim>();
            shading = viewer::corner_normals<Dim>(made, boundary, places, axes, viewer::kCrease);
            *normals = shading.data();
        }
        static thread_local SeenSurface seen;
        *surface = show(std::move(made), plane, seen);
        return 0;
    });
}

viewer::PlaneRotation rotation_of(const pent_turn& turn) {
    const auto is_axis = [](std::int32_t axis) { return axis >= 0 && axis < 4; };
    if (!is_axis(turn.from) || !is_axis(turn.to) || turn.from == turn.to) {
        throw Error("turn: found the axes " + std::to_string(turn.from) + " and "
                    + std::to_string(turn.to) + "; expected two of 0 to 3");
    }
    if (!std::isfinite(turn.degrees)) {
        throw Error("turn: found an angle that is not finite; expected degrees");
    }
    return {turn.from, turn.to, turn.degrees * (std::numbers::pi / 180)};
}

viewer::FramedHyperplane hyperplane_of(const pent_hyperplane* plane) {
    require(plane, "plane");
    if (!std::isfinite(plane->offset)) {
        throw Error("the offset of a slice must be finite");
    }
    if (plane->turn_count < 0) {
        throw Error("turn_count is " + std::to_string(plane->turn_count) + "; expected 0 or more");
    }
    if (plane->turn_count > 0) {
        require(plane->turns, "turns");
    }
    std::vector<viewer::PlaneRotation> rotations;
    std::transform(plane->turns, plane->turns + plane->turn_count, std::back_inserter(rotations),
                   rotation_of);
    return viewer::hyperplane_at(plane->offset, rotations);
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
        const viewer::FramedHyperplane plane = hyperplane<kDim>(normal, offset);
        const auto& boundary = indexed<kDim>((*opened.boundaries)[body], held.mesh(body));
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
    const auto plane = [&](auto dimension) { return hyperplane<dimension>(normal, offset); };
    return slice_stored(mesh, positions, plane, surface, nullptr);
}

int pent_slice_turned(const pent_stored_mesh* mesh,
                      const double* positions,
                      const pent_hyperplane* plane,
                      pent_surface* surface,
                      const double** normals) {
    const auto plane_of = [&](auto dimension) {
        return dimension == 3 ? viewer::FramedHyperplane() : hyperplane_of(plane);
    };
    return slice_stored(mesh, positions, plane_of, surface, normals);
}

const double* pent_mesh_strain(const pent_stored_mesh* mesh, const double* positions) {
    return with_solid<const double*>(
        mesh, nullptr, [&]<int Dim>(const SimplexMesh<Dim>& held, StoredMesh& stored) {
            static thread_local Eigen::VectorXd strain;
            strain = viewer::vertex_strain<Dim>(held, places_of(stored, held, positions));
            return static_cast<const double*>(strain.data());
        });
}

const double* pent_mesh_means(const pent_stored_mesh* mesh, const double* values, int32_t rows) {
    return with_solid<const double*>(
        mesh, nullptr, [&]<int Dim>(const SimplexMesh<Dim>& held, StoredMesh& /*stored*/) {
            require(values, "values");
            if (rows < 1 || rows > Dim) {
                throw Error("rows is " + std::to_string(rows) + "; expected 1 to "
                            + std::to_string(Dim));
            }
            static thread_local Eigen::MatrixXd means;
            means = viewer::vertex_means<Dim>(
                held, Eigen::Map<const Eigen::MatrixXd>(values, rows, held.cell_count()));
            return static_cast<const double*>(means.data());
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

int pent_slice_turned(const pent_stored_mesh* /*mesh*/,
                      const double* /*positions*/,
                      const pent_hyperplane* /*plane*/,
                      pent_surface* /*surface*/,
                      const double** /*normals*/) {
    return guarded(-1, []() -> int { throw Error(kNoViewer); });
}

const double* pent_mesh_strain(const pent_stored_mesh* /*mesh*/, const double* /*positions*/) {
    return guarded<const double*>(nullptr, []() -> const double* { throw Error(kNoViewer); });
}

const double* pent_mesh_means(const pent_stored_mesh* /*mesh*/,
                              const double* /*values*/,
                              int32_t /*rows*/) {
    return guarded<const double*>(nullptr, []() -> const double* { throw Error(kNoViewer); });
}

#endif
