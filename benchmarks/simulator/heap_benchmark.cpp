// Small bodies that fall upon one another in a cavity, under a barrier: what a step costs where
// next to nothing but contact is to be solved.
//
// With an option of the scene that heap alone, else twelve: 4 to 64 bodies, at 30 and at 120 steps
// a second, with and without friction and self-contact. Rows are means of a step.

#include "beams.h"

#include <pent/error.h>
#include <pent/simulator/simulation.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdio>
#include <cstdlib>
#include <ctime>
#include <random>
#include <string>
#include <string_view>
#include <thread>
#include <vector>

namespace pent::simulator::bench {
namespace {

constexpr const char* kUsage =
    "bench_heap [--bodies N] [--steps N] [--threads N] [--self 0|1] [--friction MU] [--rate N]"
    " [--penalty 0|1]\n";

struct Heap {
    int bodies = 12;
    bool self = true;
    double friction = 0.3;
    double rate = 30;
    bool penalty = false;
};

// Cubes of 0.4 m and, every other one, balls of 0.5 m: the same mesh with the shells of the cube
// made round. 384 pentachora each.
SimplexMesh<4> small_body(int i) {
    SimplexMesh<4> mesh = pent::test::kuhn_box<4>({2, 2, 2, 2}, {0.4, 0.4, 0.4, 0.4});
    mesh.positions.array() -= 0.2;
    for (int v = 0; i % 2 == 1 && v < static_cast<int>(mesh.vertex_count()); ++v) {
        auto x = mesh.positions.col(v);
        const double length = x.norm();
        x *= length > 0 ? 0.25 / 0.2 * x.lpNorm<Eigen::Infinity>() / length : 1;
    }
    return mesh;
}

// As near to the middle of the cavity as they go without touching, each a little aside and turned.
std::vector<Eigen::Vector4d> places(int count) {
    constexpr double kSpacing = 0.66;
    constexpr int kReach = 2;
    std::vector<Eigen::Vector4d> all;
    for (int i = 0; i < 625; ++i) {
        all.emplace_back(i % 5 - kReach, i / 5 % 5 - kReach, i / 25 % 5 - kReach, i / 125 - kReach);
    }
    std::stable_sort(all.begin(), all.end(), [](const auto& a, const auto& b) {
        return a.squaredNorm() < b.squaredNorm();
    });
    all.resize(static_cast<std::size_t>(count));
    std::mt19937 random(7);
    std::uniform_real_distribution<double> aside(-0.04, 0.04);
    for (Eigen::Vector4d& at : all) {
        at = kSpacing * at + Eigen::Vector4d::NullaryExpr([&] { return aside(random); });
    }
    return all;
}

Scene scene_of(const Heap& heap) {
    Scene scene;
    scene.gravity = Eigen::Vector4d(0, -9.8, 0, 0);
    scene.frames_per_second = heap.rate;
    scene.obstacles.push_back(
        {.shape = CavityObstacle{.center = Eigen::Vector4d::Zero(), .radius = 1.7}});
    scene.contact =
        ContactSettings{.model = heap.penalty ? ContactModel::Penalty : ContactModel::Barrier,
                        .distance = 0.02,
                        .self = heap.self,
                        .friction = heap.friction};
    scene.solver.integrator = Integrator::Bdf2;
    for (const Eigen::Vector4d& at : places(heap.bodies)) {
        Body body;
        body.name = "b" + std::to_string(scene.bodies.size());
        body.mesh = body.name + ".pent";
        body.place.translate = at;
        body.material.lame = lame_from_young(4, 1e5, 0.28);
        scene.bodies.push_back(body);
    }
    return scene;
}

void run(const Heap& heap, int steps, int threads) {
    std::vector<SimplexMesh<4>> meshes;
    for (int i = 0; i < heap.bodies; ++i) {
        meshes.push_back(small_body(i));
    }
    Simulation<4> simulation(scene_of(heap), std::move(meshes), {.threads = threads});
    double processor = 0;
    StepReport sum;
    double candidates = 0;
    double contacts = 0;
    std::vector<double> each;
    int accepted = 0;
    for (int k = 0; k < steps; ++k) {
        const std::clock_t start = std::clock();
        const StepReport step = simulation.step();
        each.push_back(static_cast<double>(std::clock() - start) / CLOCKS_PER_SEC);
        processor += each.back();
        sum.seconds += step.seconds;
        sum.newton_iterations += step.newton_iterations;
        sum.contact.seconds += step.contact.seconds;
        sum.contact.ccd_seconds += step.contact.ccd_seconds;
        candidates += static_cast<double>(step.contact.candidates);
        contacts += static_cast<double>(step.contact.point_facet + step.contact.mixed);
        accepted += step.is_accepted ? 1 : 0;
    }
    std::sort(each.begin(), each.end(), std::greater<>());
    const std::size_t tenth = std::max<std::size_t>(1, each.size() / 10);
    double dearest = 0;
    for (std::size_t k = 0; k < tenth; ++k) {
        dearest += each[k] / static_cast<double>(tenth);
    }
    std::printf(
        "| %d | %s | %g | 1/%g | %d of %d | %.1f | %.1f | %.1f | %.1f | %.0f%% | %.0f%% |"
        " %.0f | %.0f |\n",
        heap.bodies, heap.self ? "yes" : "no", heap.friction, heap.rate, accepted, steps,
        1e3 * sum.seconds / steps, 1e3 * processor / steps, 1e3 * dearest,
        1.0 * sum.newton_iterations / steps, 100 * sum.contact.seconds / sum.seconds,
        100 * sum.contact.ccd_seconds / sum.seconds, candidates / steps, contacts / steps);
    std::fflush(stdout);
}

std::vector<Heap> twelve() {
    return {{12, true, 0.3, 30},  {12, false, 0.3, 30},  {12, true, 0, 30},   {12, false, 0, 30},
            {12, true, 0.3, 120}, {12, false, 0, 120},   {4, true, 0.3, 30},  {4, false, 0, 120},
            {24, true, 0.3, 30},  {24, false, 0.3, 120}, {64, true, 0.3, 30}, {64, false, 0.3, 30}};
}

}  // namespace
}  // namespace pent::simulator::bench

