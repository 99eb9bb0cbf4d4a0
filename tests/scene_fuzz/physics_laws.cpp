#include "physics_laws.h"

#include "law_scene.h"
#include "support/crossing_checker.h"

#include <pent/formatted.h>
#include <pent/simulator/crossing_error.h>
#include <pent/simulator/seen_pairs.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <optional>

namespace pent::scene_fuzz {

namespace {

using namespace simulator;

template <int Dim>
Positions<Dim> impulses(const Simulation<Dim>& simulation) {
    return of_all(simulation, [&](int body) -> Positions<Dim> {
        return simulation.velocities(body) * simulation.masses(body).asDiagonal();
    });
}

template <int Dim>
double total_mass(const Simulation<Dim>& simulation) {
    double sum = 0;
    for (int body = 0; body < simulation.body_count(); ++body) {
        sum += simulation.masses(body).sum();
    }
    return sum;
}

template <int Dim>
std::string text_of(const Eigen::Matrix<double, Dim, 1>& vector) {
    std::string text;
    for (int axis = 0; axis < Dim; ++axis) {
        text += formatted(axis == 0 ? "(%.3g" : ", %.3g", vector[axis]);
    }
    return text + ")";
}

// Of forces about a point, in all planes.
template <int Dim>
Eigen::Matrix<double, Dim, Dim> moment(const Positions<Dim>& arms, const Positions<Dim>& forces) {
    const Eigen::Matrix<double, Dim, Dim> product = arms * forces.transpose();
    return product - product.transpose();
}

bool has_friction(const Scene& scene) {
    return (scene.contact && scene.contact->friction > 0)
           || std::any_of(scene.bodies.begin(), scene.bodies.end(), [](const Body& body) {
                  return std::isfinite(body.friction) && body.friction > 0;
              });
}

// From the mean of all vertices.
template <int Dim>
Positions<Dim> arms_of(const Simulation<Dim>& simulation) {
    const Positions<Dim> places =
        of_all(simulation, [&](int body) -> Positions<Dim> { return simulation.positions(body); });
    return places.colwise() - Eigen::Matrix<double, Dim, 1>(places.rowwise().mean());
}

// How far beside one another both forces of a pair may act, m: in valleys of a penalty whose
// nearest points are within an edge, see docs/contact.md.
double lever(const Scene& scene) {
    constexpr double kPartOfDistance = 1e-3;
    return scene.contact && scene.contact->model == ContactModel::Penalty
               ? kPartOfDistance * scene.contact->distance
               : 0;
}

// ---------------------------------------------------------------------------------------- momentum

// The elastic and contact forces add up to zero, so of a step's equations summed over all vertices
// only what is left unsolved stays: |sum| <= sqrt(vertices) |residual|, the residual being the
// reported part of what the step started with, h |M v| + h^2 |f| at most. Twice that, since BDF2
// carries an error on with 4/3 of it less 1/3, and twice again for parts of a step that are
// measured at its start alone.
constexpr double kMomentumFactor = 4;

// Corrections below this are not made, m: a part of the extent, and with a barrier of its distance.
double smallest_correction(const Scene& scene, double extent) {
    constexpr double kNegligible = 1e-10;  // see potential.h
    const bool has_barrier = scene.contact && scene.contact->model == ContactModel::Barrier;
    return std::max(kNegligible * extent,
                    has_barrier ? scene.solver.newton_tolerance * scene.contact->distance : 0);
}

// What is left unsolved of a step, as a part of what it started with. A step that reaches the
// tolerance may leave all of that.
double unsolved(const Scene& scene, const StepReport& report) {
    return scene.solver.integrator == Integrator::LinearEuler
               ? report.residual
               : std::max(report.unbalanced, scene.solver.newton_tolerance);
}

template <int Dim>
Positions<Dim> forces_of(const Simulation<Dim>& simulation) {
    return of_all(simulation, [&](int body) -> Positions<Dim> { return simulation.forces(body); });
}

// What a step starts with are the forces at its start by the activations at its end, which may have
// jumped. A simulation without contact, which would look at the obstacles of another time, has
// their difference from the forces before.
template <int Dim>
class ActivationJump {
public:
    explicit ActivationJump(Scene scene) {
        if (!scene.activations.empty()) {
            scene.contact.reset();
            scene.obstacles.clear();
            probe_.emplace(scene, read_meshes<Dim>(scene), SimulationOptions{.isa = "scalar"});
        }
    }

