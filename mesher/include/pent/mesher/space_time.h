#pragma once

#include <pent/mesher/edge_order.h>
#include <pent/mesher/moving_mesh.h>
#include <pent/mesher/prove.h>
#include <pent/mesher/quality.h>
#include <pent/pent_file.h>

#include <cstdint>
#include <functional>
#include <string>
#include <vector>

namespace pent::mesher {

struct SpaceTimeOptions {
    double time_scale = 1;  ///< m/s, above 0: the time t is at w = time_scale * t.
    /// In how many layers each step from frame to frame is cut, with vertices on straight ways
    /// between; 0: as few as make every pentachoron positive, by halves.
    int refine_time = 1;
    VertexOrder order = VertexOrder::Index;
    bool alternate = true;  ///< Every second layer takes the reverse order, as in extrude().
    bool is_bisection_ready = false;  ///< See make_space_time().
    std::function<void(const std::string& stage)> on_stage = {};
    /// Called with the number of pentachora before they are made; may throw to stop the work.
    std::function<void(double pentachora)> on_size = {};
};

/// A moving mesh as one body of space-time, and what was found.
struct SpaceTimeBody {
    SimplexMesh<4> mesh;
    MeshExtras<4> extras;
    std::vector<std::uint32_t> frame_layers;  ///< The layer of each frame.
    std::string way_of_bisection;  ///< How it became ready for that; empty if not asked for.
    double integral = 0;   ///< Of the tetrahedra's volume over w, as vertices move on straight ways
                           ///< from frame to frame, m^4.
    double base_edge = 0;  ///< Mean length at the first frame, m.
    double lowest_layer = 0;   ///< m.
    double highest_layer = 0;  ///< m.
    Proof proof;
    QualityReport quality;
};

/// Makes the pentachora that tetrahedra sweep as they move.
///
/// Layer n holds the vertices at one time at w = time_scale * t. The prism over a tetrahedron from
/// layer to layer is cut as extrude() does, by the order of the vertices alone: vertices move,
/// connectivity stays, so that neighbors agree for the same reason. Pentachoron k of an ordered
/// prism has det[b1 - b0, ...] = +-(step in w) det[b0 - bk, ..., b(k-1) - bk, t(k+1) - tk, ...,
/// t3 - tk], of corners b below and t above: it is positive exactly if this tetrahedron, mixed from
/// two frames, is. The test is that of validate(), in whose margin no sign is decided by rounding.
///
/// A step that fails is cut in halves, with vertices on straight ways, if refine_time is 0: that
/// ends exactly if every tetrahedron stays positive on its way, as the volume on it, a cubic
/// polynomial, says.
///
/// The hypervolume is that of the body; where triangles of the surface turn on their way, their
/// sides are not flat, and the cut makes it differ from the integral at second order in the steps.
///
/// With is_bisection_ready, cells with their tags meet the condition under which bisection keeps
/// them conforming [stevenson2008], which is then checked on every facet: in the order
/// asked for, else by four colors of the vertices, if the mesh has such, else after its barycentric
/// cut, 24 tetrahedra of each, which has.
///
/// Boundary facets have labels, and as base labels the region of the tetrahedron or the label of
/// the triangle. Fields of vertices are interpolated to layers between frames, those of cells are
/// means over a layer; vectors have no part along w.
///
/// Throws an Error with frame, cell and time where a tetrahedron is inverted or flat in a frame or
/// on its way, or a layer would have to be cut more than 2^16 times.
[[nodiscard]] SpaceTimeBody make_space_time(MovingMesh moving,
                                            const SpaceTimeOptions& options = {});

/// One step from frame to frame of a body, by its number: cells, vertices (those of a column one
/// after the other, so that the same column and layer is the same vertex in every slab), fields,
/// tags and labels, with InterfaceBelow and InterfaceAbove where other slabs follow.
[[nodiscard]] MeshFile<4> slab_of(const SpaceTimeBody& body, std::size_t slab);

}  // namespace pent::mesher
