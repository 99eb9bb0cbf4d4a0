#include <pent/dimensions.h>
#include <pent/simulator/thickness.h>

#include <Eigen/Eigenvalues>

namespace pent::simulator {

namespace {

// The extent along a principal axis counts if it is less than that along the axes of space by this
// part: of an upright box both are the same, but for rounding.
constexpr double kRounding = 1e-9;

}  // namespace

template <int Dim>
double thickness(const Positions<Dim>& positions) {
    using Matrix = Eigen::Matrix<double, Dim, Dim>;
    const auto least_extent = [](const Positions<Dim>& points) {
        return (points.rowwise().maxCoeff() - points.rowwise().minCoeff()).minCoeff();
    };
    const Positions<Dim> centered = positions.colwise() - positions.rowwise().mean();
    const Matrix spread = centered * centered.transpose();
    const Eigen::SelfAdjointEigenSolver<Matrix> solver(spread);
    const double upright = least_extent(positions);
    const double own = least_extent(solver.eigenvectors().transpose() * centered);
    return own < (1 - kRounding) * upright ? own : upright;
}

#define PENT_INSTANTIATE(Dim) template double thickness<Dim>(const Positions<Dim>&);
PENT_FOR_EACH_DIMENSION(PENT_INSTANTIATE)
#undef PENT_INSTANTIATE

}  // namespace pent::simulator
