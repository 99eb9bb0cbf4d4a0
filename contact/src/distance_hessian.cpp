#include "distance_hessian.h"

#include "filter.h"

#include <pent/dimensions.h>

#include <Eigen/Eigenvalues>
#include <Eigen/QR>

#include <array>
#include <utility>

namespace pent::contact {

namespace {

// Sine of an angle below which edges of nearest faces count as dependent.
constexpr double kDependent = 1e-10;

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

// What the Hessian of faces with a given number of edges does in {w, W} (x) u and w (x) E: basis
// inner basis^T.
template <int Dim, int Edges>
struct Range {
    static constexpr int kSize = 2 * Edges + 1;
    Eigen::Matrix<double, Dim*(Dim + 1), kSize> basis;  // orthonormal
    Eigen::Matrix<double, kSize, kSize> inner = Eigen::Matrix<double, kSize, kSize>::Zero();

    Range(const Contact<Dim>& contact,
          const MovingWeights<Dim>& moving,
          double slope,
          double curvature) {
        const Eigen::Matrix<double, Dim + 1, Dim> weight_frame = weight_basis<Dim>(contact, moving);
        const double length = contact.weights.norm();
        if constexpr (Edges > 0) {
            // W R^-1 in the basis: how the weights answer to unit motions along the frame.
            Eigen::Matrix<double, Edges + 1, Edges> answer =
                weight_frame.template leftCols<Edges + 1>().transpose().lazyProduct(
                    moving.weights.template leftCols<Edges>());
            moving.triangle.template topLeftCorner<Edges, Edges>()
                .template triangularView<Eigen::Upper>()
                .template solveInPlace<Eigen::OnTheRight>(answer);
            inner.template topLeftCorner<Edges + 1, Edges + 1>() =
                -slope * (contact.distance + contact.radius)
                * answer.lazyProduct(answer.transpose());
            inner.template topRightCorner<Edges + 1, Edges>() = -slope * length * answer;
            inner.template bottomLeftCorner<Edges, Edges + 1>() =
                inner.template topRightCorner<Edges + 1, Edges>().transpose();
        }
        inner(0, 0) += curvature * length * length;
        for (int k = 0; k <= Edges; ++k) {
            basis.col(k) = outer<Dim>(weight_frame.col(k), contact.direction);
        }
        for (int k = 0; k < Edges; ++k) {
            basis.col(Edges + 1 + k) = outer<Dim>(weight_frame.col(0), moving.frame.col(k));
        }
    }
};

// Orthonormal columns that are normal to the direction and to the faces.
template <int Dim, int Edges>
Eigen::Matrix<double, Dim, Dim - 1 - Edges> normals_of(const Contact<Dim>& contact,
                                                       const MovingWeights<Dim>& moving) {
    Eigen::Matrix<double, Dim, Edges + 1> along;
    along << contact.direction, moving.frame.template leftCols<Edges>();
    const Eigen::HouseholderQR<Eigen::Matrix<double, Dim, Edges + 1>> all(along);
    const Block<Dim> frame = all.householderQ();
    return frame.template rightCols<Dim - 1 - Edges>();
}

template <int Dim, int Edges>
Spectrum<Dim> spectrum_of_edges(const Contact<Dim>& contact,
                                const MovingWeights<Dim>& moving,
                                double slope,
                                double curvature,
                                Filter filter) {
    const Range<Dim, Edges> range(contact, moving, slope, curvature);
    using Inner = decltype(range.inner);
    const Eigen::SelfAdjointEigenSolver<Inner> solver(range.inner);
    // It is 0 on all of w (x) E, so at most Edges + 1 eigenvalues are above 0: another is rounding.
    const int most = filter == Filter::Clamp ? Edges + 1 : range.kSize;
    // What is normal to the direction and to the faces: buckling, negative where psi' is.
    const double buckling = filtered(slope / (contact.distance + contact.radius), filter);
    constexpr int kNormals = Dim - 1 - Edges;
    Spectrum<Dim> spectrum;
    spectrum.resize(most + kNormals);
    Eigen::Index rank = 0;
    for (int k = range.kSize - most; k < range.kSize; ++k) {
        const double value = filtered(solver.eigenvalues()[k], filter);
        if (value != 0) {
            spectrum.values[rank] = value;
            spectrum.vectors.col(rank++) = range.basis.lazyProduct(solver.eigenvectors().col(k));
        }
    }
    if constexpr (kNormals > 0) {
        if (buckling != 0) {
            const Weights<Dim> weights = contact.weights.normalized();
            const auto normals = normals_of<Dim, Edges>(contact, moving);
            for (int k = 0; k < kNormals; ++k) {
                spectrum.values[rank] = buckling * contact.weights.squaredNorm();
                spectrum.vectors.col(rank++) = outer<Dim>(weights, normals.col(k));
            }
        }
    }
    spectrum.resize(rank);
    return spectrum;
}

// Calls of_edges.operator()<Edges>(moving) with the number of edges that do move the weights.
template <int Dim, typename OfEdges>
auto with_edges(const Stencil<Dim>& points, const Contact<Dim>& contact, const OfEdges& of_edges) {
    const MovingWeights<Dim> moving = moving_weights<Dim>(points, contact);
    return [&]<int... Edges>(std::integer_sequence<int, Edges...>) {
        decltype(of_edges.template operator()<0>(moving)) result;
        ((moving.edges == Edges ? void(result = of_edges.template operator()<Edges>(moving))
                                : void()),
         ...);
        return result;
    }
    (std::make_integer_sequence<int, Dim>());
}

}  // namespace

template <int Dim>
StencilMatrix<Dim> distance_hessian(const Stencil<Dim>& points,
                                    const Contact<Dim>& contact,
                                    double slope,
                                    double curvature) {
    return with_edges<Dim>(points, contact, [&]<int Edges>(const MovingWeights<Dim>& moving) {
        const Range<Dim, Edges> range(contact, moving, slope, curvature);
        StencilMatrix<Dim> hessian =
            range.basis.lazyProduct(range.inner).eval().lazyProduct(range.basis.transpose());
        Block<Dim> normal = Block<Dim>::Identity();
        normal -= contact.direction * contact.direction.transpose();
        normal -= moving.frame * moving.frame.transpose();
        normal *= slope / (contact.distance + contact.radius);
        for (int i = 0; Edges < Dim - 1 && i <= Dim; ++i) {
            for (int j = 0; j <= Dim; ++j) {
                hessian.template block<Dim, Dim>(Dim * i, Dim * j) +=
                    contact.weights[i] * contact.weights[j] * normal;
            }
        }
        return hessian;
    });
}

template <int Dim>
Spectrum<Dim> distance_spectrum(const Stencil<Dim>& points,
                                const Contact<Dim>& contact,
                                double slope,
                                double curvature,
                                Filter filter) {
    return with_edges<Dim>(points, contact, [&]<int Edges>(const MovingWeights<Dim>& moving) {
        return spectrum_of_edges<Dim, Edges>(contact, moving, slope, curvature, filter);
    });
}

#define PENT_INSTANTIATE(Dim)                                                                   \
    template StencilMatrix<Dim> distance_hessian<Dim>(const Stencil<Dim>&, const Contact<Dim>&, \
                                                      double, double);                          \
    template Spectrum<Dim> distance_spectrum<Dim>(const Stencil<Dim>&, const Contact<Dim>&,     \
                                                  double, double, Filter);
PENT_FOR_EACH_DIMENSION(PENT_INSTANTIATE)
#undef PENT_INSTANTIATE

}  // namespace pent::contact
