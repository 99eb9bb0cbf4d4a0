#include "explain/advice.h"

#include <pent/formatted.h>
#include <pent/simulator/placed_mesh.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>
#include <utility>

namespace pent::runs {

namespace {

constexpr double kFar = std::numeric_limits<double>::infinity();

// Bend of a beam at most so many cells thick over that of theory, for the materials between; see
// docs/accuracy.md, which measures them.
struct Locking {
    int cells;
    double at_0;
    double at_028;
    double at_032;
};
constexpr Locking kLinear[] = {{1, 0.27, 0.20, 0.12}, {2, 0.57, 0.43, 0.25}, {4, 0.84, 0.72, 0.52}};
constexpr Locking kSmoothed[] = {{1, 0.64, 0.49, 0.30}, {2, 0.96, 0.83, 0.67}, {4, 1, 0.94, 0.88}};

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

class Adviser {
public:
    explicit Adviser(const Trial& trial)
        : trial_(trial), scene_(trial.scene), contact_(trial.scene.contact) {}

    std::vector<std::string> operator()() {
        if (!trial_.step.is_accepted) {
            advise("the first step fails: " + trial_.step.failure);
        }
        lines_.insert(lines_.end(), trial_.warnings.begin(), trial_.warnings.end());
        on_bending();
        on_falling();
        on_turns();
        if (contact_) {
            on_idle_contact();
            on_fast_bodies();
        } else {
            on_missing_contact();
        }
        on_idle_obstacles();
        on_damping_and_sleep();
        return std::move(lines_);
    }

private:
    void advise(std::string line) { lines_.push_back(std::move(line)); }
    [[nodiscard]] double gravity() const { return scene_.gravity.norm(); }
    [[nodiscard]] const std::string& name(std::size_t body) const {
        return scene_.bodies[body].name;
    }

    // Whether a body bends in this scene cannot be known; whether it would bend too little can.
    void on_bending() {
        for (std::size_t i = 0; i < scene_.bodies.size(); ++i) {
            if (trial_.bodies[i].is_kinematic()) {
                continue;
            }
            const int across = trial_.bodies[i].cells_across;
            double poisson =
                young_from_lame(scene_.dimension, scene_.bodies[i].material.lame).poisson;
            for (const Region& region : scene_.bodies[i].regions) {
                poisson = std::max(poisson,
                                   young_from_lame(scene_.dimension, region.material.lame).poisson);
            }
            const double part = bend(scene_.solver.elements, across, poisson);
            if (part > kBends) {
                continue;
            }
            const bool is_linear = scene_.solver.elements == ElementKind::Linear;
            const std::string cells =
                across == 1 ? "1 cell" : formatted("%d to %d cells", across, across + 1);
            advise(formatted(
                "%s is %s thick: with poisson %.2g %s elements lock, bending reaches about"
                " %.0f%% of what it should be; take elements = %s\"quadratic\" with a mesh of"
                " pent-mesh --quadratic, refine, or lower poisson",
                name(i).c_str(), cells.c_str(), poisson, is_linear ? "linear" : "even smoothed",
                100 * part, is_linear ? "\"smoothed\", or " : ""));
        }
    }

    void on_falling() {
        const bool hangs = std::any_of(scene_.attachments.begin(), scene_.attachments.end(),
                                       [](const Attachment& one) { return one.target.empty(); });
        if (gravity() > 0 && scene_.constraints.empty() && scene_.obstacles.empty() && !hangs) {
            const double time = scene_.frames / scene_.frames_per_second;
            advise(
                formatted("nothing is held and there is no obstacle: everything falls, %.3g m by"
                          " the end",
                          0.5 * gravity() * time * time));
        }
    }

    // One linear solve a step sees a rotation as its tangent: at 0.2 rad that is 2% too long.
    void on_turns() {
        constexpr double kMaxAngle = 0.2;
        if (scene_.solver.integrator != Integrator::LinearEuler) {
            return;
        }
        for (const Constraint& constraint : scene_.constraints) {
            for (const Motion& motion : constraint.motion) {
                const double degrees = simulator::largest_turn_rate(motion) * scene_.dt();
                const double angle = degrees * std::numbers::pi / 180;
                if (angle > kMaxAngle) {
                    advise(formatted(
                        "a constraint of %s turns %.3g degrees a step, far for linear_euler: take"
                        " %d steps_per_frame or newton_euler",
                        constraint.body.c_str(), degrees,
                        static_cast<int>(std::ceil(angle / kMaxAngle)) * scene_.steps_per_frame));
                }
            }
        }
    }

