#include "scene_names.h"

#include <pent/facets.h>
#include <pent/pent_file.h>
#include <pent/simulator/explain.h>
#include <pent/simulator/simulation.h>

#include <Eigen/Geometry>

#include <algorithm>
#include <cmath>
#include <cstdarg>
#include <cstdio>
#include <numbers>

namespace pent::simulator {

namespace {

std::string format(const char* form, ...) __attribute__((format(printf, 1, 2)));

std::string format(const char* form, ...) {
    char text[512];
    va_list values;
    va_start(values, form);
    std::vsnprintf(text, sizeof text, form, values);
    va_end(values);
    return text;
}

// "1.2 ms", "3.4 s"; "-" for nothing.
std::string time_text(double seconds) {
    if (seconds <= 0) {
        return "-";
    }
    return seconds < 1 ? format("%.3g ms", 1e3 * seconds) : format("%.3g s", seconds);
}

std::string bytes_text(std::int64_t bytes) {
    return bytes == 0 ? "-" : format("%.3g MB", 1e-6 * static_cast<double>(bytes));
}

// Bend of a beam so many cells thick over that of theory, for the materials between; see
// docs/accuracy.md, which measures them.
struct Locking {
    int cells;
    double at_0;
    double at_028;
    double at_032;
};
constexpr Locking kLocking[] = {{2, 0.57, 0.44, 0.25}, {4, 0.84, 0.72, 0.52}};

template <int Dim>
class Explainer {
public:
    Explainer(const Scene& scene, int threads)
        : scene_(scene), simulation_(scene, meshes_of(scene), {.threads = threads}) {
        for (int body = 0; body < simulation_.body_count(); ++body) {
            start_.push_back(box_of(simulation_.positions(body)));
        }
        step_ = simulation_.step();
        size_ = simulation_.size();
    }

    Explanation operator()() {
        result_.unknowns = Dim * size_.free_vertices;
        result_.bytes = size_.bytes;
        result_.seconds_per_step = step_.seconds;
        result_.seconds = step_.seconds * scene_.frames * scene_.steps_per_frame;
        inertia();
        elasticity();
        gravity_and_damping();
        constraints();
        contact();
        solver();
        if (!step_.is_accepted) {
            advise("the first step fails: " + step_.failure);
        }
        for (const std::string& warning : simulation_.warnings()) {
            advise(warning);
        }
        advise_on_bending();
        advise_on_what_is_missing();
        advise_on_what_is_idle();
        return std::move(result_);
    }

private:
    using Box = Eigen::AlignedBox<double, Dim>;

    static std::vector<SimplexMesh<Dim>> meshes_of(const Scene& scene) {
        std::vector<SimplexMesh<Dim>> meshes;
        for (const Body& body : scene.bodies) {
            meshes.push_back(read_mesh<Dim>(body.mesh).mesh);
        }
        return meshes;
    }

    template <typename Points>
    static Box box_of(const Points& positions) {
        return {positions.rowwise().minCoeff(), positions.rowwise().maxCoeff()};
    }

    void add(Term term) { result_.terms.push_back(std::move(term)); }
    void advise(std::string line) { result_.advice.push_back(std::move(line)); }
    [[nodiscard]] bool is_quasistatic() const {
        return scene_.solver.integrator == Integrator::Quasistatic;
    }

    // Whether everything of a body is held, and so nothing of it is solved for.
    [[nodiscard]] bool is_kinematic(const Body& body) const {
        return std::ranges::any_of(scene_.constraints, [&](const Constraint& constraint) {
            return constraint.body == body.name
                   && std::ranges::any_of(constraint.select, [](const Selection& select) {
                          return std::holds_alternative<EverythingSelection>(select);
                      });
        });
    }

    void inertia() {
        Term term{.name = "inertia", .is_on = !is_quasistatic()};
        const std::string word(word_of(kIntegrators, scene_.solver.integrator));
        term.why = term.is_on ? "integrator " + word + format(", dt = %.4g s", scene_.dt())
                              : "integrator quasistatic: every step is an equilibrium";
        term.unknowns = result_.unknowns;
        add(std::move(term));
    }

