#include <pent/contact/length.h>
#include <pent/contact/penalty.h>

#include <Eigen/Eigenvalues>
#include <gtest/gtest.h>

#include <random>

namespace pent::contact {
namespace {

constexpr double kEps = 0.02;
constexpr double kStiffness = 1000;
constexpr Penalty kAnyDepth{kEps, kStiffness, Reach::AnyDepth};
constexpr Penalty kFading{kEps, kStiffness, Reach::Fading};

template <int Dim>
Response<Dim> response(double d, const Penalty& penalty, Filter filter) {
    Vector<Dim> direction = Vector<Dim>::LinSpaced(1, Dim).normalized();
    return pair_response<Dim>(d, direction, penalty, 1, filter);
}

TEST(Penalty, IsThatOfThePaperOutside) {
    EXPECT_DOUBLE_EQ(penalty_energy(0.005, kAnyDepth), 1000 * 0.015 * 0.015);
    EXPECT_DOUBLE_EQ(penalty_energy(0.005, kFading), 1000 * 0.015 * 0.015);
    EXPECT_EQ(penalty_energy(kEps, kAnyDepth), 0);
    EXPECT_EQ(penalty_slope(1.0, kAnyDepth), 0);
    EXPECT_EQ(penalty_curvature(1.0, kFading), 0);
}

TEST(Penalty, PushesOutAtAnyDepthAndHarderTheDeeper) {
    for (const double depth : {1e-12, 0.01, kEps, 3.0, 1e6}) {
        EXPECT_LT(penalty_slope(-2 * depth, kAnyDepth), penalty_slope(-depth, kAnyDepth));
        EXPECT_LT(penalty_slope(-depth, kAnyDepth), 0);
    }
}

TEST(Penalty, FadesOutAtTheDepthOfTheDistance) {
    EXPECT_NEAR(penalty_slope(-kEps * (1 - 1e-9), kFading), 0, 1e-6 * kStiffness * kEps);
    EXPECT_EQ(penalty_slope(-kEps, kFading), 0);
    EXPECT_NEAR(-penalty_slope(-kEps / 4, kFading), 2.25 * kStiffness * kEps, 1e-12);
    for (double d = -kEps * 0.99; d < 0; d += kEps / 50) {
        EXPECT_LT(penalty_slope(d, kFading), 0);  // never pulls in
    }
}

TEST(Penalty, IsContinuousWithItsForceWhereItChangesItsForm) {
    for (const Penalty& penalty : {kAnyDepth, kFading}) {
        for (const double d : {0.0, kEps}) {
            const double h = 1e-12 * kEps;
            EXPECT_NEAR(penalty_energy(d - h, penalty), penalty_energy(d + h, penalty), 1e-11);
            EXPECT_NEAR(penalty_slope(d - h, penalty), penalty_slope(d + h, penalty), 1e-7);
        }
        EXPECT_NEAR(penalty_curvature(-1e-14, penalty), penalty_curvature(1e-14, penalty), 1e-6);
    }
}

TEST(Penalty, HasDerivativesThatAreCentralDifferences) {
    for (const Penalty& penalty : {kAnyDepth, kFading}) {
        for (double d = -0.97 * kEps; d < kEps; d += 0.1 * kEps) {
            const double h = 1e-5 * kEps;
            // psi is a cubic polynomial: truncation k h^2 / eps, rounding 1e-16 psi / h.
            EXPECT_NEAR(penalty_slope(d, penalty),
                        (penalty_energy(d + h, penalty) - penalty_energy(d - h, penalty)) / (2 * h),
                        1e-7);
            EXPECT_NEAR(penalty_curvature(d, penalty),
                        (penalty_slope(d + h, penalty) - penalty_slope(d - h, penalty)) / (2 * h),
                        1e-5 * kStiffness);
        }
    }
}

// Energy of a stencil with the weights held, as a function of the points.
template <int Dim>
double stencil_energy(const Stencil<Dim>& v, const Weights<Dim>& w, double side, const Penalty& p) {
    return penalty_energy(side * length<Dim>(v, w), p);
}

template <int Dim>
void expect_derivatives_of_stencil(double l, double side, const Penalty& penalty) {
    std::mt19937 random(5);
    std::uniform_real_distribution<double> coordinate(-1, 1);
    Stencil<Dim> v = Stencil<Dim>::NullaryExpr([&] { return coordinate(random); });
    Weights<Dim> w;
    w.setConstant(-1.0 / Dim);
    w[0] = 1;
    const Vector<Dim> start = Vector<Dim>::LinSpaced(-1, 2).normalized();
    v += (l * start - v * w) * w.transpose() / w.squaredNorm();
    const Vector<Dim> u = side * (v * w).normalized();
    const Response<Dim> at = pair_response<Dim>(side * l, u, penalty, 1, Filter::None);
    const double h = 1e-4 * l;
    // By the gradient as well as by the coordinates.
    Stencil<Dim> along_gradient = u * w.transpose();
    for (int i = 0; i <= Dim * (Dim + 1); ++i) {
        Stencil<Dim> step = Stencil<Dim>::Zero();
        if (i < Dim * (Dim + 1)) {
            step.data()[i] = 1;
        } else {
            step = along_gradient;
        }
        const Stencil<Dim> ahead = v + h * step;
        const Stencil<Dim> behind = v - h * step;
        const double slope = (stencil_energy<Dim>(ahead, w, side, penalty)
                              - stencil_energy<Dim>(behind, w, side, penalty))
                             / (2 * h);
        const double scale = kStiffness * kEps;
        const double expected = (at.gradient * w.transpose()).cwiseProduct(step).sum();
        EXPECT_NEAR(expected, slope, scale * (1e-7 + 1e-15 / h));  // truncation (h / l)^2
        const auto gradient = [&](const Stencil<Dim>& points) {
            const double length_here = length<Dim>(points, w);
            const Vector<Dim> direction = side * (points * w) / length_here;
            return pair_response<Dim>(side * length_here, direction, penalty, 1, Filter::None)
                .gradient;
        };
        const Vector<Dim> change = (gradient(ahead) - gradient(behind)) / (2 * h);
        const Vector<Dim> product = at.hessian * (step * w);
        EXPECT_LT((change - product).norm(), 1e-6 * scale / l);
    }
}

TEST(PairResponse, HasDerivativesThatAreCentralDifferences) {
    for (const double l : {0.9 * kEps, 0.1 * kEps, 1e-4 * kEps}) {
        for (const double side : {1.0, -1.0}) {
            expect_derivatives_of_stencil<3>(l, side, kAnyDepth);
            expect_derivatives_of_stencil<4>(l, side, kAnyDepth);
            expect_derivatives_of_stencil<4>(l, side, kFading);
        }
    }
    expect_derivatives_of_stencil<4>(20 * kEps, -1, kAnyDepth);
}

TEST(PairResponse, HasTheEigenvaluesOfTheAnalysisUnfiltered) {
    const double d = 0.3 * kEps;
    const Response<4> at = response<4>(d, kAnyDepth, Filter::None);
    const Eigen::SelfAdjointEigenSolver<Eigen::Matrix4d> solver(at.hessian);
    const double sideways = penalty_slope(d, kAnyDepth) / d;
    EXPECT_NEAR(solver.eigenvalues()[0], sideways, 1e-9);
    EXPECT_NEAR(solver.eigenvalues()[2], sideways, 1e-9);
    EXPECT_NEAR(solver.eigenvalues()[3], 2 * kStiffness, 1e-9);
}

TEST(PairResponse, IsFilteredToAPositiveHessianOfBoundedSize) {
    for (const Filter filter : {Filter::Clamp, Filter::Absolute}) {
        for (const Penalty& penalty : {kAnyDepth, kFading}) {
            for (const double d : {-2 * kEps, -0.5 * kEps, -1e-15, 0.0, 1e-15, 0.5 * kEps}) {
                const Response<4> at = response<4>(d, penalty, filter);
                const Eigen::SelfAdjointEigenSolver<Eigen::Matrix4d> solver(at.hessian);
                EXPECT_GE(solver.eigenvalues()[0], -1e-9);  // rounding of 2 k
                EXPECT_LE(solver.eigenvalues()[3], 2 * kStiffness * (1 + 1e-12) * 3);
            }
        }
    }
    EXPECT_NEAR(response<4>(0.5 * kEps, kAnyDepth, Filter::Clamp).hessian.trace(), 2 * kStiffness,
                1e-9);
    EXPECT_NEAR(response<4>(0.5 * kEps, kAnyDepth, Filter::Absolute).hessian.trace(),
                4 * 2 * kStiffness, 1e-9);
}

TEST(PairResponse, ScalesWithItsWeight) {
    const Vector<3> up = Vector<3>::UnitY();
    const Response<3> one = pair_response<3>(0.01, up, kAnyDepth, 1, Filter::Clamp);
    const Response<3> half = pair_response<3>(0.01, up, kAnyDepth, 0.5, Filter::Clamp);
    EXPECT_DOUBLE_EQ(half.energy, 0.5 * one.energy);
    EXPECT_EQ(half.gradient, 0.5 * one.gradient);
    EXPECT_EQ(half.hessian, 0.5 * one.hessian);
}

}  // namespace
}  // namespace pent::contact
