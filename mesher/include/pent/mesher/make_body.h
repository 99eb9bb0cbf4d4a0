#pragma once

#include <pent/mesher/body_report.h>
#include <pent/mesher/body_request.h>

#include <optional>

namespace pent::mesher {

template <int Dim>
struct Body {
    SimplexMesh<Dim> mesh;
    MeshExtras<Dim> extras;  ///< Of tet meshes: their quantities of vertices and cells.
    BodyReport report;
    std::optional<Extrusion<Dim>> extrusion;  ///< What it was extruded from, if that was asked for.
};

/// Makes a pentachoral body from a surface (read, mend, resample, fill, extrude, prove), from a tet
/// mesh (read, extrude, prove) or from a shape file, boundary or image (read, stuff with edges of
/// edge_length, prove).
///
/// If a surface that was clean or lightly mended cannot be filled, and a wrap is allowed, its wrap
/// is. An edge length beyond that of the surface coarsens it. Throws an Error if the surface cannot
/// be made clean, with what, how many and where; if a stage fails; or if the result does not pass
/// prove(); or if something is asked for that the input does not need, as layers of a box.
[[nodiscard]] Body<4> make_body(const BodyRequest& request);

/// Makes a tetrahedral body: of a surface (read, mend, resample, fill, prove), of a tet mesh, a
/// ball or a box as they are, or of a flat triangle mesh, where all z are equal: the base of an
/// extrusion along z. Throws as make_body() does.
[[nodiscard]] Body<3> make_solid(const BodyRequest& request);

}  // namespace pent::mesher
