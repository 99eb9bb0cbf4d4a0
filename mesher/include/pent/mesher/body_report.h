#pragma once

#include <pent/mesher/boundary_solid.h>
#include <pent/mesher/curve_boundary.h>
#include <pent/mesher/prove.h>
#include <pent/mesher/quality.h>
#include <pent/mesher/repair.h>
#include <pent/mesher/stuff.h>
#include <pent/mesher/surface_check.h>

#include <Eigen/Core>

#include <cstdint>
#include <string>
#include <vector>

namespace pent::mesher {

/// How long a stage of the work took, by the wall clock.
struct Stage {
    std::string name;
    double seconds = 0;
};

/// How the input of a body was read, mended and meshed, and what was proved and measured of it.
struct BodyReport {
    std::int64_t merged_points = 0;
    std::int64_t flipped_triangles = 0;
    std::int64_t components = 0;
    std::int64_t cavities = 0;
    std::string cut;                ///< Cells of a tet mesh that were cut, see TetrahedraFile.
    std::string left_out;           ///< What of the file is no part of the body: cells of fewer
                                    ///< dimensions than tetrahedra or triangles, quantities.
    std::string region_array;       ///< See TetrahedraFile.
    std::int64_t curved_cells = 0;  ///< Higher-order cells of the file: their corners were taken.
    Repair repair = Repair::None;   ///< How the surface was mended, if it had to be.
    double repair_distance = 0;     ///< From the mended surface to the one read, m.
    SurfaceReport surface_read;     ///< Defects of the surface as it was read.
    SurfaceReport surface;          ///< The same of the surface that was filled.
    double surface_area = 0;        ///< m^2.

    std::string generator;  ///< What made the base cells, as in "TetGen pq1.414Y".
    std::string failures;   ///< Why repair steps and generators failed; empty if none did.
    int fillings = 0;       ///< How often the surface was filled to meet target_cells.
    std::int64_t base_vertices = 0;
    std::int64_t base_cells = 0;
    double base_volume = 0;  ///< m^(Dim - 1).
    double base_edge = 0;    ///< Mean length of its edges, m.

    Eigen::VectorXd direction;  ///< From the first layer to the last, m.
    int layers = 0;             ///< Slabs of simplices; 0: not extruded.
    double lowest_layer = 0;    ///< Height of the lowest slab: between its layers' offsets, m.
    double highest_layer = 0;   ///< The same of the highest slab.
    std::int64_t beveled = 0;   ///< Of a stuffed body: see StuffedSolid.
    ThinParts thin_parts;       ///< Of a stuffed body: what was too thin for its edges.
    BoundaryReport boundary;    ///< Of a boundary of tetrahedra that was read.
    CurveReport curve;          ///< Of quadratic cells that are curved along the boundary.

    Proof proof;
    QualityReport quality;
    std::vector<Stage> stages;
};

}  // namespace pent::mesher
