// All contacts of a step at the sizes of the armadillo scene, and how time grows with size.

#include "hug.h"

#include <pent/contact/contact_finder.h>

#include <benchmark/benchmark.h>

namespace pent::contact {
namespace {

constexpr double kEps = 0.025;  // a quarter of a cell

constexpr double kStiffness = 1000;

ContactFinder<4> finder_of(const bench::Hug& hug, bool self, double margin) {
    ContactScene<4> scene;
    scene.options = {.distance = kEps, .self = self, .margin = margin};
    scene.is_fixed.resize(static_cast<std::size_t>(hug.positions.cols()));
    scene.rest = hug.positions;
    for (const Surface<4>& surface : hug.surfaces) {
        scene.bodies.push_back({"body" + std::to_string(scene.bodies.size()), surface, false});
    }
    return ContactFinder<4>(std::move(scene));
}

void find(benchmark::State& state, double gap, double scale, bool self, double margin) {
    const bench::Hug hug = bench::make_hug(gap, scale);
    ContactFinder<4> finder = finder_of(hug, self, margin);
    ContactReport report = finder.find(hug.positions, kStiffness).report;  // builds the trees
    double seconds = 0;
    double tree_seconds = 0;
    double search_seconds = 0;
    for (auto _ : state) {
        report = finder.find(hug.positions, kStiffness).report;
        seconds += report.seconds;
        tree_seconds += report.tree_seconds;
        search_seconds += report.search_seconds;
    }
    state.counters["facets"] =
        static_cast<double>(hug.surfaces[0].facets.cols() + hug.surfaces[1].facets.cols());
    state.counters["candidates"] = static_cast<double>(report.candidates);
    state.counters["points"] = static_cast<double>(report.point_facet);
    state.counters["mixed"] = static_cast<double>(report.mixed);
    state.counters["tree_share"] = tree_seconds / seconds;
    state.counters["search_share"] = search_seconds / seconds;
}

constexpr double kNear = 0.5 * kEps;
constexpr double kFar = 10;

BENCHMARK_CAPTURE(find, apart, kFar, 1, false, 0)->Unit(benchmark::kMillisecond)->UseRealTime();
BENCHMARK_CAPTURE(find, touching, kNear, 1, false, 0)->Unit(benchmark::kMillisecond)->UseRealTime();
BENCHMARK_CAPTURE(find, overlapping, -0.05, 1, false, 0)
    ->Unit(benchmark::kMillisecond)
    ->UseRealTime();
BENCHMARK_CAPTURE(find, touching_kept, kNear, 1, false, 0.25 * kEps)
    ->Unit(benchmark::kMillisecond)
    ->UseRealTime();
BENCHMARK_CAPTURE(find, self, kFar, 1, true, 0)->Unit(benchmark::kMillisecond)->UseRealTime();
BENCHMARK_CAPTURE(find, touching_half_size, kNear, 0.5, false, 0)
    ->Unit(benchmark::kMillisecond)
    ->UseRealTime();
BENCHMARK_CAPTURE(find, touching_double_size, kNear, 2, false, 0)
    ->Unit(benchmark::kMillisecond)
    ->UseRealTime();

}  // namespace
}  // namespace pent::contact