    double of_next_step(Snapshot<Dim> state) {
        if (!probe_) {
            return 0;
        }
        state.contact_stiffness = 0;
        probe_->restore(state);
        const Positions<Dim> before = forces_of(*probe_);
        ++state.steps;
        probe_->restore(state);
        return (forces_of(*probe_) - before).norm();
    }

private:
    std::optional<Simulation<Dim>> probe_;
};

// Bodies, gravity and what bodies do to one another, by energies that no turn changes: in a step of
// Newton's method, whose forces are those at its end, they have no moment. Solved tightly, as what
// may be left unsolved is a part of all that moves.
Scene left_alone(Scene scene) {
    scene.obstacles.clear();
    scene.constraints.clear();
    scene.loads.clear();
    scene.attachments.clear();
    scene.damping.reset();
    scene.solver.integrator = Integrator::NewtonEuler;
    scene.solver.newton_tolerance = 1e-8;
    if (scene.contact) {
        scene.contact->friction = 0;
    }
    const auto turn_freely = [](Material& material) {
        material.model = material.model == Model::Linear ? Model::Arap : material.model;
    };
    for (Body& body : scene.bodies) {
        body.friction = std::numeric_limits<double>::infinity();
        turn_freely(body.material);
        for (Region& region : body.regions) {
            turn_freely(region.material);
        }
    }
    return scene;
}

// What a step has changed of the momentum of each vertex turns nothing about where they are in the
// end, as the forces there do not.
template <int Dim>
void check_moment(const Simulation<Dim>& simulation,
                  const Positions<Dim>& impulses_before,
                  double unsolved_momentum,
                  int step) {
    const Scene& scene = simulation.scene();
    const Eigen::Matrix<double, Dim, 1> fallen = scene.dt() * scene.gravity;
    Positions<Dim> changes = of_all(simulation, [&](int body) -> Positions<Dim> {
        const auto velocities = simulation.velocities(body);
        return (velocities.colwise() - fallen) * simulation.masses(body).asDiagonal();
    });
    changes -= impulses_before;
    const Positions<Dim> arms = arms_of(simulation);
    const double turning = moment<Dim>(arms, changes).norm();
    const double longest = arms.colwise().norm().maxCoeff();
    const double pressed = contact_forces_of(simulation).colwise().norm().sum();
    const double allowed = 2 * unsolved_momentum * longest + scene.dt() * pressed * lever(scene);
    if (!(turning <= allowed)) {
        throw BrokenLaw(formatted("step %d turns all by %.3g kg m^2/s; allowed are %.3g", step,
                                  turning, allowed));
    }
}

template <int Dim>
void check_momentum_in(Scene scene, bool has_moment) {
    scene.sleep.reset();
    scene.solver.precision =
        Precision::Double;  // rounding of a float matrix is not in the residual
    Simulation<Dim> simulation(scene, read_meshes<Dim>(scene), {.isa = "scalar"});
    ActivationJump<Dim> jump(scene);
    const Eigen::Matrix<double, Dim, 1> gravity = scene.gravity;
    const double mass = total_mass(simulation);
    const double h = scene.dt();
    const Eigen::Matrix<double, Dim, 1> start = impulses(simulation).rowwise().sum();
    double moved = impulses(simulation).colwise().norm().sum();
    double allowed = 0;
    for (int k = 1; k <= step_count(scene); ++k) {
        const Positions<Dim> forces = forces_of(simulation);
        const Positions<Dim> before = impulses(simulation);
        const double size = impulses(simulation).norm()
                            + h * (forces.norm() + jump.of_next_step(simulation.save()));
        const StepReport report = simulation.step();
        if (!report.is_accepted) {
            return;
        }
        moved = std::max(moved, impulses(simulation).colwise().norm().sum());
        const double of_step = kMomentumFactor * std::sqrt(static_cast<double>(forces.cols()))
                                   * report.substeps * unsolved(scene, report) * size
                               + mass * smallest_correction(scene, extent_of(simulation)) / h;
        allowed += of_step;
        const Eigen::Matrix<double, Dim, 1> error =
            impulses(simulation).rowwise().sum() - start - mass * report.time * gravity;
        const double rounding = 1e-12 * (moved + mass * report.time * gravity.norm());
        if (!(error.norm() <= allowed + rounding)) {
            throw BrokenLaw("the momentum is off by " + text_of<Dim>(error)
                            + formatted(" kg m/s at step %d, of %.3g that move; allowed are %.3g",
                                        k, moved, allowed + rounding));
        }
        if (!has_moment && report.substeps == 1) {
            check_moment(simulation, before, of_step + rounding, k);
        }
    }
}

// ---------------------------------------------------------------------------------------- reaction

template <int Dim>
void check_reaction_in(const Scene& scene) {
    Simulation<Dim> simulation(scene, read_meshes<Dim>(scene), {.isa = "baseline"});
    for (int k = 1; k <= step_count(scene) && simulation.step().is_accepted; ++k) {
        const Positions<Dim> forces = contact_forces_of(simulation);
        // Weights of a pair add up to zero but for rounding; a held or fixed point takes its share
        // too.
        const double error = forces.rowwise().sum().norm();
        const double most = forces.colwise().norm().sum();
        if (!(error <= 1e-9 * most)) {
            throw BrokenLaw(formatted("the forces of contact add up to %.3g N of %.3g N at step %d",
                                      error, most, k));
        }
        const Positions<Dim> arms = arms_of(simulation);
        const double turning = moment<Dim>(arms, forces).norm();
        const double longest = arms.colwise().norm().maxCoeff();
        if (!has_friction(scene) && !(turning <= most * (1e-9 * longest + lever(scene)))) {
            throw BrokenLaw(
                formatted("the forces of contact have a moment of %.3g N m, of %.3g N"
                          " over %.3g m, at step %d",
                          turning, most, longest, k));
        }
    }
}

// --------------------------------------------------------------------------------------- crossings

template <int Dim>
double signed_distance(const pent::ObstacleShape<Dim>& shape,
                       const Eigen::Matrix<double, Dim, 1>& point) {
    struct Distance {
        const Eigen::Matrix<double, Dim, 1>& x;
        double operator()(const HalfSpace<Dim>& plane) const {
            return plane.normal.dot(x) - plane.offset;
        }
        double operator()(const Ball<Dim>& ball) const {
            return (x - ball.center).norm() - ball.radius;
        }
        double operator()(const Cavity<Dim>& cavity) const {
            return cavity.radius - (x - cavity.center).norm();
        }
        double operator()(
            const Bowl<Dim>& bowl) const {  // outside the ground, in the hole or above it
            const double inside = bowl.radius - (x - bowl.center).norm();
            return std::max(bowl.up.dot(x - bowl.center), inside);
        }
        double operator()(const Cuboid<Dim>& box) const {  // right inside, and outside in its sign
            return ((box.axes.transpose() * (x - box.center)).cwiseAbs() - 0.5 * box.sides)
                .maxCoeff();
        }
    };
    return std::visit(Distance{point}, shape);
}

template <int Dim>
class Watch {
public:
    explicit Watch(const Scene& scene)
        : scene_(scene),
          simulation_(
              scene, read_meshes<Dim>(scene), {.on_iterate = [this](const auto& x, bool is_start) {
                  look_at_way(x, is_start);
              }}) {
        std::uint32_t first = 0;
        for (int body = 0; body < simulation_.body_count(); ++body) {
            const SimplexMesh<Dim>& mesh = simulation_.mesh(body);
            surfaces_.push_back(contact::make_surface<Dim>(mesh.cells, mesh.vertex_count(), first));
            first += static_cast<std::uint32_t>(mesh.vertex_count());
        }
    }

