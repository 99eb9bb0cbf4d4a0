#pragma once

#include "scenes.h"

namespace pent::contact::test {

inline constexpr double kBarrierStiffness = 7;

/// Two shaken cubes side by side with a gap of 0.1 m and a little aside, so that all strata occur,
/// and a barrier between them.
template <int Dim>
struct TwoCubes {
    Scene<Dim> scene;
    Positions<Dim> rest;
    ContactOptions options{.model = ContactModel::Barrier, .distance = 0.2, .separation = 0.01};

    TwoCubes() {
        scene.add(cube<Dim>(1), Vector<Dim>::Zero());
        Vector<Dim> aside = Vector<Dim>::Constant(0.13);
        aside[0] = 1.1;
        scene.add(cube<Dim>(1), aside);
        rest = scene.positions;
        shake<Dim>(scene.positions, 0.02, 4);
    }

    [[nodiscard]] ContactScene<Dim> model(
        const std::vector<ObstacleShape<Dim>>& obstacles = {}) const {
        ContactScene<Dim> model = contact_scene<Dim>(scene, options, obstacles);
        model.rest = rest;
        return model;
    }

    /// With the first cube moved along an axis.
    [[nodiscard]] Positions<Dim> pushed(double distance, int axis = 0) const {
        Positions<Dim> x = scene.positions;
        x.leftCols(scene.begin[1]).row(axis).array() += distance;
        return x;
    }

    /// A point below the middle of the lowest side, along the last axis, of the first cube.
    [[nodiscard]] static Vector<Dim> below(double depth) {
        Vector<Dim> center = Vector<Dim>::Constant(0.45);
        center[Dim - 1] = -depth;
        return center;
    }
};

}  // namespace pent::contact::test
