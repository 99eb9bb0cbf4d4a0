#include "penalty_scenes.h"
#include "support/host_tasks.h"
#include "support/messages.h"
#include "two_cubes.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <tuple>

namespace pent::contact {
namespace {

using test::contacts_of;
using test::forces_of;
using test::kEps;
using test::kOptions;
using test::kStiffness;

// Everything of two results, to the bit.
template <int Dim>
void expect_identical(const Contacts<Dim>& a, const Contacts<Dim>& b) {
    ASSERT_EQ(a.list.size(), b.list.size());
    EXPECT_EQ(a.body_energy, b.body_energy);
    for (std::size_t i = 0; i < a.list.size(); ++i) {
        EXPECT_EQ(a.list[i].vertices, b.list[i].vertices);
        EXPECT_EQ(a.list[i].weights, b.list[i].weights);
        EXPECT_EQ(a.list[i].distance, b.list[i].distance);
        EXPECT_EQ(a.list[i].direction, b.list[i].direction);
        EXPECT_EQ(a.list[i].energy, b.list[i].energy);
        EXPECT_EQ(a.list[i].slope, b.list[i].slope);
        EXPECT_EQ(a.list[i].kind, b.list[i].kind);
    }
}

template <typename T>
class ContactFinderTest : public testing::Test {
protected:
    static constexpr int kD = T::value;

    // A box, and a tilted one above it, whose lowest corner is at a height of `gap`.
    static test::Scene<kD> corner_over_box(double gap) {
        test::Scene<kD> scene;
        const SimplexMesh<kD> box = test::cube<kD>(2);
        SimplexMesh<kD> tilted = test::cube<kD>(1);
        tilted.positions = test::tilt<kD>() * tilted.positions;
        Eigen::Index lowest = 0;
        tilted.positions.row(1).minCoeff(&lowest);
        Vector<kD> offset = Vector<kD>::LinSpaced(0.9, 1.07);
        offset[1] = 2 + gap;
        offset -= tilted.positions.col(lowest);
        scene.add(box, Vector<kD>::Zero());
        scene.add(tilted, offset);
        return scene;
    }

