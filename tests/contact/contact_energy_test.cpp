#include "contact_energy.h"

#include "pairs.h"
#include "scenes.h"
#include "spanned_volume.h"
#include "support/host_tasks.h"

#include <Eigen/Eigenvalues>
#include <gtest/gtest.h>

#include <cmath>
#include <map>

namespace pent::contact {
namespace {

constexpr double kEps = 0.02;
constexpr double kStiffness = 1000;
constexpr DistanceEnergy kAnyDepth{DistanceLaw::Penalty, kEps, kStiffness};
constexpr DistanceEnergy kFading{DistanceLaw::FadingPenalty, kEps, kStiffness};

// At some signed distance, with a weight for each point.
template <int Dim>
Contact<Dim> held_contact(double distance) {
    Contact<Dim> contact;
    contact.direction = Vector<Dim>::LinSpaced(1, Dim).normalized();
    contact.distance = distance;
    return contact;
}

// sum w_i x_i has the signed length l; its energy with the weights held, by differences.
template <int Dim>
void expect_derivatives_of_held_weights(double l, double side, const DistanceEnergy& energy) {
    test::RandomCorners random(5);
    Stencil<Dim> v = random.stencil<Dim>();
    Weights<Dim> w;
    w.setConstant(-1.0 / Dim);
    w[0] = 1;
    const Vector<Dim> start = Vector<Dim>::LinSpaced(-1, 2).normalized();
    v += (l * start - v * w) * w.transpose() / w.squaredNorm();
    const auto contact_of = [&](const Stencil<Dim>& points) {
        Contact<Dim> contact;
        contact.weights = w;
        contact.distance = side * (points * w).norm();
        contact.direction = side * (points * w).normalized();
        evaluate<Dim>(energy, Positions<Dim>(points), contact);
        return contact;
    };
    const auto gradient_of = [&](const Stencil<Dim>& points) -> Vector<Dim> {
        const Contact<Dim> contact = contact_of(points);
        return contact.slope * contact.direction;
    };
    const Block<Dim> hessian = held_hessian<Dim>(energy, contact_of(v), Filter::None);
    const double h = 1e-4 * l;
    const double scale = kStiffness * kEps;
    for (int i = 0; i < Dim * (Dim + 1); ++i) {
        Stencil<Dim> step = Stencil<Dim>::Zero();
        step.data()[i] = 1;
        const Stencil<Dim> ahead = v + h * step;
        const Stencil<Dim> behind = v - h * step;
        const double slope = (contact_of(ahead).energy - contact_of(behind).energy) / (2 * h);
        // Truncation (h / l)^2; rounding 1e-16 / h.
        EXPECT_NEAR((gradient_of(v) * w.transpose()).cwiseProduct(step).sum(), slope,
                    scale * (1e-7 + 1e-15 / h));
        const Vector<Dim> change = (gradient_of(ahead) - gradient_of(behind)) / (2 * h);
        EXPECT_LT((change - hessian * (step * w)).norm(), 1e-6 * scale / l);
    }
}

TEST(HeldHessian, AndForceAreCentralDifferences) {
    for (const double l : {0.9 * kEps, 0.1 * kEps, 1e-4 * kEps}) {
        for (const double side : {1.0, -1.0}) {
            expect_derivatives_of_held_weights<3>(l, side, kAnyDepth);
            expect_derivatives_of_held_weights<4>(l, side, kAnyDepth);
            expect_derivatives_of_held_weights<4>(l, side, kFading);
        }
    }
    expect_derivatives_of_held_weights<4>(20 * kEps, -1, kAnyDepth);
}

TEST(HeldHessian, HasTheEigenvaluesOfTheAnalysisUnfiltered) {
    const double d = 0.3 * kEps;
    const Eigen::SelfAdjointEigenSolver<Eigen::Matrix4d> solver(
        held_hessian<4>(kAnyDepth, held_contact<4>(d), Filter::None));
    const double sideways = kAnyDepth.slope(d) / d;
    EXPECT_NEAR(solver.eigenvalues()[0], sideways, 1e-9);
    EXPECT_NEAR(solver.eigenvalues()[2], sideways, 1e-9);
    EXPECT_NEAR(solver.eigenvalues()[3], 2 * kStiffness, 1e-9);
}

TEST(HeldHessian, IsFilteredToAPositiveOneOfBoundedSize) {
    for (const Filter filter : {Filter::Clamp, Filter::Absolute}) {
        for (const DistanceEnergy& energy : {kAnyDepth, kFading}) {
            for (const double d : {-2 * kEps, -0.5 * kEps, -1e-15, 0.0, 1e-15, 0.5 * kEps}) {
                const Eigen::SelfAdjointEigenSolver<Eigen::Matrix4d> solver(
                    held_hessian<4>(energy, held_contact<4>(d), filter));
                EXPECT_GE(solver.eigenvalues()[0], -1e-9);  // rounding of 2 k
                EXPECT_LE(solver.eigenvalues()[3], 2 * kStiffness * (1 + 1e-12) * 3);
            }
        }
    }
    const auto trace = [](Filter filter) {
        return held_hessian<4>(kAnyDepth, held_contact<4>(0.5 * kEps), filter).trace();
    };
    EXPECT_NEAR(trace(Filter::Clamp), 2 * kStiffness, 1e-9);
    EXPECT_NEAR(trace(Filter::Absolute), 4 * 2 * kStiffness, 1e-9);
}

TEST(HeldHessian, ScalesWithItsShareLikeEnergyAndSlope) {
    Contact<3> one = held_contact<3>(0.01);
    Contact<3> half = one;
    half.share = 0.5;
    const Positions<3> unused(3, 0);
    EXPECT_FALSE(evaluate<3>(kAnyDepth, unused, one));
    EXPECT_FALSE(evaluate<3>(kAnyDepth, unused, half));
    EXPECT_EQ(half.energy, 0.5 * one.energy);
    EXPECT_EQ(half.slope, 0.5 * one.slope);
    EXPECT_EQ(held_hessian<3>(kAnyDepth, half, Filter::Clamp),
              0.5 * held_hessian<3>(kAnyDepth, one, Filter::Clamp));
}

template <typename T>
class MovingHessian : public testing::Test {
protected:
    static constexpr int kSpace = T::value;

