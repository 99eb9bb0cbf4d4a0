#include <pent/dimensions.h>
#include <pent/simulator/rigid_fit.h>

#include <Eigen/LU>
#include <Eigen/SVD>

#include <cmath>

namespace pent::simulator {

template <int Dim>
double non_rigid(const Eigen::Ref<const Positions<Dim>>& start,
                 const Eigen::Ref<const Positions<Dim>>& now,
                 const Eigen::Ref<const Eigen::VectorXd>& masses) {
    using Vector = Eigen::Matrix<double, Dim, 1>;
    using Matrix = Eigen::Matrix<double, Dim, Dim>;
    const double mass = masses.sum();
    const Vector start_center = start * masses / mass;
    const Vector now_center = now * masses / mass;
    const Positions<Dim> before = start.colwise() - start_center;
    const Positions<Dim> after = now.colwise() - now_center;
    const Matrix covariance = after * masses.asDiagonal() * before.transpose();
    const Eigen::JacobiSVD<Matrix> svd(covariance, Eigen::ComputeFullU | Eigen::ComputeFullV);
    Vector signs = Vector::Ones();
    signs[Dim - 1] =
        svd.matrixU().determinant() * svd.matrixV().determinant() < 0 ? -1 : 1;  // no reflection
    const Matrix rotation = svd.matrixU() * signs.asDiagonal() * svd.matrixV().transpose();
    const double spread = before.colwise().squaredNorm().dot(masses);
    const double gap = (after - rotation * before).colwise().squaredNorm().dot(masses);
    return std::sqrt(gap / spread);
}

#define PENT_INSTANTIATE(Dim)                                               \
    template double non_rigid<Dim>(const Eigen::Ref<const Positions<Dim>>&, \
                                   const Eigen::Ref<const Positions<Dim>>&, \
                                   const Eigen::Ref<const Eigen::VectorXd>&);
PENT_FOR_EACH_DIMENSION(PENT_INSTANTIATE)
#undef PENT_INSTANTIATE

}  // namespace pent::simulator
