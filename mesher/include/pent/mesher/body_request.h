#pragma once

#include <pent/mesher/edge_order.h>
#include <pent/mesher/repair.h>
#include <pent/mesher/shapes.h>
#include <pent/mesher/size_field.h>
#include <pent/mesher/step_limits.h>
#include <pent/mesher/straight_layers.h>
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
    int layers = 0;  ///< Slabs of simplices, 1 to 1e6; 0: as many as make the lowest one as high as
                     ///< automatic_slabs() chooses.
    /// Each slab is this many times as high as its neighbor towards w = 0, where slices are; >= 1.
    double grade = 1;
    /// Heights of the slabs from w = 0 outward, to either side of it where the extrusion has two;
    /// instead of layers and grade, m. Their sum is the thickness; where a thickness is given too,
    /// or the body is round or has a profile, they divide that length in proportion (that of half a
    /// meridian, or of the profile's path).
    std::vector<double> layer_heights;
    Anchor anchor = Anchor::Middle;
    std::filesystem::path profile;  ///< File of layers (see read_profile), instead of thickness and
                                    ///< direction; with layers, grade or heights see relayer().
    bool round = false;     ///< To a point at both ends, see round_layers(); thickness is the whole
                            ///< height, and by default the largest side.
    bool alternate = true;  ///< See ExtrudeOptions.
    bool is_kept = false;   ///< Base and layers are wanted beside the mesh: Body::extrusion.
    VertexOrder order = VertexOrder::Index;
    std::filesystem::path edge_directions;  ///< File of directed edges, instead of an order.
};

/// How an image becomes a body: either by a level or by labels, never both.
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
    std::string region_array;     ///< Of VTK's tet meshes, see read_tetrahedra(); else empty.
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
    /// Called with an estimate before a surface is filled or a shape stuffed, and with the exact
    /// number before other cells are made; not before what target_cells decides. May throw to stop
    /// the work.
    std::function<void(const ExpectedSize&)> on_size;
    int subdivide = 1;  ///< Every edge of the body is cut in this many parts, see subdivide().
    bool is_quadratic = false;  ///< Then made ready for quadratic elements, see make_quadratic().
    bool is_curved = false;  ///< Moves mid-edge vertices of the boundary onto the curved surface,
                             ///< see curve_boundary(). Of quadratic cells that are not
                             ///< subdivided: stuffed ones in 4D, spheres and balls in 3D.

    /// Sets what every step that may crash or run away is allowed.
    void limit_steps(const StepLimits& limits) {
        repair.limits = limits;
        tetrahedra.limits = limits;
    }
};

}  // namespace pent::mesher
