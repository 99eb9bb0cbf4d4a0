#include "explain/advice.h"

#include <pent/formatted.h>
#include <pent/runs/explain.h>
#include <pent/simulator/placed_mesh.h>
#include <pent/simulator/words.h>

#include <algorithm>
#include <cmath>
#include <iterator>
#include <sys/resource.h>
#include <utility>

namespace pent::runs {

namespace {

// "1.2 ms", "3.4 s"; "-" for nothing.
std::string time_text(double seconds) {
    if (seconds <= 0) {
        return "-";
    }
    return seconds < 1 ? formatted("%.3g ms", 1e3 * seconds) : formatted("%.3g s", seconds);
}

std::string bytes_text(std::int64_t bytes) {
    return bytes == 0 ? "-" : formatted("%.3g MB", 1e-6 * static_cast<double>(bytes));
}

template <int Dim>
class Explainer {
public:
    Explainer(const Scene& scene, int threads, std::shared_ptr<const simulator::Ranks> ranks)
        : ranks_(std::move(ranks)),
          trial_(scene, threads, ranks_),
          scene_(scene),
          step_(trial_.step),
          size_(trial_.size) {}

    Explanation operator()() {
        result_.unknowns = Dim * size_.free_vertices;
        result_.bytes = size_.bytes;
        result_.seconds_per_step = step_.seconds;
        result_.seconds = step_.seconds * scene_.frames * scene_.steps_per_frame;
        inertia();
        elasticity();
        gravity();
        damping();
        constraints();
        loads();
        activations();
        attachments();
        contact_between_bodies();
        contact_within_bodies();
        obstacles();
        friction();
        sleeping();
        solver();
        output();
        processes();
        result_.advice = advice(trial_);
        return std::move(result_);
    }

private:
    void add(Term term) { result_.terms.push_back(std::move(term)); }
    void add_off(const std::string& name, const std::string& why) {
        add({.name = name, .is_on = false, .why = why});
    }
    [[nodiscard]] std::int64_t cells_of(std::size_t body) const {
        return trial_.simulation.mesh(static_cast<int>(body)).cell_count();
    }
    [[nodiscard]] bool has_barrier() const {
        return scene_.contact && scene_.contact->model == ContactModel::Barrier;
    }

    void inertia() {
        if (scene_.solver.integrator == Integrator::Quasistatic) {
            add_off("inertia", "integrator quasistatic: every step is an equilibrium");
            return;
        }
        const std::string word(simulator::word_of(scene_.solver.integrator));
        constexpr std::int64_t kScalars = Dim + 1;  // velocity and mass
        add({.name = "inertia",
             .is_on = true,
             .why = "integrator " + word + formatted(", dt = %.4g s", scene_.dt()),
             .unknowns = result_.unknowns,
             .bytes = kScalars * static_cast<std::int64_t>(sizeof(double)) * size_.vertices});
    }

    void elasticity() {
        std::int64_t all_cells = 0;  // of bodies that are solved for
        for (std::size_t i = 0; i < scene_.bodies.size(); ++i) {
            all_cells += trial_.is_kinematic(i) ? 0 : cells_of(i);
        }
        for (std::size_t i = 0; i < scene_.bodies.size(); ++i) {
            const Body& body = scene_.bodies[i];
            const std::string name = "elasticity of " + body.name;
            if (trial_.is_kinematic(i)) {
                add_off(name, "all of it is held: it moves as told, at no cost");
                continue;
            }
            const YoungPoisson young = young_from_lame(Dim, body.material.lame);
            const double share = static_cast<double>(cells_of(i)) / static_cast<double>(all_cells);
            add({.name = name,
                 .is_on = true,
                 .why = std::string(simulator::word_of(body.material.model))
                        + formatted(", young %.4g Pa, poisson %.3g, ", young.young, young.poisson)
                        + std::to_string(cells_of(i)) + " cells, "
                        + (body.regions.empty()
                               ? ""
                               : std::to_string(body.regions.size()) + " regions of their own, ")
                        + std::string(simulator::word_of(scene_.solver.elements)) + ", filter "
                        + std::string(simulator::word_of(scene_.solver.filter)),
                 .unknowns = Dim * trial_.free_vertices[i],
                 .bytes =
                     static_cast<std::int64_t>(share * static_cast<double>(size_.element_bytes)),
                 .seconds = share * step_.assembly_seconds});
        }
    }

