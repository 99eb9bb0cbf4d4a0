#pragma once

#include "scenes.h"

// Scenes of contact by penalty, for tests of its finder.

namespace pent::contact::test {

inline constexpr double kEps = 0.2;  // the cells of the bodies are 1 m
inline constexpr double kStiffness = 1000;
inline constexpr ContactOptions kOptions{.distance = kEps};

template <int Dim>
Contacts<Dim> contacts_of(const Scene<Dim>& scene, const ContactOptions& options = kOptions) {
    return ContactFinder<Dim>(contact_scene<Dim>(scene, options)).find(scene.positions, kStiffness);
}

template <int Dim>
Positions<Dim> forces_of(const Contacts<Dim>& contacts, Eigen::Index vertices) {
    Positions<Dim> gradient = Positions<Dim>::Zero(Dim, vertices);
    add_gradient<Dim>(contacts, gradient);
    return -gradient;
}

}  // namespace pent::contact::test
