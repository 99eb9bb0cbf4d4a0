// What it costs that nothing can cross: the barrier against the penalty, on the same scenes in one
// run.
//
//     bench_barrier [--part FRACTION] [--frames N] [--threads N] [SCENE.toml ...]
//
// Without a scene: two of boxes, like the paper's hug and noodles, at a part of their size. The
// penalty takes a scene's steps with its integrator; the barrier takes one step a frame. Frames of
// both take turns, so that other work on the machine slows both. Times are per simulated second, of
// the clock and of the processor.

#include "beams.h"

#include <pent/error.h>
#include <pent/pent_file.h>
#include <pent/runs/scene_file.h>
#include <pent/simulator/simulation.h>

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <cstdlib>
#include <ctime>
#include <string>
#include <string_view>
#include <thread>
#include <vector>

namespace pent::simulator::bench {
namespace {

struct Case {
    std::string name;
    Scene scene = {};
    std::vector<SimplexMesh<4>> meshes = {};
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

// Two boxes pushed against each other face to face, a little aside: everything is in contact. The
// paper's hug takes 200 steps a second.
Case hug(double part) {
    const int length = std::max(2, static_cast<int>(std::lround(60 * part)));
    Case result{.name = "hug", .meshes = {box({length, 12, 3, 2}), box({length, 12, 3, 2})}};
    result.scene.steps_per_frame = 7;
    result.scene.bodies = {body("left", {0, 0, 0, 0}, {0, 0, 0, 0.5}),
                           body("right", {0.033, 0.021, 0.013, 0.22}, {0, 0, 0, -0.5})};
    result.scene.gravity = Eigen::Vector4d::Zero();
    result.scene.contact = ContactSettings{.distance = 0.02, .stiffness = 3000};
    result.scene.solver.tolerance = 1e-3;
    return result;
}

// Bars that fall crosswise upon one another onto the ground. The paper's noodles take 150 steps a
// second.
Case noodles(double part) {
    const int length = std::max(4, static_cast<int>(std::lround(40 * part)));
    Case result{.name = "noodles"};
    result.scene.steps_per_frame = 5;
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
    result.scene.contact = ContactSettings{.distance = 0.02, .stiffness = 3000};
    result.scene.solver.tolerance = 1e-3;
    return result;
}

Case read_case(const std::string& path) {
    Case result{.name = path.substr(path.find_last_of('/') + 1), .scene = runs::read_scene(path)};
    for (const Body& body : result.scene.bodies) {
        result.meshes.push_back(read_mesh<4>(body.mesh).mesh);
    }
    return result;
}

// One model of contact in a scene, and what its frames have cost so far.
class Contender {
public:
    Contender(const Case& scene, ContactModel model, int threads)
        : scene_(with(scene.scene, model)),
          simulation_(scene_, scene.meshes, {.threads = threads}) {}

    void take_frame() {
        for (int k = 0; k < scene_.steps_per_frame; ++k) {
            const std::clock_t start = std::clock();
            const StepReport report = simulation_.step();
            processor_ += static_cast<double>(std::clock() - start) / CLOCKS_PER_SEC;
            is_whole_ = is_whole_ && report.is_accepted;
            seconds_ += report.seconds;
            ccd_ += report.contact.ccd_seconds;
            newton_ += report.newton_iterations;
            smallest_ = std::min(smallest_, report.contact.smallest_distance);
            ++steps_;
        }
    }

    [[nodiscard]] double clock() const { return seconds_ / simulation_.time(); }
    [[nodiscard]] double processor() const { return processor_ / simulation_.time(); }
    [[nodiscard]] double ccd_share() const { return ccd_ / seconds_; }
    [[nodiscard]] double newton() const { return newton_ / steps_; }
    [[nodiscard]] double smallest() const { return smallest_; }
    [[nodiscard]] bool is_whole() const { return is_whole_; }

private:
    static Scene with(Scene scene, ContactModel model) {
        scene.contact->model = model;
        if (model == ContactModel::Barrier) {
            scene.solver.integrator = Integrator::NewtonEuler;
            scene.steps_per_frame = 1;
        }
        return scene;
    }

