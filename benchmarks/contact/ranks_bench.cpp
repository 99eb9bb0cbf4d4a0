// What contact costs each of several ranks: processor seconds of the one that works most, as a
// table for docs/distributed.md. Ranks are threads of this process that wait for one another
// without turning in circles, so that their seconds are those of their own work on any number of
// cores.
//
//   bench_contact_ranks [RANKS...]

#include "model/body_dofs.h"
#include "potentials/contact_potential.h"
#include "simulator/thread_ranks.h"
#include "step/rank_agreement.h"
#include "step_scenes.h"

#include <algorithm>
#include <array>
#include <cstdio>
#include <cstdlib>
#include <ctime>
#include <string>

namespace pent::simulator {
namespace {

constexpr int kSteps = 3;
constexpr int kIterations = 4;  // of Newton's method in each

double processor_seconds() {
    timespec now = {};
    clock_gettime(CLOCK_THREAD_CPUTIME_ID, &now);
    return static_cast<double>(now.tv_sec) + 1e-9 * static_cast<double>(now.tv_nsec);
}

// Of one rank, in all steps together.
struct Cost {
    double energy = 0;    // contacts and their forces, s
    double limit = 0;     // how far steps may go, s
    double hessians = 0;  // s
    std::int64_t candidates = 0;
    std::size_t contacts = 0;

    [[nodiscard]] double all() const { return energy + limit + hessians; }
};

template <typename Work>
void add_seconds(double& sum, const Work& work) {
    const double start = processor_seconds();
    work();
    sum += processor_seconds() - start;
}

// The second body slides along the first from step to step, so far that candidates are searched for
// again; within a step vertices wander, less and less.
Positions<4> place(const Bodies<4>& bodies, int step, int iteration) {
    std::mt19937 random(static_cast<unsigned>(step));
    std::uniform_real_distribution<double> way(-1, 1);
    const double left = 0.02 * bench::kEps / (1 + iteration * iteration);
    Positions<4> x = bodies.rest().unaryExpr([&](double at) { return at + left * way(random); });
    x.rightCols(bodies.vertices(1).size).row(0).array() += 0.4 * bench::kEps * step;
    return x;
}

Cost cost_of(const Scene& scene, const std::shared_ptr<const Ranks>& ranks) {
    const Workers workers(1);
    const Bodies<4> bodies =
        share<4>(scene, make_bodies<4>(scene, {bench::hug_body(1), bench::hug_body(2)}), ranks);
    const HeldVertices<4> held(scene, bodies);
    const DofMap dofs = number_dofs(bodies, held, {true, true});
    const BlockPattern pattern = make_pattern<4>(bodies.cells(), dofs);
    ContactPotential<4> contact(workers, scene, bodies, held);
    NewtonSystem<4> system(workers, dofs, pattern, Precision::Float);
    Positions<4> gradient = Positions<4>::Zero(4, bodies.vertex_count());
    const auto evaluate = [&](const Positions<4>& x) {
        static_cast<void>(contact.evaluate(x, gradient));
    };
    evaluate(bodies.rest());  // builds the trees
    static_cast<void>(contact.take_work());
    Cost cost;
    for (int step = 1; step <= kSteps; ++step) {
        Positions<4> x = place(bodies, step - 1, kIterations);
        for (int iteration = 0; iteration < kIterations; ++iteration) {
            const Positions<4> next = place(bodies, step, iteration);
            add_seconds(cost.hessians, [&] {
                system.begin(BlockVector<4>::Zero(4, dofs.count()),
                             Positions<4>::Zero(4, bodies.vertex_count()));
                contact.add_hessian(x, 1, Filter::Clamp, system);
            });
            add_seconds(cost.limit, [&] { static_cast<void>(contact.max_step(x, next)); });
            add_seconds(cost.energy, [&] { evaluate(next); });
            x = next;
        }
    }
    cost.candidates = contact.take_work().candidates;
    cost.contacts = contact.contacts().list.size();
    return cost;
}

Scene scene_of(ContactModel model, bool self) {
    Scene scene = bench::hug_scene(self);
    scene.solver.integrator = Integrator::NewtonEuler;
    scene.contact->model = model;
    if (model == ContactModel::Barrier) {
        scene.obstacles.clear();  // which squeeze, and barriers begin with nothing crossed
    }
    return scene;
}

void print_row(const std::string& name, int count, double alone, const std::vector<Cost>& costs) {
    const Cost& most = *std::max_element(
        costs.begin(), costs.end(), [](const Cost& a, const Cost& b) { return a.all() < b.all(); });
    std::printf("| %s | %zu | %d | %.2f | %.2f | %.2f | %.2f | %.2f |\n", name.c_str(),
                most.contacts, count, most.energy, most.limit, most.hessians, most.all(),
                most.all() / alone);
    std::fflush(stdout);
}

void measure(const std::string& name, const Scene& scene, const std::vector<int>& counts) {
    double alone = 0;
    for (const int count : counts) {
        std::vector<Cost> costs(static_cast<std::size_t>(count));
        test::on_ranks(count, [&](const std::shared_ptr<const Ranks>& ranks) {
            costs[static_cast<std::size_t>(ranks->rank())] =
                cost_of(scene, count == 1 ? nullptr : ranks);
        });
        alone = alone > 0 ? alone : costs.front().all();
        print_row(name, count, alone, costs);
    }
}

}  // namespace
}  // namespace pent::simulator

int main(int argc, char** argv) {
    using pent::simulator::ContactModel;
    std::vector<int> counts;
    for (int i = 1; i < argc; ++i) {
        counts.push_back(std::atoi(argv[i]));
    }
    if (counts.empty()) {
        counts = {1, 2, 4, 8};
    }
    std::puts(
        "| contact | contacts | ranks | energy, s | step limit, s | Hessians, s | all, s |"
        " of one alone |");
    std::puts("| --- | --- | --- | --- | --- | --- | --- | --- |");
    for (const ContactModel model : {ContactModel::Penalty, ContactModel::Barrier}) {
        const std::string name = model == ContactModel::Penalty ? "penalty" : "barrier";
        for (const bool self : {false, true}) {
            pent::simulator::measure(name + (self ? ", within bodies, too" : ""),
                                     pent::simulator::scene_of(model, self), counts);
        }
    }
}
