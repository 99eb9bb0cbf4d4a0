#include "contact_reader.h"

#include "scene_names.h"

#include <cmath>

namespace pent::simulator {

namespace {

template <typename Round>
Round read_round(TableReader& reader, int dimension) {
    Round round;
    round.center = reader.vector("center", dimension, {});
    round.radius = reader.number("radius", {}, kPositive);
    return round;
}

ObstacleShape read_shape(TableReader& obstacle, int dimension) {
    const std::string kind = obstacle.one_of({"half_space", "ball", "cavity", "bowl"});
    TableReader reader = obstacle.table(kind);
    ObstacleShape shape;
    if (kind == "half_space") {
        shape = HalfSpaceObstacle{.normal = read_direction(reader, "normal", dimension),
                                  .offset = reader.number("offset", 0, kAnyNumber)};
    } else if (kind == "ball") {
        shape = read_round<BallObstacle>(reader, dimension);
    } else if (kind == "cavity") {
        shape = read_round<CavityObstacle>(reader, dimension);
    } else {
        auto bowl = read_round<BowlObstacle>(reader, dimension);
        bowl.up = Eigen::VectorXd::Unit(dimension, 1);
        if (reader.has("up")) {
            bowl.up = read_direction(reader, "up", dimension);
        }
        shape = bowl;
    }
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

}  // namespace pent::simulator