    Scene scene_;
    Simulation<4> simulation_;
    double seconds_ = 0;
    double processor_ = 0;
    double ccd_ = 0;
    double newton_ = 0;
    double smallest_ = 1e300;  // distance, m
    int steps_ = 0;
    bool is_whole_ = true;
};

void print_row(const Case& scene, int frames, const Contender& penalty, const Contender& barrier) {
    Eigen::Index cells = 0;
    for (const SimplexMesh<4>& mesh : scene.meshes) {
        cells += mesh.cell_count();
    }
    std::printf(
        "%-20s %10lld %6d | %8.3g %8.3g | %8.3g %8.3g %6.1f %5.1f%% %11.3g | %6.2f %6.2f%s\n",
        scene.name.c_str(), static_cast<long long>(cells),  // NOLINT(google-runtime-int)
        frames, penalty.clock(), penalty.processor(), barrier.clock(), barrier.processor(),
        barrier.newton(), 100 * barrier.ccd_share(), barrier.smallest(),
        barrier.clock() / penalty.clock(), barrier.processor() / penalty.processor(),
        penalty.is_whole() && barrier.is_whole() ? "" : "  (not all steps taken)");
    std::fflush(stdout);
}

// Four rows: after each quarter of the frames, of all up to there.
void compare(const Case& scene, int frames, int threads) {
    Contender penalty(scene, ContactModel::Penalty, threads);
    Contender barrier(scene, ContactModel::Barrier, threads);
    int quarter = 1;
    for (int frame = 1; frame <= frames; ++frame) {
        penalty.take_frame();
        barrier.take_frame();
        if (4 * frame >= quarter * frames) {
            print_row(scene, frame, penalty, barrier);
            quarter = 4 * frame / frames + 1;
        }
    }
}

}  // namespace
}  // namespace pent::simulator::bench

int main(int argc, char** argv) {
    using namespace pent::simulator::bench;
    double part = 1;
    int frames = 0;
    int threads = std::max(1, static_cast<int>(std::thread::hardware_concurrency()));
    std::vector<std::string> paths;
    for (int i = 1; i < argc; ++i) {
        const std::string_view option = argv[i];
        if (option.substr(0, 2) != "--") {
            paths.emplace_back(option);
        } else if (i + 1 == argc
                   || (option != "--part" && option != "--frames" && option != "--threads")) {
            std::fprintf(stderr,
                         "usage: bench_barrier [--part FRACTION] [--frames N] [--threads N]"
                         " [SCENE.toml ...]\n");
            return 2;
        } else {
            const char* value = argv[++i];
            part = option == "--part" ? std::atof(value) : part;
            frames = option == "--frames" ? std::atoi(value) : frames;
            threads = option == "--threads" ? std::atoi(value) : threads;
        }
    }
    try {
        std::printf("%-20s %10s %6s | %17s | %45s | %13s\n", "", "", "", "penalty", "barrier",
                    "ratio");
        std::printf("%-20s %10s %6s | %8s %8s | %8s %8s %6s %6s %11s | %6s %6s\n", "scene",
                    "pentachora", "frames", "s/s", "cpu s/s", "s/s", "cpu s/s", "newton", "ccd",
                    "smallest, m", "s", "cpu s");
        if (paths.empty()) {
            compare(hug(part), frames > 0 ? frames : 4, threads);
            compare(noodles(part), frames > 0 ? frames : 4, threads);
        }
        for (const std::string& path : paths) {
            const Case scene = read_case(path);
            compare(scene, frames > 0 ? frames : scene.scene.frames, threads);
        }
    } catch (const pent::Error& error) {
        std::fprintf(stderr, "%s\n", error.what());
        return 1;
    }
    return 0;
}
