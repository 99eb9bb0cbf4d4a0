#include <pent/error.h>
#include <pent/number_bounds.h>
#include <pent/simulator/scene.h>
#include <pent/simulator/scene_checks.h>

#include <algorithm>
#include <cmath>

namespace pent::simulator {

namespace {

void require(bool holds, const std::string& message) {
    if (!holds) {
        throw Error(message);
    }
}

void check_vector(const Eigen::VectorXd& vector, int dimension, const std::string& what) {
    require(vector.size() == dimension && vector.allFinite(),
            what + " must be " + std::to_string(dimension) + " finite numbers");
}

void check_unit(const Eigen::VectorXd& normal, int dimension, const std::string& what) {
    check_vector(normal, dimension, what);
    require(std::abs(normal.norm() - 1) < 1e-9, what + " must have length 1");
}

void check_plane(const Plane& plane, int dimension, const std::string& what) {
    const auto is_axis = [&](int axis) { return axis >= 0 && axis < dimension; };
    require(is_axis(plane.from) && is_axis(plane.to) && plane.from != plane.to,
            what + ": a plane needs two different axes of the scene");
}

void check_spins(const std::vector<Spin>& spins, int dimension, const std::string& what) {
    for (const Spin& spin : spins) {
        check_plane(spin.plane, dimension, what);
        require(std::abs(spin.degrees_per_s) <= kMostDegrees,
                what + ": degrees_per_s must be at most 1e9 in size");
    }
}

bool is_name(const std::string& name) {
    constexpr std::size_t kLongest = 100;  // names of files have 255 bytes
    return !name.empty() && name.size() <= kLongest
           && std::all_of(name.begin(), name.end(), [](char c) {
                  return (c >= 'a' && c <= 'z') || (c >= 'A' && c <= 'Z') || (c >= '0' && c <= '9')
                         || c == '-' || c == '_';
              });
}

void check_body(const Body& body, int dimension) {
    require(is_name(body.name),
            "the body name \"" + body.name
                + "\" may have letters, digits, - and _ only, and at most 100 of them");
    const std::string what = "body \"" + body.name + "\"";
    require(is_size(body.place.scale), what + ": the scale must be from 1e-30 to 1e30");
    check_vector(body.place.translate, dimension, what + ": place.translate");
    if (body.velocity.size() > 0) {
        check_vector(body.velocity, dimension, what + ": velocity");
    }
    check_spins(body.spin, dimension, what);
    for (const Turn& turn : body.place.rotate) {
        check_plane(turn.plane, dimension, what);
        require(std::abs(turn.degrees) <= kMostDegrees,
                what + ": degrees must be at most 1e9 in size");
    }
    try {
        check(body.material, dimension);
    } catch (const Error& error) {
        throw Error(what + ": " + error.what());
    }
    require(is_size(body.material.density), what + ": the density must be from 1e-30 to 1e30");
}

struct SelectionChecker {
    int dimension;
    std::string what;

