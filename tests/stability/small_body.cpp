#include "small_body.h"

#include "support/cut_in_two.h"
#include "support/kuhn_box.h"

#include <algorithm>
#include <array>
#include <cmath>

namespace pent::stability {

namespace {

simulator::Body body_of(const Extreme& extreme, const std::string& name) {
    simulator::Body body;
    body.name = name;
    body.mesh = name + ".pent";
    body.place.translate = Eigen::Vector4d::Constant(0.5 * extreme.offset * extreme.size);
    body.material.lame = simulator::lame_from_young(4, extreme.young, extreme.poisson);
    body.material.density = extreme.density;
    return body;
}

}  // namespace

SimplexMesh<4> mesh_of(const Extreme& extreme) {
    const int cells = std::max(extreme.cells, 1);
    const int across = extreme.across;
    const double edge = extreme.size / cells;
    SimplexMesh<4> mesh = pent::test::kuhn_box<4>(
        {cells, across, across, across},
        {extreme.size, edge * across, edge * across, edge * across * extreme.aspect});
    if (extreme.cells == 0) {
        const Eigen::Matrix<std::uint32_t, 5, 1> first = mesh.cells.col(0);
        Positions<4> corners(4, 5);
        for (int k = 0; k < 5; ++k) {
            corners.col(k) = mesh.positions.col(first[k]);
        }
        mesh.positions = corners;
        mesh.cells.resize(5, 1);
        mesh.cells.col(0) << 0, 1, 2, 3, 4;
    }
    return extreme.elements == simulator::ElementKind::Quadratic ? pent::test::cut_in_two<4>(mesh)
                                                                 : mesh;
}

simulator::Scene scene_of(const Extreme& extreme, simulator::Precision precision) {
    simulator::Scene scene;
    scene.gravity = Eigen::Vector4d::Zero();
    scene.frames_per_second = 1 / extreme.dt;
    scene.bodies = {body_of(extreme, "body")};
    if (extreme.ratio != 1 || extreme.heaviness != 1) {
        Extreme other = extreme;
        other.young *= extreme.ratio;
        other.density *= extreme.heaviness;
        scene.bodies.push_back(body_of(other, "other"));
        scene.bodies.back().place.translate[1] += 3 * extreme.size;
    }
    scene.solver.elements = extreme.elements;
    scene.solver.precision = precision;
    scene.solver.tolerance = 1e-6;
    scene.solver.newton_tolerance = extreme.newton_tolerance;
    scene.solver.max_iterations = 20'000;
    return scene;
}

void hold_ends(simulator::Scene& scene,
               const Extreme& extreme,
               const std::vector<simulator::Spin>& spins) {
    for (const simulator::Body& body : scene.bodies) {
        simulator::HalfSpaceSelection end;
        end.normal = extreme.cells == 0 ? Eigen::Vector4d::UnitW() : Eigen::Vector4d::UnitX();
        end.offset = body.place.translate[0] + 0.01 * extreme.size * std::min(1.0, extreme.aspect);
        simulator::Motion motion;
        motion.translate = Eigen::Vector4d::Zero();
        motion.rotate = spins;
        motion.about = body.place.translate;
        scene.constraints.push_back({.body = body.name, .select = {end}, .motion = {motion}});
    }
}

bool is_finite(const simulator::Simulation<4>& simulation) {
    for (int body = 0; body < simulation.body_count(); ++body) {
        if (!simulation.positions(body).allFinite() || !simulation.velocities(body).allFinite()) {
            return false;
        }
    }
    return true;
}

Outcome step_all(simulator::Simulation<4>& simulation, int steps) {
    simulator::StepReport report;
    for (int i = 0; i < steps; ++i) {
        report = simulation.step();
        if (!is_finite(simulation)) {
            return {.kind = Outcome::Kind::Wrong, .error = NAN, .reason = {}};
        }
        if (!report.is_accepted || report.refused > 0) {
            return {
                .kind = Outcome::Kind::Reported,
                .error = 0,
                .reason = report.failure + (report.is_accepted ? ", in a step that was cut" : "")};
        }
    }
    if (report.inverted > 0) {
        return {.kind = Outcome::Kind::Reported,
                .error = 0,
                .reason = std::to_string(report.inverted) + " inverted cells"};
    }
    return {};
}

double bound(simulator::Precision precision) {
    // The turn ends where forces have fallen to 1e-6 of those of a turn by 10 degrees; the softest
    // mode of a slender, nearly incompressible bar is up to 1e3 times softer than the stiffest. The
    // fall has the tolerance of the linear solver, and with a float matrix its rounding, up to
    // 1e-3.
    return precision == simulator::Precision::Float ? 2e-3 : 1e-3;
}

Outcome judge(double error, simulator::Precision precision) {
    const bool is_right = std::isfinite(error) && error <= bound(precision);
    return {.kind = is_right ? Outcome::Kind::Right : Outcome::Kind::Wrong,
            .error = error,
            .reason = {}};
}

}  // namespace pent::stability
