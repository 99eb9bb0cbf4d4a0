#include "explain/advice.h"

#include <pent/counted.h>
#include <pent/formatted.h>
#include <pent/runs/explain.h>
#include <pent/simulator/words.h>

#include <algorithm>
#include <cmath>
#include <iterator>
#include <sys/resource.h>
#include <utility>

namespace pent::runs {

namespace {

using Terms = std::vector<Term>;

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

template <typename Choice>
std::string word(Choice choice) {
    return std::string(simulator::word_of(choice));
}

Term on(const std::string& name, const std::string& why) {
    return {.name = name, .is_on = true, .why = why};
}

Term off(const std::string& name, const std::string& why) {
    return {.name = name, .is_on = false, .why = why};
}

std::int64_t unknowns_of(const Trial& trial) {
    return trial.scene.dimension * trial.size.free_vertices;
}

Terms inertia(const Trial& trial) {
    const Scene& scene = trial.scene;
    if (scene.solver.integrator == Integrator::Quasistatic) {
        return {off("inertia", "integrator quasistatic: every step is an equilibrium")};
    }
    const int scalars = scene.dimension + 1;  // velocity and mass
    return {{.name = "inertia",
             .is_on = true,
             .why = "integrator " + word(scene.solver.integrator)
                    + formatted(", dt = %.4g s", scene.dt()),
             .unknowns = unknowns_of(trial),
             .bytes = scalars * static_cast<std::int64_t>(sizeof(double)) * trial.size.vertices}};
}

Terms elasticity(const Trial& trial) {
    const Scene& scene = trial.scene;
    std::int64_t all_cells = 0;  // of bodies that are solved for
    for (const TrialBody& body : trial.bodies) {
        all_cells += body.is_kinematic() ? 0 : body.cells;
    }
    Terms terms;
    for (std::size_t i = 0; i < scene.bodies.size(); ++i) {
        const Body& body = scene.bodies[i];
        const TrialBody& tried = trial.bodies[i];
        const std::string name = "elasticity of " + body.name;
        if (tried.is_kinematic()) {
            terms.push_back(off(name, "all of it is held: it moves as told, at no cost"));
            continue;
        }
        const YoungPoisson young = young_from_lame(scene.dimension, body.material.lame);
        const double share = static_cast<double>(tried.cells) / static_cast<double>(all_cells);
        const double bytes = share * static_cast<double>(trial.size.element_bytes);
        terms.push_back(
            {.name = name,
             .is_on = true,
             .why = word(body.material.model)
                    + formatted(", young %.4g Pa, poisson %.3g, ", young.young, young.poisson)
                    + counted(tried.cells, "cell", "cells") + ", "
                    + (body.regions.empty() ? ""
                                            : counted(body.regions.size(), "region of its own",
                                                      "regions of their own")
                                                  + ", ")
                    + word(scene.solver.elements) + ", filter " + word(scene.solver.filter),
             .unknowns = scene.dimension * tried.free_vertices,
             .bytes = static_cast<std::int64_t>(bytes),
             .seconds = share * trial.step.assembly_seconds});
    }
    return terms;
}

Terms gravity(const Trial& trial) {
    const double g = trial.scene.gravity.norm();
    return {g > 0 ? on("gravity", formatted("%.4g m/s^2", g))
                  : off("gravity", "[scene] has no gravity")};
}

// Newton's method keeps the tangent of a step as a matrix of its own, assembled once; a single
// linear solve has it in its matrix anyway.
Terms damping(const Trial& trial) {
    const Scene& scene = trial.scene;
    const StepReport& step = trial.step;
    const Damping damping = scene.damping.value_or(Damping{});
    if (damping.mass == 0 && damping.stiffness == 0) {
        return {off("damping", scene.damping ? "[damping] is all zero"
                                             : "no [damping]; implicit steps damp by themselves")};
    }
    const double share = static_cast<double>(step.damping_hessians)
                         / static_cast<double>(std::max<std::int64_t>(step.hessians, 1));
    const std::int64_t scalars = step.damping_hessians > 0
                                     ? trial.size.matrix_blocks * scene.dimension * scene.dimension
                                     : 0;
    return {{.name = "damping",
             .is_on = true,
             .why = formatted("mass %.3g / s, stiffness %.3g s; implicit steps damp too",
                              damping.mass, damping.stiffness),
             .bytes = scalars * static_cast<std::int64_t>(sizeof(double)),
             .seconds = share * step.assembly_seconds}};
}

Terms constraints(const Trial& trial) {
    const std::int64_t held = trial.size.vertices - trial.size.free_vertices;
    return {held > 0 ? on("constraints",
                          std::to_string(held) + " of " + std::to_string(trial.size.vertices)
                              + " vertices are held in the first step; they have no unknowns")
                     : off("constraints", "no [[constraint]]")};
}

Terms loads(const Trial& trial) {
    Terms terms;
    for (const Load& load : trial.scene.loads) {
        std::string why = load.force.isZero(0) ? "" : formatted("force %.4g N", load.force.norm());
        if (load.pressure != 0) {
            why += (why.empty() ? "" : ", ")
                   + formatted("pressure %.4g N/m^%d", load.pressure, trial.scene.dimension - 1);
        }
        if (!load.keyframes.empty()) {
            why += ", with " + counted(load.keyframes.size(), "keyframe", "keyframes");
        }
        terms.push_back(on("load on " + load.body, why));
    }
    return terms;
}

Terms activations(const Trial& trial) {
    Terms terms;
    for (const Activation& one : trial.scene.activations) {
        const bool is_periodic =
            one.signal == simulator::Signal::Sine || one.signal == simulator::Signal::Pulses;
        terms.push_back(
            on("activation of " + one.body,
               (one.fibers == simulator::Fibers::None ? "growth" : "fibers " + word(one.fibers))
                   + formatted(", to %.3g of the length at rest", one.stretch)
                   + (one.preserves_volume ? ", volume preserved" : "") + ", " + word(one.signal)
                   + (is_periodic ? formatted(" of %.3g Hz", one.frequency) : "")));
    }
    return terms.empty() ? Terms{off("activations", "no [[activation]]")} : terms;
}

// Each with the stiffness of all its springs, which is what stays the same on another mesh.
Terms attachments(const Trial& trial) {
    Terms terms;
    for (std::size_t i = 0; i < trial.springs.size(); ++i) {
        const Attachment& one = trial.scene.attachments[i];
        const std::string points = one.motion.empty() ? "points in space" : "points that move";
        std::string why = counted(trial.springs[i], "vertex", "vertices") + " to "
                          + (one.target.empty() ? points : one.target)
                          + formatted(", %.4g N/m, all together %.4g N/m", one.stiffness,
                                      one.stiffness * static_cast<double>(trial.springs[i]));
        why += one.from > 0 ? formatted(", from %.4g s", one.from) : "";
        why += std::isfinite(one.to) ? formatted(", to %.4g s", one.to) : "";
        why +=
            std::isfinite(one.break_force) ? formatted(", breaks at %.4g N", one.break_force) : "";
        terms.push_back(on("attachment of " + one.body, why));
    }
    return terms.empty() ? Terms{off("attachments", "no [[attachment]]")} : terms;
}

std::string contact_text(const Trial& trial, std::int64_t pairs) {
    const ContactSettings& contact = *trial.scene.contact;
    return word(contact.model) + formatted(" within %.3g m; ", contact.distance)
           + counted(pairs, "pair touches", "pairs touch") + " after a step"
           + (contact.model == ContactModel::Barrier
                  ? ", " + time_text(trial.step.contact.ccd_seconds)
                        + " of the time to see that nothing crosses"
                  : "");
}

// Contact of all kinds is found and measured together: the first kind that is on has the cost.
Term contact_term(const Trial& trial,
                  const std::string& name,
                  const std::string& why,
                  bool is_first) {
    return {.name = name,
            .is_on = true,
            .why = why + (is_first ? "" : "; memory and time are above"),
            .bytes = is_first ? trial.size.contact_bytes : 0,
            .seconds = is_first ? trial.step.contact.seconds : 0};
}

Terms contact_between_bodies(const Trial& trial) {
    const std::string name = "contact between bodies";
    if (!trial.scene.contact) {
        return {off(name, "no [contact]: bodies pass through one another")};
    }
    if (trial.scene.bodies.size() == 1) {
        return {off(name, "there is one body")};
    }
    const ContactSummary& touches = trial.step.contact;
    return {contact_term(trial, name,
                         contact_text(trial, touches.point_facet + touches.mixed - touches.self),
                         true)};
}

Terms contact_within_bodies(const Trial& trial) {
    const std::string name = "contact within bodies";
    if (!trial.scene.contact) {
        return {off(name, "no [contact]")};
    }
    if (!trial.scene.contact->self) {
        return {off(name, "contact.self = false")};
    }
    return {contact_term(trial, name, contact_text(trial, trial.step.contact.self),
                         trial.scene.bodies.size() == 1)};
}

Terms obstacles(const Trial& trial) {
    const Scene& scene = trial.scene;
    if (scene.obstacles.empty()) {
        return {off("obstacles", "no [[obstacle]]")};
    }
    const auto moving = std::count_if(scene.obstacles.begin(), scene.obstacles.end(),
                                      [](const Obstacle& one) { return !one.motion.empty(); });
    const bool has_barrier = scene.contact && scene.contact->model == ContactModel::Barrier;
    return {
        contact_term(trial, "obstacles",
                     std::to_string(scene.obstacles.size())
                         + (moving > 0 ? ", of which " + std::to_string(moving) + " move, " : ", ")
                         + (has_barrier ? "barrier" : "penalty") + "; "
                         + counted(trial.step.contact.obstacle, "vertex touches", "vertices touch")
                         + " after a step, of " + std::to_string(trial.size.free_vertices),
                     !scene.contact || (scene.bodies.size() == 1 && !scene.contact->self))};
}

Terms friction(const Trial& trial) {
    const Scene& scene = trial.scene;
    if (!scene.contact && scene.obstacles.empty()) {
        return {off("friction", "no [contact] and no obstacles, which would have it")};
    }
    const ContactSettings contact = scene.contact.value_or(ContactSettings{});
    const auto count_own = [](const auto& parts) {
        return std::count_if(parts.begin(), parts.end(),
                             [](const auto& part) { return std::isfinite(part.friction); });
    };
    const auto own = count_own(scene.bodies) + count_own(scene.obstacles);
    if (contact.friction == 0 && own == 0) {
        return {off("friction", "no coefficient of [contact], a body or an obstacle")};
    }
    return {on("friction",
               formatted("coefficient %.3g, sticks below %.3g m/s; its time is that of contact",
                         contact.friction, contact.slip_speed)
                   + (own > 0 ? "; "
                                    + counted(own, "body or obstacle has its own",
                                              "bodies or obstacles have their own")
                              : ""))};
}

Terms sleeping(const Trial& trial) {
    const auto& sleep = trial.scene.sleep;
    if (!sleep) {
        return {off("sleeping", "no [sleep]: bodies at rest are solved for like all others")};
    }
    return {on("sleeping",
               formatted("a body that moves by less than %.3g of its size a second for %.3g s is"
                         " not solved for until something moves it",
                         sleep->speed, sleep->time))};
}

Terms solver(const Trial& trial) {
    const SolverOptions& options = trial.scene.solver;
    const bool is_direct = options.linear == LinearSolverKind::Direct;
    const StepReport& step = trial.step;
    return {{.name = "linear solver",
             .is_on = trial.size.free_vertices > 0,
             .why = (is_direct ? "direct, L L^T of a " : word(options.preconditioner) + ", ")
                    + word(options.precision) + " matrix"
                    + (is_direct ? ""
                                 : formatted(", to %.1g: %d iterations", options.tolerance,
                                             step.iterations))
                    + (step.newton_iterations > 0
                           ? formatted(", %d of Newton's method", step.newton_iterations)
                           : ""),
             .unknowns = unknowns_of(trial),
             .bytes = trial.size.matrix_bytes,
             .seconds = step.solve_seconds}};
}

Terms output(const Trial& trial) {
    const Output& output = trial.scene.output;
    std::string what;
    for (const VertexQuantity quantity : output.vertex) {
        what += ", " + word(quantity);
    }
    return {{.name = "output",
             .is_on = !output.vertex.empty() || output.contact_pairs || output.balance,
             .why = "positions, velocities" + what + " of every vertex, "
                    + (output.contact_pairs ? "pairs" : "no pairs") + " in contact, "
                    + (output.balance ? "" : "no ") + "energies and momenta of every step"}};
}

// What every rank has, and what they tell one another in a step.
Terms processes(const Trial& trial) {
    if (trial.ranks == nullptr) {
        return {};
    }
    rusage used = {};
    getrusage(RUSAGE_SELF, &used);
    const std::vector<double> own = {static_cast<double>(trial.size.own_vertices),
                                     static_cast<double>(trial.size.ghosts),
                                     1e-3 * static_cast<double>(used.ru_maxrss)};
    const auto count = static_cast<std::size_t>(trial.ranks->count());
    const std::vector<double> all =
        trial.ranks->gather(own, std::vector<std::int64_t>(count, std::ssize(own)));
    std::vector<double> most = own;
    for (std::size_t i = 0; i < all.size(); ++i) {
        most[i % own.size()] = std::max(most[i % own.size()], all[i]);
    }
    return {
        on("ranks",
           std::to_string(count)
               + formatted("; one has at most %.0f vertices of its own, %.0f ghosts and %.0f MB"
                           " in memory; a step takes %.0f messages and %.3g MB in all, and"
                           " %.0f times all wait for all",
                           most[0], most[1], most[2], static_cast<double>(trial.traffic.messages),
                           1e-6 * static_cast<double>(trial.traffic.bytes),
                           static_cast<double>(trial.traffic.reductions)))};
}

Terms terms_of(const Trial& trial) {
    Terms all;
    for (const auto part : {inertia, elasticity, gravity, damping, constraints, loads, activations,
                            attachments, contact_between_bodies, contact_within_bodies, obstacles,
                            friction, sleeping, solver, output, processes}) {
        Terms terms = part(trial);
        std::move(terms.begin(), terms.end(), std::back_inserter(all));
    }
    return all;
}

}  // namespace

Explanation explain(const Scene& scene,
                    int threads,
                    const std::shared_ptr<const simulator::Ranks>& ranks) {
    check(scene);
    const Trial trial = scene.dimension == 3 ? make_trial<3>(scene, threads, ranks)
                                             : make_trial<4>(scene, threads, ranks);
    return {.terms = terms_of(trial),
            .advice = advice(trial),
            .unknowns = unknowns_of(trial),
            .bytes = trial.size.bytes,
            .seconds_per_step = trial.step.seconds,
            .seconds = trial.step.seconds * scene.frames * scene.steps_per_frame};
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
