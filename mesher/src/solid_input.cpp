#include "solid_input.h"

#include "base_mesh.h"
#include "check_request.h"

#include <pent/error.h>
#include <pent/mesher/read_solid.h>

#include <cmath>
#include <memory>
#include <optional>
#include <utility>

namespace pent::mesher {

namespace {

SolidInput boundary_input(const std::filesystem::path& path, const BodyRequest& request) {
    const bool may_mend = request.repair.repair != Repair::None;
    BoundarySolid found = boundary_solid(read_boundary(path), path.string(), may_mend);
    found.report.hole_place *= request.scale;
    found.report.hole_place.head(request.translation.size()) += request.translation;
    found.report.largest_hole *= std::pow(request.scale, 3);
    // Of boundaries of 10^5 tetrahedra, where most cells are at it.
    return {.solid = std::move(found.solid), .boundary = found.report, .seconds_per_cell = 50e-6};
}

SolidInput image_input(const std::filesystem::path& path, const BodyRequest& request) {
    const ImageRequest& asked = request.image;
    if (asked.level.has_value() == asked.is_labels) {
        throw Error(path.string()
                    + ": an image needs one of --level, the value at the surface of the body, and "
                      "--labels, for whole numbers that name parts");
    }
    std::optional<Eigen::Vector4d> spacing = asked.spacing;
    if (spacing) {
        *spacing /= request.scale;  // it is m already
    }
    Image image = read_image(path, spacing);
    if (asked.is_labels) {
        Solid solid = label_solid(image);
        return {.solid = std::move(solid), .labels = std::move(image)};
    }
    return {.solid = image_solid(std::make_shared<const Image>(std::move(image)), *asked.level)};
}

}  // namespace

const std::filesystem::path* solid_file_of(const BodyRequest& request) {
    const auto* path = std::get_if<std::filesystem::path>(&request.input);
    const bool is_solid =
        path != nullptr && request.format.empty()
        && (is_shape_file(*path) || is_boundary_file(*path) || is_image_file(*path));
    return is_solid ? path : nullptr;
}

void check_solid_request(const std::filesystem::path& path, const BodyRequest& request) {
    if (request.surface_triangles > 0 || request.target_cells > 0) {
        throw Error(path.string()
                    + ": a shape is stuffed with edges of one length; leave out triangles and"
                      " number of pentachora");
    }
    if (request.edge_length <= 0) {
        throw Error(
            path.string() + ": a shape needs the length of the edges; expected --edge-length"
            + (is_boundary_file(path) ? ", or pent-convert for one that a point sees all of" : ""));
    }
    refuse_generator(request);
    if (!is_boundary_file(path)) {
        refuse_repair(request);
    }
    if (request.repair.repair == Repair::Wrap) {
        throw Error(path.string()
                    + ": a wrap is for surfaces of triangles; expected --repair light or none");
    }
}

void refuse_image_options(const BodyRequest& request) {
    if (request.image.level || request.image.is_labels || request.image.spacing) {
        throw Error(name_of_input(request)
                    + ": it is no image (.nii, .nii.gz, .nrrd); leave out level, labels and"
                      " spacing");
    }
}

SolidInput read_solid_input(const std::filesystem::path& path, const BodyRequest& request) {
    if (!is_image_file(path)) {
        refuse_image_options(request);
    }
    SolidInput input = is_shape_file(path)      ? SolidInput{.solid = read_solid(path)}
                       : is_boundary_file(path) ? boundary_input(path, request)
                                                : image_input(path, request);
    input.solid =
        place(input.solid, request.scale, Eigen::Matrix4d::Identity(), Eigen::Vector4d::Zero());
    return input;
}

}  // namespace pent::mesher