int main(int argc, char** argv) {
    using namespace pent::simulator::bench;
    Heap heap;
    int steps = 60;
    int threads = std::max(1, static_cast<int>(std::thread::hardware_concurrency()));
    bool is_one = false;
    for (int i = 1; i < argc; i += 2) {
        const std::string_view option = argv[i];
        const double value = i + 1 < argc ? std::atof(argv[i + 1]) : 0;
        is_one |= option != "--steps" && option != "--threads";
        if (i + 1 == argc) {
            std::fprintf(stderr, "%s", kUsage);
            return option == "--help" ? 0 : 2;
        }
        if (option == "--steps") {
            steps = static_cast<int>(value);
        } else if (option == "--threads") {
            threads = static_cast<int>(value);
        } else if (option == "--bodies") {
            heap.bodies = static_cast<int>(value);
        } else if (option == "--self") {
            heap.self = value != 0;
        } else if (option == "--friction") {
            heap.friction = value;
        } else if (option == "--rate") {
            heap.rate = value;
        } else if (option == "--penalty") {
            heap.penalty = value != 0;
        } else {
            std::fprintf(stderr, "bench_heap: no option is called \"%s\"\n%s", argv[i], kUsage);
            return 2;
        }
    }
    try {
        std::printf(
            "| bodies | self | friction | step, s | taken | ms a step | processor ms | of the"
            " dearest tenth | iterations | contact | of it CCD | candidates | contacts |\n"
            "|%s\n",
            " --- | --- | --- | --- | --- | --- | --- | --- | --- | --- | --- | --- | --- |");
        for (const Heap& each : is_one ? std::vector<Heap>{heap} : twelve()) {
            run(each, steps, threads);
        }
    } catch (const pent::Error& error) {
        std::fprintf(stderr, "bench_heap: %s\n", error.what());
        return 1;
    }
    return 0;
}