    static DistanceEnergy barrier(double distance, double separation = 0) {
        return {DistanceLaw::Barrier, distance, 1, separation};
    }

    // Derivatives against differences of the energy at the true distance.
    template <int K, int L>
    void expect_derivatives(const Stencil<kSpace>& points,
                            const test::PairEnergy<kSpace, K, L>& pair) {
        const std::uint8_t active = pair.contact(points).active;
        const StencilVector<kSpace> gradient = pair.gradient(points);
        const StencilMatrix<kSpace> hessian = pair.hessian(points, Filter::None);
        const double h = 1e-6;
        const double size = 1e-6 * (gradient.norm() + hessian.norm());  // truncation, and rounding
        for (int i = 0; i < gradient.size(); ++i) {
            const Stencil<kSpace> plus = test::moved<kSpace>(points, i, h);
            const Stencil<kSpace> minus = test::moved<kSpace>(points, i, -h);
            if (pair.contact(plus).active != active || pair.contact(minus).active != active) {
                return;  // on the border of a stratum, where the Hessian jumps
            }
            EXPECT_NEAR(gradient[i], (pair.value(plus) - pair.value(minus)) / (2 * h), size);
            const StencilVector<kSpace> column =
                (pair.gradient(plus) - pair.gradient(minus)) / (2 * h);
            EXPECT_LT((hessian.col(i) - column).norm(), 10 * size) << "coordinate " << i;
        }
        ++checked_[active];
    }

