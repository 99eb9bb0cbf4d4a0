#pragma once

#include <pent/simulator/body_schema.h>
#include <pent/simulator/constraint_schema.h>
#include <pent/simulator/contact_schema.h>
#include <pent/simulator/field.h>
#include <pent/simulator/load_schema.h>
#include <pent/simulator/scene.h>

/// The schema of scenes: every key is written once, here and in the headers of bodies,
/// constraints, loads and contact.
///
/// fields(part, visit) calls visit(Field, member) for each key of a part of a scene, in the order
/// in which files have them; blocks(scene, visit) calls visit(name, member) for each block.
/// check(), the reader and the writer of scene files, what a resumed run is compared by and the
/// tables of the docs are such visitors: a member that gets its line here is read, checked,
/// written, compared and documented.
namespace pent::simulator {

template <PartOf<Damping> Part, typename Visit>
void fields(Part& damping, const Visit& visit) {
    visit(key("mass", "1/s", "", kNotNegative), damping.mass);
    visit(key("stiffness", "s", "", kNotNegative), damping.stiffness);
}

template <PartOf<Sleep> Part, typename Visit>
void fields(Part& sleep, const Visit& visit) {
    visit(key("speed", "1/s",
              "a body is at rest while its fastest vertex makes less than this part of the "
              "diagonal of its box a second",
              kPositive),
          sleep.speed);
    visit(key("time", "s", "how long it has to be at rest",
              Range{.low = 0, .low_included = false, .largest = kLongestTime}),
          sleep.time);
}

template <PartOf<SolverOptions> Part, typename Visit>
void fields(Part& solver, const Visit& visit) {
    visit(
        key("integrator", "", "see above").default_is("`\"linear_euler\"` (accurate: `\"bdf2\"`)"),
        solver.integrator);
    visit(key("elements", "", "see above"), solver.elements);
    visit(key("filter", "", "of the Hessian of an element"), solver.filter);
    visit(key("linear", "",
              "conjugate gradients, or sparse L L^T, the reference, where memory allows it"),
          solver.linear);
    visit(key("preconditioner", "", "see above"), solver.preconditioner);
    visit(key("precision", "", "of matrix blocks"), solver.precision);
    visit(key("tolerance", "", "of the linear solver", kFraction).default_is("1e-4 (fast: 1e-2)"),
          solver.tolerance);
    visit(key("newton_tolerance", "",
              "unbalanced force at the end of a step over that at its start", kFraction),
          solver.newton_tolerance);
    visit(key("max_iterations", "", "of one linear solve", whole(1, 1'000'000)),
          solver.max_iterations);
    visit(key("max_halvings", "", "how often a failed step may be cut in two", whole(0, 20)),
          solver.max_halvings);
}

template <PartOf<Output> Part, typename Visit>
void fields(Part& output, const Visit& visit) {
    visit(key("vertex", "", "what the frame files have of every vertex, see below"), output.vertex);
    visit(key("contact_pairs", "",
              "`contacts/000123.csv`: kind, bodies, signed distance, force on the first body, "
              "vertices and weights of every contact"),
          output.contact_pairs);
    visit(key("balance", "",
              "`balance.csv`: energies, momentum and angular momentum about the origin, a line for "
              "each step"),
          output.balance);
}

/// Of the block [scene] alone.
template <PartOf<Scene> Part, typename Visit>
void fields(Part& scene, const Visit& visit) {
    visit(key("dimension", "", "", whole(3, 4)), scene.dimension);
    visit(key("gravity", "m/s^2"), scene.gravity);
    visit(key("frames", "", "after frame 0", whole(1, 999'999)), scene.frames);
    visit(key("frames_per_second", "1/s", "",
              Range{.low = 0, .low_included = false, .smallest = kMinRate, .largest = kMaxRate}),
          scene.frames_per_second);
    visit(key("steps_per_frame", "", "", whole(1, 1'000'000)), scene.steps_per_frame);
}

/// The blocks behind [scene], in the order of files: a list is [[name]], one
/// that may be absent or is always there [name].
template <PartOf<Scene> Part, typename Visit>
void blocks(Part& scene, const Visit& visit) {
    visit("body", scene.bodies);
    visit("constraint", scene.constraints);
    visit("load", scene.loads);
    visit("activation", scene.activations);
    visit("attachment", scene.attachments);
    visit("obstacle", scene.obstacles);
    visit("contact", scene.contact);
    visit("damping", scene.damping);
    visit("sleep", scene.sleep);
    visit("solver", scene.solver);
    visit("output", scene.output);
}

}  // namespace pent::simulator
