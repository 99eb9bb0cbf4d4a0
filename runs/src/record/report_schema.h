#pragma once

#include <pent/runs/report.h>
#include <pent/simulator/field.h>

namespace pent::runs {

// The keys of report.json and of the lines of a journal, each once: writer, reader and the tables
// of docs/simulator.md are visitors.

using simulator::key;
using simulator::PartOf;

template <PartOf<simulator::ContactSummary> Part, typename Visit>
void fields(Part& contact, const Visit& visit) {
    visit(key("point_facet", "", "vertices in contact with a facet"), contact.point_facet);
    visit(key("mixed", "", "edges in contact with triangles; in three dimensions with edges"),
          contact.mixed);
    visit(key("self", "", "of both, those within one body"), contact.self);
    visit(key("obstacle", "", "vertices in contact with an obstacle"), contact.obstacle);
    visit(key("deepest", "m", "deepest penetration of a vertex"), contact.deepest);
    visit(key("smallest_distance", "m", "least signed distance in contact; null: nothing touches"),
          contact.smallest_distance);
    visit(key("searches", "", "how often contacts were asked for"), contact.searches);
    visit(key("candidates", "", "pairs of simplices looked at one by one"), contact.candidates);
    visit(key("obstacle_tests", "", "distances of vertices to obstacles"), contact.obstacle_tests);
    visit(key("friction", "", "contacts whose friction was computed"), contact.friction);
    visit(key("trees_built", "", "trees of boxes made anew"), contact.trees_built);
    visit(key("trees_refit", "", "trees of boxes fitted to moved vertices"), contact.trees_refit);
    visit(key("ccd_seconds", "s", "of `seconds`: how far steps may go without a crossing"),
          contact.ccd_seconds);
    visit(key("stiffness", "N/m", "of the barrier at the end; 0 without one"), contact.stiffness);
    visit(key("seconds", "s", "finding contacts, their forces and their part of the matrix"),
          contact.seconds);
}

template <PartOf<simulator::ConstraintSummary> Part, typename Visit>
void fields(Part& constraint, const Visit& visit) {
    visit(key("held", "", "vertices that it holds at the end"), constraint.held);
    visit(key("center", "m", "mean of its vertices, held or not"), constraint.center);
    visit(key("force", "N", "what holds them against all forces, without inertia and damping"),
          constraint.force);
    visit(key("moment", "N m", "of it about `center`: in the planes xy, xz, xw, yz, yw, zw"),
          constraint.moment);
}

template <PartOf<simulator::AttachmentSummary> Part, typename Visit>
void fields(Part& attachment, const Visit& visit) {
    visit(key("springs", "", "that pull at the end"), attachment.springs);
    visit(key("broken", "", "of all times"), attachment.broken);
    visit(key("force", "N", "of all its springs together, on what is selected"), attachment.force);
    visit(key("largest_force", "N", "of one spring"), attachment.largest_force);
}

template <PartOf<simulator::RegionSummary> Part, typename Visit>
void fields(Part& region, const Visit& visit) {
    visit(key("energy", "J", "elastic"), region.energy);
}

template <PartOf<simulator::StepReport> Part, typename Visit>
void fields(Part& step, const Visit& visit) {
    visit(key("step", "", "steps taken so far, this one included"), step.step);
    visit(key("time", "s", "at its end"), step.time);
    visit(key("substeps", "", "1, or more where the step had to be cut"), step.substeps);
    visit(key("refused", "", "attempts that were thrown away"), step.refused);
    visit(key("failure", "", "why the last of them was"), step.failure);
    visit(key("damped", "",
              "substeps of `linear_euler` that Newton's method took, as the linear one went astray")
              .may_be_missing(),
          step.damped);
    visit(key("newton_iterations", "", "after the first, linear step"), step.newton_iterations);
    visit(key("iterations", "", "of the linear solver, in all"), step.iterations);
    visit(key("asleep", "", "bodies that sleep at the end"), step.asleep);
    visit(key("unknowns", "", "scalars solved for, in all linear solves"), step.unknowns);
    visit(key("hessians", "", "of elements, in the matrices that were solved with"), step.hessians);
    visit(key("filtered", "", "of those, the ones that `filter` changed"), step.filtered);
    visit(key("damping_hessians", "", "of damping with a tangent of its own"),
          step.damping_hessians);
    visit(key("residual", "",
              "largest \\|b - A x\\| / \\|b\\| of the linear solves, from x, in the norm in which "
              "most is left"),
          step.residual);
    visit(key("unbalanced", "", "force left by Newton's method over that at its start"),
          step.unbalanced);
    visit(key("inverted", "", "cells that are inside out at the end"), step.inverted);
    visit(key("collapsed", "", "elements in the false minimum of their energy at the end"),
          step.collapsed);
    visit(key("energies", "J", "at the end: `kinetic` and each stored one that the scene has"),
          step.energies);
    visit(key("contact", "", "what touches at the end, and what contact cost"), step.contact);
    visit(key("momentum", "kg m/s", "at the end, of all bodies; with `output.balance`")
              .may_be_missing(),
          step.momentum);
    visit(key("angular_momentum", "kg m^2/s", "about the origin, in planes as of a moment")
              .may_be_missing(),
          step.angular_momentum);
    visit(key("constraints", "", "one for each").may_be_missing(), step.constraints);
    visit(key("attachments", "", "one for each").may_be_missing(), step.attachments);
    visit(key("regions", "", "one for each of `bodies`, body after body").may_be_missing(),
          step.regions);
    visit(key("activation_work", "J", "done by activations on the bodies in the step")
              .may_be_missing(),
          step.activation_work);
    visit(key("assembly_seconds", "s", "matrices and forces of elements"), step.assembly_seconds);
    visit(key("solve_seconds", "s", "linear solves"), step.solve_seconds);
    visit(key("seconds", "s", "all of the step"), step.seconds);
}

template <PartOf<FrameReport> Part, typename Visit>
void fields(Part& frame, const Visit& visit) {
    visit(key("frame", "", "its number"), frame.frame);
    visit(key("step", "", "the last before it"), frame.step);
    visit(key("time", "s", ""), frame.time);
    visit(key("non_rigid", "",
              "for each body: RMS distance to the best-fitting rigid motion of the start over its"
              " RMS radius"),
          frame.non_rigid);
}

template <PartOf<RunPart> Part, typename Visit>
void fields(Part& part, const Visit& visit) {
    visit(key("created_by", "", "program and version"), part.created_by);
    visit(key("threads", "", "of each process"), part.threads);
    visit(
        key("ranks", "", "processes of pent-sim-mpi; 0: of a program on its own").may_be_missing(),
        part.ranks);
    visit(key("isa", "", "instruction set"), part.isa);
    visit(key("first_frame", "", "the frame it went on from"), part.first_frame);
    visit(key("last_frame", "", "the last that it wrote"), part.last_frame);
    visit(key("seconds", "s", "of a part that died: up to its last frame"), part.seconds);
    visit(key("verdict", "", "how it ended; `died`: it was killed or crashed"), part.verdict);
}

template <PartOf<BodyReport> Part, typename Visit>
void fields(Part& body, const Visit& visit) {
    visit(key("name"), body.name);
    visit(key("non_rigid_max", "", "largest `non_rigid` of all frames"), body.non_rigid_max);
    visit(key("regions", "", "names of its regions, in the order of the scene").may_be_missing(),
          body.regions);
}

template <PartOf<simulator::SimulationSize> Part, typename Visit>
void fields(Part& size, const Visit& visit) {
    visit(key("vertices"), size.vertices);
    visit(key("cells"), size.cells);
    visit(key("free_vertices", "", "those that are solved for"), size.free_vertices);
    visit(
        key("elements", "", "cells, edges where smoothed, or quadratic cells, near a free vertex"),
        size.elements);
    visit(key("matrix_blocks", "", "stored, of the upper triangle"), size.matrix_blocks);
    visit(key("contact_bytes", "B", "surfaces and trees for contact"), size.contact_bytes);
    visit(key("bytes", "B", "all that grows with the mesh"), size.bytes);
}

// Of a report with at least one part.
template <PartOf<RunReport> Part, typename Visit>
void fields(Part& report, const Visit& visit) {
    auto& last = report.parts.back();
    visit(key("created_by", "", "program and version of the last part"), last.created_by);
    visit(key("verdict", "", "how the last part ended"), report.verdict);
    visit(key("message", "", "why a run diverged").may_be_missing(), report.message);
    visit(
        key("penetration", "", "of deep penetration: how deep, and what would do").may_be_missing(),
        report.penetration);
    visit(key("seconds", "s", "spent in all parts"), report.seconds);
    visit(key("threads", "", "of the last part"), last.threads);
    visit(key("isa", "", "of the last part: its instruction set"), last.isa);
    visit(key("thinnest", "m", "least extent of a body at rest, along the axes of space or its own")
              .may_be_missing(),
          report.thinnest);
    visit(key("size", "", "how big the simulation is"), report.size);
    visit(key("warnings", "", "of meshes, settings, units, and of overlaps at the start")
              .may_be_missing(),
          report.warnings);
    visit(key("bodies", "", "in the order of the scene"), report.bodies);
    visit(key("parts", "", "calls of pent-sim").may_be_missing(), report.parts);
    visit(key("frames", "", "in the folder, frame 0 included"), report.frames);
    visit(key("steps", "", "that led to them"), report.steps);
}

}  // namespace pent::runs
