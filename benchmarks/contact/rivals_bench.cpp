// Our trees against brute force on a subset of the edges, and against the box intersection of CGAL
// where the mesher is built, as ratios in one run on one thread. Both are to be at least 10.
//
// Ours is what a step does: fit the trees of the step before to the boxes, and find the overlaps.
// The rivals keep nothing from step to step.

#include "boxes_around.h"
#include "hug.h"

#include <pent/parallel.h>

#include <benchmark/benchmark.h>

#include <algorithm>
#include <chrono>
#include <limits>

#ifdef PENT_BENCH_CGAL
#include <CGAL/box_intersection_d.h>
#endif

namespace pent::contact {
namespace {

constexpr double kEps = 0.025;  // a quarter of a cell

struct Boxes {
    std::vector<Box> edges;
    std::vector<Box> triangles;
};

Boxes hug_boxes() {
    const bench::Hug hug = bench::make_hug(0.5 * kEps);
    return {boxes_around<4, 2>(hug.surfaces[0].edges, hug.positions, 0.5 * kEps),
            boxes_around<4, 3>(hug.surfaces[1].ridges, hug.positions, 0.5 * kEps)};
}

std::int64_t count_by_trees(const Boxes& boxes, BoxTree& edges, BoxTree& triangles) {
    edges.refit(boxes.edges);
    triangles.refit(boxes.triangles);
    std::int64_t count = 0;
    for (const BoxTree::Work& work : BoxTree::split(edges, triangles, 1)) {
        BoxTree::for_each_overlap(edges, triangles, work,
                                  [&](std::uint32_t, std::uint32_t) { ++count; });
    }
    return count;
}

std::int64_t count_by_brute_force(const std::vector<Box>& first, const std::vector<Box>& second) {
    std::int64_t count = 0;
    for (const Box& a : first) {
        for (const Box& b : second) {
            count += overlap(a, b) ? 1 : 0;
        }
    }
    return count;
}

// Runs ours and a rival in turn; the counter times_faster is the ratio of their best times.
template <typename Rival>
void compare(benchmark::State& state, const Boxes& boxes, const Rival& rival) {
    using Clock = std::chrono::steady_clock;
    BoxTree edges(boxes.edges);
    BoxTree triangles(boxes.triangles);
    const Workers one_thread(1);
    double ours = std::numeric_limits<double>::infinity();
    double theirs = ours;
    for (auto _ : state) {
        const auto start = Clock::now();
        const std::int64_t found =
            one_thread.run([&] { return count_by_trees(boxes, edges, triangles); });
        const auto middle = Clock::now();
        const std::int64_t expected = rival(boxes.edges, boxes.triangles);
        const auto end = Clock::now();
        if (found != expected) {
            state.SkipWithError("the counts of overlaps differ");
        }
        ours = std::min(ours, std::chrono::duration<double>(middle - start).count());
        theirs = std::min(theirs, std::chrono::duration<double>(end - middle).count());
    }
    state.counters["ours_ms"] = 1e3 * ours;
    state.counters["theirs_ms"] = 1e3 * theirs;
    state.counters["times_faster"] = theirs / ours;
}

void BM_AgainstBruteForce(benchmark::State& state) {
    Boxes boxes = hug_boxes();
    std::vector<Box> subset;  // every sixteenth edge
    for (std::size_t i = 0; i < boxes.edges.size(); i += 16) {
        subset.push_back(boxes.edges[i]);
    }
    boxes.edges = subset;
    compare(state, boxes, count_by_brute_force);
}
BENCHMARK(BM_AgainstBruteForce)->Unit(benchmark::kMillisecond)->UseRealTime();

#ifdef PENT_BENCH_CGAL
using CgalBox = CGAL::Box_intersection_d::Box_d<float, 4>;

std::int64_t count_by_cgal(const std::vector<Box>& first, const std::vector<Box>& second) {
    std::vector<CgalBox> a;
    std::vector<CgalBox> b;
    for (Box box : first) {  // a copy: CGAL takes pointers to what it may change
        a.emplace_back(box.low, box.high);
    }
    for (Box box : second) {
        b.emplace_back(box.low, box.high);
    }
    std::int64_t count = 0;
    CGAL::box_intersection_d(a.begin(), a.end(), b.begin(), b.end(),
                             [&](const CgalBox&, const CgalBox&) { ++count; });
    return count;
}

void BM_AgainstCgal(benchmark::State& state) {
    compare(state, hug_boxes(), count_by_cgal);
}
BENCHMARK(BM_AgainstCgal)->Unit(benchmark::kMillisecond)->UseRealTime();
#endif

}  // namespace
}  // namespace pent::contact