    void run() {
        for (int k = 1; k <= step_count(scene_); ++k) {
            if (!simulation_.step().is_accepted) {
                return;
            }
            const Positions<Dim> now = of_all(simulation_, [&](int body) -> Positions<Dim> {
                return simulation_.positions(body);
            });
            require(count([&](const auto& a, const auto& b) {
                        return test::count_crossings<Dim>(a, b, now);
                    }) == 0,
                    "bodies cross", k);
            require(!is_in_obstacle(now), "a vertex is inside an obstacle", k);
        }
    }

private:
    using Surface = contact::Surface<Dim>;

    void look_at_way(const Eigen::MatrixXd& positions, bool is_start) {
        const Positions<Dim> now = positions;
        if (!is_start) {
            require(count([&](const auto& a, const auto& b) {
                        return test::count_swept_crossings<Dim>(a, b, last_, now);
                    }) == 0,
                    "bodies cross on their way", static_cast<int>(simulation_.step_count()) + 1);
        }
        last_ = now;
    }

    template <typename Count>
    int count(const Count& of_pair) const {
        const simulator::SeenPairs seen(scene_);
        int sum = 0;
        for (std::size_t a = 0; a < surfaces_.size(); ++a) {
            for (std::size_t b = a; b < surfaces_.size(); ++b) {
                sum += seen.may_touch(a, b) ? of_pair(surfaces_[a], surfaces_[b]) : 0;
            }
        }
        return sum;
    }

