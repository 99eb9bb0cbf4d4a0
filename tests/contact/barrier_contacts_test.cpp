#include "barrier_contacts.h"

#include "closest_points_oracle.h"
#include "spanned_volume.h"
#include "support/host_tasks.h"
#include "two_cubes.h"

#include <Eigen/LU>
#include <gtest/gtest.h>

#include <algorithm>
#include <random>
#include <set>
#include <utility>
#include <vector>

namespace pent::contact {
namespace {

template <typename T>
class BarrierContactsTest : public testing::Test {
protected:
    static constexpr int kSpace = T::value;

    // The energy over all pairs of two lists, each by its own distance.
    template <int K, int L>
    void add_energy(const Simplices<K>& a,
                    const Simplices<L>& b,
                    const Positions<kSpace>& x,
                    double& sum) const {
        const DistanceEnergy barrier{DistanceLaw::Barrier, cubes_.options.distance,
                                     test::kBarrierStiffness, cubes_.options.separation};
        for (Eigen::Index i = 0; i < a.cols(); ++i) {
            for (Eigen::Index j = 0; j < b.cols(); ++j) {
                Stencil<kSpace> points;
                points << gather<kSpace, K>(a, i, x), gather<kSpace, L>(b, j, x);
                const double d =
                    std::sqrt(test::closest_points<kSpace, K, L>(points.template leftCols<K>(),
                                                                 points.template rightCols<L>())
                                  .distance_squared);
                Mollifier mollifier;
                if (K == 2) {
                    const Corners<kSpace, K> edge = gather<kSpace, K>(a, i, cubes_.rest);
                    const Corners<kSpace, L> at_rest = gather<kSpace, L>(b, j, cubes_.rest);
                    const Eigen::Matrix<double, kSpace, L - 1> ridge =
                        at_rest.template rightCols<L - 1>().colwise() - at_rest.col(0);
                    mollifier.threshold = 1e-3 * (edge.col(K - 1) - edge.col(0)).squaredNorm()
                                          * (ridge.transpose() * ridge).determinant();
                }
                sum += barrier.value(d)
                       * (K == 2 ? mollifier.value(spanned_volume_squared<kSpace>(points)) : 1);
            }
        }
    }

    [[nodiscard]] double brute_force_energy(const Positions<kSpace>& x) const {
        double sum = 0;
        for (std::size_t a = 0; a < 2; ++a) {
            const Surface<kSpace>& first = cubes_.scene.surfaces[a];
            const Surface<kSpace>& second = cubes_.scene.surfaces[1 - a];
            add_energy<1, kSpace>(first.vertices, second.facets, x, sum);
            if (kSpace > 3 || a == 0) {
                add_energy<2, kSpace - 1>(first.edges, second.ridges, x, sum);
            }
        }
        return sum;
    }

    static double energy(ContactFinder<kSpace>& finder, const Positions<kSpace>& x) {
        const Contacts<kSpace> contacts = finder.find(x, test::kBarrierStiffness);
        return contacts.body_energy + contacts.obstacle_energy;
    }
    static Positions<kSpace> gradient(ContactFinder<kSpace>& finder, const Positions<kSpace>& x) {
        Positions<kSpace> gradient = Positions<kSpace>::Zero(kSpace, x.cols());
        add_gradient<kSpace>(finder.find(x, test::kBarrierStiffness), gradient);
        return gradient;
    }

