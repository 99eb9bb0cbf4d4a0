#include "image_level.h"

#include <algorithm>
#include <cmath>
#include <limits>

namespace pent::mesher {

namespace {

using Eigen::Vector4d;
using Eigen::Vector4i;

// Calls visit(place) for all places from zero to below `count`, the first axis fastest.
template <typename Visit>
void visit_grid(const Vector4i& count, const Visit& visit) {
    Vector4i at;
    for (at[3] = 0; at[3] < count[3]; ++at[3]) {
        for (at[2] = 0; at[2] < count[2]; ++at[2]) {
            for (at[1] = 0; at[1] < count[1]; ++at[1]) {
                for (at[0] = 0; at[0] < count[0]; ++at[0]) {
                    visit(at);
                }
            }
        }
    }
}

// The samples at the corners of the cell around a point, and the point in it.
struct CellValues {
    std::array<float, 16> values{};
    Vector4d part;
    std::array<double, 4> xy{};  // weights in two axes, of the corners there
    std::array<double, 4> zw{};

    [[nodiscard]] double weight(unsigned corner) const { return xy[corner & 3U] * zw[corner >> 2]; }
};

CellValues values_around(const Image& image, const Vector4d& p) {
    const Image::Cell cell = image.cell(p);
    CellValues result{{}, cell.part, {}, {}};
    const Vector4d& t = cell.part;
    result.xy = {(1 - t[0]) * (1 - t[1]), t[0] * (1 - t[1]), (1 - t[0]) * t[1], t[0] * t[1]};
    result.zw = {(1 - t[2]) * (1 - t[3]), t[2] * (1 - t[3]), (1 - t[2]) * t[3], t[2] * t[3]};
    const auto n = image.size.cast<std::size_t>();
    const std::size_t along_y = n[0];
    const std::size_t along_z = along_y * n[1];
    const std::size_t along_w = along_z * n[2];
    const float* const first = image.values.data() + image.index(cell.low);
    for (unsigned corner = 0; corner < 16; ++corner) {
        result.values[corner] = first[(corner & 1U) + (corner >> 1 & 1U) * along_y
                                      + (corner >> 2 & 1U) * along_z + (corner >> 3) * along_w];
    }
    return result;
}

}  // namespace

ImageLevel::ImageLevel(std::shared_ptr<const Image> image, double level)
    : image_(std::move(image)), level_(level) {
    find_bounds();
    find_slope();
    find_bricks();
}

void ImageLevel::find_bounds() {
    Vector4i low = image_->size;
    Vector4i high = Vector4i::Constant(-1);
    std::size_t index = 0;
    visit_grid(image_->size, [&](const Vector4i& at) {
        if (static_cast<double>(image_->values[index++]) > level_) {
            low = low.cwiseMin(at);
            high = high.cwiseMax(at);
        }
    });
    is_cut_ = low.minCoeff() == 0 || (image_->size - high).minCoeff() == 1;
    const Vector4i last = image_->size.array() - 1;
    bounds_.low = (low.array() - 1).max(0).cast<double>() * image_->spacing.array();
    bounds_.high = (high.array() + 1).min(last.array()).cast<double>() * image_->spacing.array();
}

void ImageLevel::find_slope() {
    double rise = 0;
    double way = 0;
    visit_grid(image_->size, [&](const Vector4i& at) {
        const auto here = static_cast<double>(image_->value(at));
        for (int axis = 0; axis < 4; ++axis) {
            Vector4i next = at;
            if (++next[axis] == image_->size[axis]) {
                continue;
            }
            const auto there = static_cast<double>(image_->value(next));
            if ((here > level_) != (there > level_)) {
                rise += std::abs(there - here);
                way += image_->spacing[axis];
            }
        }
    });
    slope_ = rise / way;
}

void ImageLevel::find_bricks() {
    bricks_ = (image_->size.array() - 2) / kBrick + 1;
    visit_grid(bricks_, [&](const Vector4i& brick) {
        const Vector4i low = kBrick * brick;
        const Vector4i high = (low.array() + kBrick + 1).min(image_->size.array());
        std::pair<float, float> extremes{std::numeric_limits<float>::infinity(),
                                         -std::numeric_limits<float>::infinity()};
        visit_grid(high - low, [&](const Vector4i& at) {
            const float value = image_->value(low + at);
            extremes.first = std::min(extremes.first, value);
            extremes.second = std::max(extremes.second, value);
        });
        extremes_.push_back(extremes);
    });
}

double ImageLevel::value(const Vector4d& p) const {
    const CellValues cell = values_around(*image_, p);
    double sum = 0;
    for (unsigned corner = 0; corner < 16; ++corner) {
        sum += cell.weight(corner) * static_cast<double>(cell.values[corner]);
    }
    return (level_ - sum) / slope_;
}

ValueSlope ImageLevel::value_slope(const Vector4d& p) const {
    const CellValues cell = values_around(*image_, p);
    double sum = 0;
    Vector4d rise = Vector4d::Zero();  // along a cell
    for (unsigned corner = 0; corner < 16; ++corner) {
        const auto value = static_cast<double>(cell.values[corner]);
        sum += cell.weight(corner) * value;
        const double of_xy = value * cell.zw[corner >> 2];
        const double of_zw = value * cell.xy[corner & 3U];
        const auto towards = [&](unsigned axis, unsigned other, double rest) {
            const double part =
                (corner >> other & 1U) != 0 ? cell.part[other] : 1 - cell.part[other];
            rise[axis] += ((corner >> axis & 1U) != 0 ? part : -part) * rest;
        };
        towards(0, 1, of_xy);
        towards(1, 0, of_xy);
        towards(2, 3, of_zw);
        towards(3, 2, of_zw);
    }
    // Beyond the image the value does not change.
    const Vector4d last = (image_->size.array() - 1).cast<double>() * image_->spacing.array();
    Vector4d slope = -rise.cwiseQuotient(image_->spacing) / slope_;
    for (int axis = 0; axis < 4; ++axis) {
        slope[axis] = p[axis] < 0 || p[axis] > last[axis] ? 0 : slope[axis];
    }
    return {(level_ - sum) / slope_, slope};
}

SamplesAround samples_around(const Image& image, const Vector4d& p) {
    const CellValues cell = values_around(image, p);
    SamplesAround around{cell.values, {}};
    for (unsigned corner = 0; corner < 16; ++corner) {
        around.weights[corner] = cell.weight(corner);
    }
    return around;
}

ValueRange ImageLevel::range(const Vector4d& center, double radius) const {
    const Vector4i low = image_->cell(center.array() - radius).low / kBrick;
    const Vector4i high = image_->cell(center.array() + radius).low / kBrick;
    double least = std::numeric_limits<double>::infinity();
    double most = -least;
    visit_grid((high - low).array() + 1, [&](const Vector4i& at) {
        const Vector4i brick = low + at;
        const std::size_t index =
            brick[0]
            + static_cast<std::size_t>(bricks_[0])
                  * (brick[1]
                     + static_cast<std::size_t>(bricks_[1])
                           * (brick[2] + static_cast<std::size_t>(bricks_[2]) * brick[3]));
        least = std::min(least, static_cast<double>(extremes_[index].first));
        most = std::max(most, static_cast<double>(extremes_[index].second));
    });
    // Rounding of the sum of 16 products.
    const double slack = 1e-14 * std::max(std::abs(least), std::abs(most));
    return {(level_ - most - slack) / slope_, (level_ - least + slack) / slope_};
}

}  // namespace pent::mesher