    void operator()(const BallSelection& ball) const {
        check_vector(ball.center, dimension, what + ": center");
        require(ball.radius > 0 && std::isfinite(ball.radius), what + ": radius must be above 0");
    }
    void operator()(const BoxSelection& box) const {
        check_vector(box.low, dimension, what + ": low");
        check_vector(box.high, dimension, what + ": high");
        require((box.low.array() <= box.high.array()).all(), what + ": low must be below high");
    }
    void operator()(const HalfSpaceSelection& half_space) const {
        check_unit(half_space.normal, dimension, what + ": normal");
        require(std::isfinite(half_space.offset), what + ": offset must be finite");
    }
    void operator()(const LayerSelection& layer) const {
        require(layer.first <= layer.last, what + ": the first layer is behind the last");
    }
    void operator()(const RegionSelection& /*region*/) const {}
    void operator()(const EverythingSelection& /*everything*/) const {}
};

void check_constraint(const Constraint& constraint, const Scene& scene) {
    const std::string what = "constraint on \"" + constraint.body + "\"";
    require(std::any_of(scene.bodies.begin(), scene.bodies.end(),
                        [&](const Body& body) { return body.name == constraint.body; }),
            what + ": no body has this name");
    require(!constraint.select.empty(), what + ": nothing is selected");
    for (const Selection& selection : constraint.select) {
        std::visit(SelectionChecker{scene.dimension, what}, selection);
    }
    for (const Motion& motion : constraint.motion) {
        check_vector(motion.translate, scene.dimension, what + ": motion.translate");
        check_spins(motion.rotate, scene.dimension, what);
        if (motion.about) {
            check_vector(*motion.about, scene.dimension, what + ": motion.about");
        }
        require(motion.from >= 0 && motion.to > motion.from, what + ": expected 0 <= from < to");
    }
}

void check_push(double distance, double stiffness, const std::string& what) {
    require(is_size(distance), what + ": distance must be from 1e-30 to 1e30");
    require(is_size(stiffness), what + ": stiffness must be from 1e-30 to 1e30");
}

void check_obstacle(const Obstacle& obstacle, int dimension) {
    pent::check<Eigen::Dynamic>(obstacle.shape, dimension, "obstacle");
    check_push(obstacle.distance, obstacle.stiffness, "obstacle");
}

void check_solver(const SolverOptions& solver) {
    require(solver.tolerance > 0 && solver.tolerance < 1, "solver: expected 0 < tolerance < 1");
    require(solver.newton_tolerance > 0 && solver.newton_tolerance < 1,
            "solver: expected 0 < newton_tolerance < 1");
    require(solver.max_iterations > 0, "solver: max_iterations must be above 0");
    require(solver.max_halvings >= 0 && solver.max_halvings <= 20,
            "solver: max_halvings must be from 0 to 20");
}

void check_contact(const Contact& contact, Integrator integrator) {
    check_push(contact.distance, contact.stiffness, "contact");
    require(contact.separation >= 0 && std::isfinite(contact.separation),
            "contact: separation must not be negative");
    require(contact.friction >= 0 && std::isfinite(contact.friction),
            "contact: friction must not be negative");
    require(contact.slip_speed > 0 && std::isfinite(contact.slip_speed),
            "contact: slip_speed must be above 0");
    check_model(contact.model, integrator);
}

void check_sleep(const Sleep& sleep, Integrator integrator) {
    require(sleep.speed > 0 && std::isfinite(sleep.speed), "sleep: speed must be above 0");
    require(sleep.time > 0 && sleep.time <= kLongestTime,
            "sleep: time must be above 0, at most 1e6");
    check_sleeping(integrator);
}

}  // namespace

void check_model(ContactModel model, Integrator integrator) {
    require(model != ContactModel::Barrier || integrator != Integrator::LinearEuler,
            "contact: the barrier model needs a solver that iterates, since one linear solve cannot"
            " keep bodies apart; use integrator = \"newton_euler\", or model = \"penalty\"");
}

void check_sleeping(Integrator integrator) {
    require(integrator != Integrator::Quasistatic,
            "sleep: the quasistatic integrator has no motion that could come to rest; leave [sleep]"
            " out");
}

void check_held(const Body& body, const Scene& scene) {
    const bool is_held = std::any_of(scene.constraints.begin(), scene.constraints.end(),
                                     [&](const Constraint& c) { return c.body == body.name; });
    require(is_held || scene.solver.integrator != Integrator::Quasistatic,
            "body \"" + body.name
                + "\" has no constraint: the quasistatic integrator needs every body held");
}

std::string plane_name(const Plane& plane) {
    constexpr std::string_view kAxes = "xyzw";
    return {kAxes[static_cast<std::size_t>(plane.from)], kAxes[static_cast<std::size_t>(plane.to)]};
}

void check(const Scene& scene) {
    require(scene.dimension == 3 || scene.dimension == 4, "the dimension must be 3 or 4");
    check_vector(scene.gravity, scene.dimension, "gravity");
    require(scene.frames > 0 && scene.steps_per_frame > 0,
            "frames and steps_per_frame must be above 0");
    require(scene.frames_per_second >= kLeastRate && scene.frames_per_second <= kMostRate,
            "frames_per_second must be from 1e-6 to 1e6");
    require(!scene.bodies.empty(), "the scene has no body");
    for (const Body& body : scene.bodies) {
        check_body(body, scene.dimension);
        require(std::count_if(scene.bodies.begin(), scene.bodies.end(),
                              [&](const Body& other) { return other.name == body.name; })
                    == 1,
                "two bodies have the name \"" + body.name + "\"");
    }
    for (const Constraint& constraint : scene.constraints) {
        check_constraint(constraint, scene);
    }
    for (const Obstacle& obstacle : scene.obstacles) {
        check_obstacle(obstacle, scene.dimension);
    }
    if (scene.contact) {
        check_contact(*scene.contact, scene.solver.integrator);
    }
    if (scene.damping) {
        require(scene.damping->mass >= 0 && scene.damping->stiffness >= 0,
                "damping: mass and stiffness must not be negative");
    }
    if (scene.sleep) {
        check_sleep(*scene.sleep, scene.solver.integrator);
    }
    check_solver(scene.solver);
    for (const Body& body : scene.bodies) {
        check_held(body, scene);
    }
}

}  // namespace pent::simulator
