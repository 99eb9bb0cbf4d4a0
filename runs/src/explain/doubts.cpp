#include "explain/doubts.h"

#include <pent/contact/contact.h>
#include <pent/contact/obstacles.h>
#include <pent/formatted.h>
#include <pent/simulator/placed_mesh.h>
#include <pent/simulator/seen_pairs.h>
#include <pent/simulator/step_failures.h>
#include <pent/simulator/thickness.h>

#include <Eigen/Geometry>

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <iterator>
#include <limits>
#include <map>
#include <optional>
#include <utility>

namespace pent::runs {

namespace {

constexpr double kFar = std::numeric_limits<double>::infinity();

template <int Dim>
double thickness_of(const Simulation<Dim>& simulation, int body) {
    return simulator::thickness<Dim>(simulation.mesh(body).positions);
}

double speed_of(const Eigen::VectorXd& velocity) {
    return velocity.size() > 0 ? velocity.norm() : 0;
}

// How far a body is from an obstacle, m.
template <int Dim>
double gap(const Simulation<Dim>& simulation, int body, const Obstacle& obstacle) {
    const Positions<Dim>& positions = simulation.mesh(body).positions;
    const pent::ObstacleShape<Dim> shape = fixed_size<Dim>(obstacle.shape);
    double least = kFar;
    for (Eigen::Index vertex = 0; vertex < positions.cols(); ++vertex) {
        least = std::min(least, contact::signed_distance<Dim>(shape, positions.col(vertex)).value);
    }
    return std::max(least, 0.0);
}

// What bodies have before them in a scene with [contact]: the others that they see.
template <int Dim>
class Others {
public:
    Others(const Scene& scene, const Simulation<Dim>& simulation) : scene_(scene), seen_(scene) {
        for (int body = 0; body < simulation.body_count(); ++body) {
            const Positions<Dim>& positions = simulation.mesh(body).positions;
            boxes_.emplace_back(positions.rowwise().minCoeff(), positions.rowwise().maxCoeff());
        }
    }

    // How far a body is from the nearest of them by their boxes, m; infinite from none.
    [[nodiscard]] double gap(std::size_t body) const {
        double least = kFar;
        for_each_of(body, [&](std::size_t other) {
            least = std::min(least, boxes_[body].exteriorDistance(boxes_[other]));
        });
        return least;
    }

    // Largest speed of a body against one of them, m/s.
    [[nodiscard]] double start_speed(std::size_t body) const {
        const double own = speed_of(scene_.bodies[body].velocity);
        double most = own;
        for_each_of(body, [&](std::size_t other) {
            most = std::max(most, own + speed_of(scene_.bodies[other].velocity));
        });
        return most;
    }

private:
    template <typename Visit>
    void for_each_of(std::size_t body, const Visit& visit) const {
        for (std::size_t other = 0; other < boxes_.size(); ++other) {
            if (other != body && seen_.may_touch(body, other)) {
                visit(other);
            }
        }
    }

