// What contacts cost the linear solver, on one thread: their blocks summed into matrices once a
// step, and the part of a product that is theirs.

#include "kernels/kernels.h"
#include "model/body_dofs.h"
#include "potentials/contact_potential.h"
#include "step_scenes.h"

#include <benchmark/benchmark.h>

namespace pent::simulator {
namespace {

// The two bodies of the hug at half of the distance of contact, and what touches there.
struct Touching {
    Workers workers{1};
    Scene scene = bench::hug_scene(false);
    const Bodies<4> bodies = make_bodies<4>(scene, {bench::hug_body(1), bench::hug_body(2)});
    const HeldVertices<4> held{scene, bodies};
    const DofMap dofs = number_dofs(bodies, held, {true, true});
    BlockPattern pattern = make_pattern<4>(bodies.cells(), dofs);
    ContactPotential<4> contact{workers, scene, bodies, held};
    NewtonSystem<4> system{workers, dofs, pattern, Precision::Float};
    Positions<4> gradient = Positions<4>::Zero(4, bodies.vertex_count());

    Touching() { static_cast<void>(contact.evaluate(bodies.rest(), gradient)); }

    void assemble() {
        system.begin(BlockVector<4>::Zero(4, dofs.count()),
                     Positions<4>::Zero(4, bodies.vertex_count()));
        contact.add_hessian(bodies.rest(), 1, Filter::Clamp, system);
        system.finish();
    }

    [[nodiscard]] BlockMatrix<4, float>& matrix() {
        return std::get<BlockMatrix<4, float>>(system.matrix());
    }
};

void contact_blocks(benchmark::State& state) {
    Touching touching;
    for ([[maybe_unused]] auto _ : state) {
        touching.assemble();
    }
    state.counters["contacts"] = static_cast<double>(touching.contact.contacts().list.size());
    state.counters["coupling_blocks"] =
        static_cast<double>(touching.matrix().coupling()->pattern().blocks());
}
BENCHMARK(contact_blocks)->Unit(benchmark::kMillisecond);

void product(benchmark::State& state, bool has_coupling) {
    Touching touching;
    touching.assemble();
    BlockMatrix<4, float>& matrix = touching.matrix();
    if (!has_coupling) {
        matrix.set_coupling(nullptr);
    }
    const BlockKernels& best = kernels<4>(best_isa()).blocks;
    const BlockVector<4> x = BlockVector<4>::Random(4, matrix.rows());
    BlockVector<4> result(4, matrix.rows());
    for ([[maybe_unused]] auto _ : state) {
        matrix.multiply(touching.workers, best, x, result);
    }
}
BENCHMARK_CAPTURE(product, of_bodies, false)->Unit(benchmark::kMillisecond);
BENCHMARK_CAPTURE(product, of_bodies_and_coupling, true)->Unit(benchmark::kMillisecond);

}  // namespace
}  // namespace pent::simulator
