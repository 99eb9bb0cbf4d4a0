#include "potentials/scene_energy.h"

#include "potentials/force_loads.h"
#include "potentials/gravity.h"
#include "potentials/pressure_loads.h"

#include <memory>
#include <utility>

namespace pent::simulator {

template <int Dim>
SceneEnergy<Dim>::SceneEnergy(const Workers& workers,
                              const Kernels<Dim>& kernels,
                              const Bodies<Dim>& bodies,
                              const Scene& scene) {
    if (!scene.gravity.isZero(0)) {
        sum.add(std::make_unique<Gravity<Dim>>(workers, bodies.masses, scene.gravity));
    }
    elasticity = &sum.add(
        std::make_unique<Elasticity<Dim>>(workers, kernels, bodies, scene.solver.elements));
    if (auto loads = std::make_unique<ForceLoads<Dim>>(scene, bodies); !loads->is_empty()) {
        sum.add(std::move(loads));
    }
    if (auto loads = std::make_unique<PressureLoads<Dim>>(workers, scene, bodies);
        !loads->is_empty()) {
        sum.add(std::move(loads));
    }
    if (!scene.attachments.empty()) {
        attachments = &sum.add(std::make_unique<Attachments<Dim>>(workers, scene, bodies));
    }
    contact = &sum.add(std::make_unique<ContactPotential<Dim>>(workers, scene, bodies));
    if (scene.contact && scene.contact->friction > 0) {
        const contact::Friction law{scene.contact->friction, scene.contact->slip_speed};
        friction = &sum.add(std::make_unique<FrictionPotential<Dim>>(*contact, law));
    }
}

template struct SceneEnergy<3>;
template struct SceneEnergy<4>;

}  // namespace pent::simulator
