#include "image_level.h"
#include "solid_data.h"

#include <pent/error.h>
#include <pent/formatted.h>
#include <pent/mesher/image_solid.h>
#include <pent/mesher/primitives.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <map>
#include <string>
#include <utility>

namespace pent::mesher {

namespace {

using Eigen::Vector4d;

constexpr double kInfinity = std::numeric_limits<double>::infinity();
constexpr float kMostLabels = 65535;

void check_labels(const Image& image) {
    const auto bad = std::find_if(image.values.begin(), image.values.end(), [](float value) {
        return !(value >= 0) || value > kMostLabels || value != std::floor(value);
    });
    if (bad != image.values.end()) {
        throw Error(image.name
                    + formatted(": a sample is %g, and no label; expected whole numbers from 0 to "
                                "65535, or --level for a body by values",
                                static_cast<double>(*bad)));
    }
}

}  // namespace

Solid image_solid(const std::shared_ptr<const Image>& image, double level) {
    const auto [least, most] = std::minmax_element(image->values.begin(), image->values.end());
    const auto low = static_cast<double>(*least);
    const auto high = static_cast<double>(*most);
    if (!(low <= level && level < high)) {
        throw Error(image->name
                    + formatted(": no surface at level %g: samples are from %g to %g; expected a "
                                "level between these",
                                level, low, high));
    }
    auto above = std::make_shared<const ImageLevel>(image, level);
    const Box4 bounds = above->bounds();
    const bool is_cut = above->is_cut();
    const Box4 everywhere{Vector4d::Constant(-kInfinity), Vector4d::Constant(kInfinity)};
    const Solid solid =
        solid_of(ImageField{std::move(above)}, is_cut ? everywhere : bounds, kInfinity);
    if (!is_cut) {
        return solid;
    }
    const Vector4d size = (image->size.cast<double>().array() - 1) * image->spacing.array();
    const Solid sides = place(box_solid(size), 1, Eigen::Matrix4d::Identity(), size / 2);
    return intersect(solid, sides);
}

Solid label_solid(const Image& labels) {
    check_labels(labels);
    Image is_labeled = labels;
    for (float& value : is_labeled.values) {
        value = value > 0 ? 1.0F : 0.0F;
    }
    return image_solid(std::make_shared<const Image>(std::move(is_labeled)), 0.5);
}

std::vector<std::uint16_t> label_regions(const SimplexMesh<4>& mesh,
                                         const Image& labels,
                                         double scale) {
    std::vector<std::uint16_t> regions;
    regions.reserve(static_cast<std::size_t>(mesh.cell_count()));
    for (const auto& cell : mesh.cells.colwise()) {
        Vector4d middle = Vector4d::Zero();
        for (const std::uint32_t corner : cell) {
            middle += mesh.positions.col(corner) / (5 * scale);
        }
        std::map<float, double> parts;
        visit_corners(labels, middle, [&](float label, double weight) {
            if (label > 0) {
                parts[label] += weight;
            }
        });
        const auto largest =
            std::max_element(parts.begin(), parts.end(),
                             [](const auto& a, const auto& b) { return a.second < b.second; });
        regions.push_back(largest == parts.end() ? std::uint16_t{0}
                                                 : static_cast<std::uint16_t>(largest->first));
    }
    return regions;
}

}  // namespace pent::mesher
