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

/// What a stage of the work took.
struct Stage {
    std::string name;
    double seconds = 0;
};

/// What came out, and how.
struct BodyReport {
    std::int64_t merged_points = 0;
    std::int64_t flipped_triangles = 0;
    std::int64_t components = 0;
    std::int64_t cavities = 0;
    std::string cut;                ///< Cells of a tet mesh that were cut, see TetrahedraFile.
    std::string left_out;           ///< What of the file is no part of the body: cells of fewer
                                    ///< dimensions than tetrahedra or triangles, quantities.
    std::string region_array;       ///< See TetrahedraFile.
    std::int64_t curved_cells = 0;  ///< Its cells of higher order, of which the corners were taken.
    Repair repair = Repair::None;   ///< How the surface was mended, if it had to be.
    double repair_distance = 0;     ///< From the mended surface to the one read, m.
    SurfaceReport surface_read;     ///< Before.
    SurfaceReport surface;          ///< Of the surface that was filled.
    double surface_area = 0;        ///< m^2.

    std::string generator;  ///< What made the base cells, as in "TetGen pq1.414Y".
    std::string failures;   ///< Of steps and generators tried in vain; empty if there were none.
    int fillings = 0;       ///< How often the surface was filled to meet target_cells.
    std::int64_t base_vertices = 0;
    std::int64_t base_cells = 0;
    double base_volume = 0;  ///< m^(Dim - 1).
    double base_edge = 0;    ///< Mean length, m.

    Eigen::VectorXd direction;  ///< From the first layer to the last, m.
    int layers = 0;             ///< Slabs of simplices; 0: not extruded.
    double lowest_layer = 0;    ///< From middle to middle of two, m.
    double highest_layer = 0;   ///< The same.
    std::int64_t beveled = 0;   ///< Of a shape's boundary: see StuffedSolid.
    ThinParts thin_parts;       ///< Of a shape, boundary or image, where it was meshed.
    BoundaryReport boundary;    ///< Of a boundary of tetrahedra that was read.
    CurveReport curve;          ///< Where the boundary is curved.

    Proof proof;
    QualityReport quality;
    std::vector<Stage> stages;
};

}  // namespace pent::mesher
