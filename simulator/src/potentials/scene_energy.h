#pragma once

#include "model/held_vertices.h"
#include "potentials/attachments.h"
#include "potentials/contact_potential.h"
#include "potentials/elasticity.h"
#include "potentials/force_loads.h"
#include "potentials/friction_potential.h"
#include "potentials/grabs.h"
#include "potentials/gravity.h"
#include "potentials/potential_energy.h"

namespace pent::simulator {

/// The potential energy of a scene: what a scene asks for becomes terms here, and nowhere else.
template <int Dim>
struct SceneEnergy {
    /// @param workers, kernels, bodies  Must outlive this.
    /// @param held                      At the start; not needed afterwards.
    SceneEnergy(const Workers& workers,
                const Kernels<Dim>& kernels,
                const Bodies<Dim>& bodies,
                const HeldVertices<Dim>& held,
                const Scene& scene);

    /// Puts contact of other obstacles, and friction with it, in the place of what there is.
    ///
    /// @param scene  With these obstacles.
    void replace_contact(std::unique_ptr<ContactPotential<Dim>> other, const Scene& scene);

    PotentialEnergy<Dim> sum;
    // Terms that have more to say than the others, or that a host changes.
    Gravity<Dim>* gravity;
    Elasticity<Dim>* elasticity;
    ContactPotential<Dim>* contact;
    ForceLoads<Dim>* forces;
    Grabs<Dim>* grabs;
    FrictionPotential<Dim>* friction = nullptr;  // null without friction
    Attachments<Dim>* attachments = nullptr;     // null without [[attachment]]

private:
    // They come last: all else stays where it is when they are replaced.
    void add_contact(std::unique_ptr<ContactPotential<Dim>> potential, const Scene& scene);
};

}  // namespace pent::simulator
