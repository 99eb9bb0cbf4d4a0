#include "potentials/attachments.h"

#include "potential_laws.h"
#include "support/messages.h"

#include <pent/formatted.h>

#include <gtest/gtest.h>

// The springs of attachments as a function of positions; attachment_motion_test.cpp has them in
// motion.

namespace pent::simulator {
namespace {

using test::Dimensions;
using test::expect_derivatives;
using test::expect_invariance_under_rigid_motion;
using test::gradient_of;
using test::hessian_of;
using test::Setting;
using test::shaken;
using test::value_of;

template <typename T>
class AttachmentsTest : public testing::Test {};
TYPED_TEST_SUITE(AttachmentsTest, Dimensions);

// The lower side of b, which is above a.
template <int Dim>
Attachment side_of_b(RestOffset offset) {
    Attachment attachment;
    attachment.body = "b";
    attachment.select = {
        HalfSpaceSelection{.normal = Eigen::VectorXd::Unit(Dim, 1), .offset = 0.6}};
    attachment.target = "a";
    attachment.offset = offset;
    attachment.stiffness = 300;
    attachment.max_distance = 0.1;  // it overhangs by 0.04 m
    return attachment;
}

template <int Dim>
Scene tied_cubes(RestOffset offset) {
    Scene scene = test::two_cubes<Dim>(0.03);
    scene.contact.reset();
    scene.attachments = {side_of_b<Dim>(offset)};
    return scene;
}

TYPED_TEST(AttachmentsTest, HaveTheirDerivativesAndPushAndTurnNothing) {
    constexpr int kDim = TypeParam::value;
    for (const RestOffset offset : {RestOffset::Keep, RestOffset::Zero}) {
        const Setting<kDim> setting(tied_cubes<kDim>(offset), 2);
        Attachments<kDim> attachments(setting.workers, setting.scene, setting.bodies);
        const Positions<kDim> x = shaken<kDim>(setting.bodies.rest(), 0.05, 1);
        expect_derivatives<kDim>(setting, attachments, x);
        expect_invariance_under_rigid_motion<kDim>(attachments, x);
        EXPECT_GT(value_of<kDim>(attachments, x), 0);
    }
}

TYPED_TEST(AttachmentsTest, AreAtRestWhereTheirOffsetIsKeptHoweverTheTargetIsTurnedAndStretched) {
    constexpr int kDim = TypeParam::value;
    const Setting<kDim> setting(tied_cubes<kDim>(RestOffset::Keep), 2);
    Attachments<kDim> attachments(setting.workers, setting.scene, setting.bodies);
    EXPECT_LT(value_of<kDim>(attachments, setting.bodies.rest()), 1e-25);
    Matrix<kDim> any = test::any_rotation<kDim>();
    any.col(0) *= 1.7;
    // To rounding, squared: 300 N/m (1e-15 m)^2 a spring.
    EXPECT_LT(value_of<kDim>(attachments, any * setting.bodies.rest()), 1e-25);
}

TYPED_TEST(AttachmentsTest, ArePulledByTheWholeWayWithoutAnOffset) {
    constexpr int kDim = TypeParam::value;
    const Setting<kDim> setting(tied_cubes<kDim>(RestOffset::Zero), 2);
    Attachments<kDim> attachments(setting.workers, setting.scene, setting.bodies);
    // Every vertex of the side is 0.03 m above that of a or, where it overhangs by 0.04 m along
    // some axes, farther from its rim.
    const double energy = value_of<kDim>(attachments, setting.bodies.rest());
    double expected = 0;
    for (Eigen::Index v = setting.bodies.first_vertex[1]; v < setting.bodies.rest().cols(); ++v) {
        const Vector<kDim> p = setting.bodies.rest().col(v);
        if (p[1] < 0.6) {
            expected += 150 * (p - p.cwiseMin(0.5)).squaredNorm();
        }
    }
    EXPECT_NEAR(energy, expected, 1e-12 * expected);
    EXPECT_NEAR(attachments.summaries()[0].largest_force,
                300 * std::sqrt((kDim - 1) * 0.04 * 0.04 + 0.03 * 0.03), 1e-9);
}

// Springs of no length have no direction; their Hessian is what it is anywhere else.
TYPED_TEST(AttachmentsTest, HaveTheirDerivativesWhereSpringsHaveNoLength) {
    constexpr int kDim = TypeParam::value;
    for (const bool is_to_body : {false, true}) {
        Scene scene = tied_cubes<kDim>(RestOffset::Keep);
        if (!is_to_body) {
            scene.attachments[0].target.clear();
        }
        const Setting<kDim> setting(scene, 2);
        Attachments<kDim> attachments(setting.workers, setting.scene, setting.bodies);
        static_cast<void>(attachments.set_time({0, 0.01}));
        const Positions<kDim>& rest = setting.bodies.rest();
        // 300 N/m and some roundings of a meter, each.
        EXPECT_LT(gradient_of<kDim>(attachments, rest).norm(), 300 * 1e-14);
        const BlockPattern pattern = make_pattern<kDim>(setting.bodies.cells(), setting.dofs);
        EXPECT_EQ(hessian_of<kDim>(setting, pattern, attachments, rest),
                  hessian_of<kDim>(setting, pattern, attachments, shaken<kDim>(rest, 0.05, 5)));
        // One spring is stretched, the others are not.
        Positions<kDim> x = rest;
        x.col(setting.bodies.first_vertex[1]).array() += 0.03;
        EXPECT_GT(gradient_of<kDim>(attachments, x).norm(), 1);
        expect_derivatives<kDim>(setting, attachments, x);
    }
}

TYPED_TEST(AttachmentsTest, HaveTheirDerivativesWithDampingAtPointsThatMove) {
    constexpr int kDim = TypeParam::value;
    for (const bool is_to_body : {false, true}) {
        Scene scene = tied_cubes<kDim>(RestOffset::Keep);
        Attachment& attachment = scene.attachments[0];
        attachment.damping = 7;
        if (!is_to_body) {
            attachment.target.clear();
            attachment.motion = {test::still(kDim)};
            attachment.motion[0].translate[0] = 2;
            attachment.motion[0].rotate = {{.plane = {0, kDim - 1}, .degrees_per_s = 90}};
        }
        const Setting<kDim> setting(scene, 2);
        Attachments<kDim> attachments(setting.workers, scene, setting.bodies);
        const Positions<kDim> start = shaken<kDim>(setting.bodies.rest(), 0.05, 2);
        const Positions<kDim> origin = shaken<kDim>(start, 0.05, 3);
        EXPECT_EQ(attachments.set_time({0.5, 0.51}), !is_to_body);
        EXPECT_TRUE(attachments.begin_step({start, start, origin, 0 * start, 0.01, 150, false}));
        expect_derivatives<kDim>(setting, attachments, shaken<kDim>(start, 0.02, 4));
    }
}

// Where vertices go with the points that they are tied to, by the velocity that rate and origin
// say, nothing is damped.
TYPED_TEST(AttachmentsTest, DampWhatMovesOtherwiseThanThePointsThatItIsTiedTo) {
    constexpr int kDim = TypeParam::value;
    Scene scene = tied_cubes<kDim>(RestOffset::Keep);
    Attachment& attachment = scene.attachments[0];
    attachment.target.clear();
    attachment.damping = 7;
    attachment.motion = {test::still(kDim)};
    attachment.motion[0].translate[0] = 2;
    const Setting<kDim> setting(scene, 2);
    Attachments<kDim> attachments(setting.workers, scene, setting.bodies);
    static_cast<void>(attachments.set_time({0.5, 0.51}));
    const Positions<kDim> origin = setting.bodies.rest();
    const Positions<kDim> still = 0 * origin;
    static_cast<void>(attachments.begin_step({origin, still, origin, still, 0.01, 100, false}));
    Positions<kDim> along = origin;
    along.row(0).array() += 0.02;  // 2 m/s
    const double elastic = 0.5 * 300 * std::pow(1.02 - 0.02, 2);
    const auto springs = static_cast<double>(attachments.broken().size());
    EXPECT_NEAR(value_of<kDim>(attachments, along), springs * elastic, 1e-9 * springs * elastic);
    // At rest there is the damping of 2 m/s, 7/(2 100) 4 J, beside a stretch of 1.02 m.
    EXPECT_NEAR(value_of<kDim>(attachments, origin), springs * (150 * 1.02 * 1.02 + 0.14), 1e-9);
    EXPECT_FALSE(attachments.energies()[1].is_stored);
    EXPECT_NEAR(attachments.energies()[1].energy, springs * 0.14, 1e-9);
}

TYPED_TEST(AttachmentsTest, BreakWhereTheyPullTooHardAndNowhereElse) {
    constexpr int kDim = TypeParam::value;
    Scene scene = tied_cubes<kDim>(RestOffset::Zero);
    scene.attachments[0].break_force = 300 * 0.04;  // all that overhang pull harder
    scene.attachments[0].to = 50;
    const Setting<kDim> setting(scene, 2);
    Attachments<kDim> attachments(setting.workers, scene, setting.bodies);
    static_cast<void>(value_of<kDim>(attachments, setting.bodies.rest()));
    const AttachmentSummary before = attachments.summaries()[0];
    EXPECT_EQ(before.springs, std::int64_t(std::pow(3, kDim - 1)));
    const std::vector<std::size_t> freed = attachments.break_springs();
    static_cast<void>(value_of<kDim>(attachments, setting.bodies.rest()));
    const AttachmentSummary after = attachments.summaries()[0];
    EXPECT_EQ(after.springs, std::int64_t(std::pow(2, kDim - 1)));  // 2 of 3 do not overhang
    EXPECT_EQ(after.broken, before.springs - after.springs);
    EXPECT_NEAR(after.largest_force, 300 * 0.03, 1e-9);
    EXPECT_EQ(freed.size(), 2 * static_cast<std::size_t>(after.broken));
    EXPECT_TRUE(attachments.break_springs().empty());
    // What is broken couples nothing, nor does it wake when it goes.
    static_cast<void>(attachments.set_time({50, 50.01}));
    Couplings couplings;
    attachments.add_couplings(couplings);
    EXPECT_EQ(couplings.driven.size(), 2);
    attachments.set_broken(std::vector<std::uint8_t>(attachments.broken().size(), 1));
    Couplings none;
    attachments.add_couplings(none);
    EXPECT_TRUE(none.pairs.empty() && none.driven.empty());
}

TYPED_TEST(AttachmentsTest, AreThereInStepsThatBeginFromFromAndBeforeTo) {
    constexpr int kDim = TypeParam::value;
    for (const bool is_to_body : {false, true}) {
        Scene scene = tied_cubes<kDim>(RestOffset::Zero);
        scene.frames_per_second = 10;
        scene.attachments[0].max_distance = 1;
        scene.attachments[0].from = 0.3;
        scene.attachments[0].to = 0.6;
        if (!is_to_body) {
            scene.attachments[0].target.clear();
        }
        const Setting<kDim> setting(scene, 1);
        Attachments<kDim> attachments(setting.workers, scene, setting.bodies);
        const Positions<kDim> x = shaken<kDim>(setting.bodies.rest(), 0.05, 8);
        for (int step = 0; step < 10; ++step) {
            const bool is_there = step >= 3 && step < 6;
            const bool is_changing = step == 3 || step == 6;
            bool has_changed = is_changing;
            // However the times of steps are rounded.
            for (const double begin : {0.1 * step, std::nextafter(0.1 * step, 0.0)}) {
                EXPECT_EQ(attachments.set_time({begin, begin + 0.1}), has_changed) << step;
                EXPECT_EQ(value_of<kDim>(attachments, x) > 0, is_there) << step;
                Couplings couplings;
                attachments.add_couplings(couplings);
                EXPECT_EQ(couplings.pairs.size(), is_there && is_to_body ? 1U : 0U) << step;
                // What comes or goes wakes both.
                EXPECT_EQ(couplings.driven.size(), is_changing ? 2U : 0U) << step;
                has_changed = false;
            }
        }
    }
}

// 90 degrees about the middle of where they are, or with one point, which the motion then carries
// alone; and nothing is driven once the motion is over.
TYPED_TEST(AttachmentsTest, ToPointsInSpaceGoWithTheirMotion) {
    constexpr int kDim = TypeParam::value;
    const Vector<kDim> point = Vector<kDim>::LinSpaced(1, 2);
    Matrix<kDim> turn = Matrix<kDim>::Identity();
    turn(0, 0) = turn(kDim - 1, kDim - 1) = 0;
    turn(kDim - 1, 0) = 1;
    turn(0, kDim - 1) = -1;
    for (const RestOffset offset : {RestOffset::Keep, RestOffset::Zero}) {
        Scene scene = tied_cubes<kDim>(offset);
        scene.attachments.push_back(scene.attachments[0]);
        scene.attachments[0].from = 100;  // of the first there is nothing yet
        Attachment& attachment = scene.attachments[1];
        attachment.target.clear();
        attachment.motion = {test::still(kDim)};
        attachment.motion[0].translate[1] = 3;
        attachment.motion[0].rotate = {{.plane = {0, kDim - 1}, .degrees_per_s = 90}};
        attachment.motion[0].to = 1;
        if (offset == RestOffset::Zero) {
            attachment.point = point;
        }
        const Setting<kDim> setting(scene, 2);
        Attachments<kDim> attachments(setting.workers, scene, setting.bodies);
        std::vector<Vector<kDim>> tied;
        Vector<kDim> middle = Vector<kDim>::Zero();
        for (Eigen::Index v = setting.bodies.first_vertex[1]; v < setting.bodies.rest().cols();
             ++v) {
            if (setting.bodies.rest()(1, v) < 0.6) {
                tied.push_back(setting.bodies.rest().col(v));
                middle += tied.back() / std::pow(3, kDim - 1);
            }
        }
        double expected = 0;
        for (const Vector<kDim>& place : tied) {
            const Vector<kDim> anchor =
                offset == RestOffset::Zero ? point : Vector<kDim>(middle + turn * (place - middle));
            expected += 150 * (place - anchor - 3 * Vector<kDim>::Unit(1)).squaredNorm();
        }
        for (const double begin : {0.99, 5.0}) {
            static_cast<void>(attachments.set_time({begin, begin + 0.01}));
            EXPECT_NEAR(value_of<kDim>(attachments, setting.bodies.rest()), expected,
                        1e-12 * expected);
            Couplings couplings;
            attachments.add_couplings(couplings);
            EXPECT_EQ(couplings.driven.empty(), begin > 1);
        }
    }
}

// A step that is cut is one step all the same.
TYPED_TEST(AttachmentsTest, NeitherComeNorGoWithinAStep) {
    constexpr int kDim = TypeParam::value;
    Scene scene = tied_cubes<kDim>(RestOffset::Zero);
    scene.frames_per_second = 10;
    scene.attachments[0].max_distance = 1;
    scene.attachments[0].from = 0.25;
    scene.attachments[0].to = 0.55;
    const Setting<kDim> setting(scene, 1);
    Attachments<kDim> attachments(setting.workers, scene, setting.bodies);
    for (int part = 0; part < 40; ++part) {
        const int step = part / 4;
        static_cast<void>(attachments.set_time({0.025 * part, 0.025 * (part + 1)}));
        EXPECT_EQ(value_of<kDim>(attachments, setting.bodies.rest()) > 0, step >= 3 && step < 6)
            << part;
    }
}

TYPED_TEST(AttachmentsTest, RefuseWhatIsTooFarAwayAndSayHowFar) {
    constexpr int kDim = TypeParam::value;
    Scene scene = tied_cubes<kDim>(RestOffset::Keep);
    scene.attachments[0].select = {EverythingSelection{}};
    scene.attachments[0].max_distance = 0.2;
    scene.attachments[0].source = "scene.toml:9:1";
    const std::string far = formatted("%.4g m", std::sqrt((kDim - 1) * 0.04 * 0.04 + 0.53 * 0.53));
    const Setting<kDim> setting(scene, 2);
    pent::test::expect_contains(
        pent::test::error_of([&] { Attachments<kDim>(setting.workers, scene, setting.bodies); }),
        {"scene.toml:9:1: attachment of \"b\": vertex", far + " from \"a\"", "max_distance = 0.2 m",
         "raise it"});
}

TYPED_TEST(AttachmentsTest, RefuseToCarryAnOffsetOnAFlatCell) {
    constexpr int kDim = TypeParam::value;
    const Setting<kDim> setting(tied_cubes<kDim>(RestOffset::Keep), 2);
    Bodies<kDim> bodies = setting.bodies;
    auto height = bodies.joined_rest->row(1).head(bodies.first_vertex[1]).array();
    height = 0.5 - 1e-4 * (0.5 - height);
    pent::test::expect_contains(
        pent::test::error_of([&] { Attachments<kDim>(setting.workers, setting.scene, bodies); }),
        {"too flat", "offset = \"zero\""});
}

}  // namespace
}  // namespace pent::simulator