    const Scene& scene_;
    simulator::SeenPairs seen_;
    std::vector<Eigen::AlignedBox<double, Dim>> boxes_;
};

}  // namespace

template <int Dim>
double least_thickness(const Simulation<Dim>& simulation) {
    double least = kFar;
    for (int body = 0; body < simulation.body_count(); ++body) {
        least = std::min(least, thickness_of(simulation, body));
    }
    return least;
}

template <int Dim>
std::vector<std::string> doubts_of_units(const Scene& scene, const Simulation<Dim>& simulation) {
    constexpr double kMaxPerBody = 0.1;
    constexpr double kFewestSteps = 1e-4;
    constexpr double kMaxSteps = 1e4;
    constexpr double kMinMass = 1e-6;  // kg
    std::vector<std::string> lines;
    for (std::size_t i = 0; i < scene.bodies.size(); ++i) {
        const Body& body = scene.bodies[i];
        const int at = static_cast<int>(i);
        const double thin = thickness_of(simulation, at);
        const auto doubt_distance = [&](double distance, const std::string& block) {
            if (distance > kMaxPerBody * thin) {
                lines.push_back(formatted(
                    "%s distance = %.3g m is more than a tenth of \"%s\", which is %.3g m thick: is"
                    " the body as large as meant (place.scale)?",
                    block.c_str(), distance, body.name.c_str(), thin));
            }
        };
        if (scene.contact) {
            doubt_distance(scene.contact->distance, "[contact]");
        }
        const bool has_barrier = scene.contact && scene.contact->model == ContactModel::Barrier;
        for (std::size_t o = 0; !has_barrier && o < scene.obstacles.size(); ++o) {
            doubt_distance(scene.obstacles[o].distance, "[[obstacle]] " + std::to_string(o + 1));
        }
        for (std::size_t number = 0; number <= body.regions.size(); ++number) {
            const Material& material = material_of(body, static_cast<std::uint16_t>(number));
            const std::string name =
                "\"" + body.name + "\""
                + (number == 0 ? "" : ", region \"" + body.regions[number - 1].name + "\"");
            const double wave =
                std::sqrt(std::max(material.lame.lambda + 2 * material.lame.mu, material.lame.mu)
                          / material.density);
            const double steps = thin / wave / scene.dt();
            if (scene.solver.integrator != Integrator::Quasistatic
                && (steps < kFewestSteps || steps > kMaxSteps)) {
                lines.push_back(
                    formatted("a wave crosses %s (%.3g m, %.3g m/s) in %.2g steps: are its size,"
                              " young (Pa) and density (kg/m^%d) as meant?",
                              name.c_str(), thin, wave, steps, Dim));
            }
        }
        const double mass = simulation.masses(at).sum();
        if (mass < kMinMass) {
            lines.push_back(
                formatted("\"%s\" weighs %.3g kg: are its size and density (kg/m^%d) as meant?",
                          body.name.c_str(), mass, Dim));
        }
    }
    return lines;
}

template <int Dim>
std::vector<std::string> overlaps_at_start(const Scene& scene, const Simulation<Dim>& simulation) {
    std::map<std::pair<std::string, std::string>, double> deepest;
    const auto note = [&](const std::string& a, const std::string& b, double depth,
                          double distance) {
        if (depth > 0.1 * distance) {
            double& most = deepest[{a, b}];
            most = std::max(most, depth);
        }
    };
    const auto name = [&](std::size_t body) { return "\"" + scene.bodies[body].name + "\""; };
    for (const contact::Contact<Dim>& pair : simulation.contacts()) {
        const std::size_t second = pair.second.index;
        if (pair.second.is_obstacle()) {
            note(name(pair.first.index), "[[obstacle]] " + std::to_string(second + 1),
                 -pair.distance, scene.obstacles[second].distance);
        } else {
            note(name(std::min(pair.first.index, pair.second.index)),
                 name(std::max(pair.first.index, pair.second.index)), -pair.distance,
                 scene.contact->distance);
        }
    }
    std::vector<std::string> lines;
    for (const auto& [pair, depth] : deepest) {
        lines.push_back(
            formatted("%s and %s overlap at the start, by %.3g m: what holds them apart pushes from"
                      " the first step on; move them apart",
                      pair.first.c_str(), pair.second.c_str(), depth));
    }
    return lines;
}

template <int Dim>
std::vector<std::string> soft_contacts(const Scene& scene,
                                       const Simulation<Dim>& simulation,
                                       const std::vector<std::int64_t>& boundary_vertices) {
    std::vector<std::string> lines;
    const bool has_barrier = scene.contact && scene.contact->model == ContactModel::Barrier;
    const double g = scene.gravity.norm();
    const double duration = scene.frames / scene.frames_per_second;
    const auto judge = [&](std::size_t i, double height, double speed, double stiffness,
                           const std::string& block) {
        const int body = static_cast<int>(i);
        const double fall = std::min(height, 0.5 * g * duration * duration);
        if (!(height <= speed * duration + 0.5 * g * duration * duration)) {
            return;  // they do not meet
        }
        const double mass = simulation.masses(body).sum();
        // On one of the 2 Dim sides of the body, as if it were a box.
        const double count = std::max(1.0, static_cast<double>(boundary_vertices[i]) / (2 * Dim));
        const double arrival = std::sqrt(speed * speed + 2 * g * fall);
        const double deepest = kDeep * thickness_of(simulation, body);
        const double by_weight = mass * g / (2 * count * deepest);
        const double by_impact = mass * arrival * arrival / (2 * count * deepest * deepest);
        const double needed = std::max(by_weight, by_impact);
        if (stiffness < needed) {
            lines.push_back(formatted(
                "\"%s\" (%.3g kg, arriving at %.2g m/s) may go deeper than a tenth of its thickness"
                " into what it meets: %s stiffness is %.3g N/m, about %.2g would do",
                scene.bodies[i].name.c_str(), mass, arrival, block.c_str(), stiffness, needed));
        }
    };
    const std::optional<Others<Dim>> others =
        scene.contact ? std::optional<Others<Dim>>(std::in_place, scene, simulation) : std::nullopt;
    for (std::size_t i = 0; !has_barrier && i < scene.bodies.size(); ++i) {
        const bool is_held =
            std::any_of(scene.constraints.begin(), scene.constraints.end(),
                        [&](const Constraint& held) { return held.body == scene.bodies[i].name; });
        if (is_held) {
            continue;  // what holds it bears its weight
        }
        for (std::size_t o = 0; o < scene.obstacles.size(); ++o) {
            const Obstacle& obstacle = scene.obstacles[o];
            judge(i, gap(simulation, static_cast<int>(i), obstacle),
                  speed_of(scene.bodies[i].velocity), obstacle.stiffness,
                  "[[obstacle]] " + std::to_string(o + 1));
        }
        if (others && scene.bodies.size() > 1) {
            judge(i, others->gap(i), others->start_speed(i), scene.contact->stiffness, "[contact]");
        }
    }
    return lines;
}

std::string deep_penetration(const Scene& scene, const RunReport& report) {
    const auto depth = [](const StepReport& step) { return step.contact.deepest; };
    const auto at = std::max_element(
        report.steps.begin(), report.steps.end(),
        [&](const StepReport& a, const StepReport& b) { return depth(a) < depth(b); });
    const double deepest = at == report.steps.end() ? 0 : depth(*at);
    const double part = deepest / report.thinnest;
    if (!(part > kDeep)) {
        return "";
    }
    std::string result =
        formatted("penetration reached %.3g m, %.0f%% of the thinnest extent (%.3g m): ", deepest,
                  100 * part, report.thinnest);
    const double before = at == report.steps.begin() ? 0 : depth(*std::prev(at));
    if (before < 0.5 * deepest) {
        // No force acts before something is in reach: as deep as a step is long, which may be more
        // than chance has shown here.
        result += formatted("most of it in one step; steps_per_frame = %.0f",
                            std::ceil(2 * scene.steps_per_frame * part / kDeep));
    } else {
        // Under weight depth goes with 1/k, after an impact with its root: enough for both.
        const double factor = part / kDeep * part / kDeep;
        std::string which;
        if (scene.contact) {
            which = formatted("[contact] stiffness = %.2g", factor * scene.contact->stiffness);
        }
        for (std::size_t o = 0; o < scene.obstacles.size(); ++o) {
            which += formatted("%s[[obstacle]] %d stiffness = %.2g", which.empty() ? "" : ", ",
                               static_cast<int>(o + 1), factor * scene.obstacles[o].stiffness);
        }
        result += which + " at least";
    }
    result += " would keep it below a tenth, or model = \"barrier\"";
    if (scene.solver.integrator == Integrator::LinearEuler) {
        result += " with integrator = \"newton_euler\"";
    }
    return result;
}

std::string remedy(const Scene& scene,
                   const std::string& failure,
                   const std::vector<std::string>& doubts) {
    if (!doubts.empty()) {
        return "look at the units first: " + doubts.front();
    }
    if (failure == simulator::kSolverFailure) {
        return "try a larger solver.max_iterations, precision = \"double\", or more "
               "steps_per_frame";
    }
    // Without inertia nothing keeps what turns freely in its place.
    if (scene.solver.integrator == Integrator::Quasistatic
        && failure == simulator::kIndefiniteFailure) {
        return std::string(
                   "hold more of each body, so that it can neither move nor turn: at least ")
               + (scene.dimension == 3 ? "3 vertices that are not in one line"
                                       : "4 vertices that are not in one plane")
               + "; or try more steps_per_frame";
    }
    return "try more steps_per_frame, or stiffer or slower motion";
}

#define PENT_INSTANTIATE(Dim)                                                                     \
    template double least_thickness<Dim>(const Simulation<Dim>&);                                 \
    template std::vector<std::string> doubts_of_units<Dim>(const Scene&, const Simulation<Dim>&); \
    template std::vector<std::string> overlaps_at_start<Dim>(const Scene&,                        \
                                                             const Simulation<Dim>&);             \
    template std::vector<std::string> soft_contacts<Dim>(const Scene&, const Simulation<Dim>&,    \
                                                         const std::vector<std::int64_t>&);
PENT_INSTANTIATE(3)
PENT_INSTANTIATE(4)
#undef PENT_INSTANTIATE

}  // namespace pent::runs