    // Two boxes face to face, with shaken vertices, at a distance of about `gap`.
    //
    // @param turn  Of the upper one within the plane of the faces, rad.
    static test::Scene<kD> face_to_face(double gap, double shaken = 0.03, double turn = 0) {
        test::Scene<kD> scene;
        scene.add(test::cube<kD>(kD == 3 ? 3 : 2), Vector<kD>::Zero());
        Vector<kD> offset = Vector<kD>::LinSpaced(0.31, 0.44);
        offset[1] = (kD == 3 ? 3 : 2) + gap;
        SimplexMesh<kD> upper = test::cube<kD>(kD == 3 ? 3 : 2);
        for (int axis = 2; axis < kD; ++axis) {
            Eigen::Matrix<double, kD, kD> rotation = Eigen::Matrix<double, kD, kD>::Identity();
            rotation(0, 0) = rotation(axis, axis) = std::cos(turn);
            rotation(axis, 0) = std::sin(turn);
            rotation(0, axis) = -std::sin(turn);
            upper.positions = rotation * upper.positions;
        }
        scene.add(upper, offset);
        test::shake<kD>(scene.positions, shaken, 3);
        return scene;
    }
};

using Dimensions = testing::Types<std::integral_constant<int, 3>, std::integral_constant<int, 4>>;
TYPED_TEST_SUITE(ContactFinderTest, Dimensions);

TYPED_TEST(ContactFinderTest, AreNoneApart) {
    constexpr int kDim = TypeParam::value;
    const Contacts<kDim> contacts = contacts_of(TestFixture::face_to_face(0.5));
    EXPECT_TRUE(contacts.list.empty());
    EXPECT_EQ(contacts.body_energy, 0);
    EXPECT_EQ(contacts.report.deepest, 0);
}

TYPED_TEST(ContactFinderTest, OfACornerOverAFaceIsTheHandWorkedOne) {
    constexpr int kDim = TypeParam::value;
    for (const double gap : {0.15, 0.05, 1e-12, 0.0, -1e-12, -0.1, -0.5}) {
        const test::Scene<kDim> scene = TestFixture::corner_over_box(gap);
        const Contacts<kDim> contacts = contacts_of(scene);
        const Contact<kDim>* deepest = nullptr;
        for (const Contact<kDim>& contact : contacts.list) {
            if (contact.kind == ContactKind::PointFacet && contact.first.index == 1
                && (deepest == nullptr || contact.distance < deepest->distance)) {
                deepest = &contact;
            }
        }
        ASSERT_NE(deepest, nullptr);
        EXPECT_NEAR(deepest->distance, gap, 1e-14);
        EXPECT_NEAR(deepest->energy, 1000 * (gap - kEps) * (gap - kEps), 1e-11);
        const Vector<kDim> expected = 2000 * (kEps - gap) * Vector<kDim>::UnitY();
        EXPECT_LT((deepest->force(0) - expected).norm(), 1e-10);
        EXPECT_NEAR(deepest->weights.sum(), 0, 1e-15);
        EXPECT_NEAR(contacts.report.deepest, std::max(0.0, -gap), 1e-14);
    }
}

TYPED_TEST(ContactFinderTest, ReportsWhatItsListHas) {
    constexpr int kDim = TypeParam::value;
    for (const ContactModel kind : {ContactModel::Penalty, ContactModel::Barrier}) {
        test::TwoCubes<kDim> cubes;
        cubes.options.model = kind;
        ContactFinder<kDim> finder(cubes.model({HalfSpace<kDim>{Vector<kDim>::Unit(1), -0.05}}));
        const Contacts<kDim> contacts = finder.find(cubes.scene.positions, kStiffness);
        ContactReport expected;
        for (const Contact<kDim>& contact : contacts.list) {
            if (contact.second.is_obstacle()) {
                ++expected.obstacle;
            } else {
                const bool is_point =
                    contact.first_count == 1 || contact.corner_count == contact.first_count + 1;
                if (kind == ContactModel::Barrier) {
                    EXPECT_EQ(contact.kind,
                              is_point ? ContactKind::PointFacet : ContactKind::Mixed);
                }
                ++(contact.kind == ContactKind::PointFacet ? expected.point_facet : expected.mixed);
            }
            expected.smallest_distance = std::min(expected.smallest_distance, contact.distance);
        }
        EXPECT_EQ(contacts.report.obstacle, expected.obstacle);
        EXPECT_EQ(contacts.report.point_facet, expected.point_facet);
        EXPECT_EQ(contacts.report.mixed, expected.mixed);
        EXPECT_EQ(contacts.report.smallest_distance, expected.smallest_distance);
        EXPECT_GT(expected.obstacle, 0);
        EXPECT_GT(expected.point_facet, 0);
        EXPECT_GT(expected.mixed, 0);
    }
}

// Powers of two change no digit: whatever is compared has the same units on both sides.
TYPED_TEST(ContactFinderTest, FindsTheSameInASceneOfAnySize) {
    constexpr int kDim = TypeParam::value;
    for (const ContactModel kind : {ContactModel::Penalty, ContactModel::Barrier}) {
        const auto at = [&](double scale) {
            test::TwoCubes<kDim> cubes;
            cubes.options.model = kind;
            cubes.options.distance *= scale;
            cubes.options.separation *= scale;
            cubes.rest *= scale;
            cubes.scene.positions *= scale;
            ContactFinder<kDim> finder(
                cubes.model({HalfSpace<kDim>{Vector<kDim>::Unit(1), -0.05 * scale},
                             Ball<kDim>{cubes.below(0.3) * scale, 0.2 * scale}}));
            return finder.find(cubes.scene.positions, kStiffness);
        };
        const Contacts<kDim> one = at(1);
        EXPECT_GT(one.list.size(), 10U);
        for (const double scale : {0x1p-7, 0x1p7}) {
            const Contacts<kDim> other = at(scale);
            ASSERT_EQ(other.list.size(), one.list.size());
            for (std::size_t i = 0; i < one.list.size(); ++i) {
                const Contact<kDim>& a = one.list[i];
                const Contact<kDim>& b = other.list[i];
                EXPECT_EQ(b.vertices, a.vertices);
                EXPECT_EQ(b.weights, a.weights);
                EXPECT_EQ(b.direction, a.direction);
                EXPECT_EQ(b.kind, a.kind);
                EXPECT_EQ(b.distance, scale * a.distance);
                EXPECT_EQ(b.slope, scale * a.slope);
                EXPECT_EQ(b.energy, scale * scale * a.energy);
            }
        }
    }
}

// A plane has no facets that are met on the way: where it is then is what counts.
TYPED_TEST(ContactFinderTest, OfABarrierHoldsAPlaneThatWouldReachAVertex) {
    constexpr int kDim = TypeParam::value;
    test::TwoCubes<kDim> cubes;
    const Vector<kDim> up = Vector<kDim>::Unit(1);
    const std::vector<ObstacleShape<kDim>> start = {HalfSpace<kDim>{up, -0.5}};
    const Positions<kDim>& x = cubes.scene.positions;
    const double low = x.row(1).minCoeff();
    for (const ContactModel kind : {ContactModel::Penalty, ContactModel::Barrier}) {
        cubes.options.model = kind;
        ContactFinder<kDim> finder(cubes.model(start));
        for (const double gap : {0.011, 0.009, -0.1}) {  // the separation is 0.01
            finder.move_obstacles({HalfSpace<kDim>{up, low - gap}});
            const StepLimit limit = finder.limit_obstacles(start, x);
            const bool is_held = kind == ContactModel::Barrier && gap < 0.01;
            EXPECT_EQ(limit.fraction, is_held ? 0 : 1);
            if (is_held) {
                EXPECT_EQ(limit.limiting.second, (Collider{Collider::Kind::Obstacle, 0}));
                EXPECT_EQ(limit.limiting.kind, CrossingKind::Inside);
            }
        }
    }
}

TYPED_TEST(ContactFinderTest, PushBodiesApartWithoutNetForceOrTorque) {
    constexpr int kDim = TypeParam::value;
    for (const double gap : {0.15, 0.05, -0.02, -0.25}) {
        const test::Scene<kDim> scene = TestFixture::face_to_face(gap);
        const Contacts<kDim> contacts = contacts_of(scene);
        ASSERT_FALSE(contacts.list.empty());
        const Positions<kDim> forces = forces_of(contacts, scene.positions.cols());
        const double size = forces.cwiseAbs().sum();
        EXPECT_LT(forces.rowwise().sum().norm(), 1e-14 * size);
        const Eigen::Matrix<double, kDim, kDim> moment = forces * scene.positions.transpose();
        EXPECT_LT((moment - moment.transpose()).norm(), 1e-10 * size);
        const Vector<kDim> on_upper =
            forces.rightCols(scene.begin[2] - scene.begin[1]).rowwise().sum();
        EXPECT_GT(on_upper[1], 0.9 * on_upper.norm());
    }
}

// By distance alone: at the closest points the weights do not change the distance to first order,
// so that forces with the weights held are exact derivatives of the energy.
TYPED_TEST(ContactFinderTest, ForcesOfVerticesAndFacetsAreDerivativesOfTheirEnergy) {
    constexpr int kDim = TypeParam::value;
    for (const double gap : {0.05, -0.3}) {
        test::Scene<kDim> scene = TestFixture::face_to_face(gap);
        ContactFinder<kDim> finder(test::contact_scene<kDim>(scene, kOptions));
        const auto energy = [&](const Positions<kDim>& positions) {
            double sum = 0;
            for (const Contact<kDim>& contact : finder.find(positions, kStiffness).list) {
                sum += contact.kind == ContactKind::PointFacet ? contact.energy : 0;
            }
            return sum;
        };
        Positions<kDim> gradient = Positions<kDim>::Zero(kDim, scene.positions.cols());
        for (const Contact<kDim>& contact : finder.find(scene.positions, kStiffness).list) {
            for (int i = 0; contact.kind == ContactKind::PointFacet && i <= kDim; ++i) {
                gradient.col(contact.vertices[i]) -= contact.force(i);
            }
        }
        for (unsigned trial = 0; trial < 6; ++trial) {
            Positions<kDim> step = Positions<kDim>::Zero(kDim, scene.positions.cols());
            test::shake<kDim>(step, 1, 40 + trial);
            if (trial == 0) {
                step = gradient / gradient.cwiseAbs().maxCoeff();
            }
            const double h = 1e-6;
            const double slope =
                (energy(scene.positions + h * step) - energy(scene.positions - h * step)) / (2 * h);
            // Contacts that begin within a step of 1e-6 m add k h^2; truncation is of that order
            // too.
            EXPECT_NEAR(slope, gradient.cwiseProduct(step).sum(), 1e-5 * gradient.norm());
        }
    }
}

TYPED_TEST(ContactFinderTest, FinderFindsTheSameWhereItIsMovedTo) {
    constexpr int kDim = TypeParam::value;
    const test::Scene<kDim> scene = TestFixture::face_to_face(0.05);
    ContactFinder<kDim> made(test::contact_scene<kDim>(scene, kOptions));
    ContactFinder<kDim> moved = std::move(made);
    expect_identical(moved.find(scene.positions, kStiffness), contacts_of(scene));
    ContactOptions wide = kOptions;
    wide.distance *= 2;
    ContactFinder<kDim> assigned(test::contact_scene<kDim>(scene, wide));
    assigned = std::move(moved);
    expect_identical(assigned.find(scene.positions, kStiffness), contacts_of(scene));
}

// The share of a mixed pair changes where faces slide along each other, and with it the energy; as
// it is held, no pair within two flat faces pushes along them, whichever way its edges run.
TYPED_TEST(ContactFinderTest, DoNotDependOnWhichBodyComesFirst) {
    constexpr int kDim = TypeParam::value;
    constexpr int kFace = kDim == 3 ? 3 : 2;
    for (const auto& [scene, lower, upper] :
         {std::tuple(TestFixture::face_to_face(-0.05), kFace, kFace),
          std::tuple(TestFixture::corner_over_box(-0.1), 2, 1)}) {
        test::Scene<kDim> given = scene;
        test::Scene<kDim> exchanged;
        exchanged.add(test::cube<kDim>(upper), Vector<kDim>::Zero());
        exchanged.add(test::cube<kDim>(lower), Vector<kDim>::Zero());
        exchanged.body(0) = given.body(1);
        exchanged.body(1) = given.body(0);
        const Contacts<kDim> first = contacts_of(given);
        const Contacts<kDim> second = contacts_of(exchanged);
        ASSERT_GT(first.body_energy, 0);
        EXPECT_EQ(first.list.size(), second.list.size());
        // Sums have another order.
        EXPECT_NEAR(first.body_energy, second.body_energy, 1e-12 * first.body_energy);
        const Positions<kDim> forces = forces_of<kDim>(first, given.positions.cols());
        const Positions<kDim> others = forces_of<kDim>(second, given.positions.cols());
        const Eigen::Index count = given.begin[1];
        EXPECT_LT((forces.leftCols(count) - others.rightCols(count)).norm(), 1e-12 * forces.norm());
        EXPECT_LT((forces.rightCols(forces.cols() - count) - others.leftCols(forces.cols() - count))
                      .norm(),
                  1e-12 * forces.norm());
    }
}

TYPED_TEST(ContactFinderTest, FlatFacesPushAlongTheirNormalAlone) {
    constexpr int kDim = TypeParam::value;
    constexpr double kGap = 0.05;
    for (const double turn : {0.0, 0.1, 0.3}) {
        const test::Scene<kDim> scene = TestFixture::face_to_face(kGap, 0, turn);
        const double top = scene.positions.row(1).head(scene.begin[1]).maxCoeff();
        int within = 0;
        for (const Contact<kDim>& contact : contacts_of(scene).list) {
            const bool is_within = std::all_of(
                contact.vertices.begin(), contact.vertices.end(), [&](std::uint32_t vertex) {
                    const double above = scene.positions(1, vertex) - top;
                    return above > -1e-12 && above < kGap + 1e-12;
                });
            if (contact.kind == ContactKind::Mixed && is_within) {
                ++within;
                for (int i = 0; i <= kDim; ++i) {
                    Vector<kDim> force = contact.force(i);
                    const double size = force.norm();
                    force[1] = 0;
                    EXPECT_LE(force.norm(), 1e-12 * size) << turn;
                }
            }
        }
        EXPECT_GT(within, 10) << turn;
    }
}

TYPED_TEST(ContactFinderTest, EnergyOfVerticesAndFacetsIsContinuousAtAnyDepth) {
    constexpr int kDim = TypeParam::value;
    test::Scene<kDim> scene = TestFixture::face_to_face(0.25);
    ContactFinder<kDim> finder(test::contact_scene<kDim>(scene, kOptions));
    double last = 0;
    const double step = 0.004;
    for (int i = 0; i < 200; ++i) {
        scene.body(1).row(1).array() -= step;
        const Contacts<kDim> contacts = finder.find(scene.positions, kStiffness);
        double energy = 0;
        double force = 0;
        for (const Contact<kDim>& contact : contacts.list) {
            if (contact.kind == ContactKind::PointFacet) {
                energy += contact.energy;
                force += std::abs(contact.slope);
            }
        }
        // The slope is at most the sum of all forces; contacts that begin in the step add k step^2.
        EXPECT_LE(std::abs(energy - last),
                  1.05 * force * step
                      + 1000 * step * step * static_cast<double>(contacts.list.size()) + 1e-9);
        last = energy;
    }
    EXPECT_GT(last, 0);
}

TYPED_TEST(ContactFinderTest, AreTheSameForAnyNumberOfThreads) {
    constexpr int kDim = TypeParam::value;
    const test::Scene<kDim> scene = TestFixture::face_to_face(0.02);
    Contacts<kDim> expected;
    for (const int threads : {1, 2, 3, 8}) {
        const Contacts<kDim> contacts =
            Workers(pent::test::host_tasks(threads)).run([&] { return contacts_of(scene); });
        if (threads == 1) {
            expected = contacts;
        }
        expect_identical(contacts, expected);
    }
    EXPECT_GT(expected.report.point_facet, 0);
    EXPECT_GT(expected.report.mixed, 0);
}

TYPED_TEST(ContactFinderTest, DoNotDependOnEarlierCallsNorOnTheMargin) {
    constexpr int kDim = TypeParam::value;
    for (const bool self : {false, true}) {
        ContactOptions options = kOptions;
        options.self = self;
        test::Scene<kDim> scene = TestFixture::face_to_face(0.1);
        const ContactScene<kDim> model = test::contact_scene<kDim>(scene, options);
        ContactScene<kDim> with_margin = model;
        with_margin.options.margin = 0.05;
        ContactFinder<kDim> used(model);
        ContactFinder<kDim> keeping(with_margin);
        for (unsigned i = 0; i < 12; ++i) {
            test::shake<kDim>(scene.positions, i == 7 ? 0.3 : 0.015, 60 + i);
            scene.body(1).row(1).array() -= 0.02;
            scene.positions.row(0).array() +=
                1;  // all fly: only how they move against each other counts
            ContactFinder<kDim> fresh(model);
            const Contacts<kDim> expected = fresh.find(scene.positions, kStiffness);
            expect_identical(used.find(scene.positions, kStiffness), expected);
            expect_identical(keeping.find(scene.positions, kStiffness), expected);
            EXPECT_FALSE(expected.list.empty());
        }
    }
}

TYPED_TEST(ContactFinderTest, AreNoneBetweenKinematicBodies) {
    constexpr int kDim = TypeParam::value;
    const test::Scene<kDim> scene = TestFixture::face_to_face(0.02);
    ContactScene<kDim> model = test::contact_scene<kDim>(scene, kOptions);
    model.bodies[0].is_kinematic = true;
    EXPECT_FALSE(ContactFinder<kDim>(model).find(scene.positions, kStiffness).list.empty());
    model.bodies[1].is_kinematic = true;
    EXPECT_TRUE(ContactFinder<kDim>(model).find(scene.positions, kStiffness).list.empty());
}

TYPED_TEST(ContactFinderTest, TwoRigidBoxesThrownAtEachOtherSeparateAgain) {
    constexpr int kDim = TypeParam::value;
    test::Scene<kDim> scene = TestFixture::face_to_face(0.3);
    ContactFinder<kDim> finder(test::contact_scene<kDim>(scene, kOptions));
    // Each of 1000 kg, moving as a whole; symplectic Euler with 30 steps in contact.
    Eigen::Matrix<double, kDim, 2> velocity = Eigen::Matrix<double, kDim, 2>::Zero();
    velocity(1, 0) = 0.5;
    velocity(1, 1) = -0.5;
    const double dt = 0.01;
    double deepest = 0;
    bool have_met = false;
    for (int step = 0; step < 250; ++step) {
        const Contacts<kDim> contacts = finder.find(scene.positions, kStiffness);
        const Positions<kDim> forces = forces_of(contacts, scene.positions.cols());
        have_met = have_met || !contacts.list.empty();
        deepest = std::max(deepest, contacts.report.deepest);
        for (int body = 0; body < 2; ++body) {
            const Vector<kDim> force =
                forces.middleCols(scene.begin[body], scene.begin[body + 1] - scene.begin[body])
                    .rowwise()
                    .sum();
            velocity.col(body) += dt * force / 1000;
            scene.body(body).colwise() += dt * velocity.col(body);
        }
    }
    EXPECT_TRUE(have_met);
    EXPECT_LT(deepest, kEps);
    EXPECT_LT(velocity(1, 0), -0.3);
    EXPECT_GT(velocity(1, 1), 0.3);
    EXPECT_LT((velocity.col(0) + velocity.col(1)).norm(), 1e-12);  // momentum
    EXPECT_TRUE(finder.find(scene.positions, kStiffness).list.empty());
}

TYPED_TEST(ContactFinderTest, NothingThatFallsIntoTheBowlEverLeavesIt) {
    constexpr int kDim = TypeParam::value;
    const Vector<kDim> up = Vector<kDim>::UnitY();
    const Bowl<kDim> bowl{Vector<kDim>::Zero(), 2, up};
    Positions<kDim> x(kDim, 40);
    x.setZero();
    test::shake<kDim>(x, 1, 8);
    Positions<kDim> velocity = Positions<kDim>::Zero(kDim, x.cols());
    ContactFinder<kDim> finder(
        ContactScene<kDim>{.options = {.distance = 1},
                           .bodies = {},
                           .obstacles = {{bowl, 0.05, 5e4}},
                           .is_fixed = std::vector<bool>(static_cast<std::size_t>(x.cols())),
                           .rest = x});
    // Points of 1 kg; drag damps the slowest swinging by exp(-1.5 t); the stiffest mode has a
    // period of 20 steps.
    const double dt = 1e-3;
    for (int step = 0; step < 15000; ++step) {
        Positions<kDim> force = -3 * velocity;
        force.row(1).array() -= 9.8;
        force += forces_of<kDim>(finder.find(x, 1), x.cols());
        velocity += dt * force;
        x += dt * velocity;
        ASSERT_LT(x.colwise().norm().maxCoeff(), 2 + 0.01);
    }
    // At rest at the bottom, where the force of the bowl is the weight.
    const double rest = 0.05 - 9.8 / (2 * 5e4);
    for (Eigen::Index i = 0; i < x.cols(); ++i) {
        EXPECT_NEAR(signed_distance<kDim>(bowl, x.col(i)).value, rest, 1e-6);
        EXPECT_LT(velocity.col(i).norm(), 1e-6);
    }
}

TYPED_TEST(ContactFinderTest, WarnsWhereTheDistanceIsNearTheEdgeLength) {
    constexpr int kDim = TypeParam::value;
    const test::Scene<kDim> scene = TestFixture::face_to_face(0.5);
    ContactOptions options = kOptions;
    EXPECT_TRUE(ContactFinder<kDim>(test::contact_scene<kDim>(scene, options)).warnings().empty());
    options.distance = 0.8;
    const auto warnings = ContactFinder<kDim>(test::contact_scene<kDim>(scene, options)).warnings();
    ASSERT_EQ(warnings.size(), 2U);
    pent::test::expect_contains(warnings[1], {"distance 0.8 m", "'b'", "a quarter"});
}

TYPED_TEST(ContactFinderTest, WithOptionsOutOfRangeAreRefused) {
    constexpr int kDim = TypeParam::value;
    const double nan = std::numeric_limits<double>::quiet_NaN();
    const auto message = [&](const ContactOptions& options) {
        return pent::test::error_of(
            [&] { ContactFinder<kDim>(test::contact_scene<kDim>(test::Scene<kDim>(), options)); });
    };
    pent::test::expect_contains(message({.distance = 0}), {"distance", "above 0"});
    pent::test::expect_contains(message({.distance = nan}), {"distance", "above 0"});
    pent::test::expect_contains(message({.distance = 1, .separation = -1}), {"separation", "-1"});
    pent::test::expect_contains(message({.distance = 1, .margin = -1}), {"margin", "-1"});
    const std::string obstacle = pent::test::error_of([&] {
        ContactFinder<kDim>(test::contact_scene<kDim>(
            test::Scene<kDim>(), kOptions,
            {HalfSpace<kDim>{Vector<kDim>::UnitX(), 0}, Ball<kDim>{Vector<kDim>::Zero(), -1}}));
    });
    pent::test::expect_contains(obstacle, {"obstacle 2", "radius"});
}

TYPED_TEST(ContactFinderTest, OfASceneWithoutBodiesAreNone) {
    constexpr int kDim = TypeParam::value;
    const Positions<kDim> none(kDim, 0);
    EXPECT_TRUE(ContactFinder<kDim>(test::contact_scene<kDim>(test::Scene<kDim>(), kOptions))
                    .find(none, kStiffness)
                    .list.empty());
}

}  // namespace
}  // namespace pent::contact
