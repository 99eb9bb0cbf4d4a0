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

/// Without obstacles the forces of contact add up to nothing, and without friction, which pulls at
/// two points a distance apart, their moments too.
void check_reaction(const simulator::Scene& scene);

/// Bodies that are turned, mirrored, elsewhere, in another order and with other numbers of their
/// vertices have the energies that they had, and the same forces of contact, turned as they are.
void check_frame(const simulator::Scene& scene);

/// With a barrier nothing crosses, at no step and on no way between: found by trying every pair.
void check_crossings(const simulator::Scene& scene);

/// Until the first body falls asleep, sleep changes nothing; falling asleep changes no force of
/// contact; and from there on nothing is further from where it would be than what counts as rest
/// lets it go.
void check_sleep(const simulator::Scene& scene);

/// What a host does at random, one, two or three acts before a step, has the same states for 1 and
/// 3 threads; a step that is undone is the same when it is taken again; a state goes on in another
/// simulation; and what is refused is refused in one line and has changed nothing.
void check_host(const simulator::Scene& scene);

}  // namespace pent::scene_fuzz
