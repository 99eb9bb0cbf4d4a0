#include "potentials/scene_energy.h"

#include "potentials/pressure_loads.h"

#include <cmath>
#include <memory>
#include <optional>
#include <utility>

namespace pent::simulator {

namespace {

// None if nothing has friction.
std::optional<contact::Friction> friction_law(const Scene& scene) {
    if (!scene.contact) {
        return std::nullopt;
    }
    contact::Friction law{scene.contact->friction, scene.contact->slip_speed};
    bool has_own = false;
    for (const Body& body : scene.bodies) {
        law.of_bodies.push_back(std::isinf(body.friction) ? law.coefficient : body.friction);
        has_own = has_own || law.of_bodies.back() != law.coefficient;
    }
    if (!has_own) {
        law.of_bodies.clear();
    }
    return has_own || law.coefficient > 0 ? std::optional(law) : std::nullopt;
}

}  // namespace

template <int Dim>
SceneEnergy<Dim>::SceneEnergy(const Workers& workers,
                              const Kernels<Dim>& kernels,
                              const Bodies<Dim>& bodies,
                              const Scene& scene) {
    // What a host may change later is there from the beginning, since sums have one order.
    gravity = &sum.add(
        std::make_unique<Gravity<Dim>>(workers, bodies.masses, Vector<Dim>(scene.gravity)));
    elasticity = &sum.add(std::make_unique<Elasticity<Dim>>(workers, kernels, bodies, scene));
    forces = &sum.add(std::make_unique<ForceLoads<Dim>>(scene, bodies));
    if (auto loads = std::make_unique<PressureLoads<Dim>>(workers, scene, bodies);
        !loads->is_empty()) {
        sum.add(std::move(loads));
    }
    if (!scene.attachments.empty()) {
        attachments = &sum.add(std::make_unique<Attachments<Dim>>(workers, scene, bodies));
    }
    grabs = &sum.add(std::make_unique<Grabs<Dim>>(scene, bodies));
    contact = &sum.add(std::make_unique<ContactPotential<Dim>>(workers, scene, bodies));
    if (const auto law = friction_law(scene)) {
        friction = &sum.add(std::make_unique<FrictionPotential<Dim>>(*contact, *law));
    }
}

template struct SceneEnergy<3>;
template struct SceneEnergy<4>;

}  // namespace pent::simulator
