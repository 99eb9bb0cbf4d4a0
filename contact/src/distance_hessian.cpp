#include "distance_hessian.h"

#include <pent/dimensions.h>

#include <Eigen/QR>

#include <array>

namespace pent::contact {

namespace {

// Sine of an angle below which edges of nearest faces count as dependent.
constexpr double kDependent = 1e-10;

// The edges of the active faces, orthonormalized, and how the weights change along them.
template <int Dim>
struct MovingWeights {
    // E = frame * triangle, columns 0 .. edges - 1.
    Eigen::Matrix<double, Dim, Dim - 1> frame = Eigen::Matrix<double, Dim, Dim - 1>::Zero();
    Eigen::Matrix<double, Dim - 1, Dim - 1> triangle =
        Eigen::Matrix<double, Dim - 1, Dim - 1>::Zero();
    Eigen::Matrix<double, Dim + 1, Dim - 1> weights =
        Eigen::Matrix<double, Dim + 1, Dim - 1>::Zero();  // W = dw/dt
    int edges = 0;
};

template <int Dim>
void add_edge(const Vector<Dim>& edge, int from, int to, double sign, MovingWeights<Dim>& moving) {
    const int k = moving.edges;
    Vector<Dim> rest = edge;
    for (int pass = 0; pass < 2; ++pass) {  // the second makes up for rounding in the first
        for (int i = 0; i < k; ++i) {
            const double along = moving.frame.col(i).dot(rest);
            moving.triangle(i, k) += along;
            rest -= along * moving.frame.col(i);
        }
    }
    const double length = rest.norm();
    if (!(length > kDependent * edge.norm())) {
        moving.triangle.col(k).setZero();
        return;
    }
    moving.triangle(k, k) = length;
    moving.frame.col(k) = rest / length;
    moving.weights(from, k) = -sign;
    moving.weights(to, k) = sign;
    ++moving.edges;
}

template <int Dim>
MovingWeights<Dim> moving_weights(const Stencil<Dim>& points, const Contact<Dim>& contact) {
    MovingWeights<Dim> moving;
    const std::array<int, 3> borders{0, contact.first_count, contact.corner_count};
    for (int side = 0; side < 2; ++side) {
        const double sign = side == 0 ? 1 : -1;
        int origin = -1;
        for (int i = borders[side]; i < borders[side + 1]; ++i) {
            if ((contact.active >> i & 1) == 0) {
                continue;
            }
            if (origin < 0) {
                origin = i;
                continue;
            }
            add_edge<Dim>(sign * (points.col(i) - points.col(origin)), origin, i, sign, moving);
        }
    }
    return moving;
}

// Orthonormal columns: w / |w|, then what the columns of W add to it.
template <int Dim>
Eigen::Matrix<double, Dim + 1, Dim> weight_basis(const Contact<Dim>& contact,
                                                 const MovingWeights<Dim>& moving) {
    Eigen::Matrix<double, Dim + 1, Dim> basis = Eigen::Matrix<double, Dim + 1, Dim>::Zero();
    basis.col(0) = contact.weights.normalized();
    for (int k = 0; k < moving.edges; ++k) {
        Weights<Dim> rest = moving.weights.col(k);
        for (int pass = 0; pass < 2; ++pass) {
            for (int i = 0; i <= k; ++i) {
                rest -= basis.col(i).dot(rest) * basis.col(i);
            }
        }
        basis.col(k + 1) = rest.normalized();  // W and w are independent: each side of W sums to 0
    }
    return basis;
}

// Completes the frame by what is normal to it and to the direction.
template <int Dim>
void add_normals(const Vector<Dim>& direction, MovingWeights<Dim>& moving) {
    Block<Dim> along;
    along << direction, moving.frame;
    const Block<Dim> all = Eigen::HouseholderQR<Block<Dim>>(along).householderQ();
    const int normals = Dim - 1 - moving.edges;
    moving.frame.rightCols(normals) = all.rightCols(normals);
}

}  // namespace

template <int Dim>
ReducedMatrix<Dim, 2 * Dim - 1> distance_hessian(const Stencil<Dim>& points,
                                                 const Contact<Dim>& contact,
                                                 double slope,
                                                 double curvature) {
    MovingWeights<Dim> moving = moving_weights<Dim>(points, contact);
    const Eigen::Matrix<double, Dim + 1, Dim> weight_frame = weight_basis<Dim>(contact, moving);
    const double length = contact.weights.norm();
    const double distance = contact.distance + contact.radius;

    // W R^-1 in the basis: how the weights answer to unit motions along the frame.
    Eigen::Matrix<double, Dim, Dim - 1> answer =
        weight_frame.transpose().lazyProduct(moving.weights);
    moving.triangle.diagonal().tail(Dim - 1 - moving.edges).setOnes();  // of answers that are 0
    moving.triangle.template triangularView<Eigen::Upper>()
        .template solveInPlace<Eigen::OnTheRight>(answer);

    ReducedMatrix<Dim, 2 * Dim - 1> hessian;
    hessian.inner.template topLeftCorner<Dim, Dim>() =
        -slope * distance * answer.lazyProduct(answer.transpose());
    hessian.inner.template topRightCorner<Dim, Dim - 1>() = -slope * length * answer;
    hessian.inner.template bottomLeftCorner<Dim - 1, Dim>() =
        hessian.inner.template topRightCorner<Dim, Dim - 1>().transpose();
    hessian.inner.template bottomRightCorner<Dim - 1, Dim - 1>().setZero();
    hessian.inner(0, 0) += curvature * length * length;
    if (moving.edges < Dim - 1) {  // buckling, negative where psi' is
        add_normals<Dim>(contact.direction, moving);
        hessian.inner.diagonal()
            .tail(Dim - 1 - moving.edges)
            .setConstant(slope / distance * length * length);
    }
    for (int k = 0; k < Dim; ++k) {
        hessian.basis.col(k) = outer<Dim>(weight_frame.col(k), contact.direction);
    }
    for (int k = 0; k < Dim - 1; ++k) {
        hessian.basis.col(Dim + k) = outer<Dim>(weight_frame.col(0), moving.frame.col(k));
    }
    return hessian;
}

#define PENT_INSTANTIATE(Dim)                                  \
    template ReducedMatrix<Dim, 2 * Dim - 1> distance_hessian( \
        const Stencil<Dim>&, const Contact<Dim>&, double, double);
PENT_FOR_EACH_DIMENSION(PENT_INSTANTIATE)
#undef PENT_INSTANTIATE

}  // namespace pent::contact
