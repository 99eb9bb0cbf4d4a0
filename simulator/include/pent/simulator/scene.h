#pragma once

#include <pent/simulator/activation.h>
#include <pent/simulator/attachment.h>
#include <pent/simulator/body.h>
#include <pent/simulator/constraint.h>
#include <pent/simulator/contact_settings.h>
#include <pent/simulator/load.h>
#include <pent/simulator/obstacle.h>
#include <pent/simulator/output.h>
#include <pent/simulator/solver_options.h>

#include <Eigen/Core>

#include <cstdint>
#include <optional>
#include <string>
#include <vector>

namespace pent::simulator {

/// Rayleigh damping: C = mass M + stiffness K, K being the tangent at the start of a step.
struct Damping {
    double mass = 0;       ///< 1/s, >= 0.
    double stiffness = 0;  ///< s, >= 0.
};

/// Bodies at rest that are not solved for until something moves them.
///
/// A body falls asleep, its velocities set to zero, when for a while it and all it touches have
/// been slow, asleep, or held still. It wakes when its held vertices move, or when it touches what
/// moves.
struct Sleep {
    double speed = 1e-3;  ///< Of the fastest vertex, in diagonals of the box around the body a
                          ///< second, > 0: slower counts as at rest.
    double time = 0.5;    ///< s, > 0: how long a body has to be at rest.
};

/// What to simulate, as plain data. Every vector has `Scene::dimension` entries, axes x y z w.
///
/// read_scene() fills a Scene from a file and checks it; a host program may as well fill one
/// itself.
struct Scene {
    int dimension = 4;        ///< 3 or 4.
    Eigen::VectorXd gravity;  ///< m/s^2.
    int frames = 100;         ///< After frame 0, which is the start; > 0.
    double frames_per_second = 30;
    int steps_per_frame = 1;
    std::vector<Body> bodies;
    std::vector<Constraint> constraints;
    std::vector<Load> loads;
    std::vector<Activation> activations;
    std::vector<Attachment> attachments;
    std::vector<Obstacle> obstacles;
    /// Absent: bodies pass through one another, at no cost.
    std::optional<ContactSettings> contact;
    std::optional<Damping> damping;  ///< Absent: not modeled.
    std::optional<Sleep> sleep;      ///< Absent: all bodies are solved for all the time.
    SolverOptions solver;
    Output output;

    /// Length of a time step, s.
    [[nodiscard]] double dt() const { return 1.0 / (frames_per_second * steps_per_frame); }
};

/// The place of a body among those of a scene, which has one of this name.
[[nodiscard]] std::uint32_t index_of(const Scene& scene, const std::string& body);

/// Throws an Error that names the entry unless every number is in its range, vectors have the
/// scene's dimension, names are unique and valid, and constraints name bodies of the scene.
void check(const Scene& scene);

}  // namespace pent::simulator
