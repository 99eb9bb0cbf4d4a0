#include "scenes.h"

#include <pent/contact/barrier_finder.h>
#include <pent/contact/ccd.h>
#include <pent/error.h>

#include <Eigen/LU>
#include <gtest/gtest.h>

#include <algorithm>
#include <support/host_tasks.h>

namespace pent::contact {
namespace {

template <int Dim>
std::vector<ContactBody<Dim>> bodies_of(const test::Scene<Dim>& scene) {
    std::vector<ContactBody<Dim>> bodies;
    for (const Surface<Dim>& surface : scene.surfaces) {
        bodies.push_back({"body" + std::to_string(bodies.size()), surface, false});
    }
    return bodies;
}

template <typename T>
class BarrierFinderTest : public testing::Test {
protected:
    static constexpr int kSpace = T::value;
    static constexpr BarrierOptions kOptions{.distance = 0.2, .separation = 0.01};
    static constexpr double kStiffness = 7;

    void SetUp() override {
        // Two shaken cubes side by side with a gap of 0.1 and a little aside, so that all strata occur.
        scene_.add(test::cube<kSpace>(1), Vector<kSpace>::Zero());
        Vector<kSpace> aside = Vector<kSpace>::Constant(0.13);
        aside[0] = 1.1;
        scene_.add(test::cube<kSpace>(1), aside);
        rest_ = scene_.positions;
        test::shake<kSpace>(scene_.positions, 0.02, 4);
    }

    [[nodiscard]] BarrierFinder<kSpace> finder(
        const BarrierOptions& options = kOptions,
        const std::vector<Obstacle<kSpace>>& obstacles = {}) const {
        return {bodies_of(scene_), obstacles,
                std::vector<bool>(static_cast<std::size_t>(rest_.cols()), false), rest_, options};
    }

    // The energy over all pairs of two bodies, each by its own distance.
    template <int K, int L>
    void add_energy(const Simplices<K>& a,
                    const Simplices<L>& b,
                    const Positions<kSpace>& x,
                    double& sum) const {
        for (Eigen::Index i = 0; i < a.cols(); ++i) {
            for (Eigen::Index j = 0; j < b.cols(); ++j) {
                Stencil<kSpace> points;
                Stencil<kSpace> rest;
                for (int k = 0; k < K; ++k) {
                    points.col(k) = x.col(a(k, i));
                    rest.col(k) = rest_.col(a(k, i));
                }
                for (int k = 0; k < L; ++k) {
                    points.col(K + k) = x.col(b(k, j));
                    rest.col(K + k) = rest_.col(b(k, j));
                }
                const double d =
                    std::sqrt(closest_points<kSpace, K, L>(points.template leftCols<K>(),
                                                           points.template rightCols<L>())
                                  .distance_squared);
                Mollifier mollifier;
                if (K == 2) {
                    const Eigen::Matrix<double, kSpace, L - 1> ridge =
                        rest.template rightCols<L - 1>().colwise() - rest.col(K);
                    mollifier.threshold = 1e-3 * (rest.col(1) - rest.col(0)).squaredNorm()
                                          * (ridge.transpose() * ridge).determinant();
                }
                sum += barrier_energy(d, {kOptions.distance, kStiffness, kOptions.separation})
                       * (K == 2 ? mollifier.value(spanned_volume_squared<kSpace>(points)) : 1);
            }
        }
    }

    [[nodiscard]] double brute_force_energy(const Positions<kSpace>& x) const {
        double sum = 0;
        for (int a = 0; a < 2; ++a) {
            const Surface<kSpace>& first = scene_.surfaces[a];
            const Surface<kSpace>& second = scene_.surfaces[1 - a];
            add_energy<1, kSpace>(first.vertices, second.facets, x, sum);
            if (kSpace > 3 || a == 0) {
                add_energy<2, kSpace - 1>(first.edges, second.ridges, x, sum);
            }
        }
        return sum;
    }

