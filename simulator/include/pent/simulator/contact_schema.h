#pragma once

#include <pent/simulator/contact_settings.h>
#include <pent/simulator/field.h>
#include <pent/simulator/obstacle.h>

#include <type_traits>

/// The fields of contact and obstacles; see scene_schema.h.
namespace pent::simulator {

/// Of the shapes of obstacles, which know their own fields.
template <typename Shape, typename Visit>
requires requires {
    std::remove_const_t<Shape>::kRepels;
}
void fields(Shape& shape, const Visit& visit) {
    shape.fields(shape, [&](const char* name, auto& value, ShapeField kind) {
        // Axes are given by angles, as `rotate`.
        if constexpr (!std::is_same_v<std::remove_cvref_t<decltype(value)>, Eigen::MatrixXd>) {
            const bool is_up = kind == ShapeField::UpDirection;
            Field field = key(name, "m", "", kind == ShapeField::Length ? kPositive : kAnyNumber);
            field.is_direction = kind == ShapeField::Direction || is_up;
            field.is_required = kind != ShapeField::Number && !is_up;
            visit(field, value);
        }
    });
}

template <PartOf<Obstacle> Part, typename Visit>
void fields(Part& obstacle, const Visit& visit) {
    visit(key("shape").required(),
          obstacle.shape);  // its name is the key
    visit(key("distance", "m", "", kPositive), obstacle.distance);
    visit(key("stiffness", "N/m for each vertex", "", kPositive), obstacle.stiffness);
    visit(key("rotate", "", "how it stands at the start: in the order written, about its center"),
          obstacle.rotate);
    visit(key("motion", "", "as of a constraint, about its center"), obstacle.motion);
    visit(key("friction", "", "as of a body", kNotNegative)
              .may_be_missing()
              .default_is("that of `[contact]`"),
          obstacle.friction);
}

template <PartOf<ContactSettings> Part, typename Visit>
void fields(Part& contact, const Visit& visit) {
    visit(key("model", "",
              "with a barrier nothing crosses ([barrier.md](barrier.md)); not with `linear_euler`"),
          contact.model);
    visit(key("distance", "m", "how near is in contact; a quarter of the surface edges is good",
              kPositive),
          contact.distance);
    visit(key("stiffness", "N/m for each pair", "", kPositive), contact.stiffness);
    visit(key("self", "", "whether bodies meet themselves"), contact.self);
    visit(key("filter", "", "of the Hessian of a pair"), contact.filter);
    visit(key("separation", "m", "a distance that a barrier never lets be reached", kNotNegative),
          contact.separation);
    visit(key("friction", "", "Coulomb's coefficient, of bodies and obstacles", kNotNegative),
          contact.friction);
    visit(key("slip_speed", "m/s", "what slides slower sticks", kPositive), contact.slip_speed);
    visit(key("ignore", "", "pairs of bodies that do not see each other; of one and itself, too"),
          contact.ignore);
    visit(key("only", "", "if there are any, no other pair sees each other"), contact.only);
}

template <PartOf<BodyPair> Part, typename Visit>
void fields(Part& pair, const Visit& visit) {
    visit(key("first", "", "name of a body").required(), pair.first);
    visit(key("second", "", "name of a body").required(), pair.second);
}

}  // namespace pent::simulator
