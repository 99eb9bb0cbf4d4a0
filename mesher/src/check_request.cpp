#include "check_request.h"

#include "base_mesh.h"
#include "solid_input.h"

#include <pent/counted.h>
#include <pent/error.h>
#include <pent/mesher/read_tetrahedra.h>

#include <cmath>

namespace pent::mesher {

void check_request(const BodyRequest& request, int dim) {
    const ExtrusionRequest& extrusion = request.extrusion;
    if (!(extrusion.grade >= 1) || !std::isfinite(extrusion.grade)) {
        throw Error("a grade of " + std::to_string(extrusion.grade)
                    + "; expected a finite number of 1 or more");
    }
    if (!(request.scale > 0) || !std::isfinite(request.scale)) {
        throw Error("a scale of " + std::to_string(request.scale)
                    + "; expected a finite number above 0");
    }
    if (!(request.edge_length >= 0) || !std::isfinite(request.edge_length)) {
        throw Error("an edge length of " + std::to_string(request.edge_length)
                    + " m; expected 0 or more");
    }
    if (!request.sizes.is_uniform() && solid_file_of(request) == nullptr) {
        throw Error(name_of_input(request)
                    + ": a size field is for four-dimensional shapes, boundaries and images; leave"
                      " it out");
    }
    const auto* path = std::get_if<std::filesystem::path>(&request.input);
    if (!request.region_array.empty()
        && (path == nullptr || !has_region_arrays(*path, request.format))) {
        throw Error(name_of_input(request)
                    + ": an array of cells with their labels is for tet meshes of VTK (.vtk, .vtu);"
                      " leave it out");
    }
    const Eigen::Index axes = request.translation.size();
    if ((axes != 0 && axes != 3 && axes != dim) || !request.translation.allFinite()) {
        throw Error("a translation of " + counted(axes, "component", "components") + "; expected 3"
                    + (dim == 4 ? " or 4" : "") + " finite ones");
    }
    if ((extrusion.round || !extrusion.profile.empty()) && extrusion.anchor != Anchor::Middle) {
        throw Error(name_of_input(request)
                    + ": one-sided is for straight extrusions; a round body reaches to both sides"
                      " of w = 0, and a profile says where each layer is; leave out the one or the"
                      " other");
    }
    if (extrusion.round && extrusion.layers == 1) {
        throw Error(name_of_input(request)
                    + ": a round body of one layer would be two points; expected 2 or more");
    }
    if (extrusion.is_kept && (request.subdivide > 1 || request.is_quadratic)) {
        throw Error(name_of_input(request)
                    + ": what is subdivided or quadratic is no extrusion any more; leave out the"
                      " one or base and layers");
    }
    if (request.is_curved && (!request.is_quadratic || request.subdivide > 1)) {
        throw Error(name_of_input(request)
                    + ": a curved boundary is for quadratic cells that are not subdivided before;"
                      " ask for quadratic ones, and for shorter edges in place of a subdivision");
    }
}

void refuse_extrusion(const BodyRequest& request) {
    const ExtrusionRequest& extrusion = request.extrusion;
    if (extrusion.is_kept || extrusion.thickness || extrusion.direction || extrusion.layers > 0
        || !extrusion.profile.empty() || extrusion.round || !extrusion.alternate
        || extrusion.anchor != Anchor::Middle || extrusion.order != VertexOrder::Index
        || !extrusion.edge_directions.empty() || extrusion.grade != 1
        || !extrusion.layer_heights.empty()) {
        throw Error(name_of_input(request)
                    + ": it is the body already, and not extruded; leave out thickness, direction,"
                      " layers, profile, order, base and the like");
    }
}

void refuse_filling(const BodyRequest& request) {
    if (request.edge_length > 0 || request.surface_triangles > 0 || request.target_cells > 0) {
        throw Error(name_of_input(request)
                    + ": it is cells already, and no surface to be filled; leave out edge length,"
                      " triangles and number of pentachora");
    }
    refuse_repair(request);
    refuse_generator(request);
}

void refuse_repair(const BodyRequest& request) {
    const RepairOptions usual;
    if (request.repair.repair != usual.repair
        || request.repair.wrap_distance != usual.wrap_distance) {
        throw Error(name_of_input(request)
                    + ": nothing of it is mended; leave out repair and distance of a wrap");
    }
}

void refuse_generator(const BodyRequest& request) {
    const TetrahedraOptions usual;
    const TetrahedraOptions& asked = request.tetrahedra;
    if (asked.generator != usual.generator || asked.radius_edge_ratio != usual.radius_edge_ratio
        || asked.keep_surface != usual.keep_surface) {
        throw Error(name_of_input(request)
                    + ": no surface of it is filled; leave out generator, ratio of radius and edge"
                      " and subdivision of the surface");
    }
}

}  // namespace pent::mesher