    test::Scene<kSpace> scene_;
    Positions<kSpace> rest_;
};

using Dimensions = testing::Types<std::integral_constant<int, 3>, std::integral_constant<int, 4>>;
TYPED_TEST_SUITE(BarrierFinderTest, Dimensions);

TYPED_TEST(BarrierFinderTest, EnergyIsTheSumOverAllPairs) {
    constexpr int kDim = TypeParam::value;
    auto finder = this->finder();
    for (const double push : {0.0, 0.03, 0.05}) {
        Positions<kDim> x = this->scene_.positions;
        x.leftCols(this->scene_.begin[1]).row(0).array() += push;
        const BarrierContacts<kDim> contacts = finder.find(x);
        const double energy = finder.energy(contacts, x, this->kStiffness);
        EXPECT_GT(energy, 0);
        EXPECT_NEAR(energy, this->brute_force_energy(x), 1e-12 * energy * 1000);
        EXPECT_GT(contacts.report.smallest_gap, 0);
    }
}

TYPED_TEST(BarrierFinderTest, ForcesAreTheNegativeDifferencesOfTheEnergy) {
    constexpr int kDim = TypeParam::value;
    auto finder = this->finder();
    Positions<kDim> x = this->scene_.positions;
    Positions<kDim> forces = Positions<kDim>::Zero(kDim, x.cols());
    finder.add_forces(finder.find(x), x, this->kStiffness, forces);
    EXPECT_LT(forces.rowwise().sum().norm(), 1e-12 * forces.norm());  // momentum
    const double h = 1e-6;
    for (Eigen::Index i = 0; i < x.size(); i += 3) {
        Positions<kDim> plus = x;
        Positions<kDim> minus = x;
        plus.data()[i] += h;
        minus.data()[i] -= h;
        const double difference = (finder.energy(finder.find(plus), plus, this->kStiffness)
                                   - finder.energy(finder.find(minus), minus, this->kStiffness))
                                  / (2 * h);
        // Truncation (h / gap)^2 = 1e-8; strata that change within h.
        EXPECT_NEAR(forces.data()[i], -difference, 1e-5 * forces.norm());
    }
}

TYPED_TEST(BarrierFinderTest, HessiansAreTheNegativeDifferencesOfTheForces) {
    constexpr int kDim = TypeParam::value;
    Vector<kDim> center = Vector<kDim>::Constant(0.45);
    center[kDim - 1] = -0.35;
    auto finder = this->finder(
        this->kOptions, {Ball<kDim>{center, 0.2}, HalfSpace<kDim>{Vector<kDim>::Unit(1), -0.1}});
    const Positions<kDim>& x = this->scene_.positions;
    const auto forces_at = [&](const Positions<kDim>& y) {
        Positions<kDim> forces = Positions<kDim>::Zero(kDim, y.cols());
        finder.add_forces(finder.find(y), y, this->kStiffness, forces);
        return forces;
    };
    Positions<kDim> way = Positions<kDim>::Zero(kDim, x.cols());
    test::shake<kDim>(way, 1, 6);
    Positions<kDim> product = Positions<kDim>::Zero(kDim, x.cols());
    const BarrierContacts<kDim> contacts = finder.find(x);
    EXPECT_FALSE(contacts.vertices.empty());
    for (const VertexContact& contact : contacts.vertices) {
        product.col(contact.vertex) +=
            finder.hessian(contact, x, this->kStiffness, Filter::None) * way.col(contact.vertex);
    }
    for (const BarrierContact<kDim>& contact : contacts.pairs) {
        StencilVector<kDim> local = StencilVector<kDim>::Zero();
        for (int i = 0; i < contact.faces.count; ++i) {
            if (contact.vertices[i] != kFixedPoint) {
                local.template segment<kDim>(kDim * i) = way.col(contact.vertices[i]);
            }
        }
        local = (finder.hessian(contact, x, this->kStiffness, Filter::None) * local).eval();
        for (int i = 0; i < contact.faces.count; ++i) {
            if (contact.vertices[i] != kFixedPoint) {
                product.col(contact.vertices[i]) += local.template segment<kDim>(kDim * i);
            }
        }
    }
    const double h = 1e-7;
    const Positions<kDim> difference = (forces_at(x - h * way) - forces_at(x + h * way)) / (2 * h);
    // Truncation (h / gap)^2, rounding 1e-16 / h; strata that change within h.
    EXPECT_LT((product - difference).norm(), 1e-5 * difference.norm());
}

TYPED_TEST(BarrierFinderTest, DependsOnPositionsAloneNotOnHistoryOrThreads) {
    constexpr int kDim = TypeParam::value;
    auto used = this->finder();
    Positions<kDim> x = this->scene_.positions;
    for (int k = 0; k < 5; ++k) {  // leaves candidates behind that hold for a while
        x.leftCols(this->scene_.begin[1]).row(1).array() += 0.04;
        std::ignore = used.find(x);
    }
    Positions<kDim> to = x;
    to.leftCols(this->scene_.begin[1]).row(0).array() += 0.3;
    for (const int threads : {1, 3}) {
        Workers(pent::test::host_tasks(threads)).run([&] {
            auto fresh = this->finder();
            const BarrierContacts<kDim> a = used.find(x);
            const BarrierContacts<kDim> b = fresh.find(x);
            ASSERT_EQ(a.pairs.size(), b.pairs.size());
            for (std::size_t i = 0; i < a.pairs.size(); ++i) {
                EXPECT_EQ(a.pairs[i].vertices, b.pairs[i].vertices);
                EXPECT_EQ(a.pairs[i].faces.weights, b.pairs[i].faces.weights);
                EXPECT_EQ(a.pairs[i].multiplicity, b.pairs[i].multiplicity);
            }
            EXPECT_EQ(used.energy(a, x, 1), fresh.energy(b, x, 1));
            const StepLimit limit = fresh.limit_step(x, to);
            EXPECT_LT(limit.fraction, 1);
            EXPECT_EQ(used.limit_step(x, to).fraction, limit.fraction);
            EXPECT_EQ(used.limit_step(x, to).limiting.first, limit.limiting.first);
        });
    }
}

TYPED_TEST(BarrierFinderTest, FindsTheSameWhereItIsMovedTo) {
    constexpr int kDim = TypeParam::value;
    const Positions<kDim>& x = this->scene_.positions;
    auto stays = this->finder();
    auto made = this->finder();
    BarrierFinder<kDim> moved = std::move(made);
    const double energy = stays.energy(stays.find(x), x, 1);
    EXPECT_GT(energy, 0);
    EXPECT_EQ(moved.energy(moved.find(x), x, 1), energy);
    auto assigned = this->finder({.distance = 0.3});
    EXPECT_NE(assigned.energy(assigned.find(x), x, 1), energy);
    assigned = std::move(moved);
    EXPECT_EQ(assigned.energy(assigned.find(x), x, 1), energy);
}

TYPED_TEST(BarrierFinderTest, StepLimitIsTheLeastOfAllPairs) {
    constexpr int kDim = TypeParam::value;
    auto finder = this->finder();
    const Positions<kDim>& x = this->scene_.positions;
    for (const double speed : {0.05, 0.3, 20.0}) {
        Positions<kDim> to = x;
        to.leftCols(this->scene_.begin[1]).row(0).array() += speed;
        test::shake<kDim>(to, 0.01, 9);
        const Positions<kDim> motion = to - x;
        double least = 1;
        const auto visit = [&]<int K, int L>(const Simplices<K>& a, const Simplices<L>& b) {
            for (Eigen::Index i = 0; i < a.cols(); ++i) {
                for (Eigen::Index j = 0; j < b.cols(); ++j) {
                    Corners<kDim, K> p, vp;
                    Corners<kDim, L> q, vq;
                    for (int k = 0; k < K; ++k) {
                        p.col(k) = x.col(a(k, i));
                        vp.col(k) = motion.col(a(k, i));
                    }
                    for (int k = 0; k < L; ++k) {
                        q.col(k) = x.col(b(k, j));
                        vq.col(k) = motion.col(b(k, j));
                    }
                    least = std::min(least, safe_fraction<kDim, K, L>(p, vp, q, vq, {0.01, 0.2}));
                }
            }
        };
        const Surface<kDim>& first = this->scene_.surfaces[0];
        const Surface<kDim>& second = this->scene_.surfaces[1];
        visit.template operator()<1, kDim>(first.vertices, second.facets);
        visit.template operator()<1, kDim>(second.vertices, first.facets);
        visit.template operator()<2, kDim - 1>(first.edges, second.ridges);
        if constexpr (kDim > 3) {
            visit.template operator()<2, kDim - 1>(second.edges, first.ridges);
        }
        const StepLimit limit = finder.limit_step(x, to);
        EXPECT_DOUBLE_EQ(limit.fraction, least);
        if (least < 1) {
            EXPECT_EQ(limit.limiting.first.size() + limit.limiting.second.size(), kDim + 1U);
        }
    }
}

TYPED_TEST(BarrierFinderTest, AFacetCannotCutABallBetweenItsVertices) {
    constexpr int kDim = TypeParam::value;
    // A ball of radius 0.2 below the middle of the lowest side of the first cube.
    Vector<kDim> center = Vector<kDim>::Constant(0.45);
    center[kDim - 1] = -0.35;
    auto finder = this->finder(this->kOptions, {Ball<kDim>{center, 0.2}});
    const Positions<kDim>& x = this->scene_.positions;
    Positions<kDim> to = x;
    to.row(kDim - 1).array() -= 0.3;
    const StepLimit limit = finder.limit_step(x, to);
    EXPECT_LT(limit.fraction, 0.5);
    EXPECT_GT(limit.fraction, 0.2);
    EXPECT_EQ(limit.limiting.second_body, -1);
    Positions<kDim> forces = Positions<kDim>::Zero(kDim, x.cols());
    const Positions<kDim> near = x + 0.9 * limit.fraction * (to - x);
    finder.add_forces(finder.find(near), near, 1, forces);
    EXPECT_GT(forces.row(kDim - 1).sum(), 0);  // up
    const double h = 1e-6;                     // and it is the derivative of its energy
    const auto energy_at = [&](double up) {
        Positions<kDim> y = near;
        y.row(kDim - 1).array() += up;
        return finder.energy(finder.find(y), y, 1);
    };
    EXPECT_NEAR(forces.row(kDim - 1).sum(), -(energy_at(h) - energy_at(-h)) / (2 * h),
                1e-5 * forces.row(kDim - 1).sum());
}

TYPED_TEST(BarrierFinderTest, LeavesHeldVerticesAlone) {
    constexpr int kDim = TypeParam::value;
    BarrierFinder<kDim> finder(
        bodies_of(this->scene_), {},
        std::vector<bool>(static_cast<std::size_t>(this->rest_.cols()), true), this->rest_,
        this->kOptions);
    EXPECT_EQ(finder.find(this->scene_.positions).report.contacts, 0);
}

TYPED_TEST(BarrierFinderTest, ObstaclesLeaveBodiesAloneThatAreMovedFromOutside) {
    constexpr int kDim = TypeParam::value;
    std::vector<ContactBody<kDim>> bodies = bodies_of(this->scene_);
    Vector<kDim> center = Vector<kDim>::Constant(0.45);
    center[kDim - 1] = -0.3;
    for (const bool is_kinematic : {false, true}) {
        bodies[0].is_kinematic = is_kinematic;  // the other one is far from both obstacles
        BarrierFinder<kDim> finder(
            bodies, {Ball<kDim>{center, 0.2}, HalfSpace<kDim>{Vector<kDim>::Unit(1), -0.1}},
            std::vector<bool>(static_cast<std::size_t>(this->rest_.cols())), this->rest_,
            this->kOptions);
        const BarrierContacts<kDim> contacts = finder.find(this->scene_.positions);
        EXPECT_EQ(contacts.vertices.empty(), is_kinematic);
        EXPECT_EQ(
            std::none_of(contacts.pairs.begin(), contacts.pairs.end(),
                         [](const BarrierContact<kDim>& pair) { return pair.first_body < 0; }),
            is_kinematic);
    }
}

TEST(BarrierOptions, OutOfRangeAreRefused) {
    EXPECT_THROW(check(BarrierOptions{.distance = 0}, "contact"), Error);
    EXPECT_THROW(check(BarrierOptions{.distance = 1, .separation = -1}, "contact"), Error);
    EXPECT_NO_THROW(check(BarrierOptions{.distance = 1}, "contact"));
}

}  // namespace
}  // namespace pent::contact
