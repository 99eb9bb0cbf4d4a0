#include <pent/error.h>
#include <pent/simplex_mesh.h>
#include <pent/simulator/simulation.h>
#include <pent/viewer/boundary.h>
#include <pent/viewer/slice.h>

#include <gtest/gtest.h>

#include <algorithm>
#include <support/kuhn_box.h>

// What must come out of the paper's scenes, on boxes of some thousand pentachora. The thresholds
// are those of scripts/paper_table.py, which checks the scenes themselves.

namespace pent::simulator {
namespace {

using pent::test::kuhn_box;
using viewer::Boundary;

Body elastic_body(const std::string& name, double young, double density) {
    Body body;
    body.name = name;
    body.mesh = name + ".pent";
    body.place.translate = Eigen::Vector4d::Zero();
    body.material.lame = lame_from_young(4, young, 0.28);
    body.material.density = density;
    return body;
}

Scene empty_scene() {
    Scene scene;
    scene.gravity = Eigen::Vector4d::Zero();
    scene.frames_per_second = 30;
    return scene;
}

HalfSpaceSelection end_along(int axis, double sign, double offset) {
    return {.normal = sign * Eigen::Vector4d::Unit(axis), .offset = offset};
}

double slice_volume(const Boundary<4>& boundary, const Positions<4>& positions, double offset) {
    return viewer::enclosed_volume(
        viewer::slice(boundary, positions, viewer::hyperplane_at(offset)));
}

double hypervolume(SimplexMesh<4> mesh, const Positions<4>& positions) {
    mesh.positions = positions;
    return total_volume(mesh);
}

void take_steps(Simulation<4>& simulation, int steps) {
    for (int i = 0; i < steps; ++i) {
        ASSERT_TRUE(simulation.step().is_accepted);
    }
}

// The two ends along w turn by 30 degrees each way. If all fibers along w stayed straight, the
// middle would be narrower by cos 30 along x and z, to 0.75 of its volume; a body that resists the
// change of volume is somewhere between that and its first state.
TEST(SmallTwist, CrushesTheMiddleSliceButNotTheBody) {
    Scene scene = empty_scene();
    scene.bodies = {elastic_body("box", 1e5, 1000)};
    for (const double sign : {-1.0, 1.0}) {
        Motion turn;
        turn.translate = Eigen::Vector4d::Zero();
        turn.rotate = {{{0, 2}, sign * 30}};
        turn.about = Eigen::Vector4d(1, 0.25, 1, 0);
        turn.to = 1;
        scene.constraints.push_back({.body = "box",
                                     .select = {end_along(3, sign, sign > 0 ? 1e-9 : -0.8 + 1e-9)},
                                     .motion = {turn}});
    }
    Simulation<4> simulation(scene, {kuhn_box<4>({5, 2, 5, 4}, {2, 0.5, 2, 0.8})});
    const SimplexMesh<4>& mesh = simulation.mesh(0);
    const Boundary<4> boundary = viewer::make_boundary<4>(mesh, "box");
    const double slice_before = slice_volume(boundary, mesh.positions, 0.4);
    take_steps(simulation, 45);
    const double slice_change =
        slice_volume(boundary, simulation.positions(0), 0.4) / slice_before - 1;
    const double body_change = hypervolume(mesh, simulation.positions(0)) / total_volume(mesh) - 1;
    EXPECT_LT(slice_change, -0.04);
    EXPECT_LT(std::abs(body_change), 0.05);
}

struct Sag {
    double tip = 0;     // m
    double edge = 0;    // lost of the slice next to the border, as a part of it
    double middle = 0;  // the same in the middle
};

Sag sag_of(double young) {
    Scene scene = empty_scene();
    scene.gravity[1] = -9.8;
    scene.bodies = {elastic_body("beam", young, 1000)};
    scene.constraints = {{.body = "beam", .select = {end_along(0, 1, 1e-9)}, .motion = {}}};
    scene.solver.integrator = Integrator::Quasistatic;
    Simulation<4> simulation(scene, {kuhn_box<4>({16, 3, 2, 2}, {4, 1, 1, 1})});
    const SimplexMesh<4>& mesh = simulation.mesh(0);
    const Boundary<4> boundary = viewer::make_boundary<4>(mesh, "beam");
    EXPECT_TRUE(simulation.step().is_accepted);
    const Positions<4> now = simulation.positions(0);
    const auto lost = [&](double offset) {
        return 1
               - slice_volume(boundary, now, offset)
                     / slice_volume(boundary, mesh.positions, offset);
    };
    return {.tip = (mesh.positions.row(1) - now.row(1)).maxCoeff(),
            .edge = lost(0.995),
            .middle = lost(0.5)};
}

// Where a beam is stretched by e it is narrower by nu e along w: the slice 0.005 from the border of
// a width of 1 is lost where e > 0.01 / nu = 3.6%, which bending reaches in both beams.
TEST(SmallCantilevers, SagLessWhenStifferAndPhaseOutNearTheBorderAlone) {
    const Sag soft = sag_of(1e6);
    const Sag stiff = sag_of(2e6);
    EXPECT_GT(soft.tip, stiff.tip);
    EXPECT_GT(stiff.tip,
              0.5 * 1.5 * 1000 * 9.8 * 256 / 2e6);  // of beam theory; locking takes the rest
    EXPECT_GT(soft.edge, stiff.edge);
    EXPECT_GT(stiff.edge, 0.012);
    for (const Sag& sag : {soft, stiff}) {
        EXPECT_LT(std::abs(sag.middle), std::max(0.01, sag.edge / 4));
    }
}

// Two boxes fly at each other, overlapping a little along w. They touch, push each other apart
// along w, and what the slice between them shows of both shrinks.
TEST(SmallHug, TouchesAndPhasesOutOfTheSlice) {
    Scene scene = empty_scene();
    scene.frames_per_second = 100;
    scene.bodies = {elastic_body("low", 1e5, 100), elastic_body("high", 1e5, 100)};
    scene.bodies[0].place.translate = Eigen::Vector4d(0, -1.1, 0, -0.9);
    scene.bodies[1].place.translate = Eigen::Vector4d(0, 1.1, 0, -0.1);
    scene.bodies[0].velocity = Eigen::Vector4d(0, 3, 0, 0);
    scene.bodies[1].velocity = Eigen::Vector4d(0, -3, 0, 0);
    scene.bodies[1].spin = {{{3, 2}, 30}};
    scene.contact = ContactSettings{.distance = 0.05, .stiffness = 3000};
    const SimplexMesh<4> box = kuhn_box<4>({2, 2, 2, 2}, {1, 1, 1, 1});
    Simulation<4> simulation(scene, {box, box});
    const Boundary<4> boundary = viewer::make_boundary<4>(box, "box");
    const auto common = [&] {
        return slice_volume(boundary, simulation.positions(0), 0)
               + slice_volume(boundary, simulation.positions(1), 0);
    };
    const double before = common();
    std::int64_t pairs = 0;
    for (int i = 0; i < 100; ++i) {
        const StepReport report = simulation.step();
        ASSERT_TRUE(report.is_accepted);
        pairs = std::max(pairs, report.contact.point_facet + report.contact.mixed);
    }
    EXPECT_GT(before, 1.9);
    EXPECT_GT(pairs, 0);
    EXPECT_LT(common(), 0.5 * before);
}

}  // namespace
}  // namespace pent::simulator