    test::RandomCorners random_{3};
    std::map<int, int> checked_;  // cases by stratum
};

using Dimensions = testing::Types<std::integral_constant<int, 3>, std::integral_constant<int, 4>>;
TYPED_TEST_SUITE(MovingHessian, Dimensions);

TYPED_TEST(MovingHessian, IsThatOfTheTrueDistanceInEveryStratum) {
    constexpr int kDim = TypeParam::value;
    for (int k = 0; k < 1500; ++k) {
        const Stencil<kDim> points = this->random_.template stencil<kDim>();
        const double d = test::contact_at<kDim, 1, kDim>(points).distance;
        if (d > 0.05) {
            this->template expect_derivatives<1, kDim>(points, {this->barrier(1.5 * d, 0.1 * d)});
        }
    }
    EXPECT_EQ(this->checked_.size(), (1U << kDim) - 1);  // every face of the facet
    this->checked_.clear();
    for (int k = 0; k < 4000; ++k) {
        const Stencil<kDim> points = this->random_.template stencil<kDim>();
        const double d = test::contact_at<kDim, 2, kDim - 1>(points).distance;
        if (d > 0.01) {
            this->template expect_derivatives<2, kDim - 1>(points, {this->barrier(1.5 * d)});
        }
    }
    EXPECT_EQ(this->checked_.size(), 3 * ((1U << (kDim - 1)) - 1));
}

TYPED_TEST(MovingHessian, IsThatOfTheProductWithTheMollifier) {
    constexpr int kDim = TypeParam::value;
    for (int k = 0; k < 100; ++k) {
        const Stencil<kDim> points = this->random_.template stencil<kDim>();
        const double d = test::contact_at<kDim, 2, kDim - 1>(points).distance;
        const double c = spanned_volume_squared<kDim>(points);
        if (d > 0.05 && c > 0.01) {
            for (const double threshold : {1.7 * c, 0.9 * c}) {
                this->template expect_derivatives<2, kDim - 1>(points,
                                                               {this->barrier(1.5 * d), threshold});
            }
        }
    }
    EXPECT_GT(this->checked_.size(), 3U);
}

TYPED_TEST(MovingHessian, WithAMollifierIsFilteredOnAllEigenvalues) {
    constexpr int kDim = TypeParam::value;
    for (int k = 0; k < 20; ++k) {
        const Stencil<kDim> points = this->random_.template stencil<kDim>();
        const double d = test::contact_at<kDim, 2, kDim - 1>(points).distance;
        const test::PairEnergy<kDim, 2, kDim - 1> pair{this->barrier(1.5 * d),
                                                       2 * spanned_volume_squared<kDim>(points)};
        const StencilMatrix<kDim> exact = pair.hessian(points, Filter::None);
        const Eigen::SelfAdjointEigenSolver<StencilMatrix<kDim>> solver(exact);
        const auto& V = solver.eigenvectors();
        const StencilMatrix<kDim> clamped =
            V * solver.eigenvalues().cwiseMax(0).asDiagonal() * V.transpose();
        EXPECT_LT((pair.hessian(points, Filter::Clamp) - clamped).norm(), 1e-10 * exact.norm());
    }
}

// A point that walks over a facet and beyond all its borders.
TYPED_TEST(MovingHessian, ForceIsContinuousWhereTheNearestFaceChanges) {
    constexpr int kDim = TypeParam::value;
    Stencil<kDim> points = Stencil<kDim>::Zero();
    for (int i = 1; i < kDim; ++i) {
        points(i - 1, i + 1) = 1;
    }
    points.col(0).setConstant(0.21);
    points(kDim - 1, 0) = 0.3;
    const test::PairEnergy<kDim, 1, kDim> pair{this->barrier(1)};
    StencilVector<kDim> last;
    for (int k = 0; k <= 20'000; ++k) {
        points(0, 0) = -0.8 + 1e-4 * k;
        const StencilVector<kDim> gradient = pair.gradient(points);
        if (k > 0) {
            EXPECT_LT((gradient - last).norm(), 0.02) << "at " << points(0, 0);  // 1e-4 |Hessian|
        }
        last = gradient;
    }
}

// An edge above a ridge, turned through the directions of the ridge: its closest point jumps from
// one end to the other, with a force that the mollifier has taken away.
TYPED_TEST(MovingHessian, ForceIsContinuousWhereAMixedPairTurnsParallel) {
    constexpr int kDim = TypeParam::value;
    const auto at = [&](double angle, bool is_mollified) {
        Stencil<kDim> points = Stencil<kDim>::Zero();
        for (int i = 1; i < kDim - 1; ++i) {
            points(i - 1, i + 2) = 4;
        }
        points.row(0).tail(kDim - 1).array() -= 1;
        points.template leftCols<2>().setConstant(0.25);
        points.row(kDim - 1).head(2).setConstant(0.2);
        points(0, 1) += std::cos(angle);
        points(kDim - 1, 1) += std::sin(angle);
        points(kDim - 2, 0) = 0;
        points(kDim - 2, 1) = 1e-3;
        const double threshold = is_mollified ? 1e-3 * std::pow(4, 2 * (kDim - 2)) : 0;
        return test::PairEnergy<kDim, 2, kDim - 1>{this->barrier(0.5), threshold}.gradient(points);
    };
    // The largest change of the force between two angles that are h apart.
    const auto jump = [&](bool is_mollified, double h) {
        double largest = 0;
        for (int k = -2000; k < 2000; ++k) {
            largest =
                std::max(largest, (at((k + 1) * h, is_mollified) - at(k * h, is_mollified)).norm());
        }
        return largest;
    };
    EXPECT_GT(jump(false, 1e-6), 0.3);
    EXPECT_LT(jump(true, 1e-6), 0.01);
    EXPECT_LT(jump(true, 1e-8), 0.0001);
}

template <typename T>
class SurfaceHessian : public testing::Test {};
TYPED_TEST_SUITE(SurfaceHessian, Dimensions);

TYPED_TEST(SurfaceHessian, IsTheDifferenceOfTheForceAndFilteredLikeADenseOne) {
    constexpr int kDim = TypeParam::value;
    test::RandomCorners random(9);
    const DistanceEnergy penalty{DistanceLaw::Penalty, 0.4, 50};
    const double h = 1e-6;
    int compared = 0;
    const Vector<kDim> center = Vector<kDim>::Constant(0.1);
    for (const ObstacleShape<kDim>& obstacle :
         {ObstacleShape<kDim>(Ball<kDim>{center, 0.8}),
          ObstacleShape<kDim>(Cavity<kDim>{center, 0.9}),
          ObstacleShape<kDim>(Bowl<kDim>{center, 0.9, Vector<kDim>::Unit(1)}),
          ObstacleShape<kDim>(Cuboid<kDim>{center, Vector<kDim>::LinSpaced(0.7, 1.1)})}) {
        const auto force = [&](const Vector<kDim>& x) -> Vector<kDim> {
            const SignedDistance<kDim> at = signed_distance<kDim>(obstacle, x);
            return penalty.slope(at.value) * at.gradient;
        };
        for (int trial = 0; trial < 100; ++trial) {
            const Vector<kDim> x = 1.5 * random.template corners<kDim, 1>();
            const SignedDistance<kDim> at = signed_distance<kDim>(obstacle, x);
            const Vector<kDim> along = random.template corners<kDim, 1>().normalized();
            const Vector<kDim> change = (force(x + h * along) - force(x - h * along)) / (2 * h);
            if (at.hessian().norm() > 20 || std::abs(at.value - 0.4) < 1e-3
                || change.norm() > 1e5) {
                continue;  // next to a center, or where the nearest surface changes
            }
            const Block<kDim> raw = surface_hessian<kDim>(penalty, at, Filter::None);
            EXPECT_LT((change - raw * along).norm(), 1e-2);
            const Eigen::SelfAdjointEigenSolver<Block<kDim>> solver(raw);
            const Block<kDim>& Q = solver.eigenvectors();
            const Block<kDim> clamped =
                Q * solver.eigenvalues().cwiseMax(0).asDiagonal() * Q.transpose();
            const Block<kDim> absolute =
                Q * solver.eigenvalues().cwiseAbs().asDiagonal() * Q.transpose();
            const double rounding = 1e-12 * (1 + raw.norm());
            EXPECT_LT((surface_hessian<kDim>(penalty, at, Filter::Clamp) - clamped).norm(),
                      rounding);
            EXPECT_LT((surface_hessian<kDim>(penalty, at, Filter::Absolute) - absolute).norm(),
                      rounding);
            ++compared;
        }
    }
    EXPECT_GT(compared, 200);
}

// Twenty thousand contacts with random vertices: sums by part are the sums over all, and the same
// to the bit for any number of threads.
TEST(AddGradient, IsTheSumOverAllContactsForAnyNumberOfThreads) {
    test::RandomCorners random(4);
    Contacts<3> contacts;
    constexpr std::uint32_t kVertices = 500;
    for (std::uint32_t k = 0; k < 20'000; ++k) {
        Contact<3> contact;
        contact.count = static_cast<std::uint8_t>(1 + k % 4);
        for (std::uint32_t i = 0; i < 4; ++i) {
            contact.vertices[i] = (k * 7 + i * 31) % kVertices;
        }
        contact.weights = random.corners<4, 1>();
        contact.direction = random.corners<3, 1>();
        contact.slope = -1;
        contacts.list.push_back(contact);
        if (k % 100 == 0) {
            contacts.mollified.push_back({k, StencilVector<3>::Constant(0.5)});
        }
    }
    Positions<3> expected = Positions<3>::Zero(3, kVertices);
    for (std::size_t k = 0; k < contacts.list.size(); ++k) {
        const Contact<3>& contact = contacts.list[k];
        for (int i = 0; i < contact.count; ++i) {
            expected.col(contact.vertices[i]) -= contact.force(i);
            if (k % 100 == 0) {
                expected.col(contact.vertices[i]).array() += 0.5;
            }
        }
    }
    Positions<3> first;
    for (const int threads : {1, 2, 3}) {
        Positions<3> gradient = Positions<3>::Zero(3, kVertices);
        Workers(pent::test::host_tasks(threads)).run([&] { add_gradient<3>(contacts, gradient); });
        EXPECT_LT((gradient - expected).norm(), 1e-12 * expected.norm());
        if (threads == 1) {
            first = gradient;
        }
        EXPECT_EQ(gradient, first);
    }
}

}  // namespace
}  // namespace pent::contact
