#include "extremes.h"

#include "support/kuhn_box.h"

#include <pent/error.h>
#include <pent/simulator/simulation.h>

#include <Eigen/LU>

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <numbers>
#include <random>

namespace pent::stability {

namespace {

using simulator::Precision;
using simulator::Scene;
using simulator::Simulation;
using simulator::StepReport;

constexpr double kDegrees = 60;
constexpr int kSteps = 6;

std::string number(double value) {
    char text[32];
    std::snprintf(text, sizeof text, "%.6g", value);
    return text;
}

// A bar of the case's shape, 4 axes: along, two across, and the layers.
SimplexMesh<4> mesh_of(const Extreme& extreme) {
    const double edge = extreme.size / std::max(extreme.cells, 1);
    SimplexMesh<4> mesh = pent::test::kuhn_box<4>(
        {std::max(extreme.cells, 1), 1, 1, 1}, {extreme.size, edge, edge, edge * extreme.aspect});
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
    return mesh;
}

simulator::Body body_of(const Extreme& extreme, const std::string& name) {
    simulator::Body body;
    body.name = name;
    body.mesh = name + ".pent";
    body.place.translate = Eigen::Vector4d::Constant(0.5 * extreme.offset * extreme.size);
    body.material.lame = simulator::lame_from_young(4, extreme.young, extreme.poisson);
    body.material.density = extreme.density;
    return body;
}

Scene scene_of(const Extreme& extreme, Precision precision) {
    Scene scene;
    scene.gravity = Eigen::Vector4d::Zero();
    scene.frames = kSteps;
    scene.frames_per_second = 1 / extreme.dt;
    scene.bodies = {body_of(extreme, "body")};
    if (extreme.ratio != 1) {
        Extreme other = extreme;
        other.young *= extreme.ratio;
        scene.bodies.push_back(body_of(other, "other"));
        scene.bodies.back().place.translate[1] += 3 * extreme.size;
    }
    scene.solver.precision = precision;
    scene.solver.tolerance = 1e-6;
    scene.solver.newton_tolerance = 1e-6;
    scene.solver.max_iterations = 20'000;
    return scene;
}

// Holds the end of every body, and turns it if asked.
void hold_ends(Scene& scene, const Extreme& extreme, bool is_turned) {
    for (const simulator::Body& body : scene.bodies) {
        // The low end along x; of a single cell the facet opposite its corner farthest along w.
        simulator::HalfSpaceSelection end;
        end.normal = extreme.cells == 0 ? Eigen::Vector4d::UnitW() : Eigen::Vector4d::UnitX();
        end.offset = body.place.translate[0] + 0.01 * extreme.size * std::min(1.0, extreme.aspect);
        simulator::Motion motion;
        motion.translate = Eigen::Vector4d::Zero();
        if (is_turned) {
            const double rate = kDegrees / (kSteps * extreme.dt);
            motion.rotate = {{.plane = {0, 3}, .degrees_per_s = rate},
                             {.plane = {1, 2}, .degrees_per_s = rate}};
            motion.about = body.place.translate;
        }
        scene.constraints.push_back({.body = body.name, .select = {end}, .motion = {motion}});
    }
}

Positions<4> turned(const Positions<4>& rest, const Eigen::VectorXd& about) {
    const double c = std::cos(kDegrees * std::numbers::pi / 180);
    const double s = std::sin(kDegrees * std::numbers::pi / 180);
    Eigen::Matrix4d R = Eigen::Matrix4d::Identity();
    R(0, 0) = R(3, 3) = R(1, 1) = R(2, 2) = c;
    R(0, 3) = R(1, 2) = -s;
    R(3, 0) = R(2, 1) = s;
    return (R * (rest.colwise() - Eigen::Vector4d(about))).colwise() + Eigen::Vector4d(about);
}

Outcome judge(double error, Precision precision) {
    const bool is_right = std::isfinite(error) && error <= bound(precision);
    return {.kind = is_right ? Outcome::Kind::Right : Outcome::Kind::Wrong,
            .error = error,
            .reason = {}};
}

// Steps to the end; the reason of the first step that was not taken as told, or "".
std::string step_all(Simulation<4>& simulation, int steps) {
    for (int i = 0; i < steps; ++i) {
        const StepReport report = simulation.step();
        if (!report.is_accepted) {
            return report.failure;
        }
        if (report.refused > 0) {
            return "steps had to be cut";
        }
    }
    return "";
}

Outcome simulate(const Extreme& extreme, Motion motion, Precision precision) {
    Scene scene = scene_of(extreme, precision);
    if (motion == Motion::Fall) {
        scene.gravity[1] = -extreme.gravity;
    } else {
        hold_ends(scene, extreme, motion == Motion::Turn);
    }
    if (motion == Motion::Turn) {
        scene.solver.integrator = simulator::Integrator::Quasistatic;
    }
    const std::vector<SimplexMesh<4>> meshes(scene.bodies.size(), mesh_of(extreme));
    Simulation<4> simulation(scene, meshes);
    const std::string failure = step_all(simulation, kSteps);
    if (!failure.empty()) {
        return {.kind = Outcome::Kind::Reported, .error = 0, .reason = failure};
    }
    double error = 0;
    for (int body = 0; body < simulation.body_count(); ++body) {
        Positions<4> expected = simulation.mesh(body).positions;
        double scale = extreme.size * std::max(1.0, extreme.aspect);
        if (motion == Motion::Fall) {
            const double fall =
                extreme.gravity * extreme.dt * extreme.dt * kSteps * (kSteps + 1) / 2;
            expected.row(1).array() -= fall;
            scale += fall;
        } else if (motion == Motion::Turn) {
            expected =
                turned(expected, scene.bodies[static_cast<std::size_t>(body)].place.translate);
        }
        const double worst =
            (Positions<4>(simulation.positions(body)) - expected).cwiseAbs().maxCoeff() / scale;
        error = std::isfinite(worst) ? std::max(error, worst) : worst;
    }
    return judge(error, precision);
}

template <typename Action>
Outcome guarded(const Action& action) {
    try {
        return action();
    } catch (const Error& refusal) {
        return {.kind = Outcome::Kind::Refused, .error = 0, .reason = refusal.what()};
    }
}

std::vector<Case> make_cases() {
    std::vector<Case> all;
    const auto vary = [&](const std::string& group, auto member, std::vector<double> inside,
                          std::vector<double> outside) {
        for (const bool is_inside : {true, false}) {
            for (const double value : is_inside ? inside : outside) {
                Case one{.group = group, .name = number(value), .is_inside = is_inside};
                one.extreme.*member = value;
                all.push_back(one);
            }
        }
    };
    vary("Poisson's ratio", &Extreme::poisson, {-0.5, 0, 0.28, 0.32, 0.33},
         {-0.99, 0.333, 0.33333, 0.34});
    vary("Young's modulus, Pa", &Extreme::young, {1e3, 1e5, 1e8, 1e12}, {1e-3, 1e15});
    vary("density, kg/m^4", &Extreme::density, {1, 1e3, 1e5}, {1e-6, 1e12});
    vary("time step, s", &Extreme::dt, {1e-5, 1e-3, 0.1}, {1e-7, 10});
    vary("thickness of layers over edges", &Extreme::aspect, {1e-2, 0.1, 10, 1e2}, {1e-4, 1e4});
    vary("stiffness of one body over another's", &Extreme::ratio, {1e-6, 1e6}, {1e-12, 1e12});
    vary("size of the body, m", &Extreme::size, {1e-3, 1, 1e3}, {1e-9, 1e9});
    vary("distance from the origin, sizes", &Extreme::offset, {1e3, 1e7}, {1e12});
    vary("gravity, m/s^2", &Extreme::gravity, {9.8, 1e3}, {1e6, 1e12});
    all.push_back({.group = "cells", .name = "one", .extreme = {.cells = 0}});
    all.push_back({.group = "cells", .name = "16 tesseracts", .extreme = {.cells = 16}});
    return all;
}

// The state a start names, from the state at rest.
Positions<4> started(const std::string& name, const Positions<4>& rest) {
    Positions<4> x = rest;
    const Eigen::Vector4d middle = rest.rowwise().mean();
    if (name == "flat: no extent along w") {
        x.row(3).setConstant(middle[3]);
    } else if (name == "inverted: mirrored along w") {
        x.row(3) = 2 * middle[3] - rest.row(3).array();
    } else if (name == "shrunk to 0.6") {
        x = (0.6 * (rest.colwise() - middle)).colwise() + middle;
    } else if (name == "stretched to 2") {
        x = (2.0 * (rest.colwise() - middle)).colwise() + middle;
    } else if (name == "collapsed to a point") {
        x.colwise() = middle;
    } else if (name == "scrambled: vertices at random in its box") {
        std::mt19937 random(1);
        const Eigen::Vector4d low = rest.rowwise().minCoeff();
        const Eigen::Vector4d high = rest.rowwise().maxCoeff();
        for (Eigen::Index v = 0; v < x.cols(); ++v) {
            for (int axis = 0; axis < 4; ++axis) {
                x(axis, v) = std::uniform_real_distribution<double>(low[axis], high[axis])(random);
            }
        }
    }
    return x;
}

}  // namespace

const std::vector<Case>& cases() {
    static const std::vector<Case> all = make_cases();
    return all;
}

double bound(Precision precision) {
    // The turn ends where forces have fallen to 1e-6 of those of a turn by 10 degrees; the softest mode of
    // a slender, nearly incompressible bar is up to 1e3 times softer than the stiffest. The fall has the
    // tolerance of the linear solver, and with a float matrix its rounding, up to 1e-3.
    return precision == Precision::Float ? 2e-3 : 1e-3;
}

Outcome run(const Extreme& extreme, Motion motion, Precision precision) {
    return guarded([&] { return simulate(extreme, motion, precision); });
}

const std::vector<Start>& starts() {
    static const std::vector<Start> all = {
        {"flat: no extent along w", true}, {"inverted: mirrored along w", true},
        {"shrunk to 0.6", true},           {"stretched to 2", true},
        {"collapsed to a point", false},   {"scrambled: vertices at random in its box", false}};
    return all;
}

Outcome run(const Start& start, Precision precision) {
    return guarded([&]() -> Outcome {
        const Extreme extreme;
        Scene scene = scene_of(extreme, precision);
        hold_ends(scene, extreme, false);
        scene.solver.integrator = simulator::Integrator::NewtonEuler;
        scene.damping = simulator::Damping{.mass = 10, .stiffness = 0};
        Simulation<4> simulation(scene, {mesh_of(extreme)});
        const Positions<4> rest = simulation.mesh(0).positions;
        simulation.set_state(0, started(start.name, rest), Positions<4>::Zero(4, rest.cols()));
        constexpr int kToRest = 60;  // 2 s, ten periods of the damping
        StepReport report;
        for (int i = 0; i < kToRest; ++i) {
            report = simulation.step();
            if (!report.is_accepted) {
                return {.kind = Outcome::Kind::Reported, .error = 0, .reason = report.failure};
            }
        }
        const double error =
            (Positions<4>(simulation.positions(0)) - rest).cwiseAbs().maxCoeff() / extreme.size;
        if (std::isfinite(error) && report.collapsed + report.inverted > 0) {
            return {.kind = Outcome::Kind::Reported,
                    .error = 0,
                    .reason = std::to_string(report.collapsed) + " collapsed and "
                              + std::to_string(report.inverted) + " inverted elements"};
        }
        // Motion that is left after 2 s: e^-10 of the start is 5e-5.
        constexpr double kAtRest = 1e-2;
        return {.kind = error < kAtRest ? Outcome::Kind::Right : Outcome::Kind::Wrong,
                .error = error,
                .reason = {}};
    });
}

const std::vector<Touch>& touches() {
    static const std::vector<Touch> all = {
        {.name = "contact within 1e-9 edges", .gap = 0.05, .distance = 1e-9},
        {.name = "contact within 1e-3 edges", .gap = 5e-4, .distance = 1e-3},
        {.name = "contact within half an edge", .gap = 0.25, .distance = 0.5},
        {.name = "contact within 10 edges", .gap = 0.5, .distance = 10},
        {.name = "touching at distance zero", .gap = 0},
        {.name = "exactly parallel faces", .gap = 0.05, .distance = 0.1, .shift = 0},
        {.name = "coincident faces and edges", .gap = 0, .distance = 0.1, .shift = 0},
        {.name = "overlapping by a tenth of an edge", .gap = -0.1},
        {.name = "one body within the other", .gap = -1, .distance = 0.1, .shift = 0}};
    return all;
}

Outcome run(const Touch& touch, Precision precision) {
    return guarded([&]() -> Outcome {
        const Extreme extreme{.cells = 1};
        Scene scene = scene_of(extreme, precision);
        simulator::Body other = scene.bodies[0];
        other.name = "other";
        other.place.translate =
            Eigen::Vector4d(1 + touch.gap, touch.shift, touch.shift, touch.shift);
        scene.bodies.push_back(other);
        scene.contact = simulator::Contact{.distance = touch.distance, .stiffness = 100};
        scene.solver.integrator = simulator::Integrator::NewtonEuler;
        scene.frames_per_second = 100;
        Simulation<4> simulation(scene, {mesh_of(extreme), mesh_of(extreme)});
        constexpr int kTouchSteps = 10;
        const std::string failure = step_all(simulation, kTouchSteps);
        if (!failure.empty()) {
            return {.kind = Outcome::Kind::Reported, .error = 0, .reason = failure};
        }
        Eigen::Vector4d momentum = Eigen::Vector4d::Zero();
        double scale = 0;
        double farthest = 0;
        for (int body = 0; body < 2; ++body) {
            momentum += simulation.velocities(body) * simulation.masses(body);
            scale +=
                (simulation.velocities(body).colwise().norm() * simulation.masses(body)).value();
            farthest = std::max(farthest, simulation.positions(body).cwiseAbs().maxCoeff());
        }
        if (!std::isfinite(farthest) || farthest > 100) {
            return {.kind = Outcome::Kind::Wrong, .error = farthest, .reason = {}};
        }
        return judge(scale > 0 ? momentum.norm() / scale : 0, precision);
    });
}

std::string text(const Outcome& outcome) {
    char error[32];
    std::snprintf(error, sizeof error, "%.0e", outcome.error);
    switch (outcome.kind) {
        case Outcome::Kind::Right:
            return std::string("right, ") + error;
        case Outcome::Kind::Refused:
            return "refused: " + outcome.reason;
        case Outcome::Kind::Reported:
            return "reported: " + outcome.reason;
        case Outcome::Kind::Wrong:
            return std::string("WRONG, ") + error;
    }
    return "";
}

}  // namespace pent::stability