    void elasticity() {
        for (int i = 0; i < simulation_.body_count(); ++i) {
            const Body& body = scene_.bodies[static_cast<std::size_t>(i)];
            const YoungPoisson young = young_from_lame(Dim, body.material.lame);
            const double share = static_cast<double>(simulation_.mesh(i).cell_count())
                                 / static_cast<double>(std::max<std::int64_t>(size_.elements, 1));
            Term term{.name = "elasticity of " + body.name, .is_on = !is_kinematic(body)};
            if (term.is_on) {
                term.why = std::string(word_of(kModels, body.material.model))
                           + format(", young %.4g Pa, poisson %.3g, %lld cells", young.young,
                                    young.poisson,
                                    static_cast<long long>(  // NOLINT(google-runtime-int)
                                        simulation_.mesh(i).cell_count()));
                term.seconds = std::min(1.0, share) * step_.assembly_seconds;
            } else {
                term.why = "all of it is held: it moves as told, at no cost";
            }
            add(std::move(term));
        }
    }

    void gravity_and_damping() {
        const double g = scene_.gravity.norm();
        add({.name = "gravity",
             .is_on = g > 0,
             .why = g > 0 ? format("%.4g m/s^2", g) : "[scene] has no gravity"});
        const bool is_damped =
            scene_.damping && (scene_.damping->mass > 0 || scene_.damping->stiffness > 0);
        add({.name = "damping",
             .is_on = is_damped,
             .why = is_damped ? format("mass %.3g / s, stiffness %.3g s; implicit steps damp too",
                                       scene_.damping->mass, scene_.damping->stiffness)
                              : "no [damping]; implicit steps damp by themselves"});
    }

    void constraints() {
        const std::int64_t held = size_.vertices - size_.free_vertices;
        add({.name = "constraints",
             .is_on = held > 0,
             .why = held > 0 ? format("%lld of %lld vertices are held; they have no unknowns",
                                      static_cast<long long>(held),  // NOLINT(google-runtime-int)
                                      static_cast<long long>(        // NOLINT(google-runtime-int)
                                          size_.vertices))
                             : "no [[constraint]]"});
    }

    void contact() {
        const bool is_on = scene_.contact.has_value();
        const bool has_pairs = is_on && (scene_.bodies.size() > 1 || scene_.contact->self);
        const double for_pairs = has_pairs ? step_.contact.seconds : 0;
        add({.name = "contact between bodies",
             .is_on = is_on && scene_.bodies.size() > 1,
             .why = !is_on                      ? "no [contact]: bodies pass through one another"
                    : scene_.bodies.size() == 1 ? "there is one body"
                                                : contact_text(),
             .bytes = is_on ? size_.contact_bytes : 0,
             .seconds = for_pairs});
        add({.name = "contact within bodies",
             .is_on = is_on && scene_.contact->self,
             .why = is_on && scene_.contact->self ? "contact.self = true; time as above"
                    : is_on                       ? "contact.self = false"
                                                  : "no [contact]"});
        add({.name = "obstacles",
             .is_on = !scene_.obstacles.empty(),
             .why = scene_.obstacles.empty() ? "no [[obstacle]]"
                                             : format("%zu, penalty", scene_.obstacles.size()),
             .seconds = has_pairs ? 0 : step_.contact.seconds});
    }

    [[nodiscard]] std::string contact_text() const {
        return std::string(word_of(kContactModels, scene_.contact->model))
               + format(" within %.3g m; at the start %lld pairs touch", scene_.contact->distance,
                        static_cast<long long>(  // NOLINT(google-runtime-int)
                            step_.contact.point_facet + step_.contact.mixed));
    }

