// Scenes that are hard on the barrier, at larger sizes than the tests', in R^3 and R^4: each to its
// end, with a brute-force checker, which shares no code with search and collision detection,
// looking at every accepted step and at the whole way of Newton's method there.
//
//     stress_barrier [--fine N]
//
// Exits with 1 if a step is refused or anything crosses.

#include "simulator/stress_scenes.h"

#include <chrono>
#include <cstdio>
#include <cstdlib>
#include <string>

namespace pent::simulator::bench {
namespace {

template <int Dim>
bool stress(const char* name, const test::BarrierScene<Dim>& scene, int steps) {
    const auto start = std::chrono::steady_clock::now();
    test::WatchedRun<Dim> run(scene);
    run.run(steps);
    Eigen::Index cells = 0;
    for (const SimplexMesh<Dim>& mesh : scene.meshes) {
        cells += mesh.cell_count();
    }
    const bool is_sound = run.failure().empty() && run.crossings() == 0;
    std::printf("| %s | %d | %lld | %llu of %d | %.1f | %d | %.3g | %.0f |%s%s\n", name, Dim,
                static_cast<long long>(cells),  // NOLINT(google-runtime-int): for printf
                static_cast<unsigned long long>(run.simulation().step_count()),  // NOLINT
                steps, 1.0 * run.newton_iterations() / steps, run.crossings(),
                run.smallest_distance(),
                std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count(),
                run.failure().empty() ? "" : " ", run.failure().c_str());
    std::fflush(stdout);
    return is_sound;
}

template <int Dim>
bool stress_all(int fine) {
    bool is_sound = stress<Dim>("fast impact", test::fast_impact<Dim>(fine), 10);
    is_sound &= stress<Dim>("stacked noodles", test::stacked_noodles<Dim>(fine), 30);
    is_sound &= stress<Dim>("needle at a gap", test::needle_at_gap<Dim>(fine), 20);
    is_sound &= stress<Dim>("interlocked hooks", test::interlocked_hooks<Dim>(fine), 20);
    is_sound &= stress<Dim>("stiffness 1 to 1e6", test::million_to_one<Dim>(fine), 30);
    is_sound &= stress<Dim>("thin sheets", test::thin_sheets<Dim>(fine), 20);
    return is_sound;
}

}  // namespace
}  // namespace pent::simulator::bench

int main(int argc, char** argv) {
    using namespace pent::simulator::bench;
    const int fine = argc > 2 && std::string(argv[1]) == "--fine" ? std::atoi(argv[2]) : 2;
    std::printf(
        "| scene | dimension | cells | steps | iterations a step | crossings |"
        " smallest distance, m | s |\n| --- | --- | --- | --- | --- | --- | --- | --- |\n");
    const bool is_sound = stress_all<3>(fine);
    return stress_all<4>(fine) && is_sound ? 0 : 1;
}
