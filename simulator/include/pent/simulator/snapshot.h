#pragma once

#include <pent/simplex_mesh.h>
#include <pent/simulator/host.h>

#include <cstdint>
#include <vector>

namespace pent::simulator {

/// Whether a body sleeps, and what it takes to decide that; see Sleep.
struct SleepState {
    bool is_asleep = false;
    std::uint64_t quiet_steps = 0;  ///< Steps in a row, up to now, that ended with it at rest.
    double contact_stiffness =
        0;  ///< Of a barrier when it fell asleep, N/m: it keeps those forces.

    bool operator==(const SleepState&) const = default;
};

/// All that a simulation carries from one step to the next, to be put back later: the same steps
/// follow, to the bit. Whoever goes on by steps of another length gives that, how many of them have
/// led to the same time, and nothing one step ago.
template <int Dim>
struct Snapshot {
    Positions<Dim> positions;   ///< Dim x vertices of all bodies, m.
    Positions<Dim> velocities;  ///< Dim x vertices, m/s.
    /// What BDF2 looks back to, the state one step ago; no columns after a step that was cut in
    /// two, and for the other integrators. Whoever moves bodies in a snapshot takes these away, and
    /// lets nothing sleep that lay on them.
    Positions<Dim> previous_positions;
    Positions<Dim> previous_velocities;
    std::vector<SleepState> sleep;  ///< One a body.
    std::uint64_t steps = 0;        ///< Taken so far,
    double time_step = 0;           ///< of this length, s.
    double contact_stiffness = 0;   ///< To which a barrier has adapted, N/m; 0 without one.
    /// Where constraints that begin after the start have taken up their vertices, m: Dim x their
    /// vertices, one constraint after the other; zero for those that have not begun.
    Positions<Dim> hold_places;
    /// One for each spring of all attachments: 1 if it is broken, else 0.
    std::vector<std::uint8_t> broken_springs;
    HostState<Dim> host;
};

}  // namespace pent::simulator
