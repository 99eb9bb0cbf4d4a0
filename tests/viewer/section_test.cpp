#include "runs.h"
#include "survey.h"

#include <pent/error.h>
#include <pent/viewer/section.h>
#include <pent/viewer/slice.h>

#include <gtest/gtest.h>

#include <limits>
#include <numbers>
#include <string>
#include <support/messages.h>
#include <vector>

namespace pent::viewer {
namespace {

using pent::test::error_of;
using pent::test::expect_contains;

TEST(MakeSections, GoesThroughTheMiddleUnlessTold) {
    const SimplexMesh<4> mesh = pent::test::kuhn_box<4>({1, 1, 1, 1}, {1, 1, 1, 3});
    Frame<4> frame;
    frame.positions = mesh.positions;
    const std::vector<Section> sections = make_sections<4>({}, std::span(&frame, 1));
    ASSERT_EQ(sections.size(), 1U);
    EXPECT_EQ(sections[0].plane.offset, 1.5);
    EXPECT_EQ(sections[0].label, "w = 1.5");
}

TEST(MakeSections, LetsTheLastRotationTakeSeveralAngles) {
    Frame<4> frame;
    frame.positions = Positions<4>::Identity(4, 4);
    SectionOptions options;
    options.offsets = {0.1, 0.2};
    options.rotations = {{1, 2, 0.3}, {0, 3, 0}};
    options.last_angles = {0.4, 0.5};
    const std::vector<Section> sections = make_sections<4>(options, std::span(&frame, 1));
    ASSERT_EQ(sections.size(), 4U);
    const PlaneRotation turns[] = {{1, 2, 0.3}, {0, 3, 0.5}};
    EXPECT_EQ(sections[3].plane.frame, rotation_matrix(turns));
    EXPECT_EQ(sections[3].plane.offset, 0.2);
}

TEST(MakeSections, NamesAHyperplaneByItsUnitNormal) {
    Frame<4> frame;
    frame.positions = Positions<4>::Identity(4, 4);
    SectionOptions options;
    options.normal = Eigen::Vector4d(0, 3, 0, 4);
    options.offsets = {0.5};
    EXPECT_EQ(make_sections<4>(options, std::span(&frame, 1))[0].label,
              "(0, 0.6, 0, 0.8) . p = 0.5");
}

// Rows of a contact sheet have nothing else to be told apart by.
TEST(MakeSections, NamesThemWithAsManyDigitsAsTellThemApart) {
    Frame<4> frame;
    frame.positions = Positions<4>::Identity(4, 4);
    const auto labels = [&](const std::vector<double>& offsets) {
        SectionOptions options;
        options.offsets = offsets;
        std::vector<std::string> all;
        for (const Section& section : make_sections<4>(options, std::span(&frame, 1))) {
            all.push_back(section.label);
        }
        return all;
    };
    using Labels = std::vector<std::string>;
    EXPECT_EQ(labels({0.123456, 0.2}), (Labels{"w = 0.1235", "w = 0.2"}));
    EXPECT_EQ(labels({0.123456, 0.2, 0.123461}),
              (Labels{"w = 0.123456", "w = 0.2", "w = 0.123461"}));
    EXPECT_EQ(labels({0.1, 0.3, 0.1}), (Labels{"w = 0.1", "w = 0.3", "w = 0.1"}));
}

TEST(SpanLabel, TellsOffsetsAndAnglesFromTheFirstToTheLast) {
    SectionOptions options;
    EXPECT_EQ(span_label(options), "");
    options.offsets = {-0.1, 0, 0.3};
    EXPECT_EQ(span_label(options), "-0.1 to 0.3");
    options.rotations = {{1, 2, 0.3}, {0, 3, 0}};
    options.last_angles = {0, std::numbers::pi / 2};
    EXPECT_EQ(span_label(options), "-0.1 to 0.3, xw 0 to 90");
    options.offsets = {0};
    EXPECT_EQ(span_label(options), "xw 0 to 90");
}

TEST(Survey, TakesTheRoundingOfAQuantityThatIsTheSameEverywhereForOneValue) {
    const SimplexMesh<4> mesh = test::jittered_box({2, 2, 2, 2}, 23);
    const Eigen::VectorXd w = mesh.positions.row(3).transpose();
    for (const double offset : {0.0, 0.1, 0.7}) {
        Survey survey;
        for (const double turn : {0.0, 0.1}) {  // two bodies, which round in other ways
            const Positions<4> positions = test::twisted(mesh.positions, turn);
            const Surface surface =
                slice(make_boundary(mesh, "box"), positions, hyperplane_at(offset));
            survey.add(surface, positions.row(3).transpose(), ColorBy::W);
        }
        const ColorRange range = survey.range();
        EXPECT_EQ(range.low, range.high);
        EXPECT_NEAR(range.low, offset, 1e-15);
    }
}

// What is left of the solver's single precision in a body that falls freely; stiff ones are
// strained by not much more.
TEST(Survey, TakesStrainsOfLessThanARoundingOfSinglePrecisionForNone) {
    const SimplexMesh<4> mesh = test::jittered_box({1, 1, 1, 1}, 23);
    const Surface surface = slice(make_boundary(mesh, "box"), mesh.positions, hyperplane_at(0.5));
    const auto range_of = [&](double strain) {
        Survey survey;
        survey.add(surface, Eigen::VectorXd::Constant(mesh.vertex_count(), strain),
                   ColorBy::Strain);
        return survey.range();
    };
    EXPECT_EQ(range_of(1e-7).high, 0);
    EXPECT_NEAR(range_of(2e-7).high, 2e-7, 1e-20);
}

TEST(MakeSections, RefusesWhatContradictsItself) {
    const Frame<4> frame;
    SectionOptions both;
    both.normal = Eigen::Vector4d(1, 0, 0, 0);
    both.rotations = {{0, 3, 1}};
    EXPECT_THROW((void)make_sections<4>(both, std::span(&frame, 1)), Error);
    SectionOptions endless;
    endless.offsets = {0, std::numeric_limits<double>::infinity()};
    expect_contains(error_of([&] { (void)make_sections<4>(endless, std::span(&frame, 1)); }),
                    {"an offset that is not finite"});
    SectionOptions angles;
    angles.last_angles = {1, 2};
    expect_contains(error_of([&] { (void)make_sections<4>(angles, std::span(&frame, 1)); }),
                    {"angles without a rotation"});
    const Frame<3> flat;
    SectionOptions offset;
    offset.offsets = {0.5};
    EXPECT_THROW((void)make_sections<3>(offset, std::span(&flat, 1)), Error);
}

}  // namespace
}  // namespace pent::viewer
