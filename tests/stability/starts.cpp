#include "small_body.h"

#include <random>

namespace pent::stability {

namespace {

using simulator::Precision;
using simulator::Scene;
using simulator::Simulation;
using simulator::StepReport;

// The state a start names, from the state at rest.
Positions<4> started(const std::string& name, const Positions<4>& rest) {
    Positions<4> x = rest;
    const Eigen::Vector4d middle = rest.rowwise().mean();
    const auto scaled = [&](double factor) {
        return Positions<4>((factor * (rest.colwise() - middle)).colwise() + middle);
    };
    if (name == "flat: no extent along w") {
        x.row(3).setConstant(middle[3]);
    } else if (name == "inverted: mirrored along w") {
        x.row(3) = 2 * middle[3] - rest.row(3).array();
    } else if (name == "shrunk to 0.6") {
        x = scaled(0.6);
    } else if (name == "stretched to 5 times its length") {
        x.row(0) *= 5;
    } else if (name == "blown up to 2 times its size") {
        x = scaled(2);
    } else if (name == "blown up to 5 times its size") {
        x = scaled(5);
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

const std::vector<Start>& starts() {
    static const std::vector<Start> all = {
        {"flat: no extent along w", true},
        {"inverted: mirrored along w", true},
        {"shrunk to 0.6", true},
        {"stretched to 5 times its length", true},
        {"blown up to 2 times its size", true},
        {"blown up to 5 times its size", true, false},
        {"collapsed to a point", false, false},
        {"scrambled: vertices at random in its box", false, false}};
    return all;
}

Outcome run(const Start& start,
            simulator::ElementKind elements,
            simulator::Integrator integrator,
            Precision precision) {
    return guarded([&]() -> Outcome {
        const Extreme extreme{.elements = elements};
        Scene scene = scene_of(extreme, precision);
        hold_ends(scene, extreme, {});
        scene.solver.integrator = integrator;
        scene.damping = simulator::Damping{.mass = 10, .stiffness = 0};
        Simulation<4> simulation(scene, {mesh_of(extreme)});
        const Positions<4> rest = simulation.mesh(0).positions;
        simulation.set_state(0, started(start.name, rest), Positions<4>::Zero(4, rest.cols()));
        // 6 s. Damping takes 0.1 s, but a body that falls back from far may fold on the way, and
        // first has to slide off an equilibrium that is not stable.
        constexpr int kToRest = 180;
        StepReport report;
        for (int i = 0; i < kToRest; ++i) {
            report = simulation.step();
            if (!is_finite(simulation)) {
                return {.kind = Outcome::Kind::Wrong, .error = NAN, .reason = {}};
            }
            if (!report.is_accepted) {
                return {.kind = Outcome::Kind::Reported, .error = 0, .reason = report.failure};
            }
        }
        if (report.collapsed + report.inverted > 0) {
            return {.kind = Outcome::Kind::Reported,
                    .error = 0,
                    .reason = std::to_string(report.collapsed) + " collapsed elements and "
                              + std::to_string(report.inverted) + " inverted cells"};
        }
        const Positions<4> positions = simulation.positions(0);
        return judge((positions - rest).cwiseAbs().maxCoeff() / extreme.size, precision);
    });
}

}  // namespace pent::stability
