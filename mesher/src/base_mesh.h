#pragma once

#include "stage_clock.h"

#include <pent/error.h>
#include <pent/mesher/make_body.h>
#include <pent/mesher/surface.h>
#include <pent/pent_file.h>

#include <functional>
#include <string>

namespace pent::mesher {

/// What errors call the input: a path, "standard input" or "the shape".
[[nodiscard]] std::string name_of_input(const BodyRequest& request);

/// Does a step that knows only the mesh, and puts the name of the input before its errors.
template <typename Step>
auto with_name(const BodyRequest& request, Step step) {
    try {
        return step();
    } catch (const Error& error) {
        throw Error(name_of_input(request) + ": " + error.what());
    }
}

/// Whether the input is tetrahedra already, and not a surface to be filled.
[[nodiscard]] bool has_tetrahedra(const BodyRequest& request);

/// The surface that a file has, scaled, or a sphere.
[[nodiscard]] SurfaceFile surface_of(const BodyRequest& request);

/// Tetrahedra that need no filling, with their quantities.
struct BaseMesh {
    SimplexMesh<3> mesh;
    MeshExtras<3> extras;
};

/// The tetrahedra that a file has, scaled, or a ball. Throws an Error as require_sound_base() does.
[[nodiscard]] BaseMesh read_base(const BodyRequest& request, BodyReport& report, StageClock& clock);

/// Fills a surface that is clean and oriented. `filled` becomes the surface that was filled in the
/// end, which is another one where it is resampled.
using Fill = std::function<Tetrahedra(const Surface& surface, Surface& filled)>;

/// Mends a surface, and fills it; if a wrap is allowed and filling fails, fills its wrap.
/// @param before_filling  Is given the surface that is to be filled; may throw.
[[nodiscard]] SimplexMesh<3> fill_base(const SurfaceFile& file,
                                       const BodyRequest& request,
                                       const std::function<void(const Surface&)>& before_filling,
                                       const Fill& fill,
                                       BodyReport& report,
                                       StageClock& clock);

/// Resamples a surface if an edge length or a number of triangles is asked for, and fills it.
[[nodiscard]] Tetrahedra fill_at(const Surface& surface,
                                 double edge_length,
                                 const BodyRequest& request,
                                 Surface& filled);

/// About how many tetrahedra fill_at() will make, and in how many seconds.
struct FillEstimate {
    double tetrahedra = 0;
    double seconds = 0;
    double edge = 0;  ///< Mean length, m.
};
[[nodiscard]] FillEstimate estimate_filling(const Surface& surface, const BodyRequest& request);

/// How many times as many tetrahedra TetGen needs as regular ones with the same edge would be.
inline constexpr double kCrowding = 1.3;

}  // namespace pent::mesher
