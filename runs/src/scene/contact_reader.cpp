#include "scene/contact_reader.h"

#include "scene/scene_names.h"

#include <pent/obstacle.h>

#include <algorithm>
#include <cmath>

namespace pent::runs {

namespace {

// Reads a field of a shape.
struct FieldReader {
    TableReader& reader;
    int dimension;

    void operator()(const char* key, double& value, ShapeField kind) const {
        value = kind == ShapeField::Length ? reader.number(key, {}, kPositive)
                                           : reader.number(key, 0, kAnyNumber);
    }
    void operator()(const char* key, Eigen::VectorXd& value, ShapeField kind) const {
        switch (kind) {
            case ShapeField::UpDirection:
                if (!reader.has(key)) {
                    return;  // it is along the second axis
                }
                [[fallthrough]];
            case ShapeField::Direction:
                value = read_direction(reader, key, dimension);
                return;
            default:
                value = reader.vector(key, dimension, {});
        }
        if (kind == ShapeField::Length && !(value.array() > 0).all()) {
            reader.fail(key, "\"" + std::string(key) + "\" has a length that is not above 0");
        }
    }
};

ObstacleShape read_shape(TableReader& obstacle, int dimension) {
    const std::vector<ObstacleShape> shapes = all_shapes(dimension);
    std::vector<std::string> names;
    for (const ObstacleShape& shape : shapes) {
        names.emplace_back(name_of<Eigen::Dynamic>(shape));
    }
    const std::string kind = obstacle.one_of(names);
    ObstacleShape shape = shapes[static_cast<std::size_t>(
        std::find(names.begin(), names.end(), kind) - names.begin())];
    TableReader reader = obstacle.table(kind);
    std::visit([&](auto& one) { one.fields(one, FieldReader{reader, dimension}); }, shape);
    reader.finish();
    return shape;
}

}  // namespace

Eigen::VectorXd read_direction(TableReader& reader, std::string_view key, int dimension) {
    const Eigen::VectorXd direction = reader.vector(key, dimension, {});
    if (!(direction.norm() > 0)) {
        reader.fail(key, "\"" + std::string(key) + "\" is zero; expected a direction");
    }
    // One that is a unit vector to rounding stays as it is, so that a scene written out and read
    // again is the same to the last bit.
    return std::abs(direction.norm() - 1) < 1e-14 ? direction : direction.normalized();
}

Contact read_contact(TableReader reader) {
    Contact contact;
    contact.model = kContactModels[reader.choice("model", names_of(kContactModels), 0)].value;
    contact.distance = reader.number("distance", contact.distance, kPositive);
    contact.stiffness = reader.number("stiffness", contact.stiffness, kPositive);
    contact.self = reader.flag("self", contact.self);
    contact.filter =
        kFilters[reader.choice("filter", names_of(kFilters), place_of(kFilters, contact.filter))]
            .value;
    contact.separation = reader.number("separation", contact.separation, kNotNegative);
    contact.friction = reader.number("friction", contact.friction, kNotNegative);
    contact.slip_speed = reader.number("slip_speed", contact.slip_speed, kPositive);
    reader.finish();
    return contact;
}

Obstacle read_obstacle(TableReader& reader, int dimension) {
    Obstacle obstacle;
    obstacle.distance = reader.number("distance", obstacle.distance, kPositive);
    obstacle.stiffness = reader.number("stiffness", obstacle.stiffness, kPositive);
    obstacle.shape = read_shape(reader, dimension);
    reader.finish();
    return obstacle;
}

}  // namespace pent::runs