    void gravity() {
        const double g = scene_.gravity.norm();
        add({.name = "gravity",
             .is_on = g > 0,
             .why = g > 0 ? formatted("%.4g m/s^2", g) : "[scene] has no gravity"});
    }

    // Newton's method keeps the tangent of a step as a matrix of its own, assembled once; a single
    // linear solve has it in its matrix anyway.
    void damping() {
        const Damping damping = scene_.damping.value_or(Damping{});
        if (damping.mass == 0 && damping.stiffness == 0) {
            add_off("damping", scene_.damping ? "[damping] is all zero"
                                              : "no [damping]; implicit steps damp by themselves");
            return;
        }
        const double share = static_cast<double>(step_.damping_hessians)
                             / static_cast<double>(std::max<std::int64_t>(step_.hessians, 1));
        add({.name = "damping",
             .is_on = true,
             .why = formatted("mass %.3g / s, stiffness %.3g s; implicit steps damp too",
                              damping.mass, damping.stiffness),
             .bytes = step_.damping_hessians > 0 ? size_.matrix_blocks * Dim * Dim
                                                       * static_cast<std::int64_t>(sizeof(double))
                                                 : 0,
             .seconds = share * step_.assembly_seconds});
    }

    void constraints() {
        const std::int64_t held = size_.vertices - size_.free_vertices;
        add({.name = "constraints",
             .is_on = held > 0,
             .why = held > 0 ? std::to_string(held) + " of " + std::to_string(size_.vertices)
                                   + " vertices are held in the first step; they have no unknowns"
                             : "no [[constraint]]"});
    }

    void loads() {
        for (const Load& load : scene_.loads) {
            const std::string force =
                !load.force.isZero(0) ? formatted("force %.4g N", load.force.norm()) : "";
            const std::string pressure =
                load.pressure != 0 ? formatted("pressure %.4g N/m^%d", load.pressure, Dim - 1) : "";
            add({.name = "load on " + load.body,
                 .is_on = true,
                 .why =
                     force + (force.empty() || pressure.empty() ? "" : ", ") + pressure
                     + (load.keyframes.empty()
                            ? ""
                            : ", with " + std::to_string(load.keyframes.size()) + " keyframes")});
        }
    }

    void activations() {
        if (scene_.activations.empty()) {
            add_off("activations", "no [[activation]]");
        }
        for (const Activation& one : scene_.activations) {
            const bool is_periodic =
                one.signal == simulator::Signal::Sine || one.signal == simulator::Signal::Pulses;
            add({.name = "activation of " + one.body,
                 .is_on = true,
                 .why = (one.fibers == simulator::Fibers::None
                             ? "growth"
                             : "fibers " + std::string(simulator::word_of(one.fibers)))
                        + formatted(", to %.3g of the length at rest", one.stretch)
                        + (one.preserves_volume ? ", volume preserved" : "") + ", "
                        + std::string(simulator::word_of(one.signal))
                        + (is_periodic ? formatted(" of %.3g Hz", one.frequency) : "")});
        }
    }

    // Each with the stiffness of all its springs, which is what stays the same on another mesh.
    void attachments() {
        if (scene_.attachments.empty()) {
            add_off("attachments", "no [[attachment]]");
        }
        for (const Attachment& one : scene_.attachments) {
            const auto body = static_cast<int>(index_of(scene_, one.body));
            const std::size_t springs = select_vertices(trial_.simulation.mesh(body), one).size();
            const bool is_moving = !one.motion.empty();
            add({.name = "attachment of " + one.body,
                 .is_on = true,
                 .why = std::to_string(springs) + " vertices to "
                        + (!one.target.empty() ? one.target
                           : is_moving         ? "points that move"
                                               : "points in space")
                        + formatted(", %.4g N/m, all together %.4g N/m", one.stiffness,
                                    one.stiffness * static_cast<double>(springs))
                        + (one.from > 0 ? formatted(", from %.4g s", one.from) : "")
                        + (std::isfinite(one.to) ? formatted(", to %.4g s", one.to) : "")
                        + (std::isfinite(one.break_force)
                               ? formatted(", breaks at %.4g N", one.break_force)
                               : "")});
        }
    }

