#pragma once

#include "stage_clock.h"

#include <pent/mesher/curve_boundary.h>
#include <pent/mesher/make_body.h>
#include <pent/mesher/surface.h>

#include <filesystem>

/// The steps of make_body() and make_solid(), which choose among them.

namespace pent::mesher {

/// A box of cubes, cut.
template <int Dim>
[[nodiscard]] Body<Dim> make_box(const BoxShape& shape,
                                 const BodyRequest& request,
                                 StageClock& clock);

/// A shape file, a boundary or an image, stuffed.
[[nodiscard]] Body<4> make_stuffed(const std::filesystem::path& path,
                                   const BodyRequest& request,
                                   StageClock& clock);

/// Mends and fills a surface; says before how many cells will come of it.
/// @param extrusion  Gets its layers where a number of cells is asked for.
template <int Dim>
[[nodiscard]] SimplexMesh<3> filled_base(const SurfaceFile& file,
                                         const BodyRequest& request,
                                         ExtrusionRequest& extrusion,
                                         BodyReport& report,
                                         StageClock& clock);

/// Notes vertices, cells, volume and mean edge of a base in a report.
template <int Dim>
void describe_base(const SimplexMesh<Dim>& base, BodyReport& report);

/// Extrudes a base with its quantities, and finishes the body.
template <int Dim>
[[nodiscard]] Body<Dim> extrude_and_prove(const SimplexMesh<Dim - 1>& base,
                                          const MeshExtras<Dim - 1>& fields,
                                          const BodyRequest& request,
                                          const ExtrusionRequest& extrusion,
                                          BodyReport report,
                                          StageClock& clock);

/// Moves a body of mesh, quantities and report where it is asked for, proves and measures it;
/// subdivides it first if that is asked for.
///
/// @param expected_volume  m^Dim; 0: what its cells have.
/// @param onto             Where a curved boundary's middles go; empty where the surface is flat.
template <int Dim>
[[nodiscard]] Body<Dim> finish(Body<Dim> body,
                               double expected_volume,
                               const BodyRequest& request,
                               StageClock& clock,
                               const OntoSurface<Dim>& onto = {});

/// In how many parts finish() cuts every edge.
[[nodiscard]] int parts_of_edge(const BodyRequest& request);

/// Cells and seconds of a body of which the base and the number of slabs are known.
template <int Dim>
[[nodiscard]] ExpectedSize expected_size(double base_cells,
                                         double cells_over,
                                         int slabs,
                                         const BodyRequest& request);

/// Tells who asked how large the body will be; they may throw.
void announce(const BodyRequest& request, const ExpectedSize& size);

}  // namespace pent::mesher
