#include "law_scene.h"
#include "physics_laws.h"

#include <pent/formatted.h>

#include <algorithm>
#include <cmath>

namespace pent::scene_fuzz {

namespace {

using namespace simulator;

template <int Dim>
class SleepLaw {
public:
    explicit SleepLaw(const Scene& scene)
        : scene_(scene),
          awake_scene_(awake(scene)),
          sleeping_(scene, read_meshes<Dim>(scene)),
          awake_(awake_scene_, read_meshes<Dim>(scene)) {}

    void run() {
        bool has_slept = false;
        for (int k = 1; k <= step_count(scene_); ++k) {
            const StepReport report = sleeping_.step();
            const StepReport other = awake_.step();
            if (report.is_accepted != other.is_accepted && !has_slept) {
                throw BrokenLaw(formatted("step %d is taken only by one of the two", k));
            }
            if (!report.is_accepted || !other.is_accepted) {
                return;
            }
            if (has_slept) {
                compare_places(k);
                continue;
            }
            has_slept = report.asleep > 0;
            compare_exactly(k, report, other);
        }
    }

private:
    static Scene awake(Scene scene) {
        scene.sleep.reset();
        return scene;
    }

    // No body sleeps, or one has just fallen asleep where it is.
    void compare_exactly(int step, const StepReport& report, const StepReport& other) const {
        for (int body = 0; body < sleeping_.body_count(); ++body) {
            if (sleeping_.positions(body) != awake_.positions(body)) {
                throw BrokenLaw(
                    formatted("body %d is elsewhere at step %d, before any slept", body, step));
            }
            const Positions<Dim> forces = sleeping_.contact_forces(body);
            const Positions<Dim> others = awake_.contact_forces(body);
            const double difference = (forces - others).norm();
            if (difference > 1e-9 * others.norm()) {
                throw BrokenLaw(
                    formatted("forces of contact on body %d are %.4g N with sleep, %.4g N"
                              " without, at step %d where %d bodies fall asleep",
                              body, forces.norm(), others.norm(), step, report.asleep));
            }
        }
        const double energy = report.energies.of("contact") + report.energies.of("obstacle");
        const double expected = other.energies.of("contact") + other.energies.of("obstacle");
        if (std::abs(energy - expected) > 1e-9 * std::abs(expected)) {
            throw BrokenLaw(
                formatted("the energy of contact is %.4g J with sleep, %.4g J without, at"
                          " step %d where %d bodies fall asleep",
                          energy, expected, step, report.asleep));
        }
    }

    // What was at rest for n steps at less than `speed` is accelerated by less than speed / (n h),
    // which moves it by speed T (1 + T / (2 n h)) in a time T. Three times that, for forces that
    // grow. This says nothing of what has just been let go, and of rest that lasts less than three
    // steps.
    void compare_places(int step) const {
        const double h = scene_.dt();
        const double quiet = std::ceil(scene_.sleep->time / h - 1e-6);
        if (quiet < 3) {
            return;
        }
        const double time = step_count(scene_) * h;
        for (int body = 0; body < sleeping_.body_count(); ++body) {
            const double speed = scene_.sleep->speed * largest_;
            const double allowed =
                3 * speed * time * (1 + time / (2 * quiet * h)) + 1e-3 * largest_;
            const double off =
                (sleeping_.positions(body) - awake_.positions(body)).colwise().norm().maxCoeff();
            if (!(off <= allowed)) {
                throw BrokenLaw(
                    formatted("body %d is %.3g m from where it is without sleep, at step"
                              " %d; allowed are %.3g m",
                              body, off, step, allowed));
            }
        }
    }

    const Scene& scene_;
    Scene awake_scene_;
    Simulation<Dim> sleeping_;
    Simulation<Dim> awake_;
    double largest_ = extent_of(sleeping_);
};

}  // namespace

void check_sleep(const Scene& scene) {
    // What comes, goes, breaks or moves from outside.
    const auto has_any = [](const auto& parts, const auto& is) {
        return std::any_of(parts.begin(), parts.end(), is);
    };
    const auto comes_or_goes = [](const auto& part) { return part.from > 0 || part.to < kForever; };
    const bool is_changing =
        has_any(scene.loads, [](const Load& load) { return !load.keyframes.empty(); })
        || has_any(scene.activations,
                   [](const simulator::Activation& one) {
                       return one.signal != simulator::Signal::Constant || !one.keyframes.empty();
                   })
        || has_any(scene.constraints, comes_or_goes) || has_any(scene.attachments, comes_or_goes)
        || has_any(
            scene.attachments,
            [](const Attachment& one) { return !one.motion.empty() || one.break_force < kForever; })
        || has_any(scene.obstacles,
                   [](const simulator::Obstacle& one) { return !one.motion.empty(); });
    if (scene.sleep && !is_changing) {
        in_dimension(
            scene, [&] { SleepLaw<3>(scene).run(); }, [&] { SleepLaw<4>(scene).run(); });
    }
}

}  // namespace pent::scene_fuzz