    // Hessian times a direction, by what is scattered.
    static Positions<kSpace> product(ContactFinder<kSpace>& finder,
                                     const Positions<kSpace>& x,
                                     const Positions<kSpace>& way) {
        Positions<kSpace> product = Positions<kSpace>::Zero(kSpace, x.cols());
        const StencilHessians<kSpace> hessians = finder.hessians(
            finder.find(x, test::kBarrierStiffness), x, test::kBarrierStiffness, Filter::None);
        for (const WeightedHessian<kSpace>& hessian : hessians.weighted) {
            for (int i = 0; i < hessian.count; ++i) {
                for (int j = 0; j < hessian.count; ++j) {
                    product.col(hessian.vertices[i]) += hessian.weights[i] * hessian.weights[j]
                                                        * hessian.block
                                                        * way.col(hessian.vertices[j]);
                }
            }
        }
        for (const SpectralHessian<kSpace>& hessian : hessians.spectral) {
            const double* const values = hessians.numbers.data() + hessian.begin;
            const Eigen::Map<const Eigen::MatrixXd> vectors(values + hessian.rank, kSpace,
                                                            hessian.rank * hessian.count);
            for (int k = 0; k < hessian.rank; ++k) {
                double along = 0;
                for (int i = 0; i < hessian.count; ++i) {
                    along += vectors.col(hessian.rank * i + k).dot(way.col(hessian.vertices[i]));
                }
                for (int i = 0; i < hessian.count; ++i) {
                    product.col(hessian.vertices[i]) +=
                        values[k] * along * vectors.col(hessian.rank * i + k);
                }
            }
        }
        return product;
    }

    [[nodiscard]] std::vector<ObstacleShape<kSpace>> obstacles_below() const {
        return {Ball<kSpace>{cubes_.below(0.35), 0.2},
                Cuboid<kSpace>{cubes_.below(0.25), Vector<kSpace>::LinSpaced(0.31, 0.37)},
                HalfSpace<kSpace>{Vector<kSpace>::Unit(1), -0.1}};
    }

