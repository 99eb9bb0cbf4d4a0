#include "pent/contact/barrier.h"

#include "filter.h"

#include <Eigen/Eigenvalues>

#include <array>
#include <cmath>
#include <limits>
#include <utility>

namespace pent::contact {

namespace {

// Sine of an angle below which edges of nearest faces count as dependent.
constexpr double kDependent = 1e-10;

double scaled_gap_squared(double distance, const Barrier& barrier) {
    const double scaled = (distance - barrier.separation) / barrier.distance;
    return scaled * scaled;
}

bool is_touching(double distance, const Barrier& barrier) {
    return !(distance > barrier.separation);
}

// The edges of the active faces, orthonormalized, and how the weights move along them.
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
MovingWeights<Dim> moving_weights(const Stencil<Dim>& points, const NearestFaces<Dim>& faces) {
    MovingWeights<Dim> moving;
    const std::array<int, 3> borders{0, faces.first_count, faces.count};
    for (int side = 0; side < 2; ++side) {
        const double sign = side == 0 ? 1 : -1;
        int origin = -1;
        for (int i = borders[side]; i < borders[side + 1]; ++i) {
            if ((faces.active >> i & 1) == 0) {
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
Eigen::Matrix<double, Dim + 1, Dim> weight_basis(const NearestFaces<Dim>& faces,
                                                 const MovingWeights<Dim>& moving) {
    Eigen::Matrix<double, Dim + 1, Dim> basis = Eigen::Matrix<double, Dim + 1, Dim>::Zero();
    basis.col(0) = faces.weights.normalized();
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

template <typename Square>
Square filtered_square(const Square& matrix, Filter filter) {
    if (filter == Filter::None) {
        return matrix;
    }
    const Eigen::SelfAdjointEigenSolver<Square> solver(matrix);
    const auto values =
        solver.eigenvalues().unaryExpr([&](double value) { return filtered(value, filter); });
    return solver.eigenvectors() * values.asDiagonal() * solver.eigenvectors().transpose();
}

// w (x) u of a stencil.
template <int Dim>
StencilVector<Dim> outer(const Weights<Dim>& weights, const Vector<Dim>& direction) {
    StencilVector<Dim> product;
    for (int i = 0; i <= Dim; ++i) {
        product.template segment<Dim>(Dim * i) = weights[i] * direction;
    }
    return product;
}

// The Hessian of faces with a given number of edges: all sizes known.
template <int Dim, int Edges>
StencilMatrix<Dim> hessian_of_edges(const NearestFaces<Dim>& faces,
                                    const MovingWeights<Dim>& moving,
                                    double slope,
                                    double curvature,
                                    Filter filter) {
    constexpr int kSize = 2 * Edges + 1;
    using Inner = Eigen::Matrix<double, kSize, kSize>;
    const Eigen::Matrix<double, Dim + 1, Dim> weight_frame = weight_basis<Dim>(faces, moving);
    const double length = faces.weights.norm();
    Inner inner = Inner::Zero();
    if constexpr (Edges > 0) {
        // W R^-1 in the basis: how the weights answer to unit motions along the frame.
        Eigen::Matrix<double, Edges + 1, Edges> answer =
            weight_frame.template leftCols<Edges + 1>().transpose().lazyProduct(
                moving.weights.template leftCols<Edges>());
        moving.triangle.template topLeftCorner<Edges, Edges>()
            .template triangularView<Eigen::Upper>()
            .template solveInPlace<Eigen::OnTheRight>(answer);
        inner.template topLeftCorner<Edges + 1, Edges + 1>() =
            -slope * faces.distance * answer.lazyProduct(answer.transpose());
        inner.template topRightCorner<Edges + 1, Edges>() = -slope * length * answer;
        inner.template bottomLeftCorner<Edges, Edges + 1>() =
            inner.template topRightCorner<Edges + 1, Edges>().transpose();
    }
    inner(0, 0) += curvature * length * length;
    inner = filtered_square(inner, filter);

    Eigen::Matrix<double, Dim*(Dim + 1), kSize> basis;
    for (int k = 0; k <= Edges; ++k) {
        basis.col(k) = outer<Dim>(weight_frame.col(k), faces.direction);
    }
    for (int k = 0; k < Edges; ++k) {
        basis.col(Edges + 1 + k) = outer<Dim>(weight_frame.col(0), moving.frame.col(k));
    }
    const Eigen::Matrix<double, Dim*(Dim + 1), kSize> product = basis.lazyProduct(inner);
    StencilMatrix<Dim> hessian = product.lazyProduct(basis.transpose());
    // What is normal to the direction and to the faces: buckling, negative where psi' is.
    const double buckling = filtered(slope / faces.distance, filter);
    if (Edges < Dim - 1 && buckling != 0) {
        Eigen::Matrix<double, Dim, Dim> normal = Eigen::Matrix<double, Dim, Dim>::Identity();
        normal -= faces.direction * faces.direction.transpose();
        normal -= moving.frame * moving.frame.transpose();
        for (int i = 0; i <= Dim; ++i) {
            for (int j = 0; j <= Dim; ++j) {
                hessian.template block<Dim, Dim>(Dim * i, Dim * j) +=
                    buckling * faces.weights[i] * faces.weights[j] * normal;
            }
        }
    }
    return hessian;
}

}  // namespace

double barrier_energy(double distance, const Barrier& barrier) {
    if (is_touching(distance, barrier)) {
        return std::numeric_limits<double>::infinity();
    }
    const double y = scaled_gap_squared(distance, barrier);
    if (y >= 1) {
        return 0;
    }
    return -barrier.stiffness * barrier.distance * barrier.distance * (y - 1) * (y - 1)
           * std::log(y);
}

double barrier_slope(double distance, const Barrier& barrier) {
    if (is_touching(distance, barrier)) {
        return -std::numeric_limits<double>::infinity();
    }
    const double y = scaled_gap_squared(distance, barrier);
    if (y >= 1) {
        return 0;
    }
    const double by_y = -(y - 1) * (2 * std::log(y) + (y - 1) / y);
    return 2 * barrier.stiffness * (distance - barrier.separation) * by_y;
}

double barrier_curvature(double distance, const Barrier& barrier) {
    if (is_touching(distance, barrier)) {
        return std::numeric_limits<double>::infinity();
    }
    const double y = scaled_gap_squared(distance, barrier);
    if (y >= 1) {
        return 0;
    }
    const double by_y = -(y - 1) * (2 * std::log(y) + (y - 1) / y);
    const double by_y_y = -2 * std::log(y) + (y - 1) * (y - 1 - 4 * y) / (y * y);
    return barrier.stiffness * (2 * by_y + 4 * y * by_y_y);
}

template <int Dim>
StencilMatrix<Dim> distance_energy_hessian(const Stencil<Dim>& points,
                                           const NearestFaces<Dim>& faces,
                                           double slope,
                                           double curvature,
                                           Filter filter) {
    const MovingWeights<Dim> moving = moving_weights<Dim>(points, faces);
    return [&]<int... Edges>(std::integer_sequence<int, Edges...>) {
        StencilMatrix<Dim> hessian;
        ((moving.edges == Edges ? void(
              hessian = hessian_of_edges<Dim, Edges>(faces, moving, slope, curvature, filter))
                                : void()),
         ...);
        return hessian;
    }
    (std::make_integer_sequence<int, Dim>());
}

template <int Dim>
double pair_barrier_energy(const Stencil<Dim>& points,
                           const NearestFaces<Dim>& faces,
                           const Barrier& barrier,
                           const Mollifier& mollifier) {
    const double energy = barrier_energy(faces.distance, barrier);
    return mollifier.threshold > 0 ? mollifier.value(spanned_volume_squared<Dim>(points)) * energy
                                   : energy;
}

template <int Dim>
StencilVector<Dim> pair_barrier_gradient(const Stencil<Dim>& points,
                                         const NearestFaces<Dim>& faces,
                                         const Barrier& barrier,
                                         const Mollifier& mollifier) {
    const double slope = barrier_slope(faces.distance, barrier);
    const StencilVector<Dim> gradient = slope * outer<Dim>(faces.weights, faces.direction);
    if (!(mollifier.threshold > 0)) {
        return gradient;
    }
    const double c = spanned_volume_squared<Dim>(points);
    if (c >= mollifier.threshold) {
        return gradient;
    }
    return mollifier.value(c) * gradient
           + mollifier.slope(c) * barrier_energy(faces.distance, barrier)
                 * spanned_volume_squared_gradient<Dim>(points);
}

template <int Dim>
StencilMatrix<Dim> pair_barrier_hessian(const Stencil<Dim>& points,
                                        const NearestFaces<Dim>& faces,
                                        const Barrier& barrier,
                                        const Mollifier& mollifier,
                                        Filter filter) {
    const double slope = barrier_slope(faces.distance, barrier);
    const double curvature = barrier_curvature(faces.distance, barrier);
    const double c = mollifier.threshold > 0 ? spanned_volume_squared<Dim>(points) : 0;
    if (!(c < mollifier.threshold)) {
        return distance_energy_hessian<Dim>(points, faces, slope, curvature, filter);
    }
    const double energy = barrier_energy(faces.distance, barrier);
    const StencilVector<Dim> by_distance = slope * outer<Dim>(faces.weights, faces.direction);
    const StencilVector<Dim> by_volume = spanned_volume_squared_gradient<Dim>(points);
    StencilMatrix<Dim> hessian =
        mollifier.value(c)
        * distance_energy_hessian<Dim>(points, faces, slope, curvature, Filter::None);
    hessian += mollifier.slope(c) * energy * spanned_volume_squared_hessian<Dim>(points);
    hessian += mollifier.curvature(c) * energy * by_volume * by_volume.transpose();
    hessian += mollifier.slope(c)
               * (by_distance * by_volume.transpose() + by_volume * by_distance.transpose());
    return filtered_square(hessian, filter);
}

#define PENT_INSTANTIATE(Dim)                                                               \
    template StencilMatrix<Dim> distance_energy_hessian<Dim>(                               \
        const Stencil<Dim>&, const NearestFaces<Dim>&, double, double, Filter);             \
    template double pair_barrier_energy<Dim>(const Stencil<Dim>&, const NearestFaces<Dim>&, \
                                             const Barrier&, const Mollifier&);             \
    template StencilVector<Dim> pair_barrier_gradient<Dim>(                                 \
        const Stencil<Dim>&, const NearestFaces<Dim>&, const Barrier&, const Mollifier&);   \
    template StencilMatrix<Dim> pair_barrier_hessian<Dim>(                                  \
        const Stencil<Dim>&, const NearestFaces<Dim>&, const Barrier&, const Mollifier&, Filter);
PENT_INSTANTIATE(3)
PENT_INSTANTIATE(4)
#undef PENT_INSTANTIATE

}  // namespace pent::contact
