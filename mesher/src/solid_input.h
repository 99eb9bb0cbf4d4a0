#pragma once

#include <pent/mesher/image_solid.h>
#include <pent/mesher/make_body.h>
#include <pent/mesher/solid.h>

#include <optional>

namespace pent::mesher {

/// A file with a solid: a shape, the boundary of a body or an image.
struct SolidInput {
    Solid solid;  ///< As large as asked for.
    BoundaryReport boundary = {};
    std::optional<Image> labels = {};  ///< Of an image of labels.
    double seconds_per_cell = 6e-6;    ///< Of one core, to stuff it, very roughly.
};

/// The path of the input if that is a file with a solid, else nothing.
[[nodiscard]] const std::filesystem::path* solid_file_of(const BodyRequest& request);

/// Throws an Error for what is asked for that solids do not need, and for what they lack.
void check_solid_request(const std::filesystem::path& path, const BodyRequest& request);

/// Throws an Error if something is asked for that images alone have.
void refuse_image_options(const BodyRequest& request);

[[nodiscard]] SolidInput read_solid_input(const std::filesystem::path& path,
                                          const BodyRequest& request);

}  // namespace pent::mesher