    test::TwoCubes<kSpace> cubes_;
};

using Dimensions = testing::Types<std::integral_constant<int, 3>, std::integral_constant<int, 4>>;
TYPED_TEST_SUITE(BarrierContactsTest, Dimensions);

TYPED_TEST(BarrierContactsTest, EnergyIsTheSumOverAllPairs) {
    ContactFinder<TypeParam::value> finder(this->cubes_.model());
    for (const double push : {0.0, 0.03, 0.05}) {
        const auto x = this->cubes_.pushed(push);
        const double energy = this->energy(finder, x);
        EXPECT_GT(energy, 0);
        EXPECT_NEAR(energy, this->brute_force_energy(x), 1e-12 * energy * 1000);
    }
}

TYPED_TEST(BarrierContactsTest, GradientIsTheDifferenceOfTheEnergy) {
    constexpr int kDim = TypeParam::value;
    ContactFinder<kDim> alone(this->cubes_.model());
    ContactFinder<kDim> finder(this->cubes_.model(this->obstacles_below()));
    const Positions<kDim>& x = this->cubes_.scene.positions;
    const Positions<kDim> between = this->gradient(alone, x);
    EXPECT_LT(between.rowwise().sum().norm(), 1e-12 * between.norm());  // momentum
    const Positions<kDim> gradient = this->gradient(finder, x);
    EXPECT_GT((gradient - between).norm(), 1e-3 * between.norm());  // obstacles push, too
    const double h = 1e-6;
    for (Eigen::Index i = 0; i < x.size(); i += 3) {
        Positions<kDim> plus = x;
        Positions<kDim> minus = x;
        plus.data()[i] += h;
        minus.data()[i] -= h;
        // Truncation (h / gap)^2 = 1e-8; strata that change within h.
        EXPECT_NEAR(gradient.data()[i],
                    (this->energy(finder, plus) - this->energy(finder, minus)) / (2 * h),
                    1e-5 * gradient.norm());
    }
}

TYPED_TEST(BarrierContactsTest, HessiansAreTheDifferencesOfTheGradient) {
    constexpr int kDim = TypeParam::value;
    ContactFinder<kDim> finder(this->cubes_.model(this->obstacles_below()));
    const Positions<kDim>& x = this->cubes_.scene.positions;
    Positions<kDim> way = Positions<kDim>::Zero(kDim, x.cols());
    test::shake<kDim>(way, 1, 6);
    const double h = 1e-7;
    const Positions<kDim> difference =
        (this->gradient(finder, x + h * way) - this->gradient(finder, x - h * way)) / (2 * h);
    // Truncation (h / gap)^2, rounding 1e-16 / h; strata that change within h.
    EXPECT_LT((this->product(finder, x, way) - difference).norm(), 1e-5 * difference.norm());
}

// Those of more contacts, and of another filter, were there before.
TYPED_TEST(BarrierContactsTest, HessiansDoNotDependOnTheListsTheyAreWrittenTo) {
    constexpr int kDim = TypeParam::value;
    ContactFinder<kDim> finder(this->cubes_.model(this->obstacles_below()));
    const auto hessians = [&](double push, Filter filter, StencilHessians<kDim> memory) {
        const auto x = this->cubes_.pushed(push);
        return finder.hessians(finder.find(x, test::kBarrierStiffness), x, test::kBarrierStiffness,
                               filter, std::move(memory));
    };
    const StencilHessians<kDim> fresh = hessians(0.03, Filter::Clamp, {});
    const StencilHessians<kDim> again =
        hessians(0.03, Filter::Clamp, hessians(0.05, Filter::None, {}));
    ASSERT_EQ(again.weighted.size(), fresh.weighted.size());
    ASSERT_EQ(again.spectral.size(), fresh.spectral.size());
    EXPECT_GT(fresh.spectral.size(), 10U);
    EXPECT_GE(again.numbers.size(), fresh.numbers.size());
    for (std::size_t k = 0; k < fresh.spectral.size(); ++k) {
        const SpectralHessian<kDim>& one = fresh.spectral[k];
        const SpectralHessian<kDim>& other = again.spectral[k];
        EXPECT_EQ(other.vertices, one.vertices);
        ASSERT_EQ(other.count, one.count);
        ASSERT_EQ(other.rank, one.rank);
        const auto numbers = [&](const StencilHessians<kDim>& of, const SpectralHessian<kDim>& at) {
            return std::vector<double>(
                of.numbers.data() + at.begin,
                of.numbers.data() + at.begin + at.rank * (1 + kDim * at.count));
        };
        EXPECT_EQ(numbers(again, other), numbers(fresh, one));
    }
}

TYPED_TEST(BarrierContactsTest, DependOnPositionsAloneNotOnHistoryOrThreads) {
    constexpr int kDim = TypeParam::value;
    ContactFinder<kDim> used(this->cubes_.model());
    for (int k = 1; k <= 4; ++k) {  // leaves candidates behind that hold for a while
        std::ignore = used.find(this->cubes_.pushed(0.04 * k, 1), 1);
    }
    const Positions<kDim> x = this->cubes_.pushed(0.2, 1);
    for (const int threads : {1, 3}) {
        Workers(pent::test::host_tasks(threads)).run([&] {
            ContactFinder<kDim> fresh(this->cubes_.model());
            const Contacts<kDim> a = used.find(x, 1);
            const Contacts<kDim> b = fresh.find(x, 1);
            ASSERT_EQ(a.list.size(), b.list.size());
            for (std::size_t i = 0; i < a.list.size(); ++i) {
                EXPECT_EQ(a.list[i].vertices, b.list[i].vertices);
                EXPECT_EQ(a.list[i].weights, b.list[i].weights);
                EXPECT_EQ(a.list[i].multiplicity, b.list[i].multiplicity);
            }
            EXPECT_EQ(a.body_energy, b.body_energy);
        });
    }
}

TYPED_TEST(BarrierContactsTest, WithObstaclesHaveTheseSecondAndTheirVerticesLast) {
    constexpr int kDim = TypeParam::value;
    ContactFinder<kDim> finder(this->cubes_.model(this->obstacles_below()));
    const Contacts<kDim> contacts = finder.find(this->cubes_.scene.positions, 1);
    std::array<int, 3> counts{};
    for (const Contact<kDim>& contact : contacts.list) {
        EXPECT_FALSE(contact.first.is_obstacle());
        EXPECT_GT(contact.count, 0);
        for (int i = 0; i < contact.corner_count; ++i) {
            EXPECT_EQ(contact.vertices[i] < this->cubes_.rest.cols(), i < contact.count);
        }
        if (contact.second.is_obstacle()) {
            ++counts.at(contact.second.index);
        }
    }
    EXPECT_GT(*std::min_element(counts.begin(), counts.end()), 0);
    EXPECT_EQ(contacts.report.obstacle, counts[0] + counts[1] + counts[2]);
    EXPECT_GT(contacts.report.point_facet, 0);
}

// Simplices may have their corners in any order that leaves facets outward: the same nearest faces
// are one contact.
TYPED_TEST(BarrierContactsTest, AreTheSameWhateverTheOrderOfCorners) {
    constexpr int kDim = TypeParam::value;
    std::mt19937 random(3);
    const auto shuffle = [&](auto& simplices) {
        for (auto simplex : simplices.colwise()) {
            std::shuffle(simplex.begin(), simplex.end(), random);
        }
    };
    ContactFinder<kDim> finder(this->cubes_.model());
    test::TwoCubes<kDim> shuffled = this->cubes_;
    for (Surface<kDim>& surface : shuffled.scene.surfaces) {
        for (auto facet : surface.facets.colwise()) {
            std::rotate(facet.begin(), facet.begin() + random() % 3, facet.begin() + 3);
        }
        shuffle(surface.edges);
        shuffle(surface.ridges);
    }
    ContactFinder<kDim> other(shuffled.model());
    for (const double push : {0.0, 0.03, 0.05}) {
        const auto x = this->cubes_.pushed(push);
        const Contacts<kDim> contacts = finder.find(x, test::kBarrierStiffness);
        const Contacts<kDim> again = other.find(x, test::kBarrierStiffness);
        EXPECT_GT(contacts.list.size(), 20U);
        ASSERT_EQ(contacts.list.size(), again.list.size());
        std::set<std::vector<std::uint32_t>> faces;
        for (std::size_t i = 0; i < contacts.list.size(); ++i) {
            const Contact<kDim>& one = contacts.list[i];
            std::vector<std::uint32_t> vertices(one.vertices.begin(),
                                                one.vertices.begin() + one.corner_count);
            if (!one.mollifier.is_on()) {
                EXPECT_EQ(one.vertices, again.list[i].vertices);
                EXPECT_EQ(one.multiplicity, again.list[i].multiplicity);
                EXPECT_NEAR(one.distance, again.list[i].distance, 1e-12);
                std::sort(vertices.begin(), vertices.end());
                EXPECT_TRUE(faces.insert(vertices).second);
            }
        }
        EXPECT_NEAR(contacts.body_energy, again.body_energy, 1e-12 * contacts.body_energy);
    }
}

TYPED_TEST(BarrierContactsTest, LeaveFixedVerticesAlone) {
    constexpr int kDim = TypeParam::value;
    ContactScene<kDim> model = this->cubes_.model(this->obstacles_below());
    model.is_fixed.assign(model.is_fixed.size(), true);
    EXPECT_TRUE(ContactFinder<kDim>(model).find(this->cubes_.scene.positions, 1).list.empty());
}

TYPED_TEST(BarrierContactsTest, WithObstaclesAreNoneOfBodiesThatAreMovedFromOutside) {
    constexpr int kDim = TypeParam::value;
    for (const bool is_kinematic : {false, true}) {
        ContactScene<kDim> model = this->cubes_.model(this->obstacles_below());
        model.bodies[0].is_kinematic = is_kinematic;  // the other one is far from them
        model.bodies[1].is_kinematic = true;
        EXPECT_EQ(
            ContactFinder<kDim>(model).find(this->cubes_.scene.positions, 1).report.obstacle == 0,
            is_kinematic);
    }
}

}  // namespace
}  // namespace pent::contact
