#pragma once

#include <pent/mesher/edge_order.h>
#include <pent/mesher/extrude.h>
#include <pent/mesher/prove.h>
#include <pent/mesher/quality.h>
#include <pent/mesher/surface_check.h>
#include <pent/mesher/tetrahedralize.h>

#include <cstdint>
#include <filesystem>
#include <optional>
#include <string>
#include <vector>

namespace pent::mesher {

/// How a base mesh becomes a body of one dimension more.
struct ExtrusionRequest {
    /// The whole extrusion along the new axis, m; negative goes the other way. By default 0.2 of
    /// the largest side of the base's bounding box.
    std::optional<double> thickness;
    /// The whole extrusion as a vector of the body's space, m; instead of thickness.
    std::optional<Eigen::VectorXd> direction;
    int layers = 0;  ///< Slabs of simplices, 1 to 1e6; 0: see automatic_slabs().
    Anchor anchor = Anchor::Middle;
    bool alternate = true;
    VertexOrder order = VertexOrder::Index;
    std::filesystem::path edge_directions;  ///< File of directed edges, instead of an order.
};

/// What pent-mesh is asked for.
struct BodyRequest {
    std::filesystem::path input;
    std::int64_t surface_triangles = 0;  ///< To refine or coarsen the surface to; 0: as it is.
    TetrahedraOptions tetrahedra;
    ExtrusionRequest extrusion;
};

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
    SurfaceReport surface;    ///< Of the surface that was filled.
    double surface_area = 0;  ///< m^2.

    std::string generator;  ///< What made the base cells, as in "TetGen pq1.414Y".
    std::int64_t base_vertices = 0;
    std::int64_t base_cells = 0;
    double base_volume = 0;  ///< m^(Dim - 1).
    double base_edge = 0;    ///< Mean length, m.

    Eigen::VectorXd direction;  ///< The whole extrusion, m.
    int layers = 0;             ///< Slabs of simplices.

    Proof proof;
    QualityReport quality;
    std::vector<Stage> stages;
};

template <int Dim>
struct Body {
    SimplexMesh<Dim> mesh;
    BodyReport report;
};

/// Makes a pentachoral body from a closed surface: read, check, resample, fill, extrude, prove.
///
/// Throws an Error if the surface is not clean, with what, how many and where; if a stage fails; or
/// if the result does not pass prove().
[[nodiscard]] Body<4> make_body(const BodyRequest& request);

/// Makes a tetrahedral body from a flat triangle mesh: all z are equal, and become the base of the
/// extrusion along z. Throws as make_body() does.
[[nodiscard]] Body<3> make_body_from_plane(const BodyRequest& request);

}  // namespace pent::mesher