    void solver() {
        const SolverOptions& options = scene_.solver;
        const std::int64_t block =
            Dim * Dim * (options.precision == Precision::Float ? 4 : 8) + std::int64_t{4};
        add({.name = "linear solver",
             .is_on = size_.free_vertices > 0,
             .why =
                 (options.linear == LinearSolver::Direct
                      ? std::string("direct, ")
                      : std::string(word_of(kPreconditioners, options.preconditioner)) + ", ")
                 + std::string(word_of(kPrecisions, options.precision))
                 + format(" matrix, to %.1g: %d iterations", options.tolerance, step_.iterations),
             .unknowns = result_.unknowns,
             .bytes = size_.matrix_blocks * block,
             .seconds = step_.solve_seconds});
    }

    // Whether a body bends in this scene cannot be known; whether it would bend too little can.
    void advise_on_bending() {
        for (int i = 0; i < simulation_.body_count(); ++i) {
            const Body& body = scene_.bodies[static_cast<std::size_t>(i)];
            const int across = cells_across(simulation_.mesh(i));
            if (is_kinematic(body) || across > kLocking[1].cells) {
                continue;
            }
            const Locking& locking = across <= kLocking[0].cells ? kLocking[0] : kLocking[1];
            const double poisson = young_from_lame(Dim, body.material.lame).poisson;
            const double bend = poisson < 0.14   ? locking.at_0
                                : poisson < 0.30 ? locking.at_028
                                                 : locking.at_032;
            advise(format(
                "%s is at most %d %s thick: with poisson %.2g linear simplices lock, bending"
                " reaches about %.0f%% of what it should be; refine, or lower poisson",
                body.name.c_str(), across, across == 1 ? "cell" : "cells", poisson, 100 * bend));
        }
    }

    void advise_on_what_is_missing() {
        const bool is_falling = scene_.gravity.norm() > 0 && size_.free_vertices == size_.vertices
                                && scene_.obstacles.empty();
        if (is_falling) {
            const double time = scene_.frames / scene_.frames_per_second;
            advise(
                format("nothing is held and there is no obstacle: everything falls, %.3g m by the"
                       " end",
                       0.5 * scene_.gravity.norm() * time * time));
        }
        for (const Constraint& constraint : scene_.constraints) {
            for (const Motion& motion : constraint.motion) {
                for (const Spin& spin : motion.rotate) {
                    advise_on_spin(constraint, spin);
                }
            }
        }
        if (!scene_.contact) {
            for_near_pairs(0, [&](const Body& a, const Body& b, double /*gap*/) {
                advise("the boxes around " + a.name + " and " + b.name
                       + " overlap at the start, and there is no [contact]: they pass through one"
                         " another");
            });
        }
    }

    void advise_on_spin(const Constraint& constraint, const Spin& spin) {
        // One linear solve a step sees a rotation as its tangent: at 0.2 rad that is 2% too long.
        constexpr double kMostAngle = 0.2;
        const double angle = std::abs(spin.degrees_per_s) * scene_.dt() * std::numbers::pi / 180;
        if (scene_.solver.integrator == Integrator::LinearEuler && angle > kMostAngle) {
            advise(
                format("a constraint of %s turns %.3g degrees a step, far for linear_euler: take"
                       " %d steps_per_frame or newton_euler",
                       constraint.body.c_str(), angle * 180 / std::numbers::pi,
                       static_cast<int>(std::ceil(angle / kMostAngle)) * scene_.steps_per_frame));
        }
    }

    void advise_on_what_is_idle() {
        if (scene_.damping && scene_.damping->mass == 0 && scene_.damping->stiffness == 0) {
            advise("[damping] is all zero and could go");
        }
        if (!scene_.contact) {
            return;
        }
        if (scene_.bodies.size() == 1 && !scene_.contact->self) {
            advise("[contact] has nothing to do: there is one body, and self is false");
        }
        bool is_near = scene_.contact->self;
        double nearest = std::numeric_limits<double>::infinity();
        for_near_pairs(std::numeric_limits<double>::infinity(),
                       [&](const Body& /*a*/, const Body& /*b*/, double gap) {
                           nearest = std::min(nearest, gap);
                           is_near = is_near || gap <= scene_.contact->distance;
                       });
        if (!is_near && scene_.bodies.size() > 1) {
            advise(
                format("the boxes around the bodies are %.3g m apart at the start, contact begins"
                       " at %.3g m: if they never come nearer, [contact] could go",
                       nearest, scene_.contact->distance));
        }
    }