    // Calls action(a, b, gap) for bodies, not both held, whose boxes are at most `most` apart.
    template <typename Action>
    void for_near_pairs(double most, const Action& action) const {
        for (std::size_t a = 0; a < scene_.bodies.size(); ++a) {
            for (std::size_t b = a + 1; b < scene_.bodies.size(); ++b) {
                const double gap = trial_.bodies[a].box.exteriorDistance(trial_.bodies[b].box);
                if (!(trial_.bodies[a].is_kinematic() && trial_.bodies[b].is_kinematic())
                    && gap <= most) {
                    action(a, b, gap);
                }
            }
        }
    }

    void on_missing_contact() {
        for_near_pairs(0, [&](std::size_t a, std::size_t b, double /*gap*/) {
            advise("the boxes around " + name(a) + " and " + name(b)
                   + " overlap at the start, and there is no [contact]: they pass through one"
                     " another");
        });
    }

    void on_idle_contact() {
        // Obstacles push without [contact]; but barrier and friction are its own.
        const bool serves_obstacles =
            !scene_.obstacles.empty()
            && (contact_->friction > 0 || contact_->model == ContactModel::Barrier);
        if (contact_->self || serves_obstacles) {
            return;
        }
        double nearest = kFar;
        for_near_pairs(kFar, [&](std::size_t /*a*/, std::size_t /*b*/, double gap) {
            nearest = std::min(nearest, gap);
        });
        if (scene_.bodies.size() == 1) {
            advise("[contact] has nothing to do: there is one body, and self is false");
        } else if (nearest == kFar) {
            advise("[contact] has nothing to do: all bodies are held everywhere");
        } else if (nearest > contact_->distance) {
            advise(
                formatted("the boxes around the bodies are %.3g m apart at the start, contact"
                          " begins at %.3g m: if they never come nearer, [contact] could go",
                          nearest, contact_->distance));
        }
    }

    // A penalty that is only looked for at the end of a step is missed by what flies through it.
    void on_fast_bodies() {
        if (contact_->model == ContactModel::Barrier) {
            return;
        }
        for_near_pairs(kFar, [&](std::size_t a, std::size_t b, double /*gap*/) {
            const double travel =
                scene_.dt()
                * (velocity_of(scene_.bodies[a]) - velocity_of(scene_.bodies[b])).norm();
            if (travel > 2 * contact_->distance) {
                advise(
                    formatted("%s and %s move %.3g m a step past each other, contact begins at"
                              " %.3g m: they can pass through one another; take %d"
                              " steps_per_frame or model = \"barrier\"",
                              name(a).c_str(), name(b).c_str(), travel, contact_->distance,
                              static_cast<int>(std::ceil(travel / contact_->distance))
                                  * scene_.steps_per_frame));
            }
        });
    }

    [[nodiscard]] Eigen::VectorXd velocity_of(const Body& body) const {
        return body.velocity.size() > 0 ? body.velocity : Eigen::VectorXd::Zero(scene_.dimension);
    }

    [[nodiscard]] bool is_anything_moving() const {
        const auto moves = [](const auto& part) {
            return std::any_of(part.motion.begin(), part.motion.end(), [](const Motion& motion) {
                return !motion.translate.isZero(0) || !motion.rotate.empty()
                       || !motion.keyframes.empty();
            });
        };
        const auto has_any = [&](const auto& parts) {
            return std::any_of(parts.begin(), parts.end(), moves);
        };
        return has_any(scene_.constraints) || has_any(scene_.attachments)
               || has_any(scene_.obstacles) || trial_.step.energies.kinetic > 0;
    }

    void on_idle_obstacles() {
        if (scene_.obstacles.empty()) {
            return;
        }
        if (trial_.size.free_vertices == 0) {
            advise("[[obstacle]] has nothing to do: all bodies are held everywhere");
        } else if (!is_anything_moving() && trial_.step.contact.obstacle == 0) {
            advise("[[obstacle]] could go: nothing touches one at the start, and nothing moves");
        }
    }

    void on_damping_and_sleep() {
        if (scene_.damping && scene_.damping->mass == 0 && scene_.damping->stiffness == 0) {
            advise("[damping] is all zero and could go");
        }
        constexpr double kFewSteps = 10;
        if (scene_.sleep && scene_.sleep->time < kFewSteps * scene_.dt()) {
            advise(formatted(
                "sleep.time is %.3g s, %.2g steps: falling asleep and waking cost some"
                " steps' worth; take %.2g s or more",
                scene_.sleep->time, scene_.sleep->time / scene_.dt(), kFewSteps * scene_.dt()));
        }
    }

    const Trial& trial_;
    const Scene& scene_;
    const std::optional<Contact>& contact_;
    std::vector<std::string> lines_;
};

}  // namespace

std::vector<std::string> advice(const Trial& trial) {
    return Adviser(trial)();
}

}  // namespace pent::runs
