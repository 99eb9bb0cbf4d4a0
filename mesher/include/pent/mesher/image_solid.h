#pragma once

#include <pent/mesher/image.h>
#include <pent/mesher/solid.h>
#include <pent/simplex_mesh.h>

#include <memory>

namespace pent::mesher {

/// Where an image is above a level, multilinear between samples. What reaches the sides of the
/// image is cut off there, with sharp ridges. Thin parts are not known beforehand.
///
/// Throws an Error if all of it is above or below the level.
[[nodiscard]] Solid image_solid(const std::shared_ptr<const Image>& image, double level);

/// Where the multilinear interpolation of 1 at labels other than 0, and of 0 else, is above 1/2.
///
/// @param labels  Whole numbers from 0 to 65535; an Error with the first other one.
[[nodiscard]] Solid label_solid(const Image& labels);

/// The label of each cell of a mesh: the one other than 0 with the largest weight in multilinear
/// interpolation at the middle of the cell; of several the lowest.
///
/// @param scale  Of the mesh over the image, above 0.
[[nodiscard]] std::vector<std::uint16_t> label_regions(const SimplexMesh<4>& mesh,
                                                       const Image& labels,
                                                       double scale);

}  // namespace pent::mesher
