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
    double sum = 0;
    visit_corners(*image_, p,
                  [&](float value, double weight) { sum += weight * static_cast<double>(value); });
    return (level_ - sum) / slope_;
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
