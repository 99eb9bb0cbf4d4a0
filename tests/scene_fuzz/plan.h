#pragma once

#include "meshes.h"
#include "random.h"

#include <array>
#include <string>
#include <vector>

namespace pent::scene_fuzz {

using Vector = std::array<double, 4>;  ///< Entries behind the dimension are 0.

/// A body where the scene will have it.
struct PlannedBody {
    std::string name;
    MeshName mesh;
    double scale = 1;
    bool is_turned = false;
    Vector center = {};
    Vector half = {};  ///< Half the box around it, however it is turned, m.
    Vector velocity = {};
};

/// What the keys of a scene are drawn from: sizes, places and times that fit each other, so that
/// bodies meet within few steps and stiffness, mass and step go together.
struct Plan {
    int dimension = 3;
    int frames = 5;
    int steps_per_frame = 1;
    double frames_per_second = 100;
    double size = 1;       ///< Of a body, m.
    double edge = 0.5;     ///< Of a cell, m.
    double distance = 0;   ///< Of contact, m.
    double gap = 0;        ///< Between neighbors, m.
    int axis = 1;          ///< Along which bodies are lined up.
    bool is_calm = false;  ///< At most one body moves at first, and there is no gravity.
    std::vector<PlannedBody> bodies;
    std::size_t body = 0;  ///< The one whose keys are being drawn.

    [[nodiscard]] double dt() const { return 1 / (frames_per_second * steps_per_frame); }
    [[nodiscard]] double duration() const { return frames / frames_per_second; }
    [[nodiscard]] const PlannedBody& now() const { return bodies[body]; }
    [[nodiscard]] double lowest() const;  ///< Of all bodies, along y, m.
    [[nodiscard]] double reach() const;   ///< Of all bodies from the origin, m.
};

[[nodiscard]] Plan make_plan(Random& random);

}  // namespace pent::scene_fuzz