    void contact_between_bodies() {
        const std::string name = "contact between bodies";
        if (!scene_.contact) {
            add_off(name, "no [contact]: bodies pass through one another");
        } else if (scene_.bodies.size() == 1) {
            add_off(name, "there is one body");
        } else {
            add({.name = name,
                 .is_on = true,
                 .why = contact_text(step_.contact.point_facet + step_.contact.mixed
                                     - step_.contact.self),
                 .bytes = size_.contact_bytes,
                 .seconds = step_.contact.seconds});
        }
    }

    // Contact of all kinds is found and measured together: the first kind that is on has the cost.
    void contact_within_bodies() {
        const std::string name = "contact within bodies";
        if (!scene_.contact) {
            add_off(name, "no [contact]");
        } else if (!scene_.contact->self) {
            add_off(name, "contact.self = false");
        } else {
            const bool is_first = scene_.bodies.size() == 1;
            add({.name = name,
                 .is_on = true,
                 .why = contact_text(step_.contact.self)
                        + (is_first ? "" : "; memory and time are above"),
                 .bytes = is_first ? size_.contact_bytes : 0,
                 .seconds = is_first ? step_.contact.seconds : 0});
        }
    }

    void obstacles() {
        if (scene_.obstacles.empty()) {
            add_off("obstacles", "no [[obstacle]]");
            return;
        }
        const auto moving = std::count_if(scene_.obstacles.begin(), scene_.obstacles.end(),
                                          [](const Obstacle& one) { return !one.motion.empty(); });
        const bool is_first =
            !scene_.contact || (scene_.bodies.size() == 1 && !scene_.contact->self);
        add({.name = "obstacles",
             .is_on = true,
             .why = std::to_string(scene_.obstacles.size())
                    + (moving > 0 ? ", of which " + std::to_string(moving) + " move, " : ", ")
                    + (has_barrier() ? "barrier" : "penalty") + "; "
                    + std::to_string(step_.contact.obstacle) + " vertices touch after a step, of "
                    + std::to_string(size_.free_vertices)
                    + (is_first ? "" : "; memory and time are above"),
             .bytes = is_first ? size_.contact_bytes : 0,
             .seconds = is_first ? step_.contact.seconds : 0});
    }

    [[nodiscard]] std::string contact_text(std::int64_t pairs) const {
        std::string text = std::string(simulator::word_of(scene_.contact->model))
                           + formatted(" within %.3g m; ", scene_.contact->distance)
                           + std::to_string(pairs) + " pairs touch after a step";
        if (has_barrier()) {
            text += ", " + time_text(step_.contact.ccd_seconds)
                    + " of the time is that nothing crosses";
        }
        return text;
    }

    void friction() {
        const auto count_own = [](const auto& parts) {
            return std::count_if(parts.begin(), parts.end(),
                                 [](const auto& part) { return std::isfinite(part.friction); });
        };
        const auto own = count_own(scene_.bodies) + count_own(scene_.obstacles);
        if (!scene_.contact || (scene_.contact->friction == 0 && own == 0)) {
            add_off("friction",
                    scene_.contact ? "contact.friction = 0" : "no [contact], which would have it");
            return;
        }
        add({.name = "friction",
             .is_on = true,
             .why =
                 formatted("coefficient %.3g, sticks below %.3g m/s; its time is that of contact",
                           scene_.contact->friction, scene_.contact->slip_speed)
                 + (own > 0 ? "; " + std::to_string(own) + " bodies or obstacles have their own"
                            : "")});
    }

    void sleeping() {
        if (!scene_.sleep) {
            add_off("sleeping", "no [sleep]: bodies at rest are solved for like all others");
            return;
        }
        add({.name = "sleeping",
             .is_on = true,
             .why = formatted("after %.3g s below %.3g of its size a second a body is solved for no"
                              " more, until something moves it",
                              scene_.sleep->time, scene_.sleep->speed)});
    }