    // Held vertices go where the scene says.
    // What is held for good may go there, and inner vertices where cells are inside out.
    bool is_in_obstacle(const Positions<Dim>& positions) const {
        const bool is_any_held_for_good = std::any_of(
            scene_.constraints.begin(), scene_.constraints.end(),
            [](const Constraint& held) { return held.from == 0 && held.to == kForever; });
        for (const pent::ObstacleShape<Dim>& obstacle : simulation_.obstacles()) {
            for (std::size_t s = 0; s < surfaces_.size() && !is_any_held_for_good; ++s) {
                for (const std::uint32_t v : surfaces_[s].vertices.reshaped()) {
                    if (signed_distance<Dim>(obstacle, positions.col(v)) <= 0) {
                        return true;
                    }
                }
            }
        }
        return false;
    }

    static void require(bool holds, const char* what, int step) {
        if (!holds) {
            throw BrokenLaw(std::string(what) + " at step " + std::to_string(step));
        }
    }

    const Scene& scene_;
    Positions<Dim> last_;
    std::vector<Surface> surfaces_;
    Simulation<Dim> simulation_;
};

}  // namespace

void check_momentum(const Scene& scene) {
    const auto check = [](const Scene& one, bool has_moment) {
        in_dimension(
            one, [&] { check_momentum_in<3>(one, has_moment); },
            [&] { check_momentum_in<4>(one, has_moment); });
    };
    const bool hangs = std::any_of(scene.attachments.begin(), scene.attachments.end(),
                                   [](const Attachment& one) { return one.target.empty(); });
    const bool is_free = scene.obstacles.empty() && scene.constraints.empty() && scene.loads.empty()
                         && !hangs && (!scene.damping || scene.damping->mass == 0);
    if (is_free && scene.solver.integrator != Integrator::Quasistatic) {
        check(scene, true);
    }
    try {
        check(left_alone(scene), false);
    } catch (const CrossingError<3>&) {  // what is held may cross
    } catch (const CrossingError<4>&) {
    }
}

void check_reaction(const Scene& scene) {
    if (scene.contact && scene.obstacles.empty()) {
        in_dimension(
            scene, [&] { check_reaction_in<3>(scene); }, [&] { check_reaction_in<4>(scene); });
    }
}

void check_crossings(const Scene& scene) {
    if (scene.contact && scene.contact->model == ContactModel::Barrier) {
        in_dimension(
            scene, [&] { Watch<3>(scene).run(); }, [&] { Watch<4>(scene).run(); });
    }
}

}  // namespace pent::scene_fuzz
