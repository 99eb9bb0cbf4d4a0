#include "extremes.h"

#include "small_body.h"

#include <pent/formatted.h>

#include <Eigen/LU>

#include <algorithm>
#include <cmath>
#include <numbers>

namespace pent::stability {

namespace {

using simulator::Precision;
using simulator::Scene;
using simulator::Simulation;

constexpr double kDegrees = 60;
constexpr int kSteps = 6;
constexpr int kSmallTurns = 60;

bool is_quadratic(const Extreme& extreme) {
    return extreme.elements == simulator::ElementKind::Quadratic;
}

bool has_thin_quadratic_layers(const Extreme& extreme) {
    return is_quadratic(extreme) && extreme.aspect < 0.1;
}

std::string number(double value) {
    return formatted("%.6g", value);
}

// Gravity that shears the corner of a single pentachoron of the first body by 0.3 along three axes
// and stretches it by 0.1 along the fourth. With F = I + t e_w^T the stress along e_w is linear in
// t: P e_w = mu t, and (lambda + 2 mu) t_w along w, which balances a fifth of the weight, rho g h
// / 5.
Eigen::Vector4d loading_gravity(const Extreme& extreme) {
    const simulator::Lame lame = simulator::lame_from_young(
        4, extreme.young * std::min(1.0, extreme.ratio), extreme.poisson);
    const double height = extreme.size * extreme.aspect;
    const Eigen::Vector4d stress(0.3 * lame.mu, 0.3 * lame.mu, 0.3 * lame.mu,
                                 0.1 * (lame.lambda + 2 * lame.mu));
    return 5 / (extreme.density * std::max(1.0, extreme.heaviness) * height) * stress;
}

// Where that corner comes to be, from where it is at rest: h t, exact at any load.
Eigen::Vector4d loaded_shift(const simulator::Material& material,
                             const Extreme& extreme,
                             const Eigen::Vector4d& gravity) {
    const double height = extreme.size * extreme.aspect;
    const double mu = material.lame.mu;
    const Eigen::Vector4d stiffness(mu, mu, mu, material.lame.lambda + 2 * mu);
    return (material.density * height * height / 5) * gravity.cwiseQuotient(stiffness);
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

Scene scene_of(const Extreme& extreme, Motion motion, Precision precision) {
    Scene scene = scene_of(extreme, precision);
    scene.frames = kSteps;
    switch (motion) {
        case Motion::Descend:
            scene.solver.integrator = simulator::Integrator::NewtonEuler;
            [[fallthrough]];
        case Motion::Fall:
            scene.gravity[1] = -extreme.gravity;
            break;
        case Motion::Turn: {
            scene.frames = extreme.turn_steps;
            const double rate = kDegrees / (extreme.turn_steps * extreme.dt);
            hold_ends(scene, extreme,
                      {{.plane = {0, 3}, .degrees_per_s = rate},
                       {.plane = {1, 2}, .degrees_per_s = rate}});
            scene.solver.integrator = simulator::Integrator::Quasistatic;
            break;
        }
        case Motion::Load:
            hold_ends(scene, extreme, {});
            scene.frames = 1;
            scene.gravity = loading_gravity(extreme);
            scene.solver.integrator = simulator::Integrator::Quasistatic;
            break;
        case Motion::Rest:
            hold_ends(scene, extreme, {});
            break;
    }
    return scene;
}

// Where a body has to be at the end, and the length its error is measured by.
struct Answer {
    Positions<4> positions;
    double scale = 0;
};

Answer answer(const Extreme& extreme,
              Motion motion,
              const Scene& scene,
              int body,
              const Positions<4>& start) {
    const simulator::Body& told = scene.bodies[static_cast<std::size_t>(body)];
    Answer answer{.positions = start, .scale = extreme.size * std::max(1.0, extreme.aspect)};
    if (motion == Motion::Fall || motion == Motion::Descend) {
        const double fall = extreme.gravity * extreme.dt * extreme.dt * kSteps * (kSteps + 1) / 2;
        answer.positions.row(1).array() -= fall;
        answer.scale += fall;
    } else if (motion == Motion::Turn) {
        answer.positions = turned(start, told.place.translate);
    } else if (motion == Motion::Load) {
        const Eigen::Vector4d shift = loaded_shift(told.material, extreme, scene.gravity);
        answer.positions.col(4) += shift;
        answer.scale += shift.norm();
    }
    return answer;
}

Outcome simulate(Extreme extreme, Motion motion, Precision precision) {
    extreme.cells = motion == Motion::Load ? 0 : extreme.cells;
    const Scene scene = scene_of(extreme, motion, precision);
    const std::vector<SimplexMesh<4>> meshes(scene.bodies.size(), mesh_of(extreme));
    Simulation<4> simulation(scene, meshes, {.threads = extreme.threads});
    const Outcome steps = step_all(simulation, scene.frames);
    if (steps.kind != Outcome::Kind::Right) {
        return steps;
    }
    double error = 0;
    for (int body = 0; body < simulation.body_count(); ++body) {
        const Answer right = answer(extreme, motion, scene, body, simulation.mesh(body).positions);
        const Positions<4> positions = simulation.positions(body);
        error = std::max(error, (positions - right.positions).cwiseAbs().maxCoeff() / right.scale);
    }
    return judge(error, precision);
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
    for (Case& one : all) {
        // Volume is that many times as stiff as shape, whose forces vanish beside its own: the
        // closer to 1/3, the less of them may be left. At the end of the box it is a hundred times.
        const double softness = 1 - 3 * one.extreme.poisson;
        if (softness > 0) {
            one.extreme.newton_tolerance *= std::min(1.0, 100 * softness);
        }
    }
    vary("Young's modulus, Pa", &Extreme::young, {1e3, 1e5, 1e8, 1e12}, {1e-3, 1e15});
    vary("density, kg/m^4", &Extreme::density, {1, 1e3, 1e5}, {1e-6, 1e12});
    vary("time step, s", &Extreme::dt, {1e-5, 1e-3, 0.1}, {1e-7, 10});
    vary("thickness of layers over edges", &Extreme::aspect, {1e-2, 0.1, 10, 1e2}, {1e-4, 1e4});
    vary("stiffness of one body over another's", &Extreme::ratio, {1e-6, 1e6}, {1e-12, 1e12});
    vary("density of one body over another's", &Extreme::heaviness, {1e-6, 1e6}, {1e-12, 1e12});
    vary("size of the body, m", &Extreme::size, {1e-3, 1, 1e3}, {1e-9, 1e9});
    vary("distance from the origin, sizes", &Extreme::offset, {1e3, 1e7}, {1e12});
    vary("gravity, m/s^2", &Extreme::gravity, {9.8, 1e3}, {1e6, 1e12});
    all.push_back({.group = "cells", .name = "one", .extreme = {.cells = 0}});
    all.push_back({.group = "cells", .name = "16 tesseracts", .extreme = {.cells = 16}});
    return all;
}

std::string corner_name(const Extreme& extreme) {
    return formatted("poisson %g young %g density %g dt %g aspect %g ratio %g size %g",
                     extreme.poisson, extreme.young, extreme.density, extreme.dt, extreme.aspect,
                     extreme.ratio, extreme.size);
}

std::vector<Case> make_corners() {
    std::vector<Case> all(1);
    const auto both = [&](auto member, double low, double high) {
        const std::vector<Case> before = std::move(all);
        all.clear();
        for (const double value : {low, high}) {
            for (Case one : before) {
                one.extreme.*member = value;
                all.push_back(one);
            }
        }
    };
    both(&Extreme::poisson, -0.5, 0.33);
    both(&Extreme::young, 1e3, 1e12);
    both(&Extreme::density, 1, 1e5);
    both(&Extreme::dt, 1e-5, 0.1);
    both(&Extreme::aspect, 1e-2, 1e2);
    both(&Extreme::ratio, 1, 1e6);
    both(&Extreme::size, 1e-3, 1e3);
    for (Case& one : all) {
        one.group = "corner";
        one.name = corner_name(one.extreme);
    }
    return all;
}

}  // namespace

Extreme with_elements(Extreme extreme, simulator::ElementKind elements) {
    extreme.elements = elements;
    extreme.turn_steps = has_thin_quadratic_layers(extreme) ? kSmallTurns : kSteps;
    return extreme;
}

std::vector<Asked> asked_of(const Extreme& extreme) {
    std::vector<Asked> all;
    for (const Precision precision : {Precision::Float, Precision::Double}) {
        for (const Motion motion : kMotions) {
            if (!is_quadratic(extreme) || motion != Motion::Load) {
                all.push_back({motion, precision});
            }
        }
    }
    return all;
}

std::vector<Asked> asked_of_corner(const Extreme& extreme) {
    std::vector<Asked> all = asked_of(extreme);
    if (is_quadratic(extreme) && drowns_inertia(extreme)) {
        return {{Motion::Fall, Precision::Double}};
    }
    if (is_quadratic(extreme)) {
        const bool is_turned = extreme.ratio == 1 && extreme.dt == 1e-5 && extreme.density == 1e5
                               && extreme.young == 1e3;
        std::erase_if(all, [&](const Asked& asked) {
            const bool has_precision =
                asked.precision == Precision::Double || is_right_in_float(extreme);
            return asked.motion == Motion::Turn && !(is_turned && has_precision);
        });
    }
    return all;
}

bool is_right_in_float(const Extreme& extreme) {
    return !has_thin_quadratic_layers(extreme);
}

bool drowns_inertia(const Extreme& extreme) {
    const double halves = is_quadratic(extreme) ? 2 : 1;
    const double edge = extreme.size / (halves * extreme.cells) * std::min(1.0, extreme.aspect);
    const double speed = std::sqrt(extreme.young * extreme.ratio / extreme.density);
    return std::pow(speed * extreme.dt / edge, 2) > 1e8;
}

const std::vector<Case>& corners() {
    static const std::vector<Case> all = make_corners();
    return all;
}

const std::vector<Case>& cases() {
    static const std::vector<Case> all = make_cases();
    return all;
}

Case million() {
    return {.group = "cells",
            .name = "1,053,696",  // 16 x 14 x 14 x 14 tesseracts of 24
            .is_inside = false,
            .extreme = {.cells = 16, .across = 14, .threads = 2}};
}

Outcome run(const Extreme& extreme, Motion motion, Precision precision) {
    return guarded([&] { return simulate(extreme, motion, precision); });
}

std::string text(const Outcome& outcome) {
    switch (outcome.kind) {
        case Outcome::Kind::Right:
            return formatted("right, %.0e", outcome.error);
        case Outcome::Kind::Refused:
            return "refused: " + outcome.reason;
        case Outcome::Kind::Reported:
            return "reported: " + outcome.reason;
        case Outcome::Kind::Wrong:
            return formatted("WRONG, %.0e", outcome.error);
    }
    return "";
}

}  // namespace pent::stability
