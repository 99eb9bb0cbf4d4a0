#pragma once

#include <pent/mesher/image.h>
#include <pent/mesher/solid.h>

#include <array>
#include <memory>
#include <utility>
#include <vector>

namespace pent::mesher {

/// Where an image is above a level: a function that is negative there, in meters near the surface.
/// Safe to ask from several threads.
class ImageLevel {
public:
    /// @param image  Some samples above the level and some not.
    ImageLevel(std::shared_ptr<const Image> image, double level);

    /// The level less the multilinear value, over the mean slope between samples on either side.
    /// Beyond the image that of the nearest point of it.
    [[nodiscard]] double value(const Eigen::Vector4d& p) const;

    /// The same with its slope: where cells of the grid meet, that in one of them.
    [[nodiscard]] ValueSlope value_slope(const Eigen::Vector4d& p) const;

    /// Bounds of the value within a ball.
    [[nodiscard]] ValueRange range(const Eigen::Vector4d& center, double radius) const;

    /// Holds all that is above the level within the image.
    [[nodiscard]] const Box4& bounds() const { return bounds_; }

    /// Whether what is above the level reaches a side of the image.
    [[nodiscard]] bool is_cut() const { return is_cut_; }

private:
    void find_bounds();
    void find_slope();
    void find_bricks();

    static constexpr int kBrick = 4;  // cells along each axis

    std::shared_ptr<const Image> image_;
    double level_ = 0;
    double slope_ = 1;  // of samples, 1/m
    Box4 bounds_;
    bool is_cut_ = false;
    Eigen::Vector4i bricks_;                         // along each axis
    std::vector<std::pair<float, float>> extremes_;  // of the samples in and around each brick
};

/// The samples around a point and how much each of them weighs there: corner i is further along
/// the axes whose bits are set in i.
struct SamplesAround {
    std::array<float, 16> values{};
    std::array<double, 16> weights{};
};
[[nodiscard]] SamplesAround samples_around(const Image& image, const Eigen::Vector4d& p);

}  // namespace pent::mesher
