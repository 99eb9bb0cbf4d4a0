// Broad and narrow phase at the sizes of the armadillo scene; figures to pass, two threads: trees
// built in 36 ms, refit in 0.7 ms, edges and triangles of two bodies at eps = dx / 4 in 35 ms,
// points and tetrahedra in 2.2 ms, 44 to 127 ns a candidate.

#include "boxes_around.h"
#include "hug.h"
#include "near_pairs.h"

#include <benchmark/benchmark.h>

#include <algorithm>
#include <limits>

namespace pent::contact {
namespace {

constexpr double kEps = 0.025;  // a quarter of a cell

const bench::Hug& hug() {
    static const bench::Hug scene = bench::make_hug(0.5 * kEps);
    return scene;
}

template <int Count>
std::vector<Box> boxes_of(const Simplices<Count>& simplices) {
    return boxes_around<4, Count>(simplices, hug().positions, 0.5 * kEps);
}

template <int Count>
void build(benchmark::State& state, const Simplices<Count>& simplices) {
    const std::vector<Box> boxes = boxes_of<Count>(simplices);
    for (auto _ : state) {
        benchmark::DoNotOptimize(BoxTree(boxes));
    }
    state.counters["boxes"] = static_cast<double>(boxes.size());
}

template <int Count>
void refit(benchmark::State& state, const Simplices<Count>& simplices) {
    const std::vector<Box> boxes = boxes_of<Count>(simplices);
    BoxTree tree(boxes);
    for (auto _ : state) {
        tree.refit(boxes);
    }
    state.counters["boxes"] = static_cast<double>(boxes.size());
}

template <int Count>
void box(benchmark::State& state, const Simplices<Count>& simplices) {
    for (auto _ : state) {
        benchmark::DoNotOptimize(boxes_of<Count>(simplices));
    }
    state.counters["boxes"] = static_cast<double>(simplices.cols());
}

template <int K, int L>
void query(benchmark::State& state,
           const Simplices<K>& first,
           const Simplices<L>& second,
           Closest closest) {
    const BoxTree first_tree(boxes_of<K>(first));
    const BoxTree second_tree(boxes_of<L>(second));
    CandidateList found;
    for (auto _ : state) {
        found = near_pairs<4, K, L>({first, first_tree}, {second, second_tree}, hug().positions,
                                    kEps, closest);
    }
    state.counters["candidates"] = static_cast<double>(found.overlaps);
    state.counters["pairs"] = static_cast<double>(found.pairs.size());
    state.SetItemsProcessed(state.iterations() * found.overlaps);
}

// Only the overlaps of boxes, on one thread.
template <int K, int L>
void broad(benchmark::State& state, const Simplices<K>& first, const Simplices<L>& second) {
    const BoxTree first_tree(boxes_of<K>(first));
    const BoxTree second_tree(boxes_of<L>(second));
    std::int64_t count = 0;
    for (auto _ : state) {
        count = 0;
        for (const auto& work : BoxTree::split(first_tree, second_tree, 1)) {
            BoxTree::for_each_overlap(first_tree, second_tree, work,
                                      [&](std::uint32_t, std::uint32_t) { ++count; });
        }
        benchmark::DoNotOptimize(count);
    }
    state.counters["candidates"] = static_cast<double>(count);
    state.SetItemsProcessed(state.iterations() * count);
}

void BM_BuildEdges(benchmark::State& state) {
    build<2>(state, hug().surfaces[0].edges);
}
void BM_BuildTriangles(benchmark::State& state) {
    build<3>(state, hug().surfaces[0].ridges);
}
void BM_RefitEdges(benchmark::State& state) {
    refit<2>(state, hug().surfaces[0].edges);
}
void BM_RefitTriangles(benchmark::State& state) {
    refit<3>(state, hug().surfaces[0].ridges);
}
void BM_BoxTriangles(benchmark::State& state) {
    box<3>(state, hug().surfaces[0].ridges);
}
void BM_EdgeTriangleBroad(benchmark::State& state) {
    broad<2, 3>(state, hug().surfaces[0].edges, hug().surfaces[1].ridges);
}
void BM_EdgeTriangle(benchmark::State& state) {
    query<2, 3>(state, hug().surfaces[0].edges, hug().surfaces[1].ridges, Closest::Anywhere);
}
void BM_EdgeTriangleInterior(benchmark::State& state) {
    query<2, 3>(state, hug().surfaces[0].edges, hug().surfaces[1].ridges, Closest::Interior);
}
void BM_PointTetrahedron(benchmark::State& state) {
    query<1, 4>(state, hug().surfaces[0].vertices, hug().surfaces[1].facets, Closest::Anywhere);
}
void BM_EdgeTriangleSelf(benchmark::State& state) {
    query<2, 3>(state, hug().surfaces[0].edges, hug().surfaces[0].ridges, Closest::Interior);
}
void BM_PointTetrahedronSelf(benchmark::State& state) {
    query<1, 4>(state, hug().surfaces[0].vertices, hug().surfaces[0].facets, Closest::Anywhere);
}

BENCHMARK(BM_BuildEdges)->Unit(benchmark::kMillisecond)->UseRealTime();
BENCHMARK(BM_BuildTriangles)->Unit(benchmark::kMillisecond)->UseRealTime();
BENCHMARK(BM_RefitEdges)->Unit(benchmark::kMillisecond)->UseRealTime();
BENCHMARK(BM_RefitTriangles)->Unit(benchmark::kMillisecond)->UseRealTime();
BENCHMARK(BM_BoxTriangles)->Unit(benchmark::kMillisecond)->UseRealTime();
BENCHMARK(BM_EdgeTriangleBroad)->Unit(benchmark::kMillisecond)->UseRealTime();
BENCHMARK(BM_EdgeTriangleInterior)->Unit(benchmark::kMillisecond)->UseRealTime();
BENCHMARK(BM_EdgeTriangle)->Unit(benchmark::kMillisecond)->UseRealTime();
BENCHMARK(BM_PointTetrahedron)->Unit(benchmark::kMillisecond)->UseRealTime();
BENCHMARK(BM_EdgeTriangleSelf)->Unit(benchmark::kMillisecond)->UseRealTime();
BENCHMARK(BM_PointTetrahedronSelf)->Unit(benchmark::kMillisecond)->UseRealTime();

}  // namespace
}  // namespace pent::contact
