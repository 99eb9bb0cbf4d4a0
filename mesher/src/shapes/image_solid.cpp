#include "image_level.h"
#include "solid_data.h"

#include <pent/error.h>
#include <pent/formatted.h>
#include <pent/mesher/image_solid.h>
#include <pent/mesher/primitives.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <string>
#include <utility>

namespace pent::mesher {

namespace {

using Eigen::Vector4d;

constexpr double kInfinity = std::numeric_limits<double>::infinity();
constexpr float kMaxLabels = 65535;

void check_labels(const Image& image) {
    const auto bad = std::find_if(image.values.begin(), image.values.end(), [](float value) {
        return !(value >= 0) || value > kMaxLabels || value != std::floor(value);
    });
    if (bad != image.values.end()) {
        throw Error(image.name
                    + formatted(": a sample is %g, and no label; expected whole numbers from 0 to "
                                "65535, or --level for a body by values",
                                static_cast<double>(*bad)));
    }
}

// The label above 0 with the largest weight, the lowest of several; 0 if there is none.
std::uint16_t largest_label(const SamplesAround& around) {
    float largest = 0;
    double most = 0;
    for (const float label : around.values) {
        double weight = 0;
        for (std::size_t i = 0; i < around.values.size(); ++i) {
            weight += around.values[i] == label ? around.weights[i] : 0;
        }
        if (label > 0 && (weight > most || (weight == most && label < largest) || largest == 0)) {
            largest = label;
            most = weight;
        }
    }
    return static_cast<std::uint16_t>(largest);
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
    const Solid solid = solid_of(ImageField{std::move(above)}, is_cut ? everywhere : bounds,
                                 kInfinity, {kInfinity, false});
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
        std::uint16_t label = largest_label(samples_around(labels, middle));
        // Around the middle of a cell that is longer than the part is thick there may be none.
        for (int corner = 0; corner < 5 && label == 0; ++corner) {
            label = largest_label(samples_around(labels, mesh.positions.col(cell[corner]) / scale));
        }
        regions.push_back(label);
    }
    return regions;
}

}  // namespace pent::mesher
