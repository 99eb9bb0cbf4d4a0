#include "explain/advice.h"

#include <pent/formatted.h>
#include <pent/simulator/placed_mesh.h>
#include <pent/simulator/seen_pairs.h>

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <numbers>
#include <optional>

namespace pent::runs {

namespace {

using Lines = std::vector<std::string>;

// Bend of a beam at most so many cells thick over that of theory, for the materials between; see
// docs/accuracy.md, which measures them.
struct Locking {
    int cells;
    double at_0;
    double at_028;
    double at_032;
};
constexpr Locking kLinear[] = {
    {1, 0.298, 0.247, 0.166}, {2, 0.582, 0.465, 0.291}, {4, 0.833, 0.730, 0.528}};
constexpr Locking kSmoothed[] = {
    {1, 0.655, 0.541, 0.353}, {2, 0.957, 0.848, 0.677}, {4, 1, 0.969, 0.898}};

// More bend than this is right.
constexpr double kBends = 0.9;

// Of that of theory; 1 for a body thicker than measured, and of quadratic elements, which have two
// cells across at least.
double bend(ElementKind elements, int cells, double poisson) {
    if (elements == ElementKind::Quadratic) {
        return 1;
    }
    for (const Locking& row : elements == ElementKind::Linear ? kLinear : kSmoothed) {
        if (cells <= row.cells) {
            return poisson < 0.14 ? row.at_0 : poisson < 0.30 ? row.at_028 : row.at_032;
        }
    }
    return 1;
}

Lines on_first_step(const Trial& trial) {
    return trial.step.is_accepted ? Lines{} : Lines{"the first step fails: " + trial.step.failure};
}

Lines on_warnings(const Trial& trial) {
    return trial.warnings;
}

// Whether a body bends in this scene cannot be known; whether it would bend too little can.
Lines on_bending(const Trial& trial) {
    const Scene& scene = trial.scene;
    const bool is_linear = scene.solver.elements == ElementKind::Linear;
    const bool may_be_smoothed = is_linear && scene.activations.empty();
    Lines lines;
    for (std::size_t i = 0; i < scene.bodies.size(); ++i) {
        const Body& body = scene.bodies[i];
        const int across = trial.bodies[i].cells_across;
        double poisson = young_from_lame(scene.dimension, body.material.lame).poisson;
        for (const Region& region : body.regions) {
            poisson =
                std::max(poisson, young_from_lame(scene.dimension, region.material.lame).poisson);
        }
        const double part = bend(scene.solver.elements, across, poisson);
        if (trial.bodies[i].is_kinematic() || part > kBends) {
            continue;
        }
        const std::string cells =
            across == 1 ? "1 cell" : formatted("%d to %d cells", across, across + 1);
        lines.push_back(formatted(
            "%s is %s thick: with poisson %.2g %s elements lock, bending reaches about"
            " %.0f%% of what it should be; take elements = %s\"quadratic\" with a mesh of"
            " pent-mesh --quadratic, refine, or lower poisson",
            body.name.c_str(), cells.c_str(), poisson, is_linear ? "linear" : "even smoothed",
            100 * part, may_be_smoothed ? "\"smoothed\", or " : ""));
    }
    return lines;
}

// All bodies of a scene have one kind of elements.
Lines on_idle_parents(const Trial& trial) {
    const bool are_idle = trial.scene.solver.elements != ElementKind::Quadratic
                          && std::all_of(trial.bodies.begin(), trial.bodies.end(),
                                         [](const TrialBody& body) { return body.has_parents; });
    return are_idle ? Lines{"every mesh was made for quadratic elements, which err less for little"
                            " more time: take elements = \"quadratic\""}
                    : Lines{};
}

Lines on_falling(const Trial& trial) {
    const Scene& scene = trial.scene;
    const double g = scene.gravity.norm();
    const bool hangs = std::any_of(scene.attachments.begin(), scene.attachments.end(),
                                   [](const Attachment& one) { return one.target.empty(); });
    if (g == 0 || !scene.constraints.empty() || !scene.obstacles.empty() || !scene.loads.empty()
        || hangs) {
        return {};
    }
    const double time = scene.frames / scene.frames_per_second;
    return {
        formatted("nothing is held and there is no obstacle: everything falls, %.3g m by the end",
                  0.5 * g * time * time)};
}

// One linear solve a step sees a rotation as its tangent: at 0.2 rad that is 2% too long.
Lines on_turns(const Trial& trial) {
    constexpr double kMaxAngle = 0.2;
    const Scene& scene = trial.scene;
    Lines lines;
    for (const Constraint& constraint : scene.constraints) {
        for (const Motion& motion : constraint.motion) {
            const double degrees = simulator::largest_turn_rate(motion) * scene.dt();
            const double angle = degrees * std::numbers::pi / 180;
            if (scene.solver.integrator == Integrator::LinearEuler && angle > kMaxAngle) {
                lines.push_back(formatted(
                    "a constraint of %s turns %.3g degrees a step, far for linear_euler: take"
                    " %d steps_per_frame or newton_euler",
                    constraint.body.c_str(), degrees,
                    static_cast<int>(std::ceil(angle / kMaxAngle)) * scene.steps_per_frame));
            }
        }
    }
    return lines;
}

struct Pair {
    const Body& a;
    const Body& b;
    double gap;  // between the boxes around them at the start, m
};

// Of bodies that are not both held and, where there is contact, see each other.
std::vector<Pair> pairs_of(const Trial& trial) {
    const Scene& scene = trial.scene;
    const std::optional<simulator::SeenPairs> seen =
        scene.contact ? std::optional(simulator::SeenPairs(scene)) : std::nullopt;
    std::vector<Pair> pairs;
    for (std::uint32_t a = 0; a < trial.bodies.size(); ++a) {
        for (std::uint32_t b = a + 1; b < trial.bodies.size(); ++b) {
            const TrialBody& one = trial.bodies[a];
            const TrialBody& other = trial.bodies[b];
            const bool are_seen = !seen || seen->may_touch(a, b);
            if (are_seen && (!one.is_kinematic() || !other.is_kinematic())) {
                pairs.push_back(
                    {scene.bodies[a], scene.bodies[b], one.box.exteriorDistance(other.box)});
            }
        }
    }
    return pairs;
}

Lines on_missing_contact(const Trial& trial) {
    Lines lines;
    for (const Pair& pair : pairs_of(trial)) {
        if (!trial.scene.contact && pair.gap == 0) {
            lines.push_back("the boxes around " + pair.a.name + " and " + pair.b.name
                   + " overlap at the start, and there is no [contact]: they pass through one"
                     " another");
        }
    }
    return lines;
}

// Of [contact], or of a body or an obstacle itself.
bool has_friction(const Scene& scene) {
    const auto is_rough = [](const auto& part) {
        return part.friction > 0 && !std::isinf(part.friction);
    };
    return (scene.contact && scene.contact->friction > 0)
           || std::any_of(scene.bodies.begin(), scene.bodies.end(), is_rough)
           || std::any_of(scene.obstacles.begin(), scene.obstacles.end(), is_rough);
}

Lines on_idle_contact(const Trial& trial) {
    const Scene& scene = trial.scene;
    const std::optional<ContactSettings>& contact = scene.contact;
    // Obstacles push without [contact]; but the barrier, its friction and slip_speed are its own.
    const bool serves_obstacles =
        contact && !scene.obstacles.empty()
        && (has_friction(scene) || contact->model == ContactModel::Barrier);
    if (!contact || contact->self || serves_obstacles) {
        return {};
    }
    if (scene.bodies.size() == 1) {
        return {"[contact] has nothing to do: there is one body, and self is false"};
    }
    const std::vector<Pair> pairs = pairs_of(trial);
    if (pairs.empty()) {
        return {trial.size.free_vertices == 0
                    ? "[contact] has nothing to do: all bodies are held everywhere"
                    : "[contact] has nothing to do: no body that moves sees another one"};
    }
    const double nearest =
        std::min_element(pairs.begin(), pairs.end(), [](const Pair& p, const Pair& q) {
            return p.gap < q.gap;
        })->gap;
    if (nearest <= contact->distance) {
        return {};
    }
    return {
        formatted("the boxes around the bodies are %.3g m apart at the start, contact"
                  " begins at %.3g m: if they never come nearer, [contact] could go",
                  nearest, contact->distance)};
}

// A penalty that is only looked for at the end of a step is missed by what flies through it.
Lines on_fast_bodies(const Trial& trial) {
    const Scene& scene = trial.scene;
    if (!scene.contact || scene.contact->model == ContactModel::Barrier) {
        return {};
    }
    const double distance = scene.contact->distance;
    const auto velocity_of = [&](const Body& body) -> Eigen::VectorXd {
        return body.velocity.size() > 0 ? body.velocity : Eigen::VectorXd::Zero(scene.dimension);
    };
    Lines lines;
    for (const Pair& pair : pairs_of(trial)) {
        const double travel = scene.dt() * (velocity_of(pair.a) - velocity_of(pair.b)).norm();
        if (travel > 2 * distance) {
            lines.push_back(
                formatted("%s and %s move %.3g m a step past each other, contact begins at"
                          " %.3g m: they can pass through one another; take %d"
                          " steps_per_frame or model = \"barrier\"",
                          pair.a.name.c_str(), pair.b.name.c_str(), travel, distance,
                          static_cast<int>(std::ceil(travel / distance)) * scene.steps_per_frame));
        }
    }
    return lines;
}

// Now or later.
bool is_anything_moving(const Trial& trial) {
    const auto moves = [](const auto& part) {
        return std::any_of(part.motion.begin(), part.motion.end(), [](const Motion& motion) {
            return !motion.translate.isZero(0) || !motion.rotate.empty()
                   || !motion.keyframes.empty();
        });
    };
    const auto has_any = [&](const auto& parts) {
        return std::any_of(parts.begin(), parts.end(), moves);
    };
    const auto lasts = [](const auto& part) { return part.from == 0 && std::isinf(part.to); };
    const Scene& scene = trial.scene;
    return has_any(scene.constraints) || has_any(scene.attachments) || has_any(scene.obstacles)
           || !std::all_of(scene.constraints.begin(), scene.constraints.end(), lasts)
           || !std::all_of(scene.attachments.begin(), scene.attachments.end(), lasts)
           || !scene.loads.empty() || !scene.activations.empty() || trial.step.energies.kinetic > 0;
}

Lines on_idle_obstacles(const Trial& trial) {
    if (trial.scene.obstacles.empty()) {
        return {};
    }
    if (trial.size.free_vertices == 0) {
        return {"[[obstacle]] has nothing to do: all bodies are held everywhere"};
    }
    if (!is_anything_moving(trial) && trial.step.contact.obstacle == 0) {
        return {"[[obstacle]] could go: nothing touches one at the start, and nothing moves"};
    }
    return {};
}

Lines on_idle_damping(const Trial& trial) {
    const auto& damping = trial.scene.damping;
    const bool is_idle = damping && damping->mass == 0 && damping->stiffness == 0;
    return is_idle ? Lines{"[damping] is all zero and could go"} : Lines{};
}

Lines on_short_sleep(const Trial& trial) {
    constexpr double kFewSteps = 10;
    const auto& sleep = trial.scene.sleep;
    const double dt = trial.scene.dt();
    if (!sleep || sleep->time >= kFewSteps * dt) {
        return {};
    }
    return {
        formatted("sleep.time is %.3g s, %.2g steps: falling asleep and waking cost some"
                  " steps' worth; take %.2g s or more",
                  sleep->time, sleep->time / dt, kFewSteps * dt)};
}

}  // namespace

std::vector<std::string> advice(const Trial& trial) {
    Lines all;
    for (const auto piece : {on_first_step, on_warnings, on_bending, on_idle_parents, on_falling,
                             on_turns, on_missing_contact, on_idle_contact, on_fast_bodies,
                             on_idle_obstacles, on_idle_damping, on_short_sleep}) {
        const Lines lines = piece(trial);
        all.insert(all.end(), lines.begin(), lines.end());
    }
    return all;
}

}  // namespace pent::runs
