#pragma once

#include <pent/simulator/field.h>
#include <pent/simulator/scene.h>

/// The keys of bodies: part of scene_schema.h.
namespace pent::simulator {

template <PartOf<Placement> Part, typename Visit>
void fields(Part& place, const Visit& visit) {
    visit(key("scale", "", "", kPositive), place.scale);
    visit(key("rotate", "", "applied in the order written, about the mesh's origin"), place.rotate);
    visit(key("translate", "m"), place.translate);
}

template <PartOf<Turn> Part, typename Visit>
void fields(Part& turn, const Visit& visit) {
    visit(key("plane").required(), turn.plane);
    visit(key("degrees", "", "", kAngle).required(), turn.degrees);
}

template <PartOf<Spin> Part, typename Visit>
void fields(Part& spin, const Visit& visit) {
    visit(key("plane").required(), spin.plane);
    visit(key("degrees_per_s", "", "", kAngle).required(), spin.degrees_per_s);
}

template <PartOf<Material> Part, typename Visit>
void fields(Part& material, const Visit& visit) {
    visit(key("model", "", "see above"), material.model);
    visit(key("lame"), material.lame);  // in files as one of two pairs
    visit(key("second_invariant", "", "the part of mu that it carries",
              Range{.low = 0, .high = highest_second_invariant(material.lame)})
              .required()
              .only_with(material.model == Model::MooneyRivlin, "model = \"mooney-rivlin\""),
          material.second_invariant);
    visit(key("density", "kg/m^n", "", kPositive), material.density);
}

/// The two pairs; the second takes the place of the first, whose defaults are
/// below.
inline constexpr Field kYoung = key("young", "Pa", "", kPositive).otherwise(1e5);
inline constexpr Field kPoisson = key("poisson", "", "-1 < nu < 1/(n-1)").otherwise(0.28);
inline constexpr Field kMu =
    key("mu",
        "Pa",
        "with lambda in place of the two",
        Range{.low = 0, .low_included = false, .smallest = 1e-70, .largest = 1e70});
inline constexpr Field kLambda =
    key("lambda",
        "Pa",
        "above -2 mu / n",
        Range{.low_included = false, .smallest = 1e-70, .largest = 1e70});

inline constexpr Field kLamePairs[] = {kYoung, kPoisson, kMu, kLambda};

template <PartOf<Region> Part, typename Visit>
void fields(Part& region, const Visit& visit) {
    visit(key("name", "", "as of a body; used once in it").required(), region.name);
    visit(key("select", "",
              "as of a constraint, but of cells: those with their center there, with all vertices "
              "in the layers, or with the region label")
              .required(),
          region.select);
    visit(key("material", "", "as of a body").required(), region.material);
}

template <PartOf<Body> Part, typename Visit>
void fields(Part& body, const Visit& visit) {
    visit(key("name", "", "1 to 100 letters, digits, `-`, `_`; used once").required(), body.name);
    visit(key("mesh", "", "path of a .pent file, relative to the scene file").required(),
          body.mesh);
    visit(key("recipe", "",
              "the arguments of `pent-mesh` that make the mesh, paths relative to the scene file; "
              "for `pent-study`")
              .may_be_missing(),
          body.recipe);
    visit(key("place"), body.place);
    visit(key("material"), body.material);
    visit(key("velocity", "m/s", "at the start").may_be_missing(), body.velocity);
    visit(key("spin", "", "at the start, about the center of mass"), body.spin);
    visit(key("friction", "", "Coulomb's coefficient; of two that touch the geometric mean counts",
              kNotNegative)
              .may_be_missing()
              .default_is("that of `[contact]`"),
          body.friction);
    visit(key("region", "", "cells of another material; of what two select the later one has it"),
          body.regions);
}

}  // namespace pent::simulator