    // Pairs of bodies, not both kinematic, whose boxes are at most `most` apart at the start.
    template <typename Action>
    void for_near_pairs(double most, const Action& action) const {
        for (std::size_t a = 0; a < scene_.bodies.size(); ++a) {
            for (std::size_t b = a + 1; b < scene_.bodies.size(); ++b) {
                const double gap = start_[a].exteriorDistance(start_[b]);
                const bool can_move =
                    !is_kinematic(scene_.bodies[a]) || !is_kinematic(scene_.bodies[b]);
                if (can_move && gap <= most) {
                    action(scene_.bodies[a], scene_.bodies[b], gap);
                }
            }
        }
    }

    const Scene& scene_;
    Simulation<Dim> simulation_;
    std::vector<Box> start_;  // around each body at the start
    StepReport step_;
    SimulationSize size_;
    Explanation result_;
};

}  // namespace

template <int Dim>
int cells_across(const SimplexMesh<Dim>& mesh) {
    constexpr int kFar = std::numeric_limits<int>::max();
    std::vector<int> depth(static_cast<std::size_t>(mesh.vertex_count()), kFar);
    const auto facets = match_facets<Dim>(mesh.cells, mesh.vertex_count());
    for (const std::uint32_t vertex : facets.boundary.reshaped()) {
        depth[vertex] = 0;
    }
    // One pass over the cells takes the depth at least one edge further in.
    int deepest = 0;
    for (bool has_changed = true; has_changed;) {
        has_changed = false;
        for (Eigen::Index cell = 0; cell < mesh.cell_count(); ++cell) {
            int least = kFar;
            for (const std::uint32_t vertex : mesh.cells.col(cell)) {
                least = std::min(least, depth[vertex]);
            }
            for (const std::uint32_t vertex : mesh.cells.col(cell)) {
                if (least < kFar && depth[vertex] > least + 1) {
                    depth[vertex] = least + 1;
                    has_changed = true;
                }
            }
        }
    }
    for (const int edges : depth) {
        deepest = edges < kFar ? std::max(deepest, edges) : deepest;
    }
    return std::max(1, 2 * deepest);
}

template int cells_across<3>(const SimplexMesh<3>&);
template int cells_across<4>(const SimplexMesh<4>&);

Explanation explain(const Scene& scene, int threads) {
    check(scene);
    return scene.dimension == 3 ? Explainer<3>(scene, threads)() : Explainer<4>(scene, threads)();
}

std::string explanation_text(const Explanation& explanation) {
    std::string text = format("%-26s %-4s %10s %10s %10s  %s\n", "term", "", "unknowns", "memory",
                              "per step", "why");
    for (const Term& term : explanation.terms) {
        text +=
            format("%-26s %-4s %10s %10s %10s  ", term.name.c_str(), term.is_on ? "on" : "off",
                   term.is_on && term.unknowns > 0 ? std::to_string(term.unknowns).c_str() : "-",
                   term.is_on ? bytes_text(term.bytes).c_str() : "-",
                   term.is_on ? time_text(term.seconds).c_str() : "-")
            + term.why + "\n";
    }
    text += format("all: %lld unknowns, %s, %s a step (measured on one), about ",
                   static_cast<long long>(explanation.unknowns),  // NOLINT(google-runtime-int)
                   bytes_text(explanation.bytes).c_str(),
                   time_text(explanation.seconds_per_step).c_str())
            + time_text(explanation.seconds) + " for the scene";
    for (const std::string& line : explanation.advice) {
        text += "\nnote: " + line;
    }
    return text;
}

}  // namespace pent::simulator
