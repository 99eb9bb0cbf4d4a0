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
viewer::Surface section(const Simulation<Dim>& simulation,
                        int body,
                        const viewer::Hyperplane& plane) {
    const auto boundary = viewer::make_boundary<Dim>(simulation.mesh(body), "the mesh");
    if constexpr (Dim == 3) {
        return viewer::skin(boundary, simulation.positions(body));
    } else {
        return viewer::merge_coincident(viewer::slice(boundary, simulation.positions(body), plane));
    }
}

viewer::Hyperplane hyperplane(const double* normal, double offset) {
    const Eigen::Vector4d n = vector<4>(normal, "normal");
    if (!std::isfinite(offset)) {
        throw Error("the offset of a slice must be finite");
    }
    return viewer::hyperplane_across(n, offset / n.norm());
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
        const viewer::Hyperplane plane =
            kDim == 4 ? hyperplane(normal, offset) : viewer::Hyperplane();
        viewer::Surface made = section(held, body, plane);
        opened.surface = {std::move(made.positions), std::move(made.triangles),
                          std::move(made.ends), std::move(made.weights)};
        const SeenSurface& seen = opened.surface;
        *surface = {.positions = seen.positions.data(),
                    .vertices = seen.positions.cols(),
                    .triangles = seen.triangles.data(),
                    .triangle_count = seen.triangles.cols(),
                    .ends = seen.ends.data(),
                    .weights = seen.weights.data(),
                    .frame = {}};
        Eigen::Map<Eigen::Matrix<double, 4, 4, Eigen::RowMajor>>(surface->frame) = plane.frame;
        return 0;
    });
}

#else

int pent_slice(pent_simulation* simulation,
               int body,
               const double* /*normal*/,
               double /*offset*/,
               pent_surface* /*surface*/) {
    return with_body(simulation, body, -1, [](auto& /*held*/, Opened& /*opened*/) -> int {
        throw Error("this library was built without the viewer (PENT_BUILD_VIEWER), which slices");
    });
}

#endif
