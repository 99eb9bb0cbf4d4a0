#pragma once

#include <pent/error.h>
#include <pent/simulator/scene.h>

namespace pent::scene_fuzz {

/// Thrown by the laws below, with what was seen. They read the meshes that the scene names, take
/// its steps in memory, and return at once where they have nothing to say about a scene.
class BrokenLaw : public Error {
public:
    using Error::Error;
};

/// Where nothing acts from outside but gravity, the momentum is that of the start and of gravity,
/// but for what the reports of the steps say is left unsolved.
void check_momentum(const simulator::Scene& scene);

/// Without obstacles the forces of contact add up to nothing.
void check_reaction(const simulator::Scene& scene);

/// With a barrier nothing crosses, at no step and on no way between: found by trying every pair.
void check_crossings(const simulator::Scene& scene);

/// Until the first body falls asleep, sleep changes nothing; falling asleep changes no force of
/// contact; and from there on nothing is further from where it would be than what counts as rest
/// lets it go.
void check_sleep(const simulator::Scene& scene);

}  // namespace pent::scene_fuzz
