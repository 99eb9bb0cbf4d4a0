#include "locate.h"

#include <Eigen/LU>

#include <algorithm>
#include <cmath>
#include <limits>

namespace pent::study {

namespace {

using Cells = Eigen::Matrix<std::uint32_t, -1, -1>;

// Cells by the boxes of a regular grid that their own boxes meet.
class Grid {
public:
    Grid(const Eigen::MatrixXd& vertices, const Cells& cells)
        : low_(vertices.rowwise().minCoeff()),
          counts_(Eigen::VectorXi::Ones(vertices.rows())),
          step_(vertices.rowwise().maxCoeff() - low_) {
        // About one grid box a cell.
        const auto dim = static_cast<double>(vertices.rows());
        const int along = std::max(1, static_cast<int>(std::pow(double(cells.cols()), 1 / dim)));
        for (Eigen::Index axis = 0; axis < vertices.rows(); ++axis) {
            counts_[axis] = step_[axis] > 0 ? along : 1;
            step_[axis] = step_[axis] > 0 ? step_[axis] / along : 1;
        }
        boxes_.resize(static_cast<std::size_t>(counts_.prod()));
        for (Eigen::Index cell = 0; cell < cells.cols(); ++cell) {
            Eigen::VectorXd low = vertices.col(cells(0, cell));
            Eigen::VectorXd high = low;
            for (Eigen::Index corner = 1; corner < cells.rows(); ++corner) {
                low = low.cwiseMin(vertices.col(cells(corner, cell)));
                high = high.cwiseMax(vertices.col(cells(corner, cell)));
            }
            insert(static_cast<std::uint32_t>(cell), place(low), place(high));
        }
    }

    [[nodiscard]] const std::vector<std::uint32_t>& near(const Eigen::VectorXd& point) const {
        return boxes_[index(place(point))];
    }

private:
    // The grid box of a point; a hair of slack to both sides is in the ranges of insert().
    [[nodiscard]] Eigen::VectorXi place(const Eigen::VectorXd& point) const {
        Eigen::VectorXi box(point.size());
        for (Eigen::Index axis = 0; axis < point.size(); ++axis) {
            const double along = std::floor((point[axis] - low_[axis]) / step_[axis]);
            box[axis] = static_cast<int>(std::clamp(along, 0.0, double(counts_[axis] - 1)));
        }
        return box;
    }

    [[nodiscard]] std::size_t index(const Eigen::VectorXi& box) const {
        std::size_t index = 0;
        for (Eigen::Index axis = box.size() - 1; axis >= 0; --axis) {
            index = index * static_cast<std::size_t>(counts_[axis])
                    + static_cast<std::size_t>(box[axis]);
        }
        return index;
    }

    void insert(std::uint32_t cell, const Eigen::VectorXi& low, const Eigen::VectorXi& high) {
        Eigen::VectorXi box = low;
        while (true) {
            boxes_[index(box)].push_back(cell);
            Eigen::Index axis = 0;
            while (axis < box.size() && ++box[axis] > high[axis]) {
                box[axis] = low[axis];
                ++axis;
            }
            if (axis == box.size()) {
                return;
            }
        }
    }

    Eigen::VectorXd low_;
    Eigen::VectorXi counts_;
    Eigen::VectorXd step_;
    std::vector<std::vector<std::uint32_t>> boxes_;
};

// Barycentric coordinates of a point in a cell.
Eigen::VectorXd weights_in(const Eigen::VectorXd& point,
                           const Eigen::MatrixXd& vertices,
                           const Cells& cells,
                           Eigen::Index cell) {
    const Eigen::Index dim = vertices.rows();
    Eigen::MatrixXd edges(dim, dim);
    for (Eigen::Index k = 0; k < dim; ++k) {
        edges.col(k) = vertices.col(cells(k + 1, cell)) - vertices.col(cells(0, cell));
    }
    Eigen::VectorXd weights(dim + 1);
    weights.tail(dim) = edges.partialPivLu().solve(point - vertices.col(cells(0, cell)));
    weights[0] = 1 - weights.tail(dim).sum();
    return weights;
}

}  // namespace

Eigen::MatrixXd Interpolation::operator()(const Eigen::MatrixXd& values) const {
    if (corners.size() == 0) {
        return values;
    }
    Eigen::MatrixXd result = Eigen::MatrixXd::Zero(values.rows(), corners.cols());
    for (Eigen::Index point = 0; point < corners.cols(); ++point) {
        for (Eigen::Index k = 0; k < corners.rows(); ++k) {
            result.col(point) += weights(k, point) * values.col(corners(k, point));
        }
    }
    return result;
}

Interpolation locate(const Eigen::MatrixXd& points,
                     const Eigen::MatrixXd& vertices,
                     const Cells& cells) {
    // Good enough for a point on a face, where rounding decides the sign.
    constexpr double kInside = -1e-9;
    const Grid grid(vertices, cells);
    Interpolation result;
    result.corners.resize(cells.rows(), points.cols());
    result.weights.resize(cells.rows(), points.cols());
    for (Eigen::Index point = 0; point < points.cols(); ++point) {
        double best = -std::numeric_limits<double>::infinity();
        for (const std::uint32_t cell : grid.near(points.col(point))) {
            const Eigen::VectorXd weights = weights_in(points.col(point), vertices, cells, cell);
            if (weights.minCoeff() > best) {
                best = weights.minCoeff();
                result.corners.col(point) = cells.col(cell);
                result.weights.col(point) = weights;
            }
            if (best >= kInside) {
                break;
            }
        }
        result.farthest = std::max(result.farthest, -best);
    }
    return result;
}

}  // namespace pent::study
