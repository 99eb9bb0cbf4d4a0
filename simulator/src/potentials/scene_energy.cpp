#include "potentials/scene_energy.h"

#include "potentials/pressure_loads.h"

#include <pent/dimensions.h>

#include <cmath>
#include <memory>
#include <optional>
#include <utility>
#include <vector>

namespace pent::simulator {

namespace {

// Nothing if nothing has friction. Bodies rub on obstacles without [contact], too.
std::optional<contact::Friction> friction_law(const Scene& scene) {
    const ContactSettings settings = scene.contact.value_or(ContactSettings{});
    contact::Friction law{settings.friction, settings.slip_speed};
    bool is_any_above = law.coefficient > 0;
    const auto collect = [&](const auto& parts) {
        std::vector<double> own;
        bool has_own = false;
        for (const auto& part : parts) {
            own.push_back(std::isinf(part.friction) ? law.coefficient : part.friction);
            has_own = has_own || own.back() != law.coefficient;
            is_any_above = is_any_above || own.back() > 0;
        }
        return has_own ? own : std::vector<double>();
    };
    law.of_bodies = collect(scene.bodies);
    law.of_obstacles = collect(scene.obstacles);
    return is_any_above ? std::optional(law) : std::nullopt;
}

}  // namespace

template <int Dim>
SceneEnergy<Dim>::SceneEnergy(const Workers& workers,
                              const Kernels<Dim>& kernels,
                              const Bodies<Dim>& bodies,
                              const HeldVertices<Dim>& held,
                              const Scene& scene) {
    // Terms that a host may change later are there from the beginning, even if empty: the order of
    // a sum decides its rounding.
    gravity = &sum.add(
        std::make_unique<Gravity<Dim>>(workers, bodies.masses, Vector<Dim>(scene.gravity)));
    elasticity = &sum.add(std::make_unique<Elasticity<Dim>>(workers, kernels, bodies, held, scene));
    forces = &sum.add(std::make_unique<ForceLoads<Dim>>(scene, bodies));
    if (auto loads = std::make_unique<PressureLoads<Dim>>(workers, scene, bodies, held);
        !loads->is_empty()) {
        sum.add(std::move(loads));
    }
    if (!scene.attachments.empty()) {
        attachments = &sum.add(std::make_unique<Attachments<Dim>>(workers, scene, bodies));
    }
    grabs = &sum.add(std::make_unique<Grabs<Dim>>(scene, bodies));
    add_contact(std::make_unique<ContactPotential<Dim>>(workers, scene, bodies, held), scene);
}

template <int Dim>
void SceneEnergy<Dim>::add_contact(std::unique_ptr<ContactPotential<Dim>> potential,
                                   const Scene& scene) {
    contact = &sum.add(std::move(potential));
    const auto law = friction_law(scene);
    friction = law ? &sum.add(std::make_unique<FrictionPotential<Dim>>(*contact, *law)) : nullptr;
}

template <int Dim>
void SceneEnergy<Dim>::replace_contact(std::unique_ptr<ContactPotential<Dim>> other,
                                       const Scene& scene) {
    sum.remove_from(*contact);
    add_contact(std::move(other), scene);
}

#define PENT_INSTANTIATE(Dim) template struct SceneEnergy<Dim>;
PENT_FOR_EACH_DIMENSION(PENT_INSTANTIATE)
#undef PENT_INSTANTIATE

}  // namespace pent::simulator
