#pragma once

#include <pent/simplex_mesh.h>
#include <pent/simulator/host.h>

#include <cstdint>
#include <vector>

namespace pent::simulator {

/// Whether a body sleeps, and what is needed to decide when it does; see Sleep.
struct SleepState {
    bool is_asleep = false;
    std::uint64_t quiet_steps = 0;  ///< Steps in a row, up to now, that ended with it at rest.
    double contact_stiffness =
        0;  ///< Of a barrier when it fell asleep, N/m: forces on the body stay those.

    bool operator==(const SleepState&) const = default;
};

/// All state that a simulation carries from one step to the next. After it is restored the same
/// steps follow, to the bit. To continue with steps of another length set `time_step` to that and
/// `steps` to as many of them as make the same time, and leave the previous state empty.
template <int Dim>
struct Snapshot {
    Positions<Dim> positions;   ///< Dim x vertices of all bodies, m.
    Positions<Dim> velocities;  ///< Dim x vertices, m/s.
    /// The state one step ago, which BDF2 needs; no columns after a step that was cut in two, and
    /// for other integrators. If bodies are moved in a snapshot these have to be emptied, and what
    /// lay on the bodies must not be asleep.
    Positions<Dim> previous_positions;
    Positions<Dim> previous_velocities;
    std::vector<SleepState> sleep;  ///< One a body.
    std::uint64_t steps = 0;        ///< Taken so far,
    double time_step = 0;           ///< of this length, s.
    double contact_stiffness = 0;   ///< Of a barrier, as adapted so far, N/m; 0 without one.
    /// Where vertices were when their constraints began, of constraints that begin after the start,
    /// m: Dim x their vertices, one constraint after the other; zero for those yet to begin.
    Positions<Dim> hold_places;
    /// One for each spring of all attachments: 1 if it is broken, else 0.
    std::vector<std::uint8_t> broken_springs;
    HostState<Dim> host;
};

}  // namespace pent::simulator
