#pragma once

#include "document.h"
#include "plan.h"

#include <functional>
#include <initializer_list>
#include <string>
#include <vector>

namespace pent::scene_fuzz {

/// A key of a table: how likely a scene has it, and how its value is drawn.
struct Key {
    const char* name;
    double chance;
    std::function<Json(Random&, const Plan&)> draw;
};
using Keys = std::vector<Key>;

inline Json draw_table(const Keys& keys, Random& random, const Plan& plan) {
    Json table = Json::object();
    for (const Key& key : keys) {
        if (random.chance(key.chance)) {
            table[key.name] = key.draw(random, plan);
        }
    }
    return table;
}

// Kinds of values.

inline auto one_of(std::initializer_list<const char*> words) {
    return [words = std::vector<std::string>(words.begin(), words.end())](
               Random& random, const Plan&) -> Json { return words[random.below(words.size())]; };
}

inline auto flag() {
    return [](Random& random, const Plan&) -> Json { return random.chance(0.5); };
}

inline auto number(double low, double high) {
    return [=](Random& random, const Plan&) -> Json { return random.number(low, high); };
}

inline auto magnitude(double low, double high) {
    return [=](Random& random, const Plan&) -> Json { return random.magnitude(low, high); };
}

inline auto whole(int low, int high) {
    return [=](Random& random, const Plan&) -> Json { return random.whole(low, high); };
}

inline auto table(const Keys& keys) {
    return [&keys](Random& random, const Plan& plan) -> Json {
        return draw_table(keys, random, plan);
    };
}

// One table, or a list of up to two.
inline auto tables(const Keys& keys) {
    return [&keys](Random& random, const Plan& plan) -> Json {
        if (random.chance(0.4)) {
            return draw_table(keys, random, plan);
        }
        Json list = Json::array();
        for (int i = random.whole(1, 2); i > 0; --i) {
            list.push_back(draw_table(keys, random, plan));
        }
        return list;
    };
}

inline Json as_json(const Vector& vector, int dimension) {
    Json list = Json::array();
    for (int axis = 0; axis < dimension; ++axis) {
        list.push_back(Random::short_of(vector[static_cast<std::size_t>(axis)]));
    }
    return list;
}

inline Json unit(int axis, double sign, int dimension) {
    Vector vector = {};
    vector[static_cast<std::size_t>(axis)] = sign;
    return as_json(vector, dimension);
}

// Of any length and direction below it.
inline Json random_vector(Random& random, const Plan& plan, double most) {
    Vector vector = {};
    for (double& entry : vector) {
        entry = random.number(-most, most);
    }
    return as_json(vector, plan.dimension);
}

inline Json plane(Random& random, const Plan& plan) {
    const auto axes = static_cast<std::size_t>(plan.dimension);
    const std::size_t from = random.below(axes);
    const std::size_t to = (from + 1 + random.below(axes - 1)) % axes;
    return std::string{"xyzw"[from], "xyzw"[to]};
}

}  // namespace pent::scene_fuzz
