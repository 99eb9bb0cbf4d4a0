// What it costs that nothing can cross: the barrier against the penalty, on the same scenes in one run.
//
//     bench_barrier [--part FRACTION] [--frames N]
//
// The penalty takes the paper's steps with its integrator; the barrier takes one step a frame. Times are
// per simulated second.

#include "beams.h"

#include <pent/simulator/simulation.h>

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <cstdlib>
#include <string_view>
#include <thread>
#include <vector>

namespace pent::simulator::bench {
namespace {

struct Case {
    const char* name = "";
    Scene scene = {};
    std::vector<SimplexMesh<4>> meshes = {};
    int penalty_steps = 1;  // a frame
};

Body body(const char* name, const Eigen::Vector4d& at, const Eigen::Vector4d& velocity) {
    Body body;
    body.name = name;
    body.mesh = std::string(name) + ".pent";
    body.place.translate = at;
    body.material.lame = lame_from_young(4, 1e6, 0.28);
    body.velocity = velocity;
    return body;
}

// Two boxes pushed against each other face to face, a little aside: everything is in contact. The paper's
// hug takes 200 steps a second.
Case hug(double part) {
    const int length = std::max(2, static_cast<int>(std::lround(60 * part)));
    Case result{.name = "hug",
                .meshes = {box({length, 12, 3, 2}), box({length, 12, 3, 2})},
                .penalty_steps = 7};
    result.scene.bodies = {body("left", {0, 0, 0, 0}, {0, 0, 0, 0.5}),
                           body("right", {0.033, 0.021, 0.013, 0.22}, {0, 0, 0, -0.5})};
    result.scene.gravity = Eigen::Vector4d::Zero();
    result.scene.contact = Contact{.distance = 0.02, .stiffness = 3000};
    return result;
}

// Bars that fall crosswise upon one another onto the ground. The paper's noodles take 150 steps a second.
Case noodles(double part) {
    const int length = std::max(4, static_cast<int>(std::lround(40 * part)));
    Case result{.name = "noodles", .penalty_steps = 5};
    result.scene.gravity = Eigen::Vector4d(0, -9.8, 0, 0);
    for (int i = 0; i < 5; ++i) {
        const bool is_along_x = i % 2 == 0;
        result.meshes.push_back(is_along_x ? box({length, 2, 2, 2}) : box({2, 2, length, 2}));
        const double half = 0.05 * length;
        const char* const kNames[] = {"a", "b", "c", "d", "e"};
        result.scene.bodies.push_back(body(kNames[i],
                                           {is_along_x ? -half : 0.013 * i, 0.04 + 0.23 * i,
                                            is_along_x ? 0.017 * i : -half, 0.011 * i},
                                           {0, -0.5, 0, 0}));
    }
    result.scene.obstacles.push_back(
        {.shape = HalfSpaceObstacle{.normal = Eigen::Vector4d(0, 1, 0, 0)}, .stiffness = 3000});
    result.scene.contact = Contact{.distance = 0.02, .stiffness = 3000};
    return result;
}

struct Cost {
    double seconds = 0;       // per simulated second
    double ccd_share = 0;     // of all of it
    double newton = 0;        // iterations a step
    double smallest = 1e300;  // distance, m
    bool is_whole = true;
};

Cost run(Case scene, bool has_barrier, int frames, int threads) {
    scene.scene.frames_per_second = 30;
    scene.scene.steps_per_frame = has_barrier ? 1 : scene.penalty_steps;
    scene.scene.solver.tolerance = 1e-3;
    if (has_barrier) {
        scene.scene.contact->model = ContactModel::Barrier;
        scene.scene.solver.integrator = Integrator::NewtonEuler;
    }
    Simulation<4> simulation(scene.scene, scene.meshes, {.threads = threads});
    Cost cost;
    double ccd = 0;
    const int steps = frames * scene.scene.steps_per_frame;
    for (int k = 0; k < steps; ++k) {
        const StepReport report = simulation.step();
        cost.is_whole = cost.is_whole && report.is_accepted;
        cost.seconds += report.seconds;
        ccd += report.contact.ccd_seconds;
        cost.newton += static_cast<double>(report.newton_iterations) / steps;
        cost.smallest = std::min(cost.smallest, report.contact.smallest_distance);
    }
    cost.ccd_share = ccd / cost.seconds;
    cost.seconds *= 30.0 / frames;
    return cost;
}

int compare(double part, int frames) {
    const int threads = std::max(1, static_cast<int>(std::thread::hardware_concurrency()));
    std::printf("%-8s %10s | %12s | %12s %8s %8s %12s | %s\n", "scene", "pentachora",
                "penalty, s/s", "barrier, s/s", "newton", "ccd", "smallest, m", "ratio");
    for (const Case& scene : {hug(part), noodles(part)}) {
        const Cost penalty = run(scene, false, frames, threads);
        const Cost barrier = run(scene, true, frames, threads);
        Eigen::Index cells = 0;
        for (const SimplexMesh<4>& mesh : scene.meshes) {
            cells += mesh.cell_count();
        }
        std::printf("%-8s %10lld | %12.3g | %12.3g %8.1f %7.1f%% %12.3g | %.2f%s\n", scene.name,
                    static_cast<long long>(cells),  // NOLINT(google-runtime-int): for printf
                    penalty.seconds, barrier.seconds, barrier.newton, 100 * barrier.ccd_share,
                    barrier.smallest, barrier.seconds / penalty.seconds,
                    penalty.is_whole && barrier.is_whole ? "" : "  (not all steps taken)");
    }
    return 0;
}

}  // namespace
}  // namespace pent::simulator::bench

int main(int argc, char** argv) {
    double part = 1;
    int frames = 4;
    for (int i = 1; i + 1 < argc; i += 2) {
        const std::string_view option = argv[i];
        if (option == "--part") {
            part = std::atof(argv[i + 1]);
        } else if (option == "--frames") {
            frames = std::atoi(argv[i + 1]);
        }
    }
    return pent::simulator::bench::compare(part, frames);
}