    void solver() {
        const SolverOptions& options = scene_.solver;
        const bool is_direct = options.linear == LinearSolverKind::Direct;
        const std::string method = is_direct
                                       ? "direct, L L^T of a"
                                       : std::string(simulator::word_of(options.preconditioner));
        add({.name = "linear solver",
             .is_on = size_.free_vertices > 0,
             .why = method + (is_direct ? " " : ", ")
                    + std::string(simulator::word_of(options.precision)) + " matrix"
                    + (is_direct ? ""
                                 : formatted(", to %.1g: %d iterations", options.tolerance,
                                             step_.iterations))
                    + (step_.newton_iterations > 0
                           ? formatted(", %d of Newton's method", step_.newton_iterations)
                           : ""),
             .unknowns = result_.unknowns,
             .bytes = size_.matrix_bytes,
             .seconds = step_.solve_seconds});
    }

    void output() {
        const Output& output = scene_.output;
        std::string what;
        for (const simulator::VertexQuantity quantity : output.vertex) {
            what += (what.empty() ? "" : ", ") + std::string(simulator::word_of(quantity));
        }
        add({.name = "output",
             .is_on = !output.vertex.empty() || output.contact_pairs || output.balance,
             .why = (what.empty() ? "nothing" : what) + " of every vertex, "
                    + (output.contact_pairs ? "pairs" : "no pairs") + " in contact, "
                    + (output.balance ? "balance" : "no balance")
                    + " of steps, in the run folder"});
    }

    // What every rank has, and what they tell one another in a step.
    void processes() {
        if (ranks_ == nullptr) {
            return;
        }
        rusage used = {};
        getrusage(RUSAGE_SELF, &used);
        const std::vector<double> own = {static_cast<double>(size_.own_vertices),
                                         static_cast<double>(size_.ghosts),
                                         1e-3 * static_cast<double>(used.ru_maxrss)};
        const auto count = static_cast<std::size_t>(ranks_->count());
        const std::vector<double> all =
            ranks_->gather(own, std::vector<std::int64_t>(count, std::ssize(own)));
        std::vector<double> most = own;
        for (std::size_t i = 0; i < all.size(); ++i) {
            most[i % own.size()] = std::max(most[i % own.size()], all[i]);
        }
        add({.name = "ranks",
             .is_on = true,
             .why = std::to_string(count)
                    + formatted(
                        "; one has at most %.0f vertices of its own, %.0f ghosts and %.0f MB"
                        " in memory; a step takes %.0f messages and %.3g MB in all, and"
                        " %.0f times all wait for all",
                        most[0], most[1], most[2], static_cast<double>(trial_.traffic.messages),
                        1e-6 * static_cast<double>(trial_.traffic.bytes),
                        static_cast<double>(trial_.traffic.reductions))});
    }

    std::shared_ptr<const simulator::Ranks> ranks_;
    Trial<Dim> trial_;
    const Scene& scene_;
    const StepReport& step_;
    const SimulationSize& size_;
    Explanation result_;
};

}  // namespace

Explanation explain(const Scene& scene,
                    int threads,
                    const std::shared_ptr<const simulator::Ranks>& ranks) {
    check(scene);
    return scene.dimension == 3 ? Explainer<3>(scene, threads, ranks)()
                                : Explainer<4>(scene, threads, ranks)();
}

std::string explanation_text(const Explanation& explanation) {
    std::string text = formatted("%-26s %-4s %10s %10s %10s  %s\n", "term", "", "unknowns",
                                 "memory", "per step", "why");
    for (const Term& term : explanation.terms) {
        text +=
            formatted("%-26s %-4s %10s %10s %10s  ", term.name.c_str(), term.is_on ? "on" : "off",
                      term.is_on && term.unknowns > 0 ? std::to_string(term.unknowns).c_str() : "-",
                      term.is_on ? bytes_text(term.bytes).c_str() : "-",
                      term.is_on ? time_text(term.seconds).c_str() : "-")
            + term.why + "\n";
    }
    text += "all: " + std::to_string(explanation.unknowns) + " unknowns, "
            + bytes_text(explanation.bytes) + ", " + time_text(explanation.seconds_per_step)
            + " a step (measured on one), about " + time_text(explanation.seconds)
            + " for the scene";
    for (const std::string& line : explanation.advice) {
        text += "\nnote: " + line;
    }
    return text;
}

}  // namespace pent::runs
