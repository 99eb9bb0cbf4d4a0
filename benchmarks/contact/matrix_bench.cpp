// What contacts cost the linear solver, on one thread: their blocks summed into matrices once a step, and
// the part of a product that is theirs, against products that sum over the contacts each time.

#include "contact_matrix.h"
#include "step_scenes.h"

#include <benchmark/benchmark.h>

namespace pent::simulator {
namespace {

// The two bodies of the hug at half of the distance of contact, and what touches there.
struct Touching {
    World<4> world;
    BlockPattern pattern;
    ContactState<4> contacts;
    BlockMatrix<4, float> matrix;
    BlockVector<4> x;
    BlockVector<4> result;

    explicit Touching(const Scene& scene)
        : world(make_world<4>(scene, {bench::hug_body(1), bench::hug_body(2)})),
          pattern(make_pattern<4>(world.cells, world.numbering)),
          contacts(SceneContacts<4>(scene, world).find(Workers(1), world.rest)),
          matrix(pattern),
          x(BlockVector<4>::Random(4, pattern.rows())),
          result(BlockVector<4>::Zero(4, pattern.rows())) {}

    [[nodiscard]] auto add_hessian() {
        const Positions<4> shift = Positions<4>::Zero(4, world.vertex_count());
        return add_contact_hessian<4, float>(Workers(1), world.numbering, {contacts, {}}, 1, shift,
                                             matrix, result);
    }
};

Touching touching() {
    return Touching(bench::hug_scene(false));
}

void contact_blocks(benchmark::State& state) {
    Touching scene = touching();
    for ([[maybe_unused]] auto _ : state) {
        benchmark::DoNotOptimize(scene.add_hessian());
    }
    state.counters["contacts"] = static_cast<double>(scene.contacts.pairs.size());
    state.counters["coupling_blocks"] = static_cast<double>(scene.add_hessian()->pattern.blocks());
}
BENCHMARK(contact_blocks)->Unit(benchmark::kMillisecond);

void product(benchmark::State& state, bool has_coupling) {
    Touching scene = touching();
    const auto coupling = scene.add_hessian();
    scene.matrix.set_coupling(has_coupling ? &coupling->matrix : nullptr);
    const Kernels<4>& best = kernels<4>(best_isa());
    for ([[maybe_unused]] auto _ : state) {
        scene.matrix.multiply(Workers(1), best, scene.x, scene.result);
    }
}
BENCHMARK_CAPTURE(product, of_bodies, false)->Unit(benchmark::kMillisecond);
BENCHMARK_CAPTURE(product, of_bodies_and_coupling, true)->Unit(benchmark::kMillisecond);

void product_by_contacts(benchmark::State& state) {
    Touching scene = touching();
    const std::vector<std::uint32_t>& unknowns = scene.world.numbering.unknown_of_vertex;
    for ([[maybe_unused]] auto _ : state) {
        for (const contact::Contact<4>& contact : scene.contacts.pairs) {
            Eigen::Vector4d moved = Eigen::Vector4d::Zero();
            for (int i = 0; i <= 4; ++i) {
                moved += contact.weights[i] * scene.x.col(unknowns[contact.vertices[i]]);
            }
            const Eigen::Vector4d force = contact.response.hessian * moved;
            for (int i = 0; i <= 4; ++i) {
                scene.result.col(unknowns[contact.vertices[i]]) += contact.weights[i] * force;
            }
        }
        benchmark::DoNotOptimize(scene.result.data());
    }
}
BENCHMARK(product_by_contacts)->Unit(benchmark::kMillisecond);

}  // namespace
}  // namespace pent::simulator
