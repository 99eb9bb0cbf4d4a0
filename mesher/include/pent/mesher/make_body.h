#pragma once

#include <pent/mesher/boundary_solid.h>
#include <pent/mesher/curve_boundary.h>
#include <pent/mesher/edge_order.h>
#include <pent/mesher/extrude.h>
#include <pent/mesher/prove.h>
#include <pent/mesher/quality.h>
#include <pent/mesher/repair.h>
#include <pent/mesher/shapes.h>
#include <pent/mesher/size_field.h>
#include <pent/mesher/step_limits.h>
#include <pent/mesher/surface_check.h>
#include <pent/mesher/tetrahedralize.h>

#include <cstdint>
#include <filesystem>
#include <functional>
#include <optional>
#include <string>
#include <variant>
#include <vector>

namespace pent::mesher {

/// Shapes that need no file. Spheres and balls are bases to extrude, boxes are bodies already.
struct SphereShape {
    int frequency = 4;  ///< See sphere(); filled as any surface is.
    double radius = 1;  ///< m.
};
struct BallShape {
    int frequency = 4;  ///< See ball().
    double radius = 1;  ///< m.
};
struct BoxShape {
    std::vector<int> count = {1, 1, 1, 1};    ///< Cubes along each axis of the body.
    std::vector<double> size = {1, 1, 1, 1};  ///< m; centered at the origin.
    CubeCut cut = CubeCut::Paths;
};

/// How a base mesh becomes a body of one dimension more.
struct ExtrusionRequest {
    /// The whole extrusion along the new axis, m; negative goes the other way. By default 0.2 of
    /// the largest side of the base's bounding box.
    std::optional<double> thickness;
    /// The whole extrusion as a vector of the body's space, m; instead of thickness.
    std::optional<Eigen::VectorXd> direction;
    int layers = 0;  ///< Slabs of simplices, 1 to 1e6; 0: so that the lowest is as
                     ///< automatic_slabs() has it.
    /// Each slab is this many times as high as its neighbor towards w = 0, where slices are; >= 1.
    double grade = 1;
    /// Heights of the slabs from w = 0 outward, to either side of it where the extrusion has two;
    /// instead of layers and grade, m. They are the thickness, or share out the one that is asked
    /// for: along a round body's meridian, along the way of a profile.
    std::vector<double> layer_heights;
    Anchor anchor = Anchor::Middle;
    std::filesystem::path profile;  ///< File of layers (see read_profile), instead of thickness and
                                    ///< direction; with layers, grade or heights see relayer().
    bool round = false;  ///< To a point at both ends, see round_layers(); thickness is the whole
                         ///< height, and by default the largest side.
    bool alternate = true;
    VertexOrder order = VertexOrder::Index;
    std::filesystem::path edge_directions;  ///< File of directed edges, instead of an order.
};

/// How an image becomes a body: by one of level and labels.
struct ImageRequest {
    std::optional<double> level;  ///< The body is where samples are above it.
    bool is_labels = false;       ///< Samples are numbers of regions, 0 is outside; cells get them.
    std::optional<Eigen::Vector4d> spacing;  ///< Of samples, m, instead of the file's.
};

/// How large a body will be, before the work that depends on it.
struct ExpectedSize {
    double cells = 0;
    double base_cells = 0;
    int layers = 0;      ///< 0: not extruded.
    double seconds = 0;  ///< Very roughly, of one core.
};

/// What pent-mesh is asked for.
struct BodyRequest {
    /// A file with a surface, a tet mesh, a shape, the boundary of a body or an image (see
    /// read_surface, read_tetrahedra, read_solid, read_boundary, read_image), or a shape that needs
    /// no file. The path "-" is standard input.
    std::variant<std::filesystem::path, SphereShape, BallShape, BoxShape> input;
    std::string format;           ///< Of the file, as in "obj"; empty: by the ending of its name.
    double scale = 1;             ///< Coordinates in the file times this are m; above 0.
    Eigen::VectorXd translation;  ///< Of the body at the end, m; 3 or all components, or none.
    RepairOptions repair;
    std::int64_t surface_triangles = 0;  ///< To refine or coarsen the surface to; 0: as it is.
    double edge_length = 0;         ///< To aim at, on the surface and inside, m; 0: as it comes.
    SizeField sizes;                ///< Of shapes: where edges may be longer, in the body's space.
    std::int64_t target_cells = 0;  ///< To aim at in the body, within 2%; 0: as it comes.
    TetrahedraOptions tetrahedra;   ///< Its edge_length is for the inside alone.
    ExtrusionRequest extrusion;
    ImageRequest image;
    /// Called when a stage of the work begins, as in "fill".
    std::function<void(const std::string& stage)> on_stage;
    /// Called with an estimate before a surface is filled or a shape stuffed, and with the number
    /// before other cells are made, unless target_cells asks for one. May throw to stop the work.
    std::function<void(const ExpectedSize&)> on_size;
    int subdivide = 1;  ///< Every edge of the body is cut in this many parts, see subdivide().
    bool is_quadratic = false;  ///< Then made ready for quadratic elements, see make_quadratic().
    bool is_curved = false;     ///< Their middles on the boundary's surface, see curve_boundary():
                                ///< of quadratic ones alone, not subdivided; of 4D what is stuffed,
                                ///< of 3D spheres and balls.

    /// Sets what every step that may crash or run away is allowed.
    void limit_steps(const StepLimits& limits) {
        repair.limits = limits;
        tetrahedra.limits = limits;
    }
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
    std::string cut;                ///< Cells of a tet mesh that were cut, see TetrahedraFile.
    std::string left_out;           ///< Its cells of fewer dimensions than tetrahedra or triangles.
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
    BoundaryReport boundary;    ///< Of a boundary of tetrahedra that was read.
    CurveReport curve;          ///< Where the boundary is curved.

    Proof proof;
    QualityReport quality;
    std::vector<Stage> stages;
};

template <int Dim>
struct Body {
    SimplexMesh<Dim> mesh;
    BodyReport report;
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
